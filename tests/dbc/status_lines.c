/**
 * @file status_lines.c
 * What a real supervisor says in its status frame (TOP-3), as lines for a test in another language:
 *
 *   id ID, period MS                        defaults of the settings
 *   state NAME CODE, reason NAME CODE       what the program's own names are
 *   frame HEX STATE REASON OUTPUT CHECKSUM  a status frame that was sent, and what the supervisor itself reports after it
 *
 * The supervisor drives a healthy vehicle from INIT to ACTIVE, trips over an EPS fault, and is confirmed; a second one
 * never is. It runs on a HAL of this file's own.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agv/codec.h"
#include "agv/names.h"
#include "agv/supervisor.h"
#include "hal/can.h"
#include "hal/led.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "hal/store.h"
#include "hal/watchdog.h"

enum { ENGAGED_MS = 1037, FAULT_MS = 1837, CONFIRMED_MS = 1937, END_MS = 3000 };

struct hal {
    hal_can_frame_t status; /* the last status frame that was sent */
    bool sent;
};

typedef struct {
    hal_t hal;
    agv_supervisor_t supervisor;
    agv_ports_t ports;
    uint32_t now_ms;
} run_t;

static agv_recorder_t recorder;

bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    if (side == HAL_CAN_VEHICLE && frame->id == 0x7F0u) {
        hal->status = *frame;
        hal->sent = true;
    }
    return true;
}

void hal_can_purge(hal_t *hal, hal_can_side_t side) {
    (void)hal;
    (void)side;
}

void hal_can_recover(hal_t *hal, hal_can_side_t side) {
    (void)hal;
    (void)side;
}

void hal_can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    (void)hal;
    (void)side;
    memset(status, 0, sizeof *status);
}

hal_reset_cause_t hal_reset_cause(hal_t *hal) {
    (void)hal;
    return HAL_RESET_POWER_ON;
}

void hal_led_set(hal_t *hal, bool on) {
    (void)hal;
    (void)on;
}

void hal_safety_output_set(hal_t *hal, bool closed) {
    (void)hal;
    (void)closed;
}

size_t hal_store_read_latch(hal_t *hal, void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    return 0;
}

bool hal_store_write_latch(hal_t *hal, const void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    return true;
}

bool hal_store_append(hal_t *hal, const void *record, size_t size) {
    return hal_store_write_latch(hal, record, size);
}

size_t hal_store_read_record(hal_t *hal, uint32_t index, void *record, size_t size) {
    (void)index;
    return hal_store_read_latch(hal, record, size);
}

void hal_watchdog_feed(hal_t *hal) {
    (void)hal;
}

/* The status frame that the last call sent, if it did, and what the supervisor reports now. */
static void print_frame(run_t *run) {
    const agv_fault_t reason = agv_supervisor_first_reason(&run->supervisor);
    if (!run->hal.sent) {
        return;
    }
    run->hal.sent = false;
    fputs("frame ", stdout);
    for (uint32_t i = 0; i < run->hal.status.length; i++) {
        printf("%02x", run->hal.status.data[i]);
    }
    printf(" %s %s %s %" PRIu32 "\n", agv_state_name(agv_supervisor_state(&run->supervisor)),
           (reason == AGV_FAULT_NONE) ? "none" : agv_fault_name(reason),
           agv_supervisor_output_closed(&run->supervisor) ? "closed" : "open",
           agv_config_checksum(agv_supervisor_config(&run->supervisor)));
}

static void give(run_t *run, agv_message_t message, const uint8_t data[AGV_DLC]) {
    hal_can_frame_t frame = {
        .id = agv_message_id(message, AGV_ID_SET_HEADING), .length = AGV_DLC, .time_ms = run->now_ms};
    memcpy(frame.data, data, AGV_DLC);
    agv_supervisor_frame(&run->supervisor, &run->ports, HAL_CAN_VEHICLE, &frame);
}

#define GIVE(run, MESSAGE, name, ...)                                                                                  \
    do {                                                                                                               \
        uint8_t data[AGV_DLC];                                                                                         \
        (void)agv_pack_##name(data, &(agv_##name##_t){__VA_ARGS__});                                                   \
        give((run), AGV_MSG_##MESSAGE, data);                                                                          \
    } while (0)

static void give_commands(run_t *run) {
    const uint8_t counter = (uint8_t)(run->now_ms / 25u);
    GIVE(run, TURN_SIGNAL_COMMAND, turn_signal_command, .alive_counter = counter);
    GIVE(run, GEAR_COMMAND, gear_command, .gear = AGV_GEAR_P);
    GIVE(run, THROTTLE_COMMAND, throttle_command, .throttle_permille = 0);
    GIVE(run, STEERING_COMMAND, steering_command, .angle_ddeg = 0);
}

/* All that the vehicle sends, every 10 ms. */
static void give_statuses(run_t *run, bool engaged, uint8_t eps_faults) {
    const uint8_t counter = (uint8_t)(run->now_ms / 10u);
    GIVE(run, VEHICLE_STATUS, vehicle_status, .manual_mode = !engaged, .autopilot_mode = engaged,
         .alive_counter = counter);
    GIVE(run, GEAR_STATUS, gear_status, .gear = AGV_GEAR_P);
    GIVE(run, THROTTLE_STATUS, throttle_status, .throttle_permille = 0);
    GIVE(run, STEERING_STATUS, steering_status, .alive_counter = counter);
    GIVE(run, EPS_STATUS, eps_status, .mode = AGV_EPS_MODE_ANGLE, .faults = eps_faults);
    GIVE(run, STEERING_POSITION, steering_position, .centre_raw = 0);
    GIVE(run, WHEEL_SPEED, wheel_speed, .left_mm_s = 0);
}

static void drive(bool is_confirmed) {
    static run_t run;
    agv_config_t config;
    memset(&run, 0, sizeof run);
    run.ports = (agv_ports_t){.hal = &run.hal, .recorder = &recorder};
    agv_config_defaults(&config);
    agv_supervisor_start(&run.supervisor, &run.ports, &config, true, 0);
    print_frame(&run);
    for (run.now_ms = 1; run.now_ms <= END_MS; run.now_ms++) {
        const bool engaged = run.now_ms >= ENGAGED_MS && !(is_confirmed && run.now_ms >= CONFIRMED_MS);
        if (run.now_ms % 10u == 7u) {
            give_statuses(&run, engaged, (run.now_ms >= FAULT_MS) ? AGV_EPS_FAULT_OVER_CURRENT_SHUTDOWN : 0u);
        }
        if (run.now_ms % 100u == 13u && run.now_ms < FAULT_MS) {
            give_commands(&run);
        } else if (run.now_ms % 25u == 13u && run.now_ms < FAULT_MS) {
            GIVE(&run, STEERING_COMMAND, steering_command, .angle_ddeg = 0);
        }
        agv_supervisor_receive_alive(&run.supervisor);
        agv_supervisor_tick(&run.supervisor, &run.ports, run.now_ms);
        print_frame(&run);
    }
}

static void print_codes(void) {
    agv_config_t config;
    agv_config_defaults(&config);
    printf("id %u\nperiod %u\n", config.status_frame_id, config.status_frame_period_ms);
    for (uint32_t code = 0; code <= UINT8_MAX; code++) {
        if (agv_state_name((agv_state_t)code) != NULL) {
            printf("state %s %" PRIu32 "\n", agv_state_name((agv_state_t)code), code);
        }
        if (agv_fault_name((agv_fault_t)code) != NULL) {
            printf("reason %s %" PRIu32 "\n", agv_fault_name((agv_fault_t)code), code);
        }
    }
}

int main(void) {
    print_codes();
    drive(true);
    drive(false);
    return ferror(stdout) ? 1 : 0;
}

/*
 * What tests/proofs/call-path/call-path.py runs: a supervisor on a shared bus is brought to ACTIVE by a healthy vehicle, then three calls of it
 * are traced: a 363h that changes nothing, a tick on which nothing is due, and a
 * 167h with a fault bit, which trips. The core is compiled with -finstrument-functions; each function entered and left
 * becomes a line. Public headers only, so that older cores can be measured by the same program.
 */
#include <inttypes.h>
#include <stdio.h>

#include "agv/supervisor.h"
#include "hal/led.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "hal/store.h"
#include "hal/watchdog.h"

struct hal {
    int nothing;
};

void __cyg_profile_func_enter(void *function, void *site);
void __cyg_profile_func_exit(void *function, void *site);

static bool tracing;

void __cyg_profile_func_enter(void *function, void *site) {
    (void)site;
    if (tracing) {
        (void)printf("> %" PRIxPTR "\n", (uintptr_t)function);
    }
}

void __cyg_profile_func_exit(void *function, void *site) {
    (void)function;
    (void)site;
    if (tracing) {
        (void)printf("<\n");
    }
}

/* ---- A port that takes everything ---- */

bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)hal;
    (void)side;
    (void)frame;
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
    *status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
}

void hal_led_set(hal_t *hal, bool on) {
    (void)hal;
    (void)on;
}

hal_reset_cause_t hal_reset_cause(hal_t *hal) {
    (void)hal;
    return HAL_RESET_POWER_ON;
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
    (void)hal;
    (void)record;
    (void)size;
    return true;
}

void hal_watchdog_feed(hal_t *hal) {
    (void)hal;
}

/* ---- A healthy vehicle ---- */

enum { MANUAL = 0x40, ENGAGED = 0x80, STANDBY_MS = 700, ACTIVE_MS = 2000 };

static struct hal port;
static agv_recorder_t recorder;
static agv_supervisor_t supervisor;
static const agv_ports_t ports = {.hal = &port, .recorder = &recorder};
static uint32_t now_ms;

typedef struct {
    uint32_t id;
    uint32_t cycle_ms;
    uint8_t data[8];
    uint8_t counter_at; /* which byte counts; 8: none */
} message_t;

static message_t traffic[] = {
    {0x43F, 100, {0}, 7},           {0x168, 100, {1}, 8}, {0x075, 100, {0}, 8}, {0x065, 25, {0x28, 0x23}, 8},
    {0x363, 10, {[6] = MANUAL}, 7}, {0x0A3, 25, {8}, 8},  {0x050, 10, {0}, 8},  {0x067, 10, {0, 0, 0x28, 0x23}, 0},
    {0x167, 10, {[3] = 1}, 8},      {0x267, 10, {0}, 8},  {0x101, 10, {0}, 8}};
enum { VEHICLE_STATUS = 4, EPS_STATUS = 8, MESSAGES = sizeof traffic / sizeof traffic[0] };

static void send(message_t *message) {
    hal_can_frame_t frame = {.id = message->id, .time_ms = now_ms, .length = 8};
    if (message->counter_at < 8) {
        message->data[message->counter_at]++;
    }
    for (unsigned i = 0; i < 8; i++) {
        frame.data[i] = message->data[i];
    }
    agv_supervisor_frame(&supervisor, &ports, HAL_CAN_VEHICLE, &frame);
}

static void step(void) {
    for (unsigned i = 0; i < (unsigned)MESSAGES; i++) {
        if ((now_ms % traffic[i].cycle_ms) == 0) {
            send(&traffic[i]);
        }
    }
    agv_supervisor_receive_alive(&supervisor);
    agv_supervisor_tick(&supervisor, &ports, ++now_ms);
}

static bool run_to(uint32_t time_ms, agv_state_t state) {
    while (now_ms < time_ms) {
        step();
    }
    return agv_supervisor_state(&supervisor) == state;
}

static void traced_frame(const char *name, message_t *message) {
    (void)printf("%s\n", name);
    tracing = true;
    send(message);
    tracing = false;
}

static void traced_tick(const char *name) {
    (void)printf("%s\n", name);
    agv_supervisor_receive_alive(&supervisor);
    tracing = true;
    agv_supervisor_tick(&supervisor, &ports, ++now_ms);
    tracing = false;
}

int main(void) {
    agv_config_t config;
    agv_config_defaults(&config);
    agv_supervisor_start(&supervisor, &ports, &config, true, now_ms);
    if (!run_to(STANDBY_MS, AGV_STATE_STANDBY)) {
        return 1;
    }
    traffic[VEHICLE_STATUS].data[6] = ENGAGED;
    if (!run_to(ACTIVE_MS + 1, AGV_STATE_ACTIVE)) {
        return 1;
    }
    traced_frame("status frame", &traffic[VEHICLE_STATUS]);
    traced_tick("tick");
    traffic[EPS_STATUS].data[7] = 0x08; /* over-current shutdown: no count, one frame trips */
    traced_frame("trip", &traffic[EPS_STATUS]);
    return (agv_supervisor_state(&supervisor) == AGV_STATE_TRIPPED) ? 0 : 1;
}

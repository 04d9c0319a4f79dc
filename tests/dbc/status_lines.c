/**
 * @file status_lines.c
 * What a real supervisor sends in its status frame (TOP-3), as lines for a test in another language:
 *
 *   id ID, period MS                        defaults of the settings
 *   state NAME CODE, reason NAME CODE       what the program's own names are
 *   frame HEX STATE REASON OUTPUT CHECKSUM  a status frame that was sent, and what the supervisor itself reports after it
 *
 * The supervisor drives a healthy vehicle from INIT to ACTIVE, trips over an EPS fault, and is confirmed; a second one
 * never is.
 */
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "agv/supervisor.h"
#include "hal_sim/sim_hal.h"
#include "traffic.h"

enum { ENGAGED_MS = 1037, FAULT_MS = 1837, CONFIRMED_MS = 1937, END_MS = 3000 };

enum { STATUS_ID = 0x7F0 };

typedef struct {
    struct hal hal;
    sim_store_t store;
    bool is_kept; /* a status frame was sent */
    hal_can_frame_t kept;
    agv_supervisor_t supervisor;
    agv_ports_t ports;
    traffic_message_t traffic[TRAFFIC_MESSAGES];
    uint32_t now_ms;
} run_t;

static agv_recorder_t recorder;

/* The status frame that the last call sent, if it did, and what the supervisor reports now. */
static void print_frame(run_t *run) {
    const agv_fault_t reason = agv_supervisor_first_reason(&run->supervisor);
    if (!run->is_kept) {
        return;
    }
    run->is_kept = false;
    fputs("frame ", stdout);
    for (uint32_t i = 0; i < run->kept.length; i++) {
        printf("%02x", run->kept.data[i]);
    }
    printf(" %s %s %s %" PRIu32 "\n", agv_state_name(agv_supervisor_state(&run->supervisor)),
           (reason == AGV_FAULT_NONE) ? "none" : agv_fault_name(reason),
           agv_supervisor_output_closed(&run->supervisor) ? "closed" : "open",
           agv_config_checksum(agv_supervisor_config(&run->supervisor)));
}

static void send_due(run_t *run) {
    for (unsigned i = 0; i < TRAFFIC_MESSAGES; i++) {
        if (traffic_is_due(&run->traffic[i], run->now_ms)) {
            hal_can_frame_t frame = traffic_next(&run->traffic[i]);
            frame.time_ms = run->now_ms;
            agv_supervisor_frame(&run->supervisor, &run->ports, run->traffic[i].side, &frame);
        }
    }
}

/* An EPS fault that trips, and an AI computer that falls silent. */
static void fail(run_t *run) {
    run->traffic[M_EPS_STATUS].data[7] = 0x08;
    for (unsigned i = 0; i < TRAFFIC_COMMANDS; i++) {
        run->traffic[i].muted = true;
    }
}

static void keep(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    run_t *run = ctx;
    if ((side == HAL_CAN_VEHICLE) && (frame->id == STATUS_ID)) {
        run->kept = *frame;
        run->is_kept = true;
    }
}

static void start(run_t *run) {
    const sim_hal_config_t hal = {.watchdog_ms = SIM_HAL_WATCHDOG_OFF, .store = &run->store};
    agv_config_t config;
    memset(run, 0, sizeof *run);
    sim_store_init(&run->store);
    sim_hal_init_direct(&run->hal, &hal, 1, keep, run);
    run->ports = (agv_ports_t){.hal = &run->hal, .recorder = &recorder};
    agv_config_defaults(&config);
    traffic_address(run->traffic, &config);
    traffic_heal(run->traffic);
    agv_supervisor_start(&run->supervisor, &run->ports, &config, 0);
}

static void drive(bool is_confirmed) {
    static run_t run;
    start(&run);
    print_frame(&run);
    for (run.now_ms = 1; run.now_ms <= END_MS; run.now_ms++) {
        const bool engaged = run.now_ms >= ENGAGED_MS && !(is_confirmed && run.now_ms >= CONFIRMED_MS);
        traffic_mode(run.traffic, engaged ? MODE_ENGAGED : MODE_MANUAL);
        if (run.now_ms == FAULT_MS) {
            fail(&run);
        }
        sim_hal_set_now_ms(&run.hal, run.now_ms);
        send_due(&run);
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

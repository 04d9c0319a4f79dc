/*
 * What call-path.py runs: a healthy vehicle brings a supervisor on a shared bus to ACTIVE, then three calls of it are
 * traced: a 363h that changes nothing, a tick on which nothing is due, and a 167h with a fault bit, which trips. The core
 * is compiled with -finstrument-functions; each function entered and left becomes a line.
 */
#include <inttypes.h>
#include <stdio.h>

#include "agv/supervisor.h"
#include "hal_sim/sim_hal.h"
#include "traffic.h"

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

/* ---- A healthy vehicle ---- */

enum { STANDBY_MS = 700, ACTIVE_MS = 2000 };

static hal_t port; /* a port without a bus: nobody gets what is sent */
static agv_recorder_t recorder;
static agv_supervisor_t supervisor;
static const agv_ports_t ports = {.hal = &port, .recorder = &recorder};
static uint32_t now_ms;

static traffic_message_t traffic[TRAFFIC_MESSAGES];

static void send(traffic_message_t *message) {
    hal_can_frame_t frame = traffic_next(message);
    frame.time_ms = now_ms;
    agv_supervisor_frame(&supervisor, &ports, HAL_CAN_VEHICLE, &frame);
}

static void step(void) {
    for (unsigned i = 0; i < TRAFFIC_MESSAGES; i++) {
        if (traffic_is_due(&traffic[i], now_ms)) {
            send(&traffic[i]);
        }
    }
    sim_hal_set_now_ms(&port, ++now_ms);
    agv_supervisor_receive_alive(&supervisor);
    agv_supervisor_tick(&supervisor, &ports, now_ms);
}

static bool run_to(uint32_t time_ms, agv_state_t state) {
    while (now_ms < time_ms) {
        step();
    }
    return agv_supervisor_state(&supervisor) == state;
}

static void traced_frame(const char *name, traffic_message_t *message) {
    (void)printf("%s\n", name);
    tracing = true;
    send(message);
    tracing = false;
}

static void traced_tick(const char *name) {
    (void)printf("%s\n", name);
    sim_hal_set_now_ms(&port, ++now_ms);
    agv_supervisor_receive_alive(&supervisor);
    tracing = true;
    agv_supervisor_tick(&supervisor, &ports, now_ms);
    tracing = false;
}

int main(void) {
    agv_config_t config;
    agv_config_defaults(&config);
    traffic_address(traffic, &config);
    traffic_heal(traffic);
    traffic[M_GEAR].data[0] = GEAR_D;
    sim_hal_init_direct(&port, NULL, 1, NULL, NULL);
    agv_supervisor_start(&supervisor, &ports, &config, now_ms);
    if (!run_to(STANDBY_MS, AGV_STATE_STANDBY)) {
        return 1;
    }
    traffic_mode(traffic, MODE_ENGAGED);
    if (!run_to(ACTIVE_MS + 1, AGV_STATE_ACTIVE)) {
        return 1;
    }
    traced_frame("status frame", &traffic[M_VEHICLE]);
    traced_tick("tick");
    traffic[M_EPS_STATUS].data[7] = 0x08; /* over-current shutdown: no count, one frame trips */
    traced_frame("trip", &traffic[M_EPS_STATUS]);
    return (agv_supervisor_state(&supervisor) == AGV_STATE_TRIPPED) ? 0 : 1;
}

#include "agv/watch.h"

#include <stddef.h>
#include <string.h>

#include "agv/core.h"

/* Where its limit stands in the configuration, in bytes. */
#define LIMIT(setting) ((uint8_t)offsetof(agv_config_t, setting))

/* The setting that is the limit of each, in the order of agv_watch_t. */
static const uint8_t limits[AGV_WATCH_COUNT] = {LIMIT(bus_off_recovery_ms),
                                                LIMIT(bus_off_recovery_ms),
                                                LIMIT(standstill_ms),
                                                LIMIT(engaged_grace_ms),
                                                LIMIT(steering_deviation_ms),
                                                LIMIT(throttle_in_park_ms),
                                                LIMIT(init_hold_ms),
                                                LIMIT(reset_hold_ms),
                                                LIMIT(reset_hold_ms),
                                                LIMIT(park_timeout_ms),
                                                LIMIT(event_hold_ms),
                                                LIMIT(event_hold_ms),
                                                LIMIT(event_hold_ms),
                                                LIMIT(event_hold_ms),
                                                LIMIT(event_hold_ms),
                                                LIMIT(event_hold_ms),
                                                LIMIT(event_hold_ms),
                                                LIMIT(event_hold_ms),
                                                LIMIT(watchdog_period_ms),
                                                LIMIT(mode_invalid_ms),
                                                LIMIT(ai_never_seen_timeout_ms),
                                                LIMIT(wrong_id_set_ms),
                                                LIMIT(wrong_id_set_ms),
                                                LIMIT(startup_timeout_ms),
                                                LIMIT(confirm_timeout_ms),
                                                LIMIT(confirm_timeout_ms),
                                                LIMIT(tx_stalled_ms),
                                                LIMIT(tx_stalled_ms),
                                                LIMIT(tx_stalled_ms),
                                                LIMIT(tx_stalled_ms),
                                                LIMIT(ai_heartbeat_timeout_ms),
                                                LIMIT(gear_command_timeout_ms),
                                                LIMIT(throttle_command_timeout_ms),
                                                LIMIT(steering_command_timeout_ms),
                                                LIMIT(vcu_heartbeat_timeout_ms),
                                                LIMIT(gear_status_timeout_ms),
                                                LIMIT(throttle_status_timeout_ms),
                                                LIMIT(eps_heartbeat_timeout_ms),
                                                LIMIT(eps_status_timeout_ms),
                                                LIMIT(steering_position_timeout_ms),
                                                LIMIT(wheel_speed_timeout_ms)};

uint32_t agv_age_ms(uint32_t now_ms, uint32_t then_ms) {
    const uint32_t difference = now_ms - then_ms;
    return (difference > (UINT32_MAX / 2u)) ? 0u : difference;
}

void agv_watch_start_at(agv_core_t *core, uint32_t watch, uint32_t since_ms) {
    core->watches.since_ms[watch] = since_ms;
    core->watches.phase[watch] = AGV_WATCH_RUNNING;
}

void agv_watch_start(agv_core_t *core, uint32_t watch) {
    agv_watch_start_at(core, watch, core->now_ms);
}

void agv_watch_stop(agv_core_t *core, uint32_t watch) {
    core->watches.phase[watch] = AGV_WATCH_STOPPED;
}

bool agv_watch_reached(agv_core_t *core, uint32_t watch) {
    uint32_t phase = core->watches.phase[watch];
    uint32_t age_ms = agv_age_ms(core->now_ms, core->watches.since_ms[watch]);
    uint16_t limit_ms;
    (void)memcpy(&limit_ms, &((const unsigned char *)&core->config)[limits[watch]], sizeof limit_ms);
    if (watch < (uint32_t)AGV_WATCH_UNFED) {
        age_ms++; /* its limit is enough, a deadline's is not */
    }
    if ((phase == (uint32_t)AGV_WATCH_RUNNING) && (age_ms > limit_ms)) {
        phase = AGV_WATCH_REACHED;
        core->watches.phase[watch] = AGV_WATCH_REACHED;
    }
    return (phase & (uint32_t)AGV_WATCH_REACHED) != 0u;
}

bool agv_watch_while(agv_core_t *core, uint32_t watch, bool condition) {
    if (!condition) {
        agv_watch_stop(core, watch);
    } else if (!agv_watch_runs(core, watch)) {
        agv_watch_start(core, watch);
    } else {
        /* goes on running */
    }
    return agv_watch_reached(core, watch);
}

bool agv_watch_is_within(const agv_core_t *core, uint32_t watch) {
    return core->watches.phase[watch] == (uint8_t)AGV_WATCH_RUNNING;
}

bool agv_watch_runs(const agv_core_t *core, uint32_t watch) {
    return core->watches.phase[watch] != (uint8_t)AGV_WATCH_STOPPED;
}

#include "decide/hold.h"

bool agv_hold_drop(agv_hold_t *hold) {
    const bool dropped = agv_hold_is_held(hold);
    hold->raw = 0u;
    hold->check = 0u;
    return dropped;
}

void agv_hold_take(agv_hold_t *hold, const agv_vehicle_t *vehicle) {
    if (!agv_hold_is_held(hold) || (hold->unsent_ms == (uint16_t)AGV_HOLD_UNSENT_MAX_MS)) {
        hold->raw = vehicle->angle_raw;
        hold->check = (uint16_t)~hold->raw;
    }
}

void agv_hold_trip(agv_hold_t *hold, const agv_vehicle_t *vehicle, const agv_timers_t *timers) {
    (void)agv_hold_drop(hold);
    hold->unsent_ms = 0u;
    if (agv_timer_runs(timers, AGV_TIMER_ANGLE) && !agv_timer_reached(timers, AGV_TIMER_ANGLE)) {
        agv_hold_take(hold, vehicle);
    }
}

void agv_hold_follow(agv_hold_t *hold, uint32_t elapsed_ms, bool sendable) {
    const uint32_t left_ms = (uint32_t)AGV_HOLD_UNSENT_MAX_MS - hold->unsent_ms;
    const uint32_t step_ms = (elapsed_ms < left_ms) ? elapsed_ms : left_ms;
    hold->unsent_ms = (uint16_t)(sendable ? 0u : (hold->unsent_ms + step_ms));
}

bool agv_hold_is_held(const agv_hold_t *hold) {
    const uint16_t complement = (uint16_t)~hold->raw;
    return hold->check == complement;
}

#include "decide/hold.h"

void agv_hold_drop(agv_hold_t *hold) {
    hold->raw = 0u;
    hold->check = 0u;
}

void agv_hold_take(agv_hold_t *hold, const agv_vehicle_t *vehicle) {
    if (!agv_hold_is_held(hold) || (hold->unsent_ms == (uint16_t)AGV_HOLD_UNSENT_MAX_MS)) {
        hold->raw = vehicle->angle_raw;
        hold->check = (uint16_t)~hold->raw;
        hold->taken = true;
    }
}

static void take_if_recent(agv_hold_t *hold, const agv_vehicle_t *vehicle, const agv_timers_t *timers) {
    if (agv_timer_is_within(timers, AGV_TIMER_ANGLE)) {
        agv_hold_take(hold, vehicle);
    }
}

void agv_hold_trip(agv_hold_t *hold, const agv_vehicle_t *vehicle, const agv_timers_t *timers) {
    agv_hold_drop(hold);
    hold->unsent_ms = 0u;
    hold->handed_over = false;
    take_if_recent(hold, vehicle, timers);
}

void agv_hold_renew(agv_hold_t *hold, const agv_vehicle_t *vehicle, const agv_timers_t *timers, uint32_t hold_age_ms,
                    uint32_t elapsed_ms) {
    if (hold->taken && agv_hold_is_held(hold) && (elapsed_ms > hold_age_ms)) {
        agv_hold_drop(hold);
        take_if_recent(hold, vehicle, timers);
    }
    if (elapsed_ms != 0u) {
        hold->taken = false;
    }
}

void agv_hold_follow(agv_hold_t *hold, const agv_timers_t *timers, uint32_t elapsed_ms) {
    const uint32_t left_ms = (uint32_t)AGV_HOLD_UNSENT_MAX_MS - hold->unsent_ms;
    const uint32_t step_ms = (elapsed_ms < left_ms) ? elapsed_ms : left_ms;
    hold->unsent_ms = (uint16_t)(hold->unsent_ms + step_ms);
    if ((step_ms == left_ms) && ((step_ms != 0u) || agv_timer_reached(timers, AGV_TIMER_ANGLE))) {
        agv_hold_drop(hold);
    }
}

void agv_hold_handed_over(agv_hold_t *hold) {
    hold->handed_over = true;
}

void agv_hold_left(agv_hold_t *hold) {
    if (hold->handed_over) {
        hold->unsent_ms = 0u;
    }
    hold->handed_over = false;
}

void agv_hold_withdrawn(agv_hold_t *hold) {
    hold->handed_over = false;
}

bool agv_hold_is_stuck(const agv_hold_t *hold, bool stalled, bool sendable) {
    return stalled && hold->handed_over && (!sendable || !agv_hold_is_held(hold));
}

bool agv_hold_is_held(const agv_hold_t *hold) {
    const uint16_t complement = (uint16_t)~hold->raw;
    return hold->check == complement;
}

#include "decide/hold.h"

bool agv_hold_drop(agv_hold_t *hold) {
    const bool dropped = agv_hold_is_held(hold);
    *hold = (agv_hold_t){0};
    return dropped;
}

void agv_hold_take(agv_hold_t *hold, const agv_vehicle_t *vehicle) {
    if (!agv_hold_is_held(hold)) {
        hold->raw = vehicle->angle_raw;
        hold->check = (uint16_t)~hold->raw;
    }
}

void agv_hold_trip(agv_hold_t *hold, const agv_vehicle_t *vehicle, const agv_timers_t *timers) {
    (void)agv_hold_drop(hold);
    if (agv_timer_runs(timers, AGV_TIMER_ANGLE) && !agv_timer_reached(timers, AGV_TIMER_ANGLE)) {
        agv_hold_take(hold, vehicle);
    }
}

bool agv_hold_is_held(const agv_hold_t *hold) {
    const uint16_t complement = (uint16_t)~hold->raw;
    return hold->check == complement;
}

#include "decide/hold.h"

void agv_hold_step(agv_hold_t *hold, const agv_vehicle_t *vehicle, bool tripped, bool latched) {
    if (tripped || !latched) {
        *hold = (agv_hold_t){0};
    }
    if (latched && vehicle->angle_known && !agv_hold_is_held(hold)) {
        hold->raw = vehicle->angle_raw;
        hold->check = (uint16_t)~hold->raw;
    }
}

bool agv_hold_is_held(const agv_hold_t *hold) {
    const uint16_t complement = (uint16_t)~hold->raw;
    return hold->check == complement;
}

/**
 * @file hold.h
 * The held steering angle (FSM-10), kept with its complement: no angle is held while the two do not fit (INT-5).
 */
#ifndef AGV_HOLD_H
#define AGV_HOLD_H

#include <stdbool.h>
#include <stdint.h>

#include "observe/vehicle.h"

/** The held angle. All zero: none is held. */
typedef struct {
    uint16_t raw; /**< 0..18000 (P5) */
    uint16_t check;
} agv_hold_t;

/** Follow the state: a trip takes the last valid angle, the first one after it where there is none; a reset drops it. */
void agv_hold_step(agv_hold_t *hold, const agv_vehicle_t *vehicle, bool tripped, bool latched);

/** Whether an angle is held. */
bool agv_hold_is_held(const agv_hold_t *hold);

#endif

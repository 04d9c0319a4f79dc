/**
 * @file hold.h
 * The held steering angle (FSM-10). It is stored with its complement; if the two do not match, no angle is held (INT-5).
 */
#ifndef AGV_HOLD_H
#define AGV_HOLD_H

#include <stdbool.h>
#include <stdint.h>

#include "observe/vehicle.h"

/** The held angle. All zero: no angle is held. */
typedef struct {
    uint16_t raw;   /**< 0..18000 (P5) */
    uint16_t check; /**< complement of raw */
} agv_hold_t;

/** Hold, at a trip, the angle of the last valid 067h if it is not older than hold_age_ms. */
void agv_hold_trip(agv_hold_t *hold, const agv_vehicle_t *vehicle, const agv_timers_t *timers);

/**
 * Drop the held angle: at a reset, or when manual is reported and the operator steers.
 * @return whether an angle was held
 */
bool agv_hold_drop(agv_hold_t *hold);

/** Hold the angle of a valid 067h, if none is held. Call in TRIPPED and SAFE while manual is not reported. */
void agv_hold_take(agv_hold_t *hold, const agv_vehicle_t *vehicle);

/** Whether an angle is held. */
bool agv_hold_is_held(const agv_hold_t *hold);

#endif

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
    uint16_t raw;   /**< 0..18000 (P5) */
    uint16_t check; /**< complement of raw */
} agv_hold_t;

/** A trip: the angle of the last valid 067h is held, when that is not older than hold_age_ms. */
void agv_hold_trip(agv_hold_t *hold, const agv_vehicle_t *vehicle, const agv_timers_t *timers);

/**
 * No angle is held: a reset, or manual is reported, and the operator steers.
 * @return whether one was held before
 */
bool agv_hold_drop(agv_hold_t *hold);

/** A valid 067h, in TRIPPED or SAFE, with manual not reported: its angle is held when none is. */
void agv_hold_take(agv_hold_t *hold, const agv_vehicle_t *vehicle);

/** Whether an angle is held. */
bool agv_hold_is_held(const agv_hold_t *hold);

#endif

/**
 * @file stopping.h
 * Checks that the vehicle stops after a trip and then stands (FSM-12): VEHICLE_NOT_STOPPING and MOVING_WHILE_SAFE.
 */
#ifndef AGV_STOPPING_H
#define AGV_STOPPING_H

#include <stdbool.h>
#include <stdint.h>

#include "base/score.h"
#include "base/timers.h"
#include "observe/vehicle.h"

/** State of the check since the trip. */
typedef struct {
    agv_budget_t moved; /**< how long a wheel has been turning */
    bool stood;         /**< the wheels have stood since the trip */
    bool not_stopping;  /**< the cause of VEHICLE_NOT_STOPPING is present */
    bool moving;        /**< the cause of MOVING_WHILE_SAFE is present */
} agv_stopping_t;

/** Start again, after a trip or at a start in TRIPPED. */
void agv_stopping_start(agv_stopping_t *stopping, agv_timers_t *timers);

/** Evaluate the motion, in TRIPPED and SAFE. @param elapsed_ms since the last tick; 0 for a frame */
void agv_stopping_step(agv_stopping_t *stopping, const agv_timers_t *timers, const agv_vehicle_t *vehicle,
                       uint32_t elapsed_ms);

#endif

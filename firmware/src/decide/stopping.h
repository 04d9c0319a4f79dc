/**
 * @file stopping.h
 * The safe state is a vehicle that stands (FSM-12): VEHICLE_NOT_STOPPING and MOVING_WHILE_SAFE.
 */
#ifndef AGV_STOPPING_H
#define AGV_STOPPING_H

#include <stdbool.h>
#include <stdint.h>

#include "base/timers.h"
#include "observe/vehicle.h"

/** What is known since the trip. */
typedef struct {
    uint16_t moving_ms; /**< a wheel has turned for so long, up to the limit */
    bool stood;         /**< the wheels have stood since the trip */
    bool not_stopping;  /**< VEHICLE_NOT_STOPPING has a cause */
    bool moving;        /**< MOVING_WHILE_SAFE has a cause */
} agv_stopping_t;

/** A trip, or a start in TRIPPED. */
void agv_stopping_start(agv_stopping_t *stopping, agv_timers_t *timers);

/** Evaluate, in TRIPPED and SAFE. @param elapsed_ms since the last tick; 0 for a frame */
void agv_stopping_step(agv_stopping_t *stopping, const agv_timers_t *timers, const agv_vehicle_t *vehicle,
                       uint32_t elapsed_ms);

/** A reset: nothing is awaited. */
void agv_stopping_end(agv_stopping_t *stopping);

#endif

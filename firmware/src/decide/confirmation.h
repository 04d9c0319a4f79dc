/**
 * @file confirmation.h
 * Checks whether the vehicle confirms the safe state in time (FSM-4, SAFE_STATE_UNCONFIRMED).
 */
#ifndef AGV_CONFIRMATION_H
#define AGV_CONFIRMATION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/timers.h"

/** The total time without a confirmation. It is cleared only when both have been confirmed for confirmed_ms. */
typedef struct {
    uint16_t sum_ms;
    bool at_tick; /**< it was missing at the last tick; of P that was not sent yet: the last step was a tick */
} agv_missing_t;

/** The confirmations. */
typedef struct {
    agv_missing_t off;  /**< autopilot off, since the trip */
    agv_missing_t park; /**< P, since the first P was sent */
    bool park_sent;     /**< P was sent since the trip */
    bool unconfirmed;   /**< the cause of SAFE_STATE_UNCONFIRMED is present */
} agv_confirmation_t;

/**
 * Start again, after a trip or at a start in TRIPPED.
 * @param at_tick true: in a tick or at the start, time counts from now on; false: in a frame, it counts from the next tick on
 */
void agv_confirmation_start(agv_confirmation_t *confirmation, agv_timers_t *timers, bool at_tick);

/** Note that a 168h P was sent: from now on P must be confirmed. */
void agv_confirmation_park_sent(agv_confirmation_t *confirmation);

/**
 * Evaluate the confirmations, in TRIPPED and SAFE.
 * @param elapsed_ms    since the last tick; 0 for a frame
 * @param autopilot_off the VCU confirms autopilot off
 * @param in_park       the VCU confirms P
 */
void agv_confirmation_step(agv_confirmation_t *confirmation, agv_timers_t *timers, const agv_config_t *config,
                           uint32_t elapsed_ms, bool autopilot_off, bool in_park);

#endif

/**
 * @file confirmation.h
 * Whether the vehicle confirms the safe state in time (FSM-4): two sums of time, and SAFE_STATE_UNCONFIRMED.
 */
#ifndef AGV_CONFIRMATION_H
#define AGV_CONFIRMATION_H

#include <stdbool.h>
#include <stdint.h>

#include "base/timers.h"

/** The sums. They only grow until both were confirmed for confirmed_ms without a break. */
typedef struct {
    uint16_t off_missing_ms;  /**< autopilot off not confirmed, since the trip */
    uint16_t park_missing_ms; /**< P not confirmed, since the first P was sent */
    bool park_sent;           /**< P was sent since the trip */
    bool unconfirmed;         /**< SAFE_STATE_UNCONFIRMED has a cause */
} agv_confirmation_t;

/** A trip, or a start in TRIPPED: everything begins anew. */
void agv_confirmation_start(agv_confirmation_t *confirmation, agv_timers_t *timers);

/** 168h P was sent: from the first time on P is awaited. */
void agv_confirmation_park_sent(agv_confirmation_t *confirmation);

/**
 * Evaluate, in TRIPPED and SAFE.
 * @param elapsed_ms    since the last tick; 0 for a frame
 * @param autopilot_off confirmed by the VCU
 * @param in_park       confirmed by the VCU
 */
void agv_confirmation_step(agv_confirmation_t *confirmation, agv_timers_t *timers, const agv_config_t *config,
                           uint32_t elapsed_ms, bool autopilot_off, bool in_park);

#endif

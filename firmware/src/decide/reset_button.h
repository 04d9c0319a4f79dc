/**
 * @file reset_button.h
 * The reset by remote button 1 (FSM-3): a press that begins after the trip, is held for reset_hold_ms to reset_hold_max_ms
 * and released, while everything that a reset needs holds in the last reset_hold_ms before the release.
 */
#ifndef AGV_RESET_BUTTON_H
#define AGV_RESET_BUTTON_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/recorder.h"
#include "base/timers.h"

/** Remote button 1. */
typedef enum { AGV_BUTTON_UNKNOWN, AGV_BUTTON_DOWN, AGV_BUTTON_UP } agv_button_t;

/** How many conditions a reset has. */
#define AGV_RESET_CONDITIONS 8u

/** The button and the press. */
typedef struct {
    uint16_t held_ms[AGV_RESET_CONDITIONS]; /**< how long each condition has held, up to reset_hold_ms */
    uint8_t button;                         /**< agv_button_t, as the last 363h of a VCU that is alive reports it */
    uint8_t before;                         /**< the same at the last step */
    bool began_after;                       /**< this press began with a rising edge after the trip */
    bool answered;                          /**< this press was reported */
} agv_reset_button_t;

/** What became of a press. */
typedef enum { AGV_PRESS_NOTHING, AGV_PRESS_RESETS, AGV_PRESS_IN_VAIN } agv_press_result_t;

/** A 363h reports the button. Of a VCU that is not alive it says nothing. */
void agv_reset_button_report(agv_reset_button_t *reset, bool vcu_alive, bool down);

/** The VCU is lost: the button is unknown until it reports again. */
void agv_reset_button_lose(agv_reset_button_t *reset);

/** A trip: a press that began before does not count. */
void agv_reset_button_trip(agv_reset_button_t *reset, agv_timers_t *timers);

/**
 * Evaluate, in TRIPPED and SAFE.
 * @param elapsed_ms since the last tick; 0 for a frame
 * @param lacking    AGV_MISSING_* bits of the conditions that do not hold now
 * @param missing    out, when a press was in vain: what was missing at any time in its last reset_hold_ms
 */
agv_press_result_t agv_reset_button_step(agv_reset_button_t *reset, agv_timers_t *timers, const agv_config_t *config,
                                         uint32_t elapsed_ms, uint32_t lacking, uint32_t *missing);

#endif

/**
 * @file reset_button.h
 * The reset by a button: remote button 1 (FSM-3), or the push button on the reset input (HW-3). The press must begin after
 * the trip and last reset_hold_ms to reset_hold_max_ms. All conditions of a reset must hold in the last reset_hold_ms before
 * the release.
 */
#ifndef AGV_RESET_BUTTON_H
#define AGV_RESET_BUTTON_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/recorder.h"
#include "base/timers.h"
#include "observe/hardware.h"

/** Number of conditions of a reset. */
#define AGV_RESET_CONDITIONS 9u

/** A press begins with a rising edge only if this many 363h in a row have reported the button up: one alone is a glitch. */
#define AGV_BUTTON_UP_FRAMES 3u

/** A button and its press. */
typedef struct {
    uint16_t held_ms[AGV_RESET_CONDITIONS]; /**< how long each condition has held, up to reset_hold_ms */
    uint8_t button;    /**< agv_button_t; of the remote from the last 363h while the VCU is alive */
    uint8_t up_frames; /**< consecutive 363h in which it is up, up to AGV_BUTTON_UP_FRAMES */
    bool was_up;       /**< at the last step, and for AGV_BUTTON_UP_FRAMES: a press that begins now has a rising edge */
    bool began_after;  /**< this press began with a rising edge after the trip */
    bool answered;     /**< this press was reported */
    bool is_pin;       /**< the push button on the reset input; false: remote button 1 */
} agv_reset_button_t;

/** Result of a press. */
typedef enum { AGV_PRESS_NOTHING, AGV_PRESS_RESETS, AGV_PRESS_IN_VAIN } agv_press_result_t;

/**
 * Handle the button state in a 363h. It is ignored if the VCU is not alive. Fewer than AGV_BUTTON_UP_FRAMES reports of a
 * button that is up end a press, but the next one has no rising edge. While the remote receiver is lost, what
 * 363h says of the button does not count: it ends a press without a release, and a button that is pressed when the receiver
 * returns is not a rising edge.
 */
void agv_reset_button_report(agv_reset_button_t *reset, bool vcu_alive, bool remote_lost, bool down);

/** Take the debounced state of the push button. @param button agv_button_t */
void agv_reset_button_read(agv_reset_button_t *reset, uint8_t button);

/** Set the button to unknown, because the VCU is lost: a press that goes on when it returns resets nothing. */
void agv_reset_button_lose(agv_reset_button_t *reset);

/** Ignore, at a trip, a press that began before it. */
void agv_reset_button_trip(agv_reset_button_t *reset, agv_timers_t *timers);

/**
 * Evaluate the button, in TRIPPED and SAFE.
 * @param elapsed_ms for so long since the last tick the conditions are known to hold; 0 for a frame
 * @param lacking    AGV_MISSING_* bits of the conditions that do not hold now
 * @param missing    out, for AGV_PRESS_IN_VAIN: the conditions that did not hold at some time in its last reset_hold_ms
 */
agv_press_result_t agv_reset_button_step(agv_reset_button_t *reset, agv_timers_t *timers, const agv_config_t *config,
                                         uint32_t elapsed_ms, uint32_t lacking, uint32_t *missing);

#endif

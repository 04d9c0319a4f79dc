/**
 * @file state.h
 * The states of the supervisor. Their values are code words with a Hamming distance of 4 or more (INT-5): one flipped bit
 * never makes one state of another.
 */
#ifndef AGV_STATE_H
#define AGV_STATE_H

#include <stdbool.h>
#include <stdint.h>

/** State. Any other value is a corrupted one. */
typedef enum {
    AGV_STATE_INIT = 0x0F,    /**< sends the safe commands, waits for a healthy vehicle in manual */
    AGV_STATE_STANDBY = 0x33, /**< autopilot not engaged */
    AGV_STATE_ACTIVE = 0x3C,  /**< autopilot engaged */
    AGV_STATE_TRIPPED = 0x55, /**< latched: sends the safe commands, not confirmed yet */
    AGV_STATE_SAFE = 0x5A     /**< latched: the vehicle confirmed P and autopilot off */
} agv_state_t;

/** Whether the state is one in which the safe commands are sent: INIT, TRIPPED, SAFE, and whatever is no state. */
bool agv_state_commands_safe(agv_state_t state);

/** Whether the state is a latched one: TRIPPED, SAFE, and whatever is no state. */
bool agv_state_is_latched(agv_state_t state);

#endif

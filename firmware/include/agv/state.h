/**
 * @file state.h
 * The states of the supervisor. Their values have a Hamming distance of 4 or more (INT-5): one flipped bit never turns a
 * state into another.
 */
#ifndef AGV_STATE_H
#define AGV_STATE_H

#include <stdbool.h>
#include <stdint.h>

/** The state. Any other value means corrupted memory. */
typedef enum {
    AGV_STATE_INIT = 0x0F,    /**< sends the safe commands until the vehicle is healthy and in manual mode */
    AGV_STATE_STANDBY = 0x33, /**< the autopilot is not engaged */
    AGV_STATE_ACTIVE = 0x3C,  /**< the autopilot is engaged */
    AGV_STATE_TRIPPED = 0x55, /**< latched: sends the safe commands; the vehicle has not confirmed them */
    AGV_STATE_SAFE = 0x5A     /**< latched: the vehicle has confirmed gear P and autopilot off */
} agv_state_t;

/** Whether the safe commands are sent in this state: true for INIT, TRIPPED, SAFE and invalid values. */
bool agv_state_commands_safe(agv_state_t state);

/** Whether the state is latched: true for TRIPPED, SAFE and invalid values. */
bool agv_state_is_latched(agv_state_t state);

#endif

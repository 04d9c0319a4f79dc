/**
 * @file names.h
 * The public names, for programs that print: the supervisor itself does not use them, and a target that prints nothing
 * does not link them.
 */
#ifndef AGV_NAMES_H
#define AGV_NAMES_H

#include "agv/config.h"
#include "agv/faults.h"
#include "agv/protocol.h"
#include "agv/state.h"

/** "EPS_HEARTBEAT_LOST" ...; NULL for AGV_FAULT_NONE and beyond. */
const char *agv_fault_name(agv_fault_t fault);

/** The fault with this name; AGV_FAULT_NONE when there is none. */
agv_fault_t agv_fault_from_name(const char *name);

/** "trip" or "warn". */
const char *agv_class_name(agv_fault_class_t fault_class);

/** "INIT" ...; NULL for what is no state. */
const char *agv_state_name(agv_state_t state);

/** "turn_signal_command" ...; NULL for AGV_MSG_NONE and beyond. */
const char *agv_message_name(agv_message_t message);

/**
 * The words of the AGV_MISSING_* bits: "state", "vcu_heartbeat", "eps_heartbeat", "trip_cause", "standstill", "manual",
 * "button", "messages", "throttle", "released".
 * @param index number of the bit, 0..9
 * @return NULL beyond.
 */
const char *agv_missing_name(uint8_t index);

#endif

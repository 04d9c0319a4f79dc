/**
 * @file names.h
 * Names as text, for programs that print. The supervisor does not use them; a target that prints nothing does not link
 * them.
 */
#ifndef AGV_NAMES_H
#define AGV_NAMES_H

#include "agv/config.h"
#include "agv/faults.h"
#include "agv/protocol.h"
#include "agv/state.h"

/** Name of a fault, such as "EPS_HEARTBEAT_LOST"; NULL for AGV_FAULT_NONE and values above. */
const char *agv_fault_name(agv_fault_t fault);

/** The fault with this name; AGV_FAULT_NONE if there is none. @param name not NULL */
agv_fault_t agv_fault_from_name(const char *name);

/** Name of a class: "trip" or "warn". */
const char *agv_class_name(agv_fault_class_t fault_class);

/** Name of a state, such as "INIT"; NULL for an invalid value. */
const char *agv_state_name(agv_state_t state);

/** Name of a message, such as "turn_signal_command"; NULL for AGV_MSG_NONE and values above. */
const char *agv_message_name(agv_message_t message);

/**
 * Name of an AGV_MISSING_* bit: "state", "vcu_heartbeat", "eps_heartbeat", "trip_cause", "standstill", "manual",
 * "button", "messages", "throttle", "released", "output_feedback".
 * @param index number of the bit, 0..10
 * @return NULL for any other index.
 */
const char *agv_missing_name(uint8_t index);

/**
 * Name of a part of the self-test, a HAL_SELF_TEST_* bit: "flash", "ram", "processor", "watchdog", "devices", "core",
 * "supply".
 * @param index number of the bit, 0..6
 * @return NULL for any other index.
 */
const char *agv_self_test_part_name(uint8_t index);

/** Name of a hal_reset_cause_t, such as "brown-out"; NULL for values above. */
const char *agv_reset_cause_name(uint8_t cause);

/** Name of a hal_end_t, such as "stack overflow"; NULL for HAL_END_UNKNOWN and values above. */
const char *agv_end_name(uint8_t end);

#endif

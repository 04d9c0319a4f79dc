/**
 * @file supervisor_internal.h
 * What the parts of the supervisor share: supervisor.c (entry points, time, integrity), supervisor_start.c (start and
 * restart), supervisor_react.c (faults to state to actions), supervisor_frames.c (frames in, frames on).
 */
#ifndef AGV_SUPERVISOR_INTERNAL_H
#define AGV_SUPERVISOR_INTERNAL_H

#include "agv/core.h"

/**
 * Faults as they stand: report them, step the state machine, carry out what follows.
 * @return whether a trip sent all safe commands at once
 */
bool agv_core_react(agv_core_t *core);

/** Record an event. */
void agv_core_record(const agv_core_t *core, agv_event_kind_t kind, uint8_t a, uint8_t b, uint8_t c);

/** Write the latch record. */
void agv_core_store_latch(const agv_core_t *core);

/** Report what changed among the faults to the recorder, and sum up what is active (core->summary). */
void agv_core_report_faults(agv_core_t *core);

/** What was found wrong before the start: bit n is the fault of rank n. */
#define AGV_FOUND_SELF_TEST_FAILED (1u << (uint32_t)AGV_FAULT_SELF_TEST_FAILED)
#define AGV_FOUND_CORRUPTED (1u << (uint32_t)AGV_FAULT_MEMORY_CORRUPTED)
#define AGV_FOUND_CONFIG_INVALID (1u << (uint32_t)AGV_FAULT_CONFIG_INVALID)

/** Start, once core->config, hal, recorder and now_ms stand (FSM-7, FSM-9). @param found AGV_FOUND_* bits */
void agv_core_begin(agv_core_t *core, uint32_t found);

/** Start again after a corruption was found in the memory of the supervisor (INT-5). */
void agv_core_begin_corrupted(agv_core_t *core);

/** The defaults, but on the identifiers and the wiring that this vehicle has, as far as they are known. */
void agv_core_built_in_config(agv_config_t *config, uint16_t id_set, uint16_t topology);

/** Handle a frame. */
void agv_core_frame(agv_core_t *core, hal_can_side_t side, const hal_can_frame_t *frame);

/** Advance the LED. */
void agv_core_show_led(agv_core_t *core, uint32_t elapsed_ms);

#endif

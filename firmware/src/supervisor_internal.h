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

/** Whether the next step is overdue by more than the watchdog's period (TIM-4): only steps look at deadlines. */
bool agv_core_step_is_late(const agv_core_t *core);

/** Record an event. @param what agv_event_kind_t, and AGV_MISSING_* in the byte above */
void agv_core_record(const agv_core_t *core, uint32_t what, uint32_t a, uint32_t b, uint32_t c);

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

/** Keep second copies of what the identifiers and the wiring of this vehicle are. */
void agv_core_keep_wiring(agv_core_t *core);

/**
 * Check the configuration in the core. One that does not stand is replaced by the defaults, but on the identifiers and
 * the wiring of the second copies.
 * @param intact whether it is the one that was handed in
 * @return whether it stands
 */
bool agv_core_check_config(agv_core_t *core, bool intact);

/** Handle a frame. */
void agv_core_frame(agv_core_t *core, hal_can_side_t side, const hal_can_frame_t *frame);

/** Advance the LED. */
void agv_core_show_led(agv_core_t *core, uint32_t elapsed_ms);

#endif

/**
 * @file supervisor_internal.h
 * What the parts of the supervisor share: supervisor.c (entry points, time, integrity), supervisor_start.c (start and
 * restart), supervisor_react.c (faults to state to actions), supervisor_frames.c (frames in, frames on).
 */
#ifndef AGV_SUPERVISOR_INTERNAL_H
#define AGV_SUPERVISOR_INTERNAL_H

#include "agv/supervisor.h"

/** Make the outlet for this call: the gate's view of the state, and which own commands are sent. */
agv_outlet_t agv_core_outlet(agv_core_t *core, const agv_ports_t *ports);

/**
 * Faults as they stand: report them, step the state machine, carry out what follows.
 * @return whether the safe commands were all sent at once
 */
bool agv_core_react(agv_core_t *core, const agv_ports_t *ports);

/** After sending: a frame that the gate refused trips (INT-4), 168h P that was sent starts its confirmation. */
void agv_core_after_sending(agv_core_t *core, const agv_ports_t *ports, const agv_outlet_t *outlet);

/** Record an event. */
void agv_core_record(const agv_core_t *core, const agv_ports_t *ports, const agv_event_t *what);

/** Write the latch record. */
void agv_core_store_latch(const agv_core_t *core, const agv_ports_t *ports);

/** Report what changed among the faults to the recorder. @return those that became trips. */
agv_fault_set_t agv_core_report_faults(agv_core_t *core, const agv_ports_t *ports);

/** Start: see agv_supervisor_start. */
void agv_core_start(agv_core_t *core, const agv_ports_t *ports, const agv_config_t *config, bool self_test_passed,
                    uint32_t now_ms);

/** Start again after a corruption was found in the memory of the supervisor (INT-5). */
void agv_core_restart_corrupted(agv_core_t *core, const agv_ports_t *ports, uint32_t now_ms);

/** Handle a frame. */
void agv_core_frame(agv_core_t *core, const agv_ports_t *ports, hal_can_side_t side, const hal_can_frame_t *frame);

#endif

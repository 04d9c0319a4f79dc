/**
 * @file deadlines.h
 * Which faults the silence of messages and heartbeats is (SUP-2, SUP-3, SUP-8), and traffic with the identifiers of the
 * other set (P1, WRONG_ID_SET).
 */
#ifndef AGV_DEADLINES_H
#define AGV_DEADLINES_H

#include <stdbool.h>
#include <stdint.h>

#include "decide/fault_monitor.h"
#include "observe/liveness.h"

/** Evaluate all deadlines and heartbeats. Call at every tick, after agv_liveness_tick. */
void agv_deadlines_tick(agv_fault_monitor_t *faults, const agv_timers_t *timers, const agv_config_t *config,
                        const agv_liveness_t *liveness, bool engaged);

/** Evaluate the heartbeats alone. Call when an engagement begins: an AI computer that is lost then trips at once. */
void agv_deadlines_heartbeats(agv_fault_monitor_t *faults, const agv_timers_t *timers, const agv_liveness_t *liveness,
                              bool engaged);

/** A frame of the right shape came with an identifier that this message has in the other set only. */
void agv_deadlines_other_id_set(agv_timers_t *timers, uint32_t message);

/** A reset was accepted: the AI computer is forgotten, and with it that it is lost (SUP-8). */
void agv_deadlines_forget_ai(agv_fault_monitor_t *faults);

/** Whether every status message whose silence trips is fresh. */
bool agv_deadlines_messages_fresh(const agv_liveness_t *liveness, const agv_timers_t *timers,
                                  const agv_config_t *config);

#endif

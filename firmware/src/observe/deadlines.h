/**
 * @file deadlines.h
 * The faults of expired deadlines of messages and heartbeats (SUP-2, SUP-3, SUP-8), and of traffic with the identifiers
 * of the other set (P1, WRONG_ID_SET).
 */
#ifndef AGV_DEADLINES_H
#define AGV_DEADLINES_H

#include <stdbool.h>
#include <stdint.h>

#include "base/fault_monitor.h"
#include "observe/liveness.h"

/**
 * Evaluate all deadlines and heartbeats. Call at every tick, after agv_liveness_tick.
 * @param engaged the AI computer has to send commands: their deadlines count
 */
void agv_deadlines_tick(agv_fault_monitor_t *faults, const agv_timers_t *timers, const agv_config_t *config,
                        const agv_liveness_t *liveness, bool engaged);

/** Evaluate only the heartbeats. Call when an engagement begins: an AI computer that is lost then trips at once. */
void agv_deadlines_heartbeats(agv_fault_monitor_t *faults, const agv_timers_t *timers, const agv_liveness_t *liveness,
                              bool engaged);

/** Note a well-formed frame with the identifier that this message has in the other set only. */
void agv_deadlines_other_id_set(agv_timers_t *timers, uint32_t message);

/** End the faults of the AI computer's heartbeat after a reset, which forgets the AI computer (SUP-8). */
void agv_deadlines_forget_ai(agv_fault_monitor_t *faults);

/** Whether all status messages whose silence trips are fresh. */
bool agv_deadlines_messages_fresh(const agv_liveness_t *liveness, const agv_timers_t *timers,
                                  const agv_config_t *config);

#endif

/**
 * @file scheduler.h
 * When to send (FSM-2, TIM-1, TOP-1): the periodic slots of the four commands, and the least time between overrides.
 * Slot n belongs to the command n of agv_message_t.
 */
#ifndef AGV_SCHEDULER_H
#define AGV_SCHEDULER_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/protocol.h"
#include "base/timers.h"

/** One slot. */
typedef struct {
    uint32_t next_ms;       /**< when it is due */
    uint32_t overridden_us; /**< last override of this identifier, microseconds (wraps) */
} agv_slot_t;

/** All slots; bit n of a set is the command n. */
typedef struct {
    agv_slot_t slots[AGV_COMMAND_COUNT];
    uint32_t override_recent; /**< the last override was less than the gap ago */
    uint32_t override_waits;  /**< another one came too soon and is answered later */
} agv_scheduler_t;

/**
 * All four have just been sent: the next ones are due in 100 ms (43Fh), 66 ms (168h), 33 ms (075h), 25 ms (065h), then on
 * their cycles. What waited to be answered is forgotten.
 */
void agv_scheduler_restart(agv_scheduler_t *scheduler, uint32_t now_ms);

/** One of them has just been sent for the first time: its next one is due a cycle later. */
void agv_scheduler_restart_slot(agv_scheduler_t *scheduler, uint32_t now_ms, uint32_t command);

/**
 * Whether a slot is due; if so its next moment is set, on the same grid. Slots that were missed are not made up for.
 * @return 0: not due; else how many slots have come since the last call, the missed ones among them
 */
uint32_t agv_scheduler_due(agv_scheduler_t *scheduler, uint32_t now_ms, uint32_t command);

/**
 * A foreign command has to be answered.
 * @param gap_ms least time between two answers
 * @return true: now. false: the last answer is less than @p gap_ms ago, by the exact receive times; it waits.
 */
bool agv_scheduler_override(agv_scheduler_t *scheduler, uint32_t now_us, uint32_t gap_ms, uint32_t command);

/** Whether a waiting answer is to be sent now. Call at every tick. */
bool agv_scheduler_override_due(agv_scheduler_t *scheduler, uint32_t now_us, uint32_t gap_ms, uint32_t command);

/** An override was sent: the next periodic frame is due half a cycle later. */
void agv_scheduler_overridden(agv_scheduler_t *scheduler, const agv_timers_t *timers, uint32_t command);

/** The own command was sent: what waited to be answered is answered. */
void agv_scheduler_answered(agv_scheduler_t *scheduler, uint32_t command);

/** Nothing waits to be answered. */
void agv_scheduler_discard(agv_scheduler_t *scheduler);

#endif

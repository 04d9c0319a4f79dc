/**
 * @file scheduler.h
 * When to send (FSM-2, TIM-1, TOP-1): the periodic slots of the four commands, and the shortest time between overrides.
 * An override is an own command sent at once after another sender's command. Slot n belongs to command n of
 * agv_message_t.
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
    uint8_t override_recent; /**< the last override is less than the gap ago */
    uint8_t override_waits;  /**< an override came too soon and is sent later */
} agv_scheduler_t;

/**
 * Restart all slots, because all four commands have just been sent. The next ones are due in 100 ms (43Fh), 66 ms (168h),
 * 33 ms (075h) and 25 ms (065h), then on their cycles. Waiting overrides are discarded.
 */
void agv_scheduler_restart(agv_scheduler_t *scheduler, uint32_t now_ms);

/** Restart the slot of a command that has just been sent for the first time: the next one is due a cycle later. */
void agv_scheduler_restart_slot(agv_scheduler_t *scheduler, uint32_t now_ms, uint32_t command);

/**
 * Whether a slot is due; if so, its next time is set, on the same grid. Missed slots are not made up for.
 * @return 0: not due; otherwise the number of slots since the last call, including missed ones
 */
uint32_t agv_scheduler_due(agv_scheduler_t *scheduler, uint32_t now_ms, uint32_t command);

/** Delay all further slots of a command by 3 ms, so that it does not collide with another sender of its identifier each time. */
void agv_scheduler_shift(agv_scheduler_t *scheduler, uint32_t command);

/**
 * Request an override of another sender's command.
 * @param gap_ms shortest time between two overrides
 * @return true: send it now. false: the last one is less than @p gap_ms ago, by the exact receive times; it waits.
 */
bool agv_scheduler_override(agv_scheduler_t *scheduler, uint32_t now_us, uint32_t gap_ms, uint32_t command);

/** Whether a waiting override is to be sent now. Call at every tick. */
bool agv_scheduler_override_due(agv_scheduler_t *scheduler, uint32_t now_us, uint32_t gap_ms, uint32_t command);

/** Note that an override was sent: the next periodic frame is due half a cycle later. */
void agv_scheduler_overridden(agv_scheduler_t *scheduler, const agv_timers_t *timers, uint32_t command);

/** Note that the own command was sent, or is no longer sent: a waiting override of it is done. */
void agv_scheduler_answered(agv_scheduler_t *scheduler, uint32_t command);

/** Discard all waiting overrides. */
void agv_scheduler_discard(agv_scheduler_t *scheduler);

#endif

/**
 * @file fault_monitor.h
 * The faults of one supervisor: which have a cause, which of those count as trips, which are latched. The rules say what
 * has a cause; agv_fault_monitor_evaluate, once a call, says what that amounts to.
 */
#ifndef AGV_FAULT_MONITOR_H
#define AGV_FAULT_MONITOR_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"
#include "base/timers.h"

/** What the active and latched faults amount to; faults by rank, AGV_FAULT_NONE where there is none. */
typedef struct {
    uint8_t raised;       /**< highest-ranking trip that was raised, or occurred again, since the last evaluation */
    uint8_t cause;        /**< highest-ranking trip with a cause that does not come from the AI computer */
    uint8_t ai_cause;     /**< highest-ranking trip with a cause that comes from the AI computer */
    uint8_t unresettable; /**< highest-ranking unresettable fault with a cause */
    bool eps_fault;       /**< a fault is active with which the EPS must not be commanded (FSM-10) */
} agv_fault_summary_t;

/** The faults. */
typedef struct {
    agv_fault_set_t active;   /**< their cause is present */
    agv_fault_set_t reported; /**< were active at the last evaluation */
    agv_fault_set_t tripping; /**< and counted as trips */
    agv_fault_set_t latched;  /**< raised as trips since the last reset */
    agv_fault_set_t occurred; /**< events since the last evaluation: each occurrence counts (FSM-11) */
    agv_fault_summary_t summary;
    bool outdated;      /**< a cause came or went since the last evaluation */
    bool ai_loss_warns; /**< at the last evaluation a lost AI heartbeat only warned (SUP-8) */
} agv_fault_monitor_t;

/** What an evaluation has changed. */
typedef struct {
    agv_fault_set_t changed;  /**< raised, raised with another class, or ended */
    agv_fault_set_t was_trip; /**< counted as trips before it */
    bool any;                 /**< something may have changed; when not, the sets are not filled in */
} agv_fault_changes_t;

/** No fault, from zeroed memory. */
void agv_fault_monitor_start(agv_fault_monitor_t *monitor);

/** Say whether the cause of a fault is present. Ignored for AGV_FAULT_NONE. */
void agv_fault_monitor_set(agv_fault_monitor_t *monitor, uint32_t fault, bool cause);

/** An event occurred: it is active for event_hold_ms from now. Ignored for what is no event. */
void agv_fault_monitor_event(agv_fault_monitor_t *monitor, agv_timers_t *timers, uint32_t fault);

/** End the events whose hold time is over. Call at every tick. */
void agv_fault_monitor_tick(agv_fault_monitor_t *monitor, const agv_timers_t *timers);

/**
 * Evaluate what came and went since the last call; `summary` says what that amounts to.
 * @param trips         the faults whose class is trip
 * @param ai_loss_warns the faults of the AI computer's heartbeat only warn at the moment (SUP-8)
 * @param changes       out: what is to be reported
 */
void agv_fault_monitor_evaluate(agv_fault_monitor_t *monitor, const agv_fault_set_t *trips, bool ai_loss_warns,
                                agv_fault_changes_t *changes);

/** A trip: the faults that count as trips are latched; so are, until the reset, those that come to count. */
void agv_fault_monitor_latch(agv_fault_monitor_t *monitor);

/** An earlier run was tripped for this reason: it is latched. Ignored for AGV_FAULT_NONE. */
void agv_fault_monitor_latch_one(agv_fault_monitor_t *monitor, uint32_t fault);

/** A reset: nothing is latched. */
void agv_fault_monitor_forget(agv_fault_monitor_t *monitor);

/** Whether the cause of a fault is present. False for AGV_FAULT_NONE. */
bool agv_fault_monitor_is_active(const agv_fault_monitor_t *monitor, uint32_t fault);

/** The fault that the LED shows: trips, active or latched, before warnings; AGV_FAULT_NONE when there is none (LED-1). */
uint32_t agv_fault_monitor_shown(const agv_fault_monitor_t *monitor);

#endif

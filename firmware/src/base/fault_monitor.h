/**
 * @file fault_monitor.h
 * The faults of one supervisor: which are active, which of those count as trips, which are latched. The checks set the
 * faults; agv_fault_monitor_evaluate summarises them once per pass.
 */
#ifndef AGV_FAULT_MONITOR_H
#define AGV_FAULT_MONITOR_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"
#include "base/timers.h"

/** Summary of the active faults. Each fault is the highest-ranking one of its kind, or AGV_FAULT_NONE. */
typedef struct {
    uint8_t raised;       /**< trips that were raised, or occurred again, since the last evaluation */
    uint8_t cause;        /**< active trips that do not come from the AI computer */
    uint8_t ai_cause;     /**< active trips that come from the AI computer */
    uint8_t unresettable; /**< active unresettable faults */
    bool eps_fault;       /**< a fault is active that forbids commanding the EPS (FSM-10) */
} agv_fault_summary_t;

/** The faults. */
typedef struct {
    agv_fault_set_t active;   /**< faults whose cause is present */
    agv_fault_set_t reported; /**< faults that were active at the last evaluation */
    agv_fault_set_t tripping; /**< those of `reported` that counted as trips */
    agv_fault_set_t latched;  /**< faults raised as trips since the last reset */
    agv_fault_set_t occurred; /**< transients since the last evaluation: each occurrence counts (FSM-11) */
    agv_fault_summary_t summary;
    bool outdated;      /**< `active` has changed since the last evaluation */
    bool transient;     /**< a transient fault is active: its timer runs */
    bool ai_loss_warns; /**< at the last evaluation a lost AI heartbeat only warned (SUP-8) */
} agv_fault_monitor_t;

/** Changes found by an evaluation. */
typedef struct {
    agv_fault_set_t changed;  /**< faults that were raised, changed their class, or ended */
    agv_fault_set_t was_trip; /**< faults that counted as trips before */
    bool any;                 /**< false: nothing changed, and the sets are not filled in */
} agv_fault_changes_t;

/** Start without faults, from zeroed memory. */
void agv_fault_monitor_start(agv_fault_monitor_t *monitor);

/** Set whether the cause of a fault is present. Ignored for AGV_FAULT_NONE. */
void agv_fault_monitor_set(agv_fault_monitor_t *monitor, uint32_t fault, bool cause);

/** Raise a transient fault: it is active for event_hold_ms from now. Ignored for other faults. */
void agv_fault_monitor_event(agv_fault_monitor_t *monitor, agv_timers_t *timers, uint32_t fault);

/** End the transient faults whose hold time is over. Call at every tick. */
void agv_fault_monitor_tick(agv_fault_monitor_t *monitor, const agv_timers_t *timers);

/**
 * Evaluate the changes since the last call, and update `summary`.
 * @param trips         the faults of class trip
 * @param ai_loss_warns the faults of the AI computer's heartbeat only warn at present (SUP-8)
 * @param changes       out: the changes to report
 */
void agv_fault_monitor_evaluate(agv_fault_monitor_t *monitor, const agv_fault_set_t *trips, bool ai_loss_warns,
                                agv_fault_changes_t *changes);

/** Latch the faults that count as trips, at a trip and for as long as the supervisor is tripped. */
void agv_fault_monitor_latch(agv_fault_monitor_t *monitor);

/** Latch the reason of an earlier run's trip. Ignored for AGV_FAULT_NONE. */
void agv_fault_monitor_latch_one(agv_fault_monitor_t *monitor, uint32_t fault);

/** Unlatch all faults at a reset. */
void agv_fault_monitor_forget(agv_fault_monitor_t *monitor);

/** Whether a fault is active. False for AGV_FAULT_NONE. */
bool agv_fault_monitor_is_active(const agv_fault_monitor_t *monitor, uint32_t fault);

/** The fault that the LED shows (LED-1): trips, active or latched, before warnings; AGV_FAULT_NONE if there is none. */
uint32_t agv_fault_monitor_shown(const agv_fault_monitor_t *monitor);

#endif

/**
 * @file faults.h
 * The faults by name, their policy (one table, fault_table.def), and the set of those that are active or latched.
 */
#ifndef AGV_FAULTS_H
#define AGV_FAULTS_H

#include <stdbool.h>
#include <stdint.h>

/** A fault; the value is its rank, 0 the highest. */
typedef enum {
#define AGV_FAULT(name, class, led, flags) AGV_FAULT_##name,
#include "agv/fault_table.def"
#undef AGV_FAULT
    AGV_FAULT_COUNT,
    AGV_FAULT_NONE = AGV_FAULT_COUNT
} agv_fault_t;

/** What a fault does when it is raised. */
typedef enum { AGV_CLASS_WARN = 0, AGV_CLASS_TRIP = 1 } agv_fault_class_t;

/** Properties of a fault, see fault_table.def. */
#define AGV_FAULT_FLAG_NONE 0x00u
#define AGV_FAULT_FLAG_UNRESETTABLE 0x01u
#define AGV_FAULT_FLAG_EVENT 0x02u
#define AGV_FAULT_FLAG_FIXED 0x04u
#define AGV_FAULT_FLAG_FROM_AI 0x08u
#define AGV_FAULT_FLAG_OF_EPS 0x10u

/** A set of faults, bit n = the fault of rank n. */
typedef uint64_t agv_fault_set_t;

/** The set with one fault in it; empty for AGV_FAULT_NONE and beyond. */
static inline agv_fault_set_t agv_fault_bit(agv_fault_t fault) {
    return ((uint32_t)fault < (uint32_t)AGV_FAULT_COUNT) ? ((agv_fault_set_t)1u << (uint32_t)fault) : 0u;
}

/** That set when the condition holds, else the empty one. */
static inline agv_fault_set_t agv_fault_when(bool condition, agv_fault_t fault) {
    return condition ? agv_fault_bit(fault) : 0u;
}

/** The highest-ranking fault of a set; AGV_FAULT_NONE when it is empty. */
agv_fault_t agv_fault_highest(agv_fault_set_t set);

/** All faults with the flag UNRESETTABLE, EVENT, FIXED, FROM_AI, OF_EPS. */
extern const agv_fault_set_t agv_faults_unresettable;
extern const agv_fault_set_t agv_faults_events;
extern const agv_fault_set_t agv_faults_fixed;
extern const agv_fault_set_t agv_faults_from_ai;
extern const agv_fault_set_t agv_faults_of_eps;

/** All faults whose default class is trip. */
extern const agv_fault_set_t agv_faults_default_trips;

/** LED code of a fault: 1..17, or 0 where the protocol document has none (also for no fault). */
uint8_t agv_fault_led_code(agv_fault_t fault);

/** How many faults are events. */
#define AGV_EVENT_FAULT_COUNT 8u

/**
 * The faults of one supervisor. A *level* is active while its cause is; an *event* for event_hold_ms after it was last
 * raised (the hold time is an argument).
 */
typedef struct {
    agv_fault_set_t active;                   /**< cause present */
    agv_fault_set_t latched;                  /**< raised as a trip since the last reset */
    agv_fault_set_t reported;                 /**< active ones as last reported */
    agv_fault_set_t tripping;                 /**< those of `reported` that were reported as trips */
    uint32_t event_ms[AGV_EVENT_FAULT_COUNT]; /**< when each event was last raised */
} agv_faults_t;

/** Nothing active, nothing latched. */
void agv_faults_init(agv_faults_t *faults);

/** Say which of some levels have a cause now: those of @p judged become active if in @p causes, else end. */
void agv_faults_levels(agv_faults_t *faults, agv_fault_set_t judged, agv_fault_set_t causes);

/** Raise an event, or raise it again. Ignored for what is no event. */
void agv_faults_event(agv_faults_t *faults, agv_fault_t fault, uint32_t now_ms);

/** End the events whose hold time is over. Call at every tick. */
void agv_faults_tick(agv_faults_t *faults, uint32_t now_ms, uint16_t event_hold_ms);

/** What changed between two reports. */
typedef struct {
    agv_fault_set_t raised; /**< became active, or changed their class while active */
    agv_fault_set_t ended;
    agv_fault_set_t trips; /**< those of `raised` that are trips now */
} agv_fault_changes_t;

/** Compare with the last report, given which faults are trips at the moment, and make this the last report. */
agv_fault_changes_t agv_faults_report(agv_faults_t *faults, agv_fault_set_t trip_classes);

#endif

/**
 * @file faults.h
 * The faults by name, their policy (one table, fault_table.def), and those of one supervisor that are active or latched.
 */
#ifndef AGV_FAULTS_H
#define AGV_FAULTS_H

#include <stdbool.h>
#include <stdint.h>

struct agv_core;

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

/** Properties of a fault, see fault_table.def. For EVENT and FIXED there are sets. */
#define AGV_FAULT_FLAG_UNRESETTABLE 0x20u
#define AGV_FAULT_FLAG_FROM_AI 0x40u
#define AGV_FAULT_FLAG_OF_EPS 0x80u

/** A set of faults, bit n = the fault of rank n. */
typedef uint64_t agv_fault_set_t;

/** The set with one fault in it; empty for AGV_FAULT_NONE and beyond. */
agv_fault_set_t agv_fault_bit(uint32_t fault);

/** Whether a set has a fault in it. False for AGV_FAULT_NONE and beyond. */
bool agv_fault_is_in(agv_fault_set_t set, uint32_t fault);

/** All faults with the flag FIXED, all with EVENT, and all whose default class is trip. */
extern const agv_fault_set_t agv_faults_fixed;
extern const agv_fault_set_t agv_faults_events;
extern const agv_fault_set_t agv_faults_default_trips;

/** The properties of a fault, AGV_FAULT_FLAG_*; 0 for no fault. */
uint8_t agv_fault_flags(uint32_t fault);

/** LED code of a fault: 1..17, or 0 where the protocol document has none (also for no fault). */
uint8_t agv_fault_led_code(uint32_t fault);

/** What is known of one fault: bits of agv_faults_t.marks. */
#define AGV_MARK_ACTIVE 0x01u   /**< its cause is present */
#define AGV_MARK_REPORTED 0x02u /**< was active at the last report */
#define AGV_MARK_TRIPPING 0x04u /**< and counted as a trip */
#define AGV_MARK_LATCHED 0x08u  /**< raised as a trip since the last reset */
#define AGV_MARK_RAISED 0x10u   /**< became a trip at the last report */

/** How many faults are events. */
#define AGV_EVENT_FAULT_COUNT 8u

/**
 * The faults of one supervisor. A *level* is active while its cause is; an *event* until its watch (AGV_WATCH_EVENT) is
 * reached, event_hold_ms after it was last raised.
 */
typedef struct {
    uint8_t marks[AGV_FAULT_COUNT];
} agv_faults_t;

/** Say whether the cause of a level is present. Ignored for AGV_FAULT_NONE. */
void agv_faults_level(struct agv_core *core, uint32_t fault, bool cause);

/** Raise an event, or raise it again. Ignored for what is no event. */
void agv_faults_event(struct agv_core *core, uint32_t fault);

/** End the events whose hold time is over. Call at every tick. */
void agv_faults_tick(struct agv_core *core);

/** Whether the cause of a fault is present. False for AGV_FAULT_NONE. */
bool agv_faults_is_active(const struct agv_core *core, uint32_t fault);

/** The faults that have all of some marks (AGV_MARK_*). */
agv_fault_set_t agv_faults_marked(const agv_faults_t *faults, uint8_t marks);

#endif

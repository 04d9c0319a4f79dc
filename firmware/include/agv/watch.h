/**
 * @file watch.h
 * The stop watches of one supervisor, by name: each has one setting of the configuration as its limit. They run on
 * core->now_ms.
 */
#ifndef AGV_WATCH_H
#define AGV_WATCH_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"
#include "agv/protocol.h"

struct agv_core;

/** The watches. */
typedef enum {
    /* Reached after their limit or later ("for 100 ms"). */
    AGV_WATCH_BUS_OFF,          /**< vehicle side: since bus-off, or since its recovery was last asked for */
    AGV_WATCH_AI_BUS_OFF,       /**< AI side, as above */
    AGV_WATCH_STANDSTILL,       /**< both wheels are below the standstill speed and 101h is fresh */
    AGV_WATCH_ENGAGED,          /**< since the engagement: the checks of SUP-5 count once it is reached */
    AGV_WATCH_STEERING_OFF,     /**< the steering is off its command and does not gain */
    AGV_WATCH_THROTTLE_IN_PARK, /**< 050h is above 0 in gear P */
    AGV_WATCH_INIT_GOOD,        /**< INIT: all well */
    AGV_WATCH_RESET_GOOD,       /**< everything that a reset needs holds */
    AGV_WATCH_PRESS,            /**< button 1 held, in TRIPPED or SAFE */
    AGV_WATCH_PARK_WAIT,        /**< since the trip or the start: P at the latest (park: at_standstill) */
    AGV_WATCH_EVENT,            /**< since a fault that is an event was last raised; eight, one an event */
    /* Reached when they run for longer than their limit (deadlines). */
    AGV_WATCH_UNFED = AGV_WATCH_EVENT + (int)AGV_EVENT_FAULT_COUNT, /**< since the hardware watchdog was fed */
    AGV_WATCH_BOTH_MODES,                                           /**< both mode bits are set */
    AGV_WATCH_AI_AWAITED,                                           /**< engaged with an AI never seen */
    AGV_WATCH_OTHER_43F,                                            /**< since the other ID set's 43Fh was last heard */
    AGV_WATCH_OTHER_363,                                            /**< since the other ID set's 363h was last heard */
    AGV_WATCH_INIT,                                                 /**< since the start, in INIT */
    AGV_WATCH_UNCONFIRMED, /**< since the trip or the withdrawal of the confirmation: autopilot off is awaited */
    AGV_WATCH_PARK_SENT,   /**< since the first P, or that withdrawal: P is awaited */
    AGV_WATCH_TX,          /**< vehicle side: since when the HAL does not take a command; four, one a command */
    /** Deadlines of the messages, in their order; liveness.h says when each begins anew. */
    AGV_WATCH_MESSAGE = AGV_WATCH_TX + (int)AGV_COMMAND_COUNT,
    AGV_WATCH_COUNT = AGV_WATCH_MESSAGE + (int)AGV_MSG_COUNT
} agv_watch_t;

/** Phases of a watch. Once its limit was reached it stays so until the next start: nothing un-expires after 49.7 days. */
enum { AGV_WATCH_STOPPED = 0, AGV_WATCH_RUNNING = 1, AGV_WATCH_REACHED = 2 };

/** All watches. All zero: stopped. */
typedef struct {
    uint32_t since_ms[AGV_WATCH_COUNT];
    uint8_t phase[AGV_WATCH_COUNT];
} agv_watches_t;

/**
 * Milliseconds from @p then_ms to @p now_ms across the wrap. What lies in the future has the age 0: frames may carry
 * stamps that are a little ahead of the tick.
 */
uint32_t agv_age_ms(uint32_t now_ms, uint32_t then_ms);

/** Start anew from now. */
void agv_watch_start(struct agv_core *core, uint32_t watch);

/** Start anew, as if it were that moment. */
void agv_watch_start_at(struct agv_core *core, uint32_t watch, uint32_t since_ms);

/** Stop. */
void agv_watch_stop(struct agv_core *core, uint32_t watch);

/** Whether it has reached its limit. False when stopped. */
bool agv_watch_reached(struct agv_core *core, uint32_t watch);

/** Go on running while a condition holds, stop when it does not. @return whether it has reached its limit */
bool agv_watch_while(struct agv_core *core, uint32_t watch, bool condition);

/** Whether it runs and had not reached its limit when that was last asked for. */
bool agv_watch_is_within(const struct agv_core *core, uint32_t watch);

/** Whether it runs or has reached its limit. */
bool agv_watch_runs(const struct agv_core *core, uint32_t watch);

#endif

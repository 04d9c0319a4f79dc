/**
 * @file timers.h
 * The time of one supervisor: the latest time seen, and its timers by name (timer_table.def). Each timer has one setting
 * as its limit. Time is unsigned 32-bit milliseconds that wrap (TIM-2); no module reads a clock.
 */
#ifndef AGV_TIMERS_H
#define AGV_TIMERS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/protocol.h"

/** The timers. Those of the messages are in the order of agv_message_t. */
typedef enum {
#define AGV_TIMER(name, setting, kind) AGV_TIMER_##name,
#include "base/timer_table.def"
#undef AGV_TIMER
#define AGV_FAULT(name, class, led, flags)
#define AGV_FAULT_TRANSIENT(name, class, led, flags) AGV_TIMER_EVENT_##name,
#include "agv/fault_table.def"
#undef AGV_FAULT
#undef AGV_FAULT_TRANSIENT
#define AGV_COMMAND(NAME, name, heading, table, cycle, deadline, fault, counter) AGV_TIMER_MESSAGE_##NAME,
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) AGV_TIMER_MESSAGE_##NAME,
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
    AGV_TIMER_COUNT,
    AGV_TIMER_MESSAGE = AGV_TIMER_MESSAGE_TURN_SIGNAL_COMMAND /**< of message n: AGV_TIMER_MESSAGE + n */
} agv_timer_t;

/** Phases of a timer. One that has reached its limit stays so until it is started again (TIM-2). */
enum { AGV_TIMER_STOPPED = 0, AGV_TIMER_RUNNING = 1, AGV_TIMER_REACHED = 2 };

/** Time and timers of one supervisor. */
typedef struct {
    uint32_t now_ms;                    /**< latest time seen */
    uint32_t now_us;                    /**< the same in microseconds, wraps */
    uint32_t due_ms;                    /**< no running timer reaches its limit before this time */
    uint16_t since_ms[AGV_TIMER_COUNT]; /**< start, low half: a running timer is younger than its limit, at most 60 s */
    uint8_t phase[AGV_TIMER_COUNT];     /**< AGV_TIMER_STOPPED ... */
} agv_timers_t;

/**
 * Milliseconds from @p then_ms to @p now_ms, also across the wrap. A time in the future has the age 0: the time stamps of
 * frames may be slightly ahead of the tick.
 */
uint32_t agv_age_ms(uint32_t now_ms, uint32_t then_ms);

/** The limit of a timer, ms. */
uint32_t agv_timer_limit_ms(const agv_config_t *config, uint32_t timer);

/** Stop all timers. The time does not change. */
void agv_timers_start(agv_timers_t *timers);

/** Set the time; it may go backwards. */
void agv_timers_set_time(agv_timers_t *timers, uint32_t time_ms);

/**
 * Advance the time to a time stamp, and note which timers have reached their limit. The timers are only checked when the
 * first of them may have reached it. An earlier time stamp changes nothing: time never goes backwards. Call this at least
 * once in 24 days, so that the comparison holds across the wrap.
 * @param time_us microseconds within that millisecond, 0..999; a tick passes 0
 */
void agv_timers_advance(agv_timers_t *timers, const agv_config_t *config, uint32_t time_ms, uint32_t time_us);

/** The time for which a timer has run, ms; its limit if it has reached it. Must not be called for a stopped timer. */
uint32_t agv_timer_spent_ms(const agv_timers_t *timers, const agv_config_t *config, uint32_t timer);

/** Start or restart a timer now. */
void agv_timer_start(agv_timers_t *timers, uint32_t timer);

/** Start or restart a timer at a given time; now if that lies in the future. */
void agv_timer_start_at(agv_timers_t *timers, uint32_t timer, uint32_t since_ms);

/** Stop a timer. */
void agv_timer_stop(agv_timers_t *timers, uint32_t timer);

/** Whether a timer had reached its limit when the time last advanced. False when it is stopped. */
bool agv_timer_reached(const agv_timers_t *timers, uint32_t timer);

/** Run a timer while a condition holds, and stop it otherwise. @return whether it has reached its limit */
bool agv_timer_while(agv_timers_t *timers, uint32_t timer, bool condition);

/** Whether a timer is running and has not reached its limit. */
bool agv_timer_is_within(const agv_timers_t *timers, uint32_t timer);

/** Whether a timer is running or has reached its limit. */
bool agv_timer_is_started(const agv_timers_t *timers, uint32_t timer);

#endif

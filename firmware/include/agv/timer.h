/**
 * @file timer.h
 * A stop watch on the wrapping millisecond clock (TIM-2). Once a limit was reached it stays reached until the next start,
 * so that nothing un-expires after 49.7 days. One limit per timer.
 */
#ifndef AGV_TIMER_H
#define AGV_TIMER_H

#include <stdbool.h>
#include <stdint.h>

/** Phases of a timer. */
enum { AGV_TIMER_STOPPED = 0, AGV_TIMER_RUNNING = 1, AGV_TIMER_REACHED = 2 };

/** A timer. All zero: stopped. */
typedef struct {
    uint32_t since_ms;
    uint8_t phase;
} agv_timer_t;

/** Start anew from now. */
void agv_timer_start(agv_timer_t *timer, uint32_t now_ms);

/** Go on running while a condition holds (start when it begins to), stop when it does not. */
void agv_timer_while(agv_timer_t *timer, bool condition, uint32_t now_ms);

/** Whether it runs for @p limit_ms or longer ("for 100 ms"). False when stopped. */
bool agv_timer_reached(agv_timer_t *timer, uint32_t now_ms, uint32_t limit_ms);

/** Whether it runs for longer than @p limit_ms (a deadline: expired when the age is greater). False when stopped. */
bool agv_timer_exceeded(agv_timer_t *timer, uint32_t now_ms, uint32_t limit_ms);

/** Stop. */
static inline void agv_timer_stop(agv_timer_t *timer) {
    timer->phase = AGV_TIMER_STOPPED;
}

/** Whether it runs or has reached its limit. */
static inline bool agv_timer_runs(const agv_timer_t *timer) {
    return timer->phase != (uint8_t)AGV_TIMER_STOPPED;
}

/**
 * Milliseconds from @p then_ms to @p now_ms across the wrap. What lies in the future has the age 0: frames may carry
 * stamps that are a little ahead of the tick.
 */
uint32_t agv_age_ms(uint32_t now_ms, uint32_t then_ms);

#endif

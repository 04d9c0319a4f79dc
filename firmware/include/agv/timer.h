/**
 * @file timer.h
 * A stop watch on the wrapping millisecond clock (TIM-2). Once a limit was reached it stays reached until the next start,
 * so that nothing un-expires after 49.7 days. One limit per timer.
 */
#ifndef AGV_TIMER_H
#define AGV_TIMER_H

#include <stdbool.h>
#include <stdint.h>

/** A timer. All zero: stopped. */
typedef struct {
    uint32_t since_ms;
    uint8_t phase; /**< stopped, running, reached */
} agv_timer_t;

enum { AGV_TIMER_STOPPED = 0, AGV_TIMER_RUNNING = 1, AGV_TIMER_REACHED = 2 };

/** Stop. */
static inline void agv_timer_stop(agv_timer_t *timer) {
    timer->phase = AGV_TIMER_STOPPED;
}

/** Start anew from now. */
static inline void agv_timer_start(agv_timer_t *timer, uint32_t now_ms) {
    timer->since_ms = now_ms;
    timer->phase = AGV_TIMER_RUNNING;
}

/** Go on running while a condition holds, stop when it does not. */
static inline void agv_timer_while(agv_timer_t *timer, bool condition, uint32_t now_ms) {
    if (!condition) {
        agv_timer_stop(timer);
    } else if (timer->phase == AGV_TIMER_STOPPED) {
        agv_timer_start(timer, now_ms);
    }
}

/** Whether it runs for @p limit_ms or longer ("for 100 ms"). False when stopped. */
static inline bool agv_timer_reached(agv_timer_t *timer, uint32_t now_ms, uint32_t limit_ms) {
    if ((timer->phase == AGV_TIMER_RUNNING) && ((now_ms - timer->since_ms) >= limit_ms)) {
        timer->phase = AGV_TIMER_REACHED;
    }
    return timer->phase == AGV_TIMER_REACHED;
}

/** Whether it runs for longer than @p limit_ms (a deadline: expired when the age is greater). False when stopped. */
static inline bool agv_timer_exceeded(agv_timer_t *timer, uint32_t now_ms, uint32_t limit_ms) {
    return agv_timer_reached(timer, now_ms, limit_ms + 1u);
}

#endif

#include "agv/timer.h"

void agv_timer_start(agv_timer_t *timer, uint32_t now_ms) {
    timer->since_ms = now_ms;
    timer->phase = AGV_TIMER_RUNNING;
}

void agv_timer_while(agv_timer_t *timer, bool condition, uint32_t now_ms) {
    if (!condition) {
        agv_timer_stop(timer);
    } else if (!agv_timer_runs(timer)) {
        agv_timer_start(timer, now_ms);
    } else {
        /* goes on running */
    }
}

bool agv_timer_reached(agv_timer_t *timer, uint32_t now_ms, uint32_t limit_ms) {
    if ((timer->phase == (uint8_t)AGV_TIMER_RUNNING) && (agv_age_ms(now_ms, timer->since_ms) >= limit_ms)) {
        timer->phase = AGV_TIMER_REACHED;
    }
    return timer->phase == (uint8_t)AGV_TIMER_REACHED;
}

bool agv_timer_exceeded(agv_timer_t *timer, uint32_t now_ms, uint32_t limit_ms) {
    return agv_timer_reached(timer, now_ms, limit_ms + 1u);
}

uint32_t agv_age_ms(uint32_t now_ms, uint32_t then_ms) {
    const uint32_t difference = now_ms - then_ms;
    return (difference > (UINT32_MAX / 2u)) ? 0u : difference;
}

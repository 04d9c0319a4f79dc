#include "base/timers.h"

#include <stddef.h>
#include <string.h>

/* Added to the age, which then has to be above the limit: durations are reached at their limit, deadlines above it. */
enum { DURATION = 1, DEADLINE = 0 };

/* Which setting is the limit, and the kind. */
static const struct {
    uint8_t setting;
    uint8_t kind;
} rows[AGV_TIMER_COUNT] = {
#define AGV_TIMER(name, limit, of_kind) [AGV_TIMER_##name] = {.setting = AGV_SETTING_##limit, .kind = (of_kind)},
#include "base/timer_table.def"
#undef AGV_TIMER
#define AGV_FAULT(name, class, led, flags)
#define AGV_FAULT_EVENT(name, class, led, flags)                                                                       \
    [AGV_TIMER_EVENT_##name] = {.setting = AGV_SETTING_event_hold_ms, .kind = DURATION},
#include "agv/fault_table.def"
#undef AGV_FAULT
#undef AGV_FAULT_EVENT
#define AGV_COMMAND AGV_STATUS
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter)                                        \
    [AGV_TIMER_MESSAGE_##NAME] = {.setting = AGV_SETTING_##deadline, .kind = DEADLINE},
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
};

uint32_t agv_age_ms(uint32_t now_ms, uint32_t then_ms) {
    const uint32_t difference = now_ms - then_ms;
    return (difference > (UINT32_MAX / 2u)) ? 0u : difference;
}

uint32_t agv_timer_limit_ms(const agv_config_t *config, uint32_t timer) {
    return agv_config_get(config, rows[timer].setting);
}

void agv_timers_start(agv_timers_t *timers) {
    (void)memset(timers->phase, AGV_TIMER_STOPPED, sizeof timers->phase);
}

void agv_timers_set_time(agv_timers_t *timers, uint32_t time_ms) {
    timers->now_ms = time_ms;
    timers->now_us = time_ms * 1000u;
}

static void evaluate(agv_timers_t *timers, const agv_config_t *config) {
    for (uint32_t i = 0u; i < (uint32_t)AGV_TIMER_COUNT; i++) {
        if (timers->phase[i] == (uint8_t)AGV_TIMER_RUNNING) {
            const uint32_t age_ms = agv_age_ms(timers->now_ms, timers->since_ms[i]) + rows[i].kind;
            if (age_ms > agv_timer_limit_ms(config, i)) {
                timers->phase[i] = AGV_TIMER_REACHED;
            }
        }
    }
}

void agv_timers_advance(agv_timers_t *timers, const agv_config_t *config, uint32_t time_ms, uint32_t time_us) {
    const uint32_t now_us = (time_ms * 1000u) + time_us;
    if (time_ms == timers->now_ms) {
        timers->now_us = ((now_us - timers->now_us) < 1000u) ? now_us : timers->now_us;
    } else if (agv_age_ms(time_ms, timers->now_ms) > 0u) {
        timers->now_ms = time_ms;
        timers->now_us = now_us;
        evaluate(timers, config);
    } else {
        /* from before */
    }
}

void agv_timer_start_at(agv_timers_t *timers, uint32_t timer, uint32_t since_ms) {
    timers->since_ms[timer] = since_ms;
    timers->phase[timer] = AGV_TIMER_RUNNING;
}

void agv_timer_start(agv_timers_t *timers, uint32_t timer) {
    agv_timer_start_at(timers, timer, timers->now_ms);
}

void agv_timer_stop(agv_timers_t *timers, uint32_t timer) {
    timers->phase[timer] = AGV_TIMER_STOPPED;
}

bool agv_timer_reached(const agv_timers_t *timers, uint32_t timer) {
    return timers->phase[timer] == (uint8_t)AGV_TIMER_REACHED;
}

bool agv_timer_while(agv_timers_t *timers, uint32_t timer, bool condition) {
    if (!condition) {
        agv_timer_stop(timers, timer);
    } else if (!agv_timer_runs(timers, timer)) {
        agv_timer_start(timers, timer);
    } else {
        /* runs on */
    }
    return agv_timer_reached(timers, timer);
}

bool agv_timer_is_within(const agv_timers_t *timers, uint32_t timer) {
    return timers->phase[timer] == (uint8_t)AGV_TIMER_RUNNING;
}

bool agv_timer_runs(const agv_timers_t *timers, uint32_t timer) {
    return timers->phase[timer] != (uint8_t)AGV_TIMER_STOPPED;
}

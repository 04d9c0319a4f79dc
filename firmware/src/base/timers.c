#include "base/timers.h"

#include <string.h>

/* Time in ms that a timer must run beyond its limit: durations expire at >= the limit, deadlines at > it; a step adds 1 ms. */
enum { DURATION = 0, DEADLINE = 1, STEP = 2 };

/* The setting that is the limit, and the kind of each timer. */
static const struct {
    uint8_t setting;
    uint8_t more_ms;
} rows[AGV_TIMER_COUNT] = {
#define AGV_TIMER(name, limit, kind) [AGV_TIMER_##name] = {.setting = AGV_SETTING_##limit, .more_ms = (kind)},
#include "base/timer_table.def"
#undef AGV_TIMER
#define AGV_FAULT(name, class, led, flags)
#define AGV_FAULT_TRANSIENT(name, class, led, flags)                                                                   \
    [AGV_TIMER_EVENT_##name] = {.setting = AGV_SETTING_event_hold_ms, .more_ms = DURATION},
#include "agv/fault_table.def"
#undef AGV_FAULT
#undef AGV_FAULT_TRANSIENT
#define AGV_COMMAND AGV_STATUS
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter)                                        \
    [AGV_TIMER_MESSAGE_##NAME] = {.setting = AGV_SETTING_##deadline, .more_ms = DEADLINE},
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
};

uint32_t agv_age_ms(uint32_t now_ms, uint32_t then_ms) {
    const uint32_t difference = now_ms - then_ms;
    return (difference > (UINT32_MAX / 2u)) ? 0u : difference;
}

/* Settings are in the order of their indices (config.c). */
static uint32_t limit_of(const agv_config_t *config, uint32_t timer) {
    uint16_t limit_ms;
    (void)memcpy(&limit_ms, &((const unsigned char *)config)[rows[timer].setting * sizeof limit_ms], sizeof limit_ms);
    return limit_ms;
}

uint32_t agv_timer_limit_ms(const agv_config_t *config, uint32_t timer) {
    return limit_of(config, timer);
}

void agv_timers_start(agv_timers_t *timers) {
    (void)memset(timers->phase, AGV_TIMER_STOPPED, sizeof timers->phase);
    timers->due_ms = timers->now_ms;
}

void agv_timers_set_time(agv_timers_t *timers, uint32_t time_ms) {
    timers->now_ms = time_ms;
    timers->now_us = time_ms * 1000u;
    timers->due_ms = time_ms;
}

/* The start of a timer is stored in 16 bits: the longest age, and the longest time until the timers are evaluated again. */
#define AGE_MAX_MS 0xFFFFu

/* Time from since_ms until the timer has reached its limit. */
static uint32_t time_to_limit_ms(const agv_config_t *config, uint32_t timer) {
    return limit_of(config, timer) + rows[timer].more_ms;
}

static bool is_running(const agv_timers_t *timers, uint32_t timer) {
    return timers->phase[timer] == (uint8_t)AGV_TIMER_RUNNING;
}

/* The age of a running timer at the latest time seen. */
static uint32_t age_of(const agv_timers_t *timers, uint32_t timer) {
    return (uint16_t)(timers->now_ms - timers->since_ms[timer]);
}

/* Note which timers reach their limit within @p step_ms. Returns the time from then until the next one, or less. */
static uint32_t evaluate(agv_timers_t *timers, const agv_config_t *config, uint32_t step_ms) {
    uint32_t next_ms = AGE_MAX_MS;
    /* for tests/proofs/unbounded/run */
    /*@ loop invariant i <= AGV_TIMER_COUNT && 1 <= next_ms <= 65535;
        loop invariant \forall integer k; i <= k < AGV_TIMER_COUNT ==> timers->phase[k] == \at(timers->phase[k], Pre);
        loop invariant \forall integer k; 0 <= k < i ==>
            (\at(running(timers, k), Pre) && age(timers, k) + step_ms >= span(config, k) ?
                 reached(timers, k) : timers->phase[k] == \at(timers->phase[k], Pre));
        loop invariant \forall integer k; 0 <= k < i && running(timers, k) ==>
            next_ms + age(timers, k) + step_ms <= span(config, k);
        loop assigns i, next_ms, timers->phase[0 .. AGV_TIMER_COUNT - 1];
        loop variant AGV_TIMER_COUNT - i; */
    for (uint32_t i = 0u; i < (uint32_t)AGV_TIMER_COUNT; i++) {
        if (is_running(timers, i)) {
            const uint32_t age_ms = age_of(timers, i) + step_ms;
            const uint32_t span_ms = time_to_limit_ms(config, i);
            if (age_ms >= span_ms) {
                timers->phase[i] = AGV_TIMER_REACHED;
            } else if ((span_ms - age_ms) < next_ms) {
                next_ms = span_ms - age_ms;
            } else {
                /* not the next one */
            }
        }
    }
    return next_ms;
}

void agv_timers_advance(agv_timers_t *timers, const agv_config_t *config, uint32_t time_ms, uint32_t time_us) {
    const uint32_t now_us = (time_ms * 1000u) + time_us;
    if (time_ms == timers->now_ms) {
        timers->now_us = ((now_us - timers->now_us) < 1000u) ? now_us : timers->now_us;
    } else if (agv_age_ms(time_ms, timers->now_ms) > 0u) {
        if ((time_ms - timers->due_ms) <= (UINT32_MAX / 2u)) {
            timers->due_ms = time_ms + evaluate(timers, config, time_ms - timers->now_ms);
        }
        timers->now_ms = time_ms;
        timers->now_us = now_us;
    } else {
        /* from before */
    }
}

/* due_ms stays valid: a timer that is restarted can only reach its limit later. */
void agv_timer_start_at(agv_timers_t *timers, uint32_t timer, uint32_t since_ms) {
    uint32_t age_ms = agv_age_ms(timers->now_ms, since_ms);
    if (age_ms > AGE_MAX_MS) {
        age_ms = AGE_MAX_MS;
    }
    if (!is_running(timers, timer) || (age_ms > age_of(timers, timer))) {
        timers->due_ms = timers->now_ms;
    }
    timers->since_ms[timer] = (uint16_t)(timers->now_ms - age_ms);
    timers->phase[timer] = AGV_TIMER_RUNNING;
}

void agv_timer_start(agv_timers_t *timers, uint32_t timer) {
    agv_timer_start_at(timers, timer, timers->now_ms);
}

void agv_timer_stop(agv_timers_t *timers, uint32_t timer) {
    timers->phase[timer] = AGV_TIMER_STOPPED;
}

uint32_t agv_timer_spent_ms(const agv_timers_t *timers, const agv_config_t *config, uint32_t timer) {
    const uint32_t limit_ms = limit_of(config, timer);
    const uint32_t age_ms = age_of(timers, timer);
    return (is_running(timers, timer) && (age_ms < limit_ms)) ? age_ms : limit_ms;
}

bool agv_timer_reached(const agv_timers_t *timers, uint32_t timer) {
    return timers->phase[timer] == (uint8_t)AGV_TIMER_REACHED;
}

bool agv_timer_while(agv_timers_t *timers, uint32_t timer, bool condition) {
    if (!condition) {
        agv_timer_stop(timers, timer);
    } else if (!agv_timer_is_started(timers, timer)) {
        agv_timer_start(timers, timer);
    } else {
        /* runs on */
    }
    return agv_timer_reached(timers, timer);
}

bool agv_timer_is_within(const agv_timers_t *timers, uint32_t timer) {
    return is_running(timers, timer);
}

bool agv_timer_is_started(const agv_timers_t *timers, uint32_t timer) {
    return timers->phase[timer] != (uint8_t)AGV_TIMER_STOPPED;
}

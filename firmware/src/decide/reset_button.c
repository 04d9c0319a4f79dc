#include "decide/reset_button.h"

#include <string.h>

/* The conditions. */
static const uint16_t conditions[AGV_RESET_CONDITIONS] = {
    AGV_MISSING_STATE,      AGV_MISSING_VCU_HEARTBEAT, AGV_MISSING_EPS_HEARTBEAT,
    AGV_MISSING_TRIP_CAUSE, AGV_MISSING_STANDSTILL,    AGV_MISSING_MANUAL,
    AGV_MISSING_MESSAGES,   AGV_MISSING_THROTTLE,      AGV_MISSING_OUTPUT};

void agv_reset_button_report(agv_reset_button_t *reset, bool vcu_alive, bool remote_lost, bool down) {
    const agv_button_t heard = down ? AGV_BUTTON_DOWN : AGV_BUTTON_UP;
    if (vcu_alive) {
        reset->button = (uint8_t)(remote_lost ? AGV_BUTTON_UNHEARD : heard);
        if (reset->button != (uint8_t)AGV_BUTTON_UP) {
            reset->up_frames = 0u;
        } else if (reset->up_frames < AGV_BUTTON_UP_FRAMES) {
            reset->up_frames++;
        } else {
            /* up for long enough */
        }
    }
}

void agv_reset_button_read(agv_reset_button_t *reset, uint8_t button) {
    reset->button = button;
    reset->up_frames = AGV_BUTTON_UP_FRAMES; /* debounced */
}

void agv_reset_button_lose(agv_reset_button_t *reset) {
    reset->button = AGV_BUTTON_UNKNOWN;
    reset->up_frames = 0u;
}

/* Each button has two timers. */
static uint32_t press_timer(const agv_reset_button_t *reset) {
    return reset->is_pin ? AGV_TIMER_PIN_PRESS : AGV_TIMER_PRESS;
}

static uint32_t long_press_timer(const agv_reset_button_t *reset) {
    return reset->is_pin ? AGV_TIMER_PIN_PRESS_LONG : AGV_TIMER_PRESS_LONG;
}

static void forget_press(agv_reset_button_t *reset, agv_timers_t *timers) {
    reset->began_after = false;
    reset->answered = false;
    agv_timer_stop(timers, press_timer(reset));
    agv_timer_stop(timers, long_press_timer(reset));
}

/* Up, and not for a glitch only. */
static bool is_up(const agv_reset_button_t *reset) {
    return (reset->button == (uint8_t)AGV_BUTTON_UP) && (reset->up_frames == AGV_BUTTON_UP_FRAMES);
}

void agv_reset_button_trip(agv_reset_button_t *reset, agv_timers_t *timers) {
    forget_press(reset, timers);
    reset->was_up = is_up(reset); /* a button that is down at the trip has no rising edge after it */
    (void)memset(reset->held_ms, 0, sizeof reset->held_ms);
}

/* The conditions that did not hold at some time in the last reset_hold_ms. */
static uint32_t missing_lately(const agv_reset_button_t *reset, const agv_config_t *config) {
    uint32_t missing = 0u;
    /* for tests/proofs/unbounded/run */
    /*@ loop invariant 0 <= i <= 9;
        loop invariant missing == 0 <==> \forall integer k; 0 <= k < i ==> reset->held_ms[k] >= config->reset_hold_ms;
        loop assigns i, missing;
        loop variant 9 - i; */
    for (uint32_t i = 0u; i < AGV_RESET_CONDITIONS; i++) {
        missing |= (reset->held_ms[i] < config->reset_hold_ms) ? conditions[i] : 0u;
    }
    return missing;
}

static void follow_conditions(agv_reset_button_t *reset, const agv_config_t *config, uint32_t elapsed_ms,
                              uint32_t lacking) {
    /* for tests/proofs/unbounded/run */
    /*@ loop invariant 0 <= i <= 9;
        loop invariant \forall integer k; i <= k < 9 ==> reset->held_ms[k] == \at(reset->held_ms[k], Pre);
        loop invariant \forall integer k; 0 <= k < i ==> reset->held_ms[k] <= config->reset_hold_ms;
        loop invariant \forall integer k; 0 <= k < i && (lacking & bit_of(k)) != 0 ==> reset->held_ms[k] == 0;
        loop invariant \forall integer k; 0 <= k < i && (lacking & bit_of(k)) == 0 ==>
            reset->held_ms[k] == \at(held_for(reset, config, k, elapsed_ms), Pre);
        loop assigns i, reset->held_ms[0 .. 8];
        loop variant 9 - i; */
    for (uint32_t i = 0u; i < AGV_RESET_CONDITIONS; i++) {
        const uint32_t room_ms = (uint32_t)config->reset_hold_ms - reset->held_ms[i];
        const uint32_t more_ms = (elapsed_ms < room_ms) ? elapsed_ms : room_ms;
        reset->held_ms[i] = (uint16_t)(((lacking & conditions[i]) == 0u) ? (reset->held_ms[i] + more_ms) : 0u);
    }
}

static void follow_press(agv_reset_button_t *reset, agv_timers_t *timers) {
    if (reset->button == (uint8_t)AGV_BUTTON_DOWN) {
        reset->began_after = reset->began_after || reset->was_up;
        (void)agv_timer_while(timers, press_timer(reset), true);
        (void)agv_timer_while(timers, long_press_timer(reset), true);
    }
}

/* The press has just ended, or has reached reset_hold_max_ms. */
static agv_press_result_t press_result(const agv_reset_button_t *reset, const agv_timers_t *timers, uint32_t *missing) {
    const bool too_long = agv_timer_reached(timers, long_press_timer(reset));
    const bool unheard = reset->button == (uint8_t)AGV_BUTTON_UNHEARD;
    *missing |= (reset->began_after && !unheard) ? 0u : AGV_MISSING_BUTTON;
    *missing |= too_long ? AGV_MISSING_RELEASED : 0u;
    *missing |= (reset->button == (uint8_t)AGV_BUTTON_UNKNOWN) ? AGV_MISSING_VCU_HEARTBEAT : 0u;
    return (*missing == 0u) ? AGV_PRESS_RESETS : AGV_PRESS_IN_VAIN;
}

agv_press_result_t agv_reset_button_step(agv_reset_button_t *reset, agv_timers_t *timers, const agv_config_t *config,
                                         uint32_t elapsed_ms, uint32_t lacking, uint32_t *missing) {
    agv_press_result_t result = AGV_PRESS_NOTHING;
    const uint32_t before = missing_lately(reset, config);
    follow_conditions(reset, config, elapsed_ms, lacking);
    /* The loss of the VCU ends the press: conditions that fail because of it are not reported. */
    *missing = (reset->button == (uint8_t)AGV_BUTTON_UNKNOWN) ? before : missing_lately(reset, config);
    follow_press(reset, timers);
    const bool is_down = reset->button == (uint8_t)AGV_BUTTON_DOWN;
    const bool ends = !is_down || agv_timer_reached(timers, long_press_timer(reset));
    if (ends && !reset->answered && agv_timer_reached(timers, press_timer(reset))) {
        result = press_result(reset, timers, missing);
        reset->answered = true;
    }
    if (!is_down) {
        forget_press(reset, timers);
    }
    reset->was_up = is_up(reset);
    return result;
}

#include "observe/mode.h"

enum { BOTH = AGV_VCU_FLAG_MANUAL | AGV_VCU_FLAG_AUTOPILOT };

static agv_mode_change_t take(agv_mode_t *mode, agv_timers_t *timers, uint32_t value, uint32_t time_ms) {
    const bool was_engaged = agv_mode_is_engaged(mode);
    mode->value = (uint8_t)value;
    if (agv_mode_is_engaged(mode) == was_engaged) {
        return AGV_MODE_SAME;
    }
    if (was_engaged) {
        agv_timer_stop(timers, AGV_TIMER_ENGAGED);
        return AGV_MODE_ENDED;
    }
    agv_timer_start(timers, AGV_TIMER_ENGAGED);
    agv_timer_start_at(timers, AGV_TIMER_AI_NEVER_SEEN, time_ms);
    return AGV_MODE_BEGAN;
}

agv_mode_change_t agv_mode_report(agv_mode_t *mode, agv_timers_t *timers, uint32_t flags, uint32_t time_ms) {
    const uint32_t value = flags & (uint32_t)BOTH;
    const bool both = value == (uint32_t)BOTH;
    (void)agv_timer_while(timers, AGV_TIMER_BOTH_MODES, both);
    return both ? AGV_MODE_SAME : take(mode, timers, value, time_ms);
}

agv_mode_change_t agv_mode_tick(agv_mode_t *mode, agv_timers_t *timers) {
    return agv_mode_is_invalid(timers) ? take(mode, timers, AGV_MODE_NONE, timers->now_ms) : AGV_MODE_SAME;
}

bool agv_mode_is_engaged(const agv_mode_t *mode) {
    return (mode->value & (uint32_t)AGV_MODE_ENGAGED) != 0u;
}

bool agv_mode_is_manual(const agv_mode_t *mode) {
    return (mode->value & (uint32_t)AGV_MODE_MANUAL) != 0u;
}

bool agv_mode_is_settled(const agv_timers_t *timers) {
    return agv_timer_reached(timers, AGV_TIMER_ENGAGED);
}

bool agv_mode_is_invalid(const agv_timers_t *timers) {
    return agv_timer_reached(timers, AGV_TIMER_BOTH_MODES);
}

bool agv_mode_is_ambiguous(const agv_timers_t *timers) {
    return agv_timer_runs(timers, AGV_TIMER_BOTH_MODES);
}

#include "observe/mode.h"

#include "agv/codec.h"

enum { MANUAL = AGV_VCU_FLAG_MANUAL, AUTOPILOT = AGV_VCU_FLAG_AUTOPILOT, BOTH = MANUAL | AUTOPILOT };

/* The engagements that count for MODE_FLAPPING: the last three. */
enum { ENGAGEMENTS = 3 };
static const uint8_t engagement_timers[ENGAGEMENTS] = {AGV_TIMER_ENGAGEMENT_1, AGV_TIMER_ENGAGEMENT_2,
                                                       AGV_TIMER_ENGAGEMENT_3};

/* Budget of manual while engaged: longer than an engagement takes to end, also with a slow 363h. */
enum { FLICKER_MS = 250 };

static uint32_t flicker_ms(const agv_config_t *config) {
    const uint32_t slow_ms = ((uint32_t)config->mode_frames * config->vcu_heartbeat_timeout_ms) / 2u;
    return (slow_ms > (uint32_t)FLICKER_MS) ? slow_ms : (uint32_t)FLICKER_MS;
}

static bool has(const agv_mode_t *mode, uint32_t bit) {
    return (mode->bits & bit) != 0u;
}

static agv_mode_change_t begin_engagement(agv_mode_t *mode, agv_timers_t *timers, uint32_t time_ms) {
    const bool continues = agv_timer_is_within(timers, AGV_TIMER_DISENGAGED);
    mode->engaged = true;
    mode->off_frames = 0u;
    agv_timer_stop(timers, AGV_TIMER_DISENGAGED);
    if (continues) {
        return AGV_MODE_CONTINUED;
    }
    agv_timer_start_at(timers, AGV_TIMER_ENGAGED, time_ms);
    agv_timer_start_at(timers, AGV_TIMER_AI_NEVER_SEEN, time_ms);
    return AGV_MODE_BEGAN;
}

static agv_mode_change_t end(agv_mode_t *mode, agv_timers_t *timers) {
    if (!mode->engaged) {
        return AGV_MODE_SAME;
    }
    mode->engaged = false;
    mode->off_frames = 0u;
    agv_timer_start(timers, AGV_TIMER_DISENGAGED);
    return AGV_MODE_ENDED;
}

/* An engagement ends with the last of mode_frames consecutive 363h without the autopilot bit. */
static agv_mode_change_t count_off_frame(agv_mode_t *mode, agv_timers_t *timers, const agv_config_t *config) {
    if (!mode->engaged) {
        return AGV_MODE_SAME;
    }
    mode->off_frames++;
    return (mode->off_frames >= config->mode_frames) ? end(mode, timers) : AGV_MODE_SAME;
}

/* Time an interrupted condition: it resumes with the time that is left. Returns whether it has lasted long enough. */
static bool resume_while(agv_timers_t *timers, const agv_config_t *config, uint32_t timer, agv_budget_t *spent,
                         bool condition) {
    if (condition && !agv_timer_is_started(timers, timer)) {
        agv_timer_start_at(timers, timer, timers->now_ms - spent->value_ms);
    } else if (!condition && agv_timer_is_started(timers, timer)) {
        spent->value_ms = (uint16_t)agv_timer_spent_ms(timers, config, timer);
        agv_timer_stop(timers, timer);
    } else {
        /* no change */
    }
    return agv_timer_reached(timers, timer);
}

static void reduce_budget(const agv_timers_t *timers, uint32_t timer, agv_budget_t *spent, uint32_t elapsed_ms) {
    if (!agv_timer_is_started(timers, timer)) {
        agv_budget_add(spent, false, elapsed_ms, UINT16_MAX);
    }
}

agv_mode_change_t agv_mode_report(agv_mode_t *mode, agv_timers_t *timers, const agv_config_t *config, uint32_t flags,
                                  bool vcu_alive, uint32_t time_ms) {
    mode->heard = true;
    mode->bits = (uint8_t)(flags & (uint32_t)BOTH);
    (void)resume_while(timers, config, AGV_TIMER_BOTH_MODES, &mode->both_spent, mode->bits == (uint8_t)BOTH);
    if (mode->bits == (uint8_t)BOTH) {
        mode->off_frames = 0u;
        return AGV_MODE_SAME; /* the previous mode remains */
    }
    mode->manual = has(mode, MANUAL);
    if (!has(mode, AUTOPILOT)) {
        return count_off_frame(mode, timers, config);
    }
    mode->off_frames = 0u;
    return (!mode->engaged && vcu_alive) ? begin_engagement(mode, timers, time_ms) : AGV_MODE_SAME;
}

static bool is_invalid(const agv_timers_t *timers) {
    return agv_timer_reached(timers, AGV_TIMER_BOTH_MODES);
}

agv_mode_change_t agv_mode_tick(agv_mode_t *mode, agv_timers_t *timers, const agv_config_t *config, bool vcu_alive,
                                uint32_t elapsed_ms) {
    /* while the last 363h reports manual, driving is not judged: without a limit this would hide every fault */
    agv_budget_add(&mode->manual_spent, mode->engaged && (mode->bits == (uint8_t)MANUAL), elapsed_ms,
                   flicker_ms(config));
    reduce_budget(timers, AGV_TIMER_BOTH_MODES, &mode->both_spent, elapsed_ms);
    reduce_budget(timers, AGV_TIMER_NO_MODE, &mode->none_spent, elapsed_ms);
    if (is_invalid(timers)) {
        mode->manual = false;
    }
    return (is_invalid(timers) || !vcu_alive) ? end(mode, timers) : AGV_MODE_SAME;
}

void agv_mode_count_engagement(agv_mode_t *mode, agv_timers_t *timers, agv_fault_monitor_t *faults) {
    const uint32_t timer = engagement_timers[mode->oldest];
    if (agv_timer_is_within(timers, timer)) {
        agv_fault_monitor_event(faults, timers, AGV_FAULT_MODE_FLAPPING);
    }
    agv_timer_start(timers, timer);
    mode->oldest = (uint8_t)((mode->oldest + 1u) % (uint32_t)ENGAGEMENTS);
}

void agv_mode_check(agv_mode_t *mode, agv_timers_t *timers, agv_fault_monitor_t *faults, const agv_config_t *config,
                    bool supervising, bool standstill) {
    const bool began = agv_timer_reached(timers, AGV_TIMER_NO_MODE);
    /* both bits, or manual while engaged, count as no valid mode: a node that alternates between them is detected */
    const bool known = (mode->bits == (uint8_t)AUTOPILOT) || ((mode->bits == (uint8_t)MANUAL) && !mode->engaged);
    const bool none = mode->heard && !known && !standstill;
    if (supervising && mode->manual_spent.present) {
        agv_fault_monitor_event(faults, timers, AGV_FAULT_MODE_FLAPPING);
    }
    agv_fault_monitor_set(faults, AGV_FAULT_MODE_INVALID, is_invalid(timers));
    agv_fault_monitor_set(
        faults, AGV_FAULT_MODE_NONE,
        resume_while(timers, config, AGV_TIMER_NO_MODE, &mode->none_spent, none && (supervising || began)));
}

bool agv_mode_is_engaged(const agv_mode_t *mode) {
    return mode->engaged;
}

bool agv_mode_is_manual(const agv_mode_t *mode) {
    return mode->manual;
}

bool agv_mode_is_judged(const agv_mode_t *mode, const agv_timers_t *timers) {
    return mode->engaged && has(mode, AUTOPILOT) && agv_timer_reached(timers, AGV_TIMER_ENGAGED);
}

bool agv_mode_reports_autopilot(const agv_mode_t *mode) {
    return mode->bits == (uint8_t)AUTOPILOT;
}

bool agv_mode_is_ambiguous(const agv_mode_t *mode) {
    return mode->bits == (uint8_t)BOTH;
}

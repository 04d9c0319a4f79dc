#include "observe/motion_checks.h"

#include <stddef.h>
#include <string.h>

/* SUP-11: the decrease of 050h towards 075h that clears the budget, in counts. */
enum { THROTTLE_DROP_COUNTS = 25 };

/* SUP-12: m/h to mm/s is 1000 / 3600. The speeds may differ by the constant plus a quarter of the larger one. */
enum { MM_S_PER_18_COUNTS = 5, SPEED_SLACK_MM_S = 500, SPEED_SHARE = 4, WHEEL_MAX_MM_S = 1000000 };

static const uint8_t faults_of[AGV_BUDGET_COUNT] = {[AGV_BUDGET_STEERING] = AGV_FAULT_STEERING_DEVIATION,
                                                    [AGV_BUDGET_THROTTLE] = AGV_FAULT_THROTTLE_DEVIATION,
                                                    [AGV_BUDGET_GEAR] = AGV_FAULT_GEAR_DEVIATION,
                                                    [AGV_BUDGET_AUTOPILOT_OFF] = AGV_FAULT_AUTOPILOT_OFF_IGNORED,
                                                    [AGV_BUDGET_THROTTLE_IN_PARK] = AGV_FAULT_THROTTLE_IN_PARK,
                                                    [AGV_BUDGET_SPEED] = AGV_FAULT_SPEED_IMPLAUSIBLE};

static int32_t magnitude_of(int32_t value) {
    return (value < 0) ? -value : value;
}

static int32_t clamp(int32_t value, int32_t limit) {
    if (value > limit) {
        return limit;
    }
    return (value < -limit) ? -limit : value;
}

static int32_t off_by_ddeg(const agv_motion_facts_t *facts, uint32_t angle_raw) {
    return magnitude_of((int32_t)angle_raw - (int32_t)facts->commands->angle_raw);
}

/* While the budget is 0, only steps back are kept, and only for some time after progress has cleared it. */
static int16_t kept(int16_t gained, bool steps_back_count) {
    return (steps_back_count && (gained < 0)) ? gained : 0;
}

static void restart_progress(const agv_budget_t *budget, agv_progress_t *progress) {
    if (budget->value_ms == 0u) {
        const bool steps_back_count = progress->steps_back_ms != 0u;
        progress->gained = kept(progress->gained, steps_back_count);
        progress->gained_beyond = kept(progress->gained_beyond, steps_back_count);
    }
}

/* The time for which a full budget decays. */
static uint16_t decay_ms(uint32_t limit_ms) {
    return (uint16_t)(2u * limit_ms);
}

static int32_t beyond(int32_t off, int32_t limit) {
    return (off > limit) ? (off - limit) : 0;
}

/* A value has moved: how far it is off its command, before and now, and how far it may be. */
typedef struct {
    int32_t before;
    int32_t now;
    int32_t limit;
} step_t;

/* Progress after a step. Only the part of the step that is farther from the command than the limit counts. */
static int16_t gained_by(int16_t gained, step_t step, int32_t limit, bool judged, bool steps_back_count) {
    const int32_t nearer = beyond(step.before, limit) - beyond(step.now, limit);
    const bool counts = judged || (steps_back_count && (nearer < 0));
    return counts ? (int16_t)clamp(gained + nearer, AGV_ANGLE_RAW_MAX) : gained;
}

/* Count a step, if driving is judged or it is one back that counts. Enough progress towards the command clears the budget. */
static void follow_progress(agv_budget_t *budget, agv_progress_t *progress, step_t step, bool judged, int32_t enough,
                            uint32_t limit_ms) {
    const bool steps_back_count = progress->steps_back_ms != 0u;
    progress->gained = gained_by(progress->gained, step, 0, judged, steps_back_count);
    if (steps_back_count) {
        progress->gained_beyond = gained_by(progress->gained_beyond, step, step.limit, judged, true);
    }
    if ((budget->value_ms != 0u) && ((progress->gained >= enough) || (progress->gained_beyond >= enough))) {
        *budget = (agv_budget_t){0};
        progress->steps_back_ms = decay_ms(limit_ms);
    }
    restart_progress(budget, progress);
}

void agv_motion_checks_angle(agv_motion_checks_t *checks, const agv_motion_facts_t *facts, uint32_t before_raw) {
    const agv_config_t *const config = facts->config;
    if (agv_commands_has(facts->commands, AGV_MSG_STEERING_COMMAND)) {
        const step_t step = {.before = off_by_ddeg(facts, before_raw),
                             .now = off_by_ddeg(facts, facts->vehicle->angle_raw),
                             .limit = (int32_t)config->steering_deviation_ddeg};
        follow_progress(&checks->budgets[AGV_BUDGET_STEERING], &checks->steering, step, facts->judged,
                        (int32_t)config->steering_gain_ddeg, config->steering_deviation_ms);
    }
}

void agv_motion_checks_throttle(agv_motion_checks_t *checks, const agv_motion_facts_t *facts, uint32_t before) {
    const agv_config_t *const config = facts->config;
    const int32_t commanded = (int32_t)facts->commands->throttle;
    const step_t step = {.before = (int32_t)before - commanded,
                         .now = (int32_t)facts->vehicle->throttle - commanded,
                         .limit = (int32_t)config->throttle_deviation_counts};
    follow_progress(&checks->budgets[AGV_BUDGET_THROTTLE], &checks->throttle, step, facts->judged, THROTTLE_DROP_COUNTS,
                    config->throttle_deviation_ms);
}

static bool steering_is_off(const agv_motion_facts_t *facts) {
    return facts->vehicle->angle_known && agv_commands_has(facts->commands, AGV_MSG_STEERING_COMMAND) &&
           (off_by_ddeg(facts, facts->vehicle->angle_raw) > (int32_t)facts->config->steering_deviation_ddeg);
}

static bool throttle_is_above(const agv_motion_facts_t *facts) {
    return agv_commands_has(facts->commands, AGV_MSG_THROTTLE_COMMAND) &&
           (facts->vehicle->throttle >
            ((uint32_t)facts->commands->throttle + facts->config->throttle_deviation_counts));
}

static bool gear_is_another(const agv_motion_facts_t *facts) {
    const uint32_t gear = facts->vehicle->gear;
    return (facts->commands->gear != 0u) && (gear <= (uint32_t)AGV_GEAR_R) && (gear != facts->commands->gear);
}

/* D or R is commanded, and not reported: at idle this does not show that the gear is right. */
static bool gear_is_awaited(const agv_motion_facts_t *facts) {
    return (facts->commands->gear <= (uint8_t)AGV_GEAR_R) && (facts->vehicle->gear != facts->commands->gear);
}

static bool speeds_are_known(const agv_vehicle_t *vehicle) {
    return vehicle->wheels_fresh && vehicle->vcu_alive && vehicle->vcu_speed_seen;
}

static bool speeds_differ(const agv_vehicle_t *vehicle) {
    const int32_t left_mm_s = clamp(vehicle->wheels.left_mm_s, WHEEL_MAX_MM_S);
    const int32_t right_mm_s = clamp(vehicle->wheels.right_mm_s, WHEEL_MAX_MM_S);
    const int32_t wheels_mm_s = magnitude_of(left_mm_s + right_mm_s) / 2;
    const int32_t vcu_mm_s = ((int32_t)vehicle->vcu_speed * MM_S_PER_18_COUNTS) / 18;
    const int32_t larger_mm_s = (wheels_mm_s > vcu_mm_s) ? wheels_mm_s : vcu_mm_s;
    return magnitude_of(wheels_mm_s - vcu_mm_s) > (SPEED_SLACK_MM_S + (larger_mm_s / SPEED_SHARE));
}

/* Add the time to a budget that progress clears. */
static void spend(agv_budget_t *budget, agv_progress_t *progress, bool off, uint32_t elapsed_ms, uint32_t limit_ms) {
    agv_budget_add(budget, off, elapsed_ms, limit_ms);
    if (progress->steps_back_ms == 0u) {
        /* nothing is remembered */
    } else if (off) {
        progress->steps_back_ms = decay_ms(limit_ms);
    } else {
        progress->steps_back_ms -=
            (uint16_t)((elapsed_ms < progress->steps_back_ms) ? elapsed_ms : progress->steps_back_ms);
    }
    restart_progress(budget, progress);
}

/* The two budgets that need the gear. An invalid 0A3h hides nothing: they do not change. */
static void tick_gear(agv_budget_t *budgets, const agv_motion_facts_t *facts, uint32_t elapsed_ms) {
    const agv_config_t *const config = facts->config;
    const bool idle = agv_vehicle_throttle_is_idle(facts->vehicle, config);
    if (facts->vehicle->gear == 0u) {
        return;
    }
    if (!idle || !gear_is_awaited(facts)) {
        agv_budget_add(&budgets[AGV_BUDGET_GEAR], !idle && gear_is_another(facts), elapsed_ms,
                       config->gear_deviation_ms);
    }
    if (!facts->gear_fresh) {
        return; /* a slow 0A3h hides nothing */
    }
    agv_budget_add(&budgets[AGV_BUDGET_THROTTLE_IN_PARK], (facts->vehicle->gear == (uint8_t)AGV_GEAR_P) && !idle,
                   elapsed_ms, config->throttle_in_park_ms);
}

void agv_motion_checks_tick(agv_motion_checks_t *checks, const agv_motion_facts_t *facts, uint32_t elapsed_ms) {
    const agv_config_t *const config = facts->config;
    agv_budget_t *const budgets = checks->budgets;
    const uint32_t known_ms = speeds_are_known(facts->vehicle) ? elapsed_ms : 0u; /* a slow 101h hides nothing */
    agv_budget_add(&budgets[AGV_BUDGET_SPEED], speeds_differ(facts->vehicle), known_ms, config->speed_implausible_ms);
    if (!facts->judged) {
        return; /* the other budgets do not change */
    }
    spend(&budgets[AGV_BUDGET_STEERING], &checks->steering, steering_is_off(facts), elapsed_ms,
          config->steering_deviation_ms);
    spend(&budgets[AGV_BUDGET_THROTTLE], &checks->throttle, throttle_is_above(facts), elapsed_ms,
          config->throttle_deviation_ms);
    agv_budget_add(&budgets[AGV_BUDGET_AUTOPILOT_OFF], facts->commands->autopilot_off, elapsed_ms,
                   config->autopilot_off_ms);
    tick_gear(budgets, facts, elapsed_ms);
}

bool agv_motion_checks_doubts_wheels(const agv_motion_checks_t *checks, const agv_vehicle_t *vehicle) {
    const bool agree = speeds_are_known(vehicle) && !speeds_differ(vehicle);
    return checks->budgets[AGV_BUDGET_SPEED].present && !agree;
}

static bool is_any_present(const agv_motion_checks_t *checks) {
    bool present = false;
    for (uint32_t i = 0u; i < (uint32_t)AGV_BUDGET_COUNT; i++) {
        present = present || checks->budgets[i].present;
    }
    return present;
}

void agv_motion_checks_evaluate(agv_motion_checks_t *checks, agv_fault_monitor_t *faults, bool judged) {
    const bool present = is_any_present(checks);
    if (!present && !checks->reported) {
        return;
    }
    checks->reported = present;
    for (uint32_t i = 0u; i < (uint32_t)AGV_BUDGET_COUNT; i++) {
        const bool counts = judged || (i == (uint32_t)AGV_BUDGET_SPEED);
        agv_fault_monitor_set(faults, faults_of[i], counts && checks->budgets[i].present);
    }
}

void agv_motion_checks_engage(agv_motion_checks_t *checks) {
    (void)memset(checks->budgets, 0, sizeof(agv_budget_t) * (size_t)AGV_BUDGET_SPEED);
    checks->steering = (agv_progress_t){0};
    checks->throttle = (agv_progress_t){0};
}

#include "hunt_program.h"

#include <string.h>

#include "agv/faults.h"
#include "chance.h"
#include "options.h"

enum { BEGIN_FIRST_MS = 600, BEGIN_MIN_MS = 1600, BEGIN_MAX_MS = 7000, RESET_MIN_MS = 500, RESET_MAX_MS = 4000 };
enum { LASTS_MIN_MS = 20, LASTS_MAX_MS = 4000, DURATION_MIN_MS = 8000, DURATION_MAX_MS = 14000 };
enum { THROTTLE_MIN_PCT = 10, THROTTLE_MAX_PCT = 100, STEER_MAX_DEG = 90, TICK_SPAN_US = 999, TRIES = 20 };
enum { SHORT_PATTERN = 4, RATE_DDEG_S = 3000, SLOW_DDEG_S = 300 };

static bool toss(uint64_t *state, uint32_t in) {
    return chance_draw(state, 1u, in) == 1u;
}

static uint32_t count_words(const char *words) {
    uint32_t count = 1u;
    for (; *words != '\0'; words++) {
        count += (*words == '|') ? 1u : 0u;
    }
    return count;
}

/** A number of frames: most patterns that matter are short. */
static uint32_t draw_pattern(const hunt_attack_t *attack, unsigned i, uint64_t *state) {
    if ((i == HUNT_PATTERN_BAD) && toss(state, 3u)) {
        return 0u;
    }
    return toss(state, 2u) ? chance_draw(state, 1u, SHORT_PATTERN) : chance_draw(state, 1u, attack->highest[i]);
}

static uint32_t draw_parameter(const hunt_attack_t *attack, unsigned i, uint64_t *state) {
    if ((i == 0u) && ((attack->flags & HUNT_PATTERN) != 0u) && ((attack->flags & HUNT_MESSAGE) == 0u) &&
        toss(state, 3u)) {
        return 0u; /* the first word is the worst */
    }
    if (attack->words[i] != NULL) {
        return chance_draw(state, 0u, count_words(attack->words[i]) - 1u);
    }
    if (((attack->flags & HUNT_PATTERN) != 0u) && (i >= HUNT_PATTERN_BAD)) {
        return draw_pattern(attack, i, state);
    }
    if (toss(state, 4u)) {
        return toss(state, 2u) ? attack->lowest[i] : attack->highest[i];
    }
    return chance_draw(state, attack->lowest[i], attack->highest[i]);
}

/** A reset comes some time after the other attacks have begun. */
static uint32_t draw_reset_ms(const hunt_program_t *program, uint64_t *state) {
    uint32_t latest_ms = BEGIN_MIN_MS;

    for (uint32_t i = 0u; i < program->action_count; i++) {
        const uint32_t begin_ms = program->actions[i].begin_ms;
        latest_ms = (begin_ms > latest_ms) ? begin_ms : latest_ms;
    }
    return latest_ms + chance_draw(state, RESET_MIN_MS, RESET_MAX_MS);
}

static void draw_times(const hunt_program_t *program, hunt_action_t *action, uint64_t *state) {
    const bool is_reset = action->attack == hunt_attack_of_reset();

    action->begin_ms = is_reset ? draw_reset_ms(program, state)
                                : chance_draw(state, toss(state, 5u) ? BEGIN_FIRST_MS : BEGIN_MIN_MS, BEGIN_MAX_MS);
    action->end_ms =
        toss(state, 2u) ? program->duration_ms : action->begin_ms + chance_draw(state, LASTS_MIN_MS, LASTS_MAX_MS);
    action->end_ms = (action->end_ms < program->duration_ms) ? action->end_ms : program->duration_ms;
}

/** The message of an action, for others to be about the same one; AGV_MSG_NONE. */
static agv_message_t message_of(const hunt_action_t *action) {
    const hunt_attack_t *attack = &HUNT_ATTACKS[action->attack];
    return ((attack->flags & HUNT_MESSAGE) != 0u) ? (agv_message_t)action->parameters[0] : attack->message;
}

static void draw_action(const hunt_program_t *program, hunt_action_t *action, uint64_t *state) {
    const hunt_attack_t *attack = NULL;

    do {
        action->attack = (uint16_t)chance_draw(state, 0u, (uint32_t)HUNT_ATTACK_COUNT - 1u);
        attack = &HUNT_ATTACKS[action->attack];
    } while (((attack->flags & HUNT_GATEWAY) != 0u) && !program->gateway);
    for (unsigned i = 0u; i < HUNT_PARAMETERS; i++) {
        action->parameters[i] = draw_parameter(attack, i, state);
    }
    if (((attack->flags & HUNT_MESSAGE) != 0u) && (program->action_count > 0u) && toss(state, 2u)) {
        const agv_message_t other = message_of(&program->actions[chance_draw(state, 0u, program->action_count - 1u)]);
        if ((uint32_t)other < count_words(attack->words[0])) {
            action->parameters[0] = (uint32_t)other;
        }
    }
    draw_times(program, action, state);
}

static void add_action(hunt_program_t *program, uint64_t *state) {
    if (program->action_count < (uint32_t)HUNT_ACTIONS_MAX) {
        draw_action(program, &program->actions[program->action_count], state);
        program->action_count++;
    }
}

static void add_reset(hunt_program_t *program, uint64_t *state) {
    hunt_action_t action = {.attack = (uint16_t)hunt_attack_of_reset()};

    if (program->action_count < (uint32_t)HUNT_ACTIONS_MAX) {
        for (unsigned i = 0u; i < HUNT_PARAMETERS; i++) {
            action.parameters[i] = draw_parameter(&HUNT_ATTACKS[action.attack], i, state);
        }
        draw_times(program, &action, state);
        program->actions[program->action_count] = action;
        program->action_count++;
    }
}

/** Settings that say what stands where, or that switch the protection off, are not an attacker's. */
static bool is_fixed(const char *name) {
    return (options_word("topology|id_set|shadow|status_frame_id", name) >= 0) || (strncmp(name, "id_", 3u) == 0);
}

/** How long something is remembered or waited for decides most: such a setting, or any. */
static uint16_t draw_setting(uint64_t *state) {
    static const char *const names[] = {"event_hold_ms",        "reset_hold_ms",   "engaged_grace_ms",
                                        "confirm_timeout_ms",   "eps_mode_frames", "reengage_ms",
                                        "standstill_speed_mm_s"};
    const uint32_t count = sizeof names / sizeof names[0];
    const uint16_t any = (uint16_t)chance_draw(state, 0u, AGV_SETTING_COUNT - 1u);
    const char *name = names[chance_draw(state, 0u, count - 1u)];

    for (uint16_t i = 0u; i < AGV_SETTING_COUNT; i++) {
        if (strcmp(agv_setting_info(i)->name, name) == 0) {
            return i;
        }
    }
    return any;
}

static void add_setting(hunt_program_t *program, uint64_t *state) {
    const uint16_t setting =
        toss(state, 3u) ? draw_setting(state) : (uint16_t)chance_draw(state, 0u, AGV_SETTING_COUNT - 1u);
    const agv_setting_info_t *info = agv_setting_info(setting);

    if (is_fixed(info->name) || (program->setting_count == (uint32_t)HUNT_SETTINGS_MAX)) {
        return;
    }
    for (uint32_t i = 0u; i < program->setting_count; i++) {
        if (program->settings[i].setting == setting) {
            return;
        }
    }
    const uint32_t edge = toss(state, 2u) ? info->lowest : info->highest;
    const uint16_t value = (uint16_t)(toss(state, 2u) ? edge : chance_draw(state, info->lowest, info->highest));
    program->settings[program->setting_count] = (hunt_setting_t){setting, value};
    program->setting_count++;
}

/** A fault whose class an integrator may choose gets the other one; most of those that only warn are made trips. */
static void add_class(hunt_program_t *program, uint64_t *state) {
    const bool is_warning = !toss(state, 4u);
    uint32_t fault = 0u;

    if (program->class_count > 0u) {
        return;
    }
    for (unsigned i = 0u; i < (unsigned)TRIES; i++) {
        fault = chance_draw(state, 0u, AGV_FAULT_COUNT - 1u);
        const bool warns = agv_fault_default_class(fault) == AGV_CLASS_WARN;
        if (((agv_fault_flags(fault) & AGV_FAULT_FLAG_FIXED) == 0u) && (warns == is_warning)) {
            program->classes[0] = (uint8_t)fault;
            program->class_count = 1u;
            return;
        }
    }
}

void hunt_program_config(const hunt_program_t *program, agv_config_t *config) {
    agv_config_defaults(config);
    config->topology = program->gateway ? AGV_TOPOLOGY_GATEWAY : AGV_TOPOLOGY_SHARED;
    for (uint32_t i = 0u; i < program->setting_count; i++) {
        (void)agv_config_set(config, program->settings[i].setting, program->settings[i].value);
    }
    for (uint32_t i = 0u; i < program->class_count; i++) {
        const uint32_t fault = program->classes[i];
        agv_fault_set_put(&config->trips, fault, !agv_fault_is_in(&config->trips, fault));
    }
}

static bool is_legal(const hunt_program_t *program) {
    agv_config_t config;

    hunt_program_config(program, &config);
    return agv_config_check(&config).problem == AGV_CONFIG_OK;
}

/** What a supervisor would refuse is taken back. */
static void make_legal(hunt_program_t *program) {
    while ((program->setting_count > 0u) && !is_legal(program)) {
        program->setting_count--;
    }
    if (!is_legal(program)) {
        program->class_count = 0u;
    }
}

static void draw_vehicle(hunt_program_t *program, uint64_t *state) {
    program->gateway = toss(state, 2u);
    program->park_guard = !toss(state, 3u);
    program->rolls = toss(state, 6u);
    program->obeys_short = toss(state, 4u);
    program->tick_phase_us = toss(state, 8u) ? (uint16_t)chance_draw(state, 1u, TICK_SPAN_US) : 0u;
    program->steering_rate_ddeg_s = toss(state, 6u) ? SLOW_DDEG_S : RATE_DDEG_S;
    program->throttle_pct = chance_draw(state, THROTTLE_MIN_PCT, THROTTLE_MAX_PCT);
    program->steer_deg = (int32_t)chance_draw(state, 0u, 2u * STEER_MAX_DEG) - STEER_MAX_DEG;
    program->duration_ms = chance_draw(state, DURATION_MIN_MS, DURATION_MAX_MS);
}

void hunt_program_make(hunt_program_t *program, uint64_t *state) {
    memset(program, 0, sizeof *program);
    draw_vehicle(program, state);
    for (uint32_t left = toss(state, 2u) ? chance_draw(state, 1u, 3u) : 0u; left > 0u; left--) {
        add_setting(program, state);
    }
    if (toss(state, 4u)) {
        add_class(program, state);
    }
    for (uint32_t left = chance_draw(state, 1u, 4u); left > 0u; left--) {
        add_action(program, state);
    }
    if (toss(state, 3u)) {
        add_reset(program, state);
    }
    make_legal(program);
}

static void remove_action(hunt_program_t *program, uint64_t *state) {
    if (program->action_count > 1u) {
        const uint32_t i = chance_draw(state, 0u, program->action_count - 1u);
        program->action_count--;
        program->actions[i] = program->actions[program->action_count];
    }
}

/** Another parameter, or other times. */
static void change_action(hunt_program_t *program, uint64_t *state) {
    hunt_action_t *action = &program->actions[chance_draw(state, 0u, program->action_count - 1u)];
    const uint32_t i = chance_draw(state, 0u, HUNT_PARAMETERS);

    if (i < HUNT_PARAMETERS) {
        action->parameters[i] = draw_parameter(&HUNT_ATTACKS[action->attack], i, state);
    } else {
        draw_times(program, action, state);
    }
}

static void change_once(hunt_program_t *program, const hunt_program_t *other, uint64_t *state) {
    const hunt_action_t *given = &other->actions[chance_draw(state, 0u, other->action_count - 1u)];
    const bool fits = ((HUNT_ATTACKS[given->attack].flags & HUNT_GATEWAY) == 0u) || program->gateway;

    switch (chance_draw(state, 0u, 8u)) {
    case 0u:
    case 1u:
        add_action(program, state);
        break;
    case 2u:
        remove_action(program, state);
        break;
    case 3u:
        if (fits && (program->action_count < (uint32_t)HUNT_ACTIONS_MAX)) {
            program->actions[program->action_count] = *given;
            program->action_count++;
        }
        break;
    case 4u:
        add_setting(program, state);
        break;
    case 5u:
        if (toss(state, 2u)) {
            add_class(program, state);
        } else {
            add_reset(program, state);
        }
        break;
    default:
        change_action(program, state);
        break;
    }
}

void hunt_program_mutate(hunt_program_t *program, const hunt_program_t *other, uint64_t *state) {
    for (uint32_t left = chance_draw(state, 1u, 3u); left > 0u; left--) {
        change_once(program, other, state);
    }
    for (uint32_t i = 0u; i < program->action_count; i++) {
        hunt_action_t *action = &program->actions[i];
        action->end_ms = (action->end_ms < program->duration_ms) ? action->end_ms : program->duration_ms;
    }
    make_legal(program);
}

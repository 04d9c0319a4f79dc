/* The parts of a program, drawn from random numbers. */
#include "hunt/hunt_draw.h"

#include <string.h>

#include "agv/faults.h"
#include "common/prng.h"
#include "text/words.h"

enum { BEGIN_FIRST_MS = 530, BEGIN_MIN_MS = 900, BEGIN_MAX_MS = 4000, BEGIN_SOON_MS = 2200 };
enum { RESET_MIN_MS = 500, RESET_MAX_MS = 3000 };
enum {
    LASTS_MIN_MS = 20,
    LASTS_MAX_MS = 3000,
    AFTER_ENGAGED_MS = 4000,
    PATTERN_MS = 9000,
    SHORT_PATTERN = 4,
    TRIES = 20
};

/** The attack of this name, which is one. */
static size_t attack_named(const char *name) {
    for (size_t i = 0; i < HUNT_ATTACK_COUNT; i++) {
        if (strcmp(HUNT_ATTACKS[i].name, name) == 0) {
            return i;
        }
    }
    return 0;
}

/** The attack that lets the operator reset, engage and drive off again. */
static size_t attack_of_reset(void) {
    return attack_named("reset_and_engage");
}

/** The attack that raises this fault, where only one does. @return HUNT_ATTACK_COUNT: none, or many do */
static size_t attack_of_fault(agv_fault_t fault) {
    switch (fault) {
    case AGV_FAULT_AI_BUS_OFF:
        return attack_named("ai_side_stalled");
    case AGV_FAULT_COMMAND_TOO_FAST:
        return attack_named("ai_fast");
    default:
        return HUNT_ATTACK_COUNT;
    }
}

static uint32_t count_words(const char *words) {
    uint32_t count = 1;
    for (; *words != '\0'; words++) {
        count += (*words == '|') ? 1 : 0;
    }
    return count;
}

/** A number of frames: most patterns that matter are short. */
static uint32_t draw_pattern(const hunt_attack_t *attack, unsigned i, uint64_t *state) {
    if ((i == HUNT_PATTERN_BAD) && prng_toss(state, 3)) {
        return 0;
    }
    return prng_toss(state, 2) ? prng_draw(state, 1, SHORT_PATTERN)
                               : prng_draw(state, 1, attack->parameters[i].highest);
}

uint32_t hunt_draw_parameter(const hunt_attack_t *attack, unsigned i, uint64_t *state) {
    const hunt_parameter_t *parameter = &attack->parameters[i];
    if ((i == 0) && ((attack->flags & HUNT_PATTERN) != 0) && ((attack->flags & HUNT_MESSAGE) == 0) &&
        prng_toss(state, 3)) {
        return 0; /* the first word is the worst */
    }
    if (parameter->words != NULL) {
        return prng_draw(state, 0, count_words(parameter->words) - 1);
    }
    if (((attack->flags & HUNT_PATTERN) != 0) && (i >= HUNT_PATTERN_BAD)) {
        return draw_pattern(attack, i, state);
    }
    if (prng_toss(state, 4)) {
        return prng_toss(state, 2) ? parameter->lowest : parameter->highest;
    }
    return prng_draw(state, parameter->lowest, parameter->highest);
}

/** A reset comes some time after the other attacks have begun. */
static uint32_t draw_reset_ms(const hunt_program_t *program, uint64_t *state) {
    uint32_t latest_ms = BEGIN_MIN_MS;

    for (uint32_t i = 0; i < program->action_count; i++) {
        const uint32_t begin_ms = program->actions[i].begin_ms;
        latest_ms = (begin_ms > latest_ms) ? begin_ms : latest_ms;
    }
    return latest_ms + prng_draw(state, RESET_MIN_MS, RESET_MAX_MS);
}

void hunt_draw_times(const hunt_program_t *program, hunt_action_t *action, uint64_t *state) {
    const bool is_reset = action->attack == attack_of_reset();

    const uint32_t first_ms = prng_toss(state, 5) ? BEGIN_FIRST_MS : BEGIN_MIN_MS;
    const uint32_t last_ms = (program->action_count == 0) ? BEGIN_SOON_MS : BEGIN_MAX_MS;

    action->begin_ms = is_reset ? draw_reset_ms(program, state) : prng_draw(state, first_ms, last_ms);
    action->end_ms =
        prng_toss(state, 2) ? program->duration_ms : action->begin_ms + prng_draw(state, LASTS_MIN_MS, LASTS_MAX_MS);
    action->end_ms = (action->end_ms < program->duration_ms) ? action->end_ms : program->duration_ms;
}

/** Parameters and times of an action whose attack stands. */
static void draw_action(const hunt_program_t *program, hunt_action_t *action, uint64_t *state) {
    const hunt_attack_t *attack = &HUNT_ATTACKS[action->attack];

    for (unsigned i = 0; i < HUNT_PARAMETERS; i++) {
        action->parameters[i] = hunt_draw_parameter(attack, i, state);
    }
    if (((attack->flags & HUNT_MESSAGE) != 0) && (program->action_count > 0) && prng_toss(state, 2)) {
        const agv_message_t other =
            hunt_action_message(&program->actions[prng_draw(state, 0, program->action_count - 1)]);
        if ((uint32_t)other < count_words(attack->parameters[0].words)) {
            action->parameters[0] = (uint32_t)other;
        }
    }
    hunt_draw_times(program, action, state);
}

/** The run becomes longer; what lasts up to its end still does. */
static void extend_run(hunt_program_t *program, uint32_t duration_ms) {
    const uint32_t before_ms = program->duration_ms;

    if (duration_ms > before_ms) {
        program->duration_ms = duration_ms;
        for (uint32_t i = 0; i < program->action_count; i++) {
            hunt_action_t *action = &program->actions[i];
            action->end_ms = (action->end_ms == before_ms) ? duration_ms : action->end_ms;
        }
    }
}

/** A pattern may need long: what is right now and then takes back what is wrong. */
static bool needs_long(const hunt_action_t *action) {
    return ((HUNT_ATTACKS[action->attack].flags & HUNT_PATTERN) != 0) && (action->parameters[HUNT_PATTERN_BAD] != 0);
}

static void add_attack(hunt_program_t *program, size_t attack, uint64_t *state) {
    if (program->action_count < HUNT_ACTIONS_MAX) {
        hunt_action_t *action = &program->actions[program->action_count];
        action->attack = (uint16_t)attack;
        draw_action(program, action, state);
        program->action_count++;
        if (needs_long(action) && prng_toss(state, 2)) {
            extend_run(program, action->begin_ms + PATTERN_MS);
            action->end_ms = program->duration_ms;
        }
    }
}

void hunt_add_action(hunt_program_t *program, uint64_t *state) {
    size_t attack = 0;

    do {
        attack = prng_draw(state, 0, (uint32_t)HUNT_ATTACK_COUNT - 1);
    } while (((HUNT_ATTACKS[attack].flags & HUNT_GATEWAY) != 0) && !program->gateway);
    add_attack(program, attack, state);
}

void hunt_add_reset(hunt_program_t *program, uint64_t *state) {
    const uint32_t count = program->action_count;

    add_attack(program, attack_of_reset(), state);
    if (program->action_count > count) {
        const hunt_action_t *reset = &program->actions[count];
        extend_run(program, reset->begin_ms + reset->parameters[HUNT_ENGAGE_AFTER] + AFTER_ENGAGED_MS);
    }
}

/** Topology, identifiers and shadow mode are not changed. */
static bool is_fixed(const char *name) {
    return (words_find("topology|id_set|shadow|status_frame_id", name) >= 0) || (strncmp(name, "id_", 3) == 0);
}

/** How long something is remembered or waited for decides most: such a setting, or any. */
static uint16_t draw_setting(uint64_t *state) {
    static const uint16_t settings[] = {AGV_SETTING_event_hold_ms,         AGV_SETTING_reset_hold_ms,
                                        AGV_SETTING_engaged_grace_ms,      AGV_SETTING_confirm_timeout_ms,
                                        AGV_SETTING_eps_mode_frames,       AGV_SETTING_reengage_ms,
                                        AGV_SETTING_standstill_speed_mm_s, AGV_SETTING_park};
    (void)prng_draw(state, 0, AGV_SETTING_COUNT - 1); /* so that a seed makes the same runs as ever */
    return settings[prng_draw(state, 0, (uint32_t)(sizeof settings / sizeof settings[0]) - 1)];
}

void hunt_add_setting(hunt_program_t *program, uint64_t *state) {
    const uint16_t setting =
        prng_toss(state, 3) ? draw_setting(state) : (uint16_t)prng_draw(state, 0, AGV_SETTING_COUNT - 1);
    const agv_setting_info_t *info = agv_setting_info(setting);

    if (is_fixed(info->name) || (program->setting_count == HUNT_SETTINGS_MAX)) {
        return;
    }
    for (uint32_t i = 0; i < program->setting_count; i++) {
        if (program->settings[i].setting == setting) {
            return;
        }
    }
    const uint32_t edge = prng_toss(state, 2) ? info->lowest : info->highest;
    const uint16_t value = (uint16_t)(prng_toss(state, 2) ? edge : prng_draw(state, info->lowest, info->highest));
    program->settings[program->setting_count] = (hunt_setting_t){setting, value};
    program->setting_count++;
}

/** A class matters with what raises its fault. */
static void add_attack_of_class(hunt_program_t *program, uint64_t *state) {
    const size_t attack = attack_of_fault((agv_fault_t)program->classes[0]);

    if ((attack != HUNT_ATTACK_COUNT) && (program->gateway || ((HUNT_ATTACKS[attack].flags & HUNT_GATEWAY) == 0))) {
        add_attack(program, attack, state);
    }
}

void hunt_add_class(hunt_program_t *program, uint64_t *state) {
    const bool is_warning = !prng_toss(state, 4);
    uint32_t fault = 0;

    if (program->class_count > 0) {
        return;
    }
    for (unsigned i = 0; i < TRIES; i++) {
        fault = prng_draw(state, 0, AGV_FAULT_COUNT - 1);
        const bool warns = agv_fault_default_class(fault) == AGV_CLASS_WARN;
        if (((agv_fault_flags(fault) & AGV_FAULT_FLAG_FIXED) == 0) && (warns == is_warning)) {
            program->classes[0] = (uint8_t)fault;
            program->class_count = 1;
            add_attack_of_class(program, state);
            return;
        }
    }
}

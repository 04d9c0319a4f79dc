#include "hunt/hunt_program.h"

#include <string.h>

#include "agv/faults.h"
#include "common/prng.h"
#include "hunt/hunt_draw.h"

enum { SHORT_MIN_MS = 5000, SHORT_MAX_MS = 8000, LONG_MAX_MS = 13000, RATE_DDEG_S = 3000, SLOW_DDEG_S = 300 };
enum { THROTTLE_MIN_PCT = 10, THROTTLE_MAX_PCT = 100, STEER_MAX_DEG = 90, TICK_SPAN_US = 999 };

void hunt_program_config(const hunt_program_t *program, agv_config_t *config) {
    agv_config_defaults(config);
    config->topology = program->gateway ? AGV_TOPOLOGY_GATEWAY : AGV_TOPOLOGY_SHARED;
    for (uint32_t i = 0; i < program->setting_count; i++) {
        (void)agv_config_set(config, program->settings[i].setting, program->settings[i].value);
    }
    for (uint32_t i = 0; i < program->class_count; i++) {
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
static void drop_refused_settings(hunt_program_t *program) {
    while ((program->setting_count > 0) && !is_legal(program)) {
        program->setting_count--;
    }
    if (!is_legal(program)) {
        program->class_count = 0;
    }
}

static void draw_vehicle(hunt_program_t *program, uint64_t *state) {
    program->gateway = prng_toss(state, 2);
    program->park_guard = !prng_toss(state, 3);
    program->rolls = prng_toss(state, 6);
    program->obeys_short = prng_toss(state, 4);
    program->tick_phase_us = prng_toss(state, 8) ? (uint16_t)prng_draw(state, 1, TICK_SPAN_US) : 0;
    program->steering_rate_ddeg_s = prng_toss(state, 6) ? SLOW_DDEG_S : RATE_DDEG_S;
    program->throttle_pct = prng_draw(state, THROTTLE_MIN_PCT, THROTTLE_MAX_PCT);
    program->steer_deg = (int32_t)prng_draw(state, 0, 2 * STEER_MAX_DEG) - STEER_MAX_DEG;
    program->duration_ms = prng_toss(state, 3) ? prng_draw(state, SHORT_MAX_MS, LONG_MAX_MS)
                                               : prng_draw(state, SHORT_MIN_MS, SHORT_MAX_MS);
}

void hunt_program_make(hunt_program_t *program, uint64_t *state) {
    memset(program, 0, sizeof *program);
    draw_vehicle(program, state);
    for (uint32_t left = prng_toss(state, 2) ? prng_draw(state, 1, 3) : 0; left > 0; left--) {
        hunt_add_setting(program, state);
    }
    if (prng_toss(state, 4)) {
        hunt_add_class(program, state);
    }
    for (uint32_t left = prng_draw(state, 1, 4); left > 0; left--) {
        hunt_add_action(program, state);
    }
    if (prng_toss(state, 3)) {
        hunt_add_reset(program, state);
    }
    drop_refused_settings(program);
}

static void remove_action(hunt_program_t *program, uint64_t *state) {
    if (program->action_count > 1) {
        const uint32_t i = prng_draw(state, 0, program->action_count - 1);
        program->action_count--;
        program->actions[i] = program->actions[program->action_count];
    }
}

agv_message_t hunt_action_message(const hunt_action_t *action) {
    const hunt_attack_t *attack = &HUNT_ATTACKS[action->attack];

    if ((attack->flags & HUNT_MESSAGE) != 0) {
        return (agv_message_t)action->parameters[0];
    }
    return ((attack->flags & HUNT_VALUE) != 0) ? attack->message : AGV_MSG_NONE;
}

/** Another parameter, or other times. */
static void change_action(hunt_program_t *program, uint64_t *state) {
    hunt_action_t *action = &program->actions[prng_draw(state, 0, program->action_count - 1)];
    const uint32_t i = prng_draw(state, 0, HUNT_PARAMETERS);

    if (i < HUNT_PARAMETERS) {
        action->parameters[i] = hunt_draw_parameter(&HUNT_ATTACKS[action->attack], i, state);
    } else {
        hunt_draw_times(program, action, state);
    }
}

/** One of another program, where it makes sense. */
static void take_action(hunt_program_t *program, const hunt_action_t *given) {
    const bool fits = ((HUNT_ATTACKS[given->attack].flags & HUNT_GATEWAY) == 0) || program->gateway;

    if (fits && (program->action_count < HUNT_ACTIONS_MAX)) {
        program->actions[program->action_count] = *given;
        program->action_count++;
    }
}

static void change_once(hunt_program_t *program, const hunt_program_t *other, uint64_t *state) {
    const hunt_action_t *given = &other->actions[prng_draw(state, 0, other->action_count - 1)];

    switch (prng_draw(state, 0, 8)) {
    case 0:
    case 1:
        hunt_add_action(program, state);
        break;
    case 2:
        remove_action(program, state);
        break;
    case 3:
        take_action(program, given);
        break;
    case 4:
        hunt_add_setting(program, state);
        break;
    case 5:
        if (prng_toss(state, 2)) {
            hunt_add_class(program, state);
        } else {
            hunt_add_reset(program, state);
        }
        break;
    default:
        change_action(program, state);
        break;
    }
}

void hunt_program_mutate(hunt_program_t *program, const hunt_program_t *other, uint64_t *state) {
    for (uint32_t left = prng_draw(state, 1, 3); left > 0; left--) {
        change_once(program, other, state);
    }
    for (uint32_t i = 0; i < program->action_count; i++) {
        hunt_action_t *action = &program->actions[i];
        action->end_ms = (action->end_ms < program->duration_ms) ? action->end_ms : program->duration_ms;
    }
    drop_refused_settings(program);
}

#include "hunt/hunt_found.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "common/report.h"
#include "text/units.h"

enum { PATH_SIZE = 4096, BITS = 64, AFTER_MS = 500 };
_Static_assert((unsigned)AGV_SETTING_COUNT <= 64 * (unsigned)HUNT_SETTING_WORDS, "a setting has no bit");
_Static_assert(HUNT_ATTACKS_MAX <= 64 * (unsigned)HUNT_ATTACK_WORDS, "an attack has no bit");
_Static_assert((unsigned)AGV_FAULT_COUNT <= 64 * (unsigned)HUNT_CLASS_WORDS, "a fault has no bit");

static hunt_signature_t signature_of(const hunt_program_t *program, const hazard_t *hazard) {
    hunt_signature_t signature;

    memset(&signature, 0, sizeof signature);
    signature.kind = (uint32_t)hazard->kind;
    signature.gateway = program->gateway ? 1 : 0;
    (void)snprintf(signature.cause, sizeof signature.cause, "%s", hazard->cause);
    for (uint32_t i = 0; i < program->action_count; i++) {
        const hunt_action_t *action = &program->actions[i];
        const uint64_t bit = UINT64_C(1) << (action->attack % BITS);
        const uint32_t word = action->attack / BITS;
        const bool is_pattern =
            ((HUNT_ATTACKS[action->attack].flags & HUNT_PATTERN) != 0) && (action->parameters[HUNT_PATTERN_BAD] != 0);
        signature.attacks[word] |= bit;
        signature.patterns[word] |= is_pattern ? bit : 0;
    }
    for (uint32_t i = 0; i < program->setting_count; i++) {
        const uint16_t setting = program->settings[i].setting;
        signature.settings[setting / BITS] |= UINT64_C(1) << (setting % BITS);
    }
    for (uint32_t i = 0; i < program->class_count; i++) {
        signature.classes[program->classes[i] / BITS] |= UINT64_C(1) << (program->classes[i] % BITS);
    }
    return signature;
}

static bool are_part_of(const uint64_t *known, const uint64_t *bits, unsigned words) {
    for (unsigned i = 0; i < words; i++) {
        if ((known[i] & ~bits[i]) != 0) {
            return false;
        }
    }
    return true;
}

/** All of @p known is in @p signature too. */
static bool is_part_of(const hunt_signature_t *known, const hunt_signature_t *signature) {
    return (known->kind == signature->kind) && (known->gateway == signature->gateway) &&
           (strcmp(known->cause, signature->cause) == 0) &&
           are_part_of(known->attacks, signature->attacks, HUNT_ATTACK_WORDS) &&
           are_part_of(known->patterns, signature->patterns, HUNT_ATTACK_WORDS) &&
           are_part_of(known->classes, signature->classes, HUNT_CLASS_WORDS) &&
           are_part_of(known->settings, signature->settings, HUNT_SETTING_WORDS);
}

static hunt_signature_t *find(hunt_found_t *found, const hunt_signature_t *signature) {
    for (uint32_t i = 0; i < found->count; i++) {
        if (is_part_of(&found->items[i], signature)) {
            return &found->items[i];
        }
    }
    return NULL;
}

/** Keep a change of the program when the hazard is still there. */
static bool keep_if_same(hunt_play_t *play, hunt_program_t *program, const hunt_program_t *changed, hazard_kind_t kind,
                         const char *cause) {
    const bool same = hunt_play(play, changed) && (play->hazard.kind == kind) && (play->hazard.cause == cause);
    if (same) {
        *program = *changed;
    }
    return same;
}

/** Drop actions, settings and classes one by one, and make the vehicle the common one. */
static void minimise(hunt_play_t *play, hunt_program_t *program, hazard_kind_t kind, const char *cause) {
    for (uint32_t i = program->action_count; (i > 0) && (program->action_count > 1); i--) {
        hunt_program_t changed = *program;
        memmove(&changed.actions[i - 1], &changed.actions[i], (changed.action_count - i) * sizeof changed.actions[0]);
        changed.action_count--;
        (void)keep_if_same(play, program, &changed, kind, cause);
    }
    for (uint32_t i = program->setting_count; i > 0; i--) {
        hunt_program_t changed = *program;
        changed.setting_count--;
        changed.settings[i - 1] = changed.settings[changed.setting_count];
        (void)keep_if_same(play, program, &changed, kind, cause);
    }
    if (program->class_count > 0) {
        hunt_program_t changed = *program;
        changed.class_count = 0;
        (void)keep_if_same(play, program, &changed, kind, cause);
    }
    hunt_program_t plain = *program;
    plain.tick_phase_us = 0;
    plain.obeys_short = false;
    plain.park_guard = true;
    (void)keep_if_same(play, program, &plain, kind, cause);
    plain = *program;
    plain.rolls = false;
    (void)keep_if_same(play, program, &plain, kind, cause);
}

/** The scenario: what was done, and that no hazard is expected. It ends soon after the hazard. */
static void write_scenario(hunt_play_t *play, const hunt_program_t *program, const hunt_place_t *place) {
    const hazard_t *hazard = &play->hazard;
    const hazard_info_t *info = hazard_info(hazard->kind);
    text_t *text = &play->text;
    char name[SCENARIO_TEXT_MAX];

    text_clear(text);
    (void)snprintf(name, sizeof name, "hunt of seed %" PRIu64 ", run %" PRIu64, place->seed, place->run);
    text_add(text, "# %s, at %" PRIu64 " ms: %s.\n# %s.\n# Safe reaction: %s.\n", info->name, hazard->at_ms,
             hazard->cause, info->meaning, info->safe);
    hunt_program_write(program, name, text);
    text_add(text, "expect:\n  states: any\n  hazards: never\n");
}

/** The time after the hazard is not needed. */
static void cut_end(hunt_play_t *play, hunt_program_t *program, hazard_kind_t kind, const char *cause) {
    hunt_program_t changed = *program;

    changed.duration_ms = (uint32_t)play->hazard.at_ms + AFTER_MS;
    for (uint32_t i = 0; i < changed.action_count; i++) {
        hunt_action_t *action = &changed.actions[i];
        if (action->begin_ms > changed.duration_ms) {
            return;
        }
        action->end_ms = (action->end_ms > changed.duration_ms) ? changed.duration_ms : action->end_ms;
    }
    if (changed.duration_ms < program->duration_ms) {
        (void)keep_if_same(play, program, &changed, kind, cause);
    }
}

static bool write_file(hunt_play_t *play, const hunt_program_t *program, const hunt_place_t *place) {
    char path[PATH_SIZE];
    text_t line = {.used = 0};
    const int length =
        snprintf(path, sizeof path, "%s/hunt-%" PRIu64 "-%" PRIu64 ".yaml", place->folder, place->seed, place->run);

    if ((length < 0) || (length >= PATH_SIZE)) {
        return report("--found: the name of the folder is too long");
    }
    hunt_program_describe(program, &line);
    write_scenario(play, program, place);
    if (!output_put(place->file, path, play->text.bytes, play->text.used)) {
        return false;
    }
    (void)printf("HAZARD  %s run %" PRIu64 " after %" PRIu64 " s: %s; %s; %s\n", hazard_info(play->hazard.kind)->name,
                 place->run, place->spent_ms / MS_PER_S, play->hazard.cause, line.bytes, path);
    (void)fflush(stdout);
    return true;
}

/** One that is known already: only counted. */
static bool is_known(hunt_found_t *found, const hunt_signature_t *signature) {
    hunt_signature_t *known = find(found, signature);

    if ((known == NULL) && (found->count == HUNT_FOUND_MAX)) {
        known = &found->items[0];
    }
    if (known != NULL) {
        known->more++;
    }
    return known != NULL;
}

/** Make it as small as it can be, and play that. */
static bool make_small(hunt_play_t *play, hunt_program_t *program) {
    const hazard_kind_t kind = play->hazard.kind;
    const char *cause = play->hazard.cause;

    minimise(play, program, kind, cause);
    if (!hunt_play(play, program)) {
        return false;
    }
    cut_end(play, program, kind, cause);
    return hunt_play(play, program);
}

bool hunt_found_take(hunt_found_t *found, hunt_play_t *play, const hunt_program_t *program, const hunt_place_t *place) {
    hunt_signature_t signature = signature_of(program, &play->hazard);
    hunt_program_t small = *program;

    found->runs++;
    if (is_known(found, &signature)) {
        return true;
    }
    if (!make_small(play, &small)) {
        return false;
    }
    signature = signature_of(&small, &play->hazard);
    if (is_known(found, &signature)) {
        return true;
    }
    signature.run = place->run;
    found->items[found->count] = signature;
    found->count++;
    return write_file(play, &small, place);
}

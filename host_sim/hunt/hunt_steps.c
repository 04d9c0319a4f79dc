/* The attacks of a program as the steps of a scenario. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "hunt/hunt_program.h"
#include "text/words.h"
#include "vehicle/vehicle.h"

enum { STEPS_MAX = 64, STEP_SIZE = 200, DRIVE_MS = 520, ENGAGE_MS = 840, DECIMAL = 10, STRETCH = 20, ZERO_DEG = 90 };

/** A step that is being written. */
typedef struct {
    uint32_t at_ms;
    uint32_t order;
    char text[STEP_SIZE];
} line_t;

typedef struct {
    line_t lines[STEPS_MAX];
    uint32_t count;
    const hunt_program_t *program;
    const hunt_action_t *action;
    const hunt_attack_t *attack;
} steps_t;

__attribute__((format(printf, 2, 3))) static void append(line_t *line, const char *format, ...) {
    const size_t used = strlen(line->text);
    va_list arguments;
    va_start(arguments, format);
    (void)vsnprintf(&line->text[used], sizeof line->text - used, format, arguments);
    va_end(arguments);
}

static agv_message_t message_of(const steps_t *steps) {
    return hunt_action_message(steps->action);
}

static uint32_t cycle_of(const steps_t *steps) {
    return agv_message_cycle_ms(message_of(steps));
}

/** A parameter: its word, or its number. */
static void add_parameter(const steps_t *steps, line_t *line, unsigned i) {
    const char *words = steps->attack->parameters[i].words;

    if (words == NULL) {
        append(line, "%" PRIu32, steps->action->parameters[i]);
        return;
    }
    const char *word = NULL;
    const size_t length = words_at(words, steps->action->parameters[i], &word);
    append(line, "%.*s", (int)length, word);
}

static void add_again(const steps_t *steps, line_t *line, uint32_t every_ms) {
    if (every_ms > 0) {
        append(line, ", again_every_ms: %" PRIu32 ", again_until_ms: %" PRIu32, every_ms, steps->action->end_ms);
    }
}

static void add_pattern(const steps_t *steps, line_t *line) {
    const uint32_t bad = steps->action->parameters[HUNT_PATTERN_BAD];

    if (bad > 0) {
        append(line, ", frames: %" PRIu32, bad);
        add_again(steps, line, cycle_of(steps) * (bad + steps->action->parameters[HUNT_PATTERN_GOOD]));
    }
}

static void add_bytes(const steps_t *steps, line_t *line) {
    const uint32_t length = steps->action->parameters[HUNT_PATTERN_GOOD];

    add_parameter(steps, line, HUNT_PATTERN_BAD);
    for (uint32_t i = 1; (i < length) && (i < AGV_DLC); i++) {
        append(line, " 00");
    }
}

/** Status frames are not forged: no receiver could distinguish them from true ones. */
static uint32_t free_id(uint32_t id) {
    while ((agv_message_from_id(id, AGV_ID_SET_HEADING) >= AGV_COMMAND_COUNT) &&
           (agv_message_from_id(id, AGV_ID_SET_HEADING) != AGV_MSG_NONE)) {
        id = (id + 1) & AGV_ID_MAX;
    }
    return id;
}

/** What stands for a word or a number. @return false: it stands for something else */
static bool add_word(const steps_t *steps, line_t *line, char letter) {
    const uint32_t *parameters = steps->action->parameters;

    switch (letter) {
    case 'n':
        append(line, "%s", vehicle_node_name(vehicle_sender_of(message_of(steps))));
        return true;
    case 'v':
        append(line, "%s", vehicle_node_name(vehicle_receiver_of(message_of(steps))));
        return true;
    case 't':
        append(line, "%" PRIu32, cycle_of(steps));
        return true;
    case 'e':
        append(line, "%" PRIu32, cycle_of(steps) + ((cycle_of(steps) * parameters[1]) / STRETCH));
        return true;
    case 's':
        append(line, "%s", steps->program->gateway ? "ai" : "vehicle");
        return true;
    case 'z':
        append(line, "%" PRId32, (int32_t)parameters[HUNT_PATTERN_BAD] - ZERO_DEG);
        return true;
    case 'i':
        append(line, "%03" PRIX32 "h", free_id(parameters[0]));
        return true;
    default:
        return false;
    }
}

/** What stands for something else. */
static void add_placeholder(const steps_t *steps, line_t *line, char letter) {
    const uint32_t *parameters = steps->action->parameters;

    if (add_word(steps, line, letter)) {
        return;
    }
    switch (letter) {
    case 'f':
        add_pattern(steps, line);
        break;
    case 'r':
        add_again(steps, line, parameters[1]);
        break;
    case 'w':
        add_again(steps, line, 2 * parameters[HUNT_PATTERN_BAD]);
        break;
    case 'g':
        add_again(steps, line, parameters[HUNT_PATTERN_GOOD]);
        break;
    case 'y':
        add_bytes(steps, line);
        break;
    default:
        add_parameter(steps, line, (unsigned)(letter - 'a'));
        break;
    }
}

/** Time from the begin to 1 ms after the next slot of the message. */
static uint32_t to_slot_ms(const steps_t *steps) {
    const uint32_t cycle_ms = cycle_of(steps);
    vehicle_config_t vehicle;

    vehicle_defaults(&vehicle);
    const uint32_t phase_ms = vehicle.phase_ms[message_of(steps)] + 1u;
    return (phase_ms + (cycle_ms * DRIVE_MS) - steps->action->begin_ms % cycle_ms) % cycle_ms;
}

/** "+12 ", "+$b ": how long after the begin. @return what follows */
static const char *read_offset(const steps_t *steps, const char *at, uint32_t *offset_ms) {
    *offset_ms = 0;
    if (*at != '+') {
        return at;
    }
    at++;
    if (*at == '$') {
        *offset_ms = (at[1] == 'k') ? to_slot_ms(steps) : steps->action->parameters[at[1] - 'a'];
        return &at[3];
    }
    for (; *at != ' '; at++) {
        *offset_ms = (*offset_ms * DECIMAL) + (uint32_t)(*at - '0');
    }
    return &at[1];
}

static void add_steps(steps_t *steps, const char *words, uint32_t at_ms) {
    while (*words != '\0') {
        const char *end = words + strcspn(words, "|");
        uint32_t offset_ms = 0;
        const char *at = read_offset(steps, words, &offset_ms);
        line_t *line = &steps->lines[steps->count];
        if ((at_ms + offset_ms > steps->program->duration_ms) || (steps->count == STEPS_MAX)) {
            return;
        }
        *line = (line_t){.at_ms = at_ms + offset_ms, .order = steps->count};
        steps->count++;
        for (; at < end; at++) {
            if (*at == '$') {
                at++;
                add_placeholder(steps, line, *at);
            } else {
                append(line, "%c", *at);
            }
        }
        words = (*end == '|') ? end + 1 : end;
    }
}

static int compare(const void *a, const void *b) {
    const line_t *left = a;
    const line_t *right = b;
    const bool same = left->at_ms == right->at_ms;
    const uint32_t l = same ? left->order : left->at_ms;
    const uint32_t r = same ? right->order : right->at_ms;
    return (l > r) - (l < r);
}

void hunt_steps_write(const hunt_program_t *program, text_t *text) {
    steps_t steps = {.program = program, .count = 2};

    steps.lines[0] = (line_t){.at_ms = DRIVE_MS, .order = 0};
    append(&steps.lines[0], "ai: drive, gear: D, throttle_pct: %" PRIu32 ", steer_deg: %" PRId32, program->throttle_pct,
           program->steer_deg);
    steps.lines[1] = (line_t){.at_ms = ENGAGE_MS, .order = 1, .text = "operator: engage"};
    for (uint32_t i = 0; i < program->action_count; i++) {
        steps.action = &program->actions[i];
        steps.attack = &HUNT_ATTACKS[steps.action->attack];
        add_steps(&steps, steps.attack->begin, steps.action->begin_ms);
        if ((steps.attack->end != NULL) && (steps.action->end_ms < program->duration_ms)) {
            add_steps(&steps, steps.attack->end, steps.action->end_ms);
        }
    }
    qsort(steps.lines, steps.count, sizeof steps.lines[0], compare);
    text_add(text, "steps:\n");
    for (uint32_t i = 0; i < steps.count; i++) {
        text_add(text, "  - {at_ms: %" PRIu32 ", %s}\n", steps.lines[i].at_ms, steps.lines[i].text);
    }
}

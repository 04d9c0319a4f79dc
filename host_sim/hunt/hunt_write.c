/* A program of a hunt as the text of a scenario. */
#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "agv/names.h"
#include "config/config_file.h"
#include "hunt/hunt_program.h"
#include "vehicle/vehicle.h"

enum { STEPS_MAX = 64, STEP_SIZE = 200, DRIVE_MS = 520, ENGAGE_MS = 840, DECIMAL = 10, STRETCH = 20 };
enum { ZERO_DEG = 90, ROLLS_MM_S2 = 1 };

/** A step in the making. */
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
    return ((steps->attack->flags & HUNT_MESSAGE) != 0u) ? (agv_message_t)steps->action->parameters[0]
                                                         : steps->attack->message;
}

static uint32_t cycle_of(const steps_t *steps) {
    return agv_message_cycle_ms(message_of(steps));
}

/** A parameter: its word, or its number. */
static void add_parameter(const steps_t *steps, line_t *line, unsigned i) {
    const char *words = steps->attack->words[i];

    if (words == NULL) {
        append(line, "%" PRIu32, steps->action->parameters[i]);
        return;
    }
    for (uint32_t skip = steps->action->parameters[i]; skip > 0u; skip--) {
        words += strcspn(words, "|");
        words += (*words == '|') ? 1 : 0;
    }
    append(line, "%.*s", (int)strcspn(words, "|"), words);
}

static void add_again(const steps_t *steps, line_t *line, uint32_t every_ms) {
    if (every_ms > 0u) {
        append(line, ", again_every_ms: %" PRIu32 ", again_until_ms: %" PRIu32, every_ms, steps->action->end_ms);
    }
}

static void add_pattern(const steps_t *steps, line_t *line) {
    const uint32_t bad = steps->action->parameters[HUNT_PATTERN_BAD];

    if (bad > 0u) {
        append(line, ", frames: %" PRIu32, bad);
        add_again(steps, line, cycle_of(steps) * (bad + steps->action->parameters[HUNT_PATTERN_GOOD]));
    }
}

static void add_bytes(const steps_t *steps, line_t *line) {
    const uint32_t length = steps->action->parameters[HUNT_PATTERN_GOOD];

    add_parameter(steps, line, HUNT_PATTERN_BAD);
    for (uint32_t i = 1u; (i < length) && (i < AGV_DLC); i++) {
        append(line, " 00");
    }
}

/** Status frames of others are not forged: nobody could tell them from true ones. */
static uint32_t free_id(uint32_t id) {
    while ((agv_message_from_id(id, AGV_ID_SET_HEADING) >= AGV_COMMAND_COUNT) &&
           (agv_message_from_id(id, AGV_ID_SET_HEADING) != (uint32_t)AGV_MSG_NONE)) {
        id = (id + 1u) & AGV_ID_MAX;
    }
    return id;
}

static const char *node_name(vehicle_node_t node) {
    static const char *const names[VEHICLE_NODES] = {"vcu", "eps", "ai"};
    return names[node];
}

/** What stands for something else. */
static void add_placeholder(const steps_t *steps, line_t *line, char letter) {
    const uint32_t *parameters = steps->action->parameters;

    switch (letter) {
    case 'n':
        append(line, "%s", node_name(vehicle_sender_of(message_of(steps))));
        break;
    case 'v':
        append(line, "%s", node_name(vehicle_receiver_of(message_of(steps))));
        break;
    case 't':
        append(line, "%" PRIu32, cycle_of(steps));
        break;
    case 'e':
        append(line, "%" PRIu32, cycle_of(steps) + ((cycle_of(steps) * parameters[1]) / STRETCH));
        break;
    case 'f':
        add_pattern(steps, line);
        break;
    case 'r':
        add_again(steps, line, parameters[1]);
        break;
    case 'w':
        add_again(steps, line, 2u * parameters[HUNT_PATTERN_BAD]);
        break;
    case 'g':
        add_again(steps, line, parameters[HUNT_PATTERN_GOOD]);
        break;
    case 's':
        append(line, "%s", steps->program->gateway ? "ai" : "vehicle");
        break;
    case 'y':
        add_bytes(steps, line);
        break;
    case 'z':
        append(line, "%" PRId32, (int32_t)parameters[HUNT_PATTERN_BAD] - ZERO_DEG);
        break;
    case 'i':
        append(line, "%03" PRIX32 "h", free_id(parameters[0]));
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
    *offset_ms = 0u;
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
        uint32_t offset_ms = 0u;
        const char *at = read_offset(steps, words, &offset_ms);
        line_t *line = &steps->lines[steps->count];
        if ((at_ms + offset_ms > steps->program->duration_ms) || (steps->count == (uint32_t)STEPS_MAX)) {
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

static void write_steps(const hunt_program_t *program, campaign_text_t *text) {
    steps_t steps = {.program = program, .count = 2u};

    steps.lines[0] = (line_t){.at_ms = DRIVE_MS, .order = 0u};
    append(&steps.lines[0], "ai: drive, gear: D, throttle_pct: %" PRIu32 ", steer_deg: %" PRId32, program->throttle_pct,
           program->steer_deg);
    steps.lines[1] = (line_t){.at_ms = ENGAGE_MS, .order = 1u, .text = "operator: engage"};
    for (uint32_t i = 0u; i < program->action_count; i++) {
        steps.action = &program->actions[i];
        steps.attack = &HUNT_ATTACKS[steps.action->attack];
        add_steps(&steps, steps.attack->begin, steps.action->begin_ms);
        if (steps.action->end_ms < program->duration_ms) {
            add_steps(&steps, steps.attack->end, steps.action->end_ms);
        }
    }
    qsort(steps.lines, steps.count, sizeof steps.lines[0], compare);
    campaign_text_add(text, "steps:\n");
    for (uint32_t i = 0u; i < steps.count; i++) {
        campaign_text_add(text, "  - {at_ms: %" PRIu32 ", %s}\n", steps.lines[i].at_ms, steps.lines[i].text);
    }
}

/** A setting as its file has it: a word, or a number. */
static void write_setting(const hunt_setting_t *setting, campaign_text_t *text) {
    const agv_setting_info_t *info = agv_setting_info(setting->setting);
    const char *word = NULL;

    if (info->words == NULL) {
        campaign_text_add(text, "%s: %u", info->name, setting->value);
        return;
    }
    const size_t length = config_word(info->words, setting->value, &word);
    campaign_text_add(text, "%s: %.*s", info->name, (int)length, word);
}

static void write_class(const hunt_program_t *program, uint8_t fault, campaign_text_t *text) {
    char key[CONFIG_CLASS_KEY_SIZE];
    agv_config_t config;

    hunt_program_config(program, &config);
    config_class_key((agv_fault_t)fault, key);
    campaign_text_add(text, "%s: %s", key, agv_config_is_trip(&config, fault) ? "trip" : "warn");
}

static void write_config(const hunt_program_t *program, campaign_text_t *text) {
    if (program->setting_count + program->class_count > 0u) {
        campaign_text_add(text, "config:\n");
    }
    for (uint32_t i = 0u; i < program->setting_count; i++) {
        campaign_text_add(text, "  ");
        write_setting(&program->settings[i], text);
        campaign_text_add(text, "\n");
    }
    for (uint32_t i = 0u; i < program->class_count; i++) {
        campaign_text_add(text, "  ");
        write_class(program, program->classes[i], text);
        campaign_text_add(text, "\n");
    }
}

static void write_vehicle(const hunt_program_t *program, campaign_text_t *text) {
    campaign_text_add(text, "vehicle:\n  park_guard: %s\n  obeys_short_frames: %s\n  steering_rate_ddeg_s: %u\n",
                      program->park_guard ? "true" : "false", program->obeys_short ? "true" : "false",
                      program->steering_rate_ddeg_s);
    if (program->rolls) {
        campaign_text_add(text, "  coasting_mm_s2: %d\n  braking_mm_s2: %d\n  locked_mm_s2: %d\n", ROLLS_MM_S2,
                          ROLLS_MM_S2, ROLLS_MM_S2);
    }
}

void hunt_program_write(const hunt_program_t *program, const char *name, campaign_text_t *text) {
    campaign_text_add(text, "name: %s\nshows: [H1]\ntopology: %s\nid_set: heading\ntick_phase_us: %u\n", name,
                      program->gateway ? "gateway" : "shared", program->tick_phase_us);
    write_config(program, text);
    write_vehicle(program, text);
    campaign_text_add(text, "duration_ms: %" PRIu32 "\n", program->duration_ms);
    write_steps(program, text);
}

void hunt_program_describe(const hunt_program_t *program, campaign_text_t *text) {
    campaign_text_add(text, "%s", program->gateway ? "gateway" : "shared");
    for (uint32_t i = 0u; i < program->action_count; i++) {
        campaign_text_add(text, " %s", HUNT_ATTACKS[program->actions[i].attack].name);
    }
    for (uint32_t i = 0u; i < program->setting_count; i++) {
        campaign_text_add(text, ", ");
        write_setting(&program->settings[i], text);
    }
    for (uint32_t i = 0u; i < program->class_count; i++) {
        campaign_text_add(text, ", ");
        write_class(program, program->classes[i], text);
    }
}

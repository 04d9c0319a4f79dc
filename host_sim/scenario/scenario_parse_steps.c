/*
 * Scenario files: the steps. A step is a time, an actor with its action, and parameters:
 * `- {at_ms: 5000, ai: mute, message: gear_command}`. scenario_actions.c lists the actions of each actor and their
 * parameters.
 */
#include <string.h>

#include "io/yaml_file.h"
#include "scenario/scenario_actions.h"
#include "scenario/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define BITS_OF_BYTE 8u
#define BITS_OF_VALUE 32u

/** A step that is being read. */
typedef struct {
    const yaml_node_t *node;
    uint32_t at_ms;
    uint32_t again_every_ms;
    uint32_t again_until_ms;
    scenario_actor_t actor;
    const yaml_node_t *word; /* what the actor does */
    uint32_t given;          /* P_* */
    const yaml_node_t *value_of[SCENARIO_PARAMETERS];
} reading_t;

static const yaml_node_t *given(const reading_t *reading, uint32_t parameter) {
    for (unsigned i = 0u; i < SCENARIO_PARAMETERS; i++) {
        if ((1u << i) == parameter) {
            return reading->value_of[i];
        }
    }
    return NULL;
}

static bool take_message(const yaml_reader_t *reader, const reading_t *reading, const scenario_action_row_t *row,
                         scenario_step_t *step) {
    const yaml_node_t *message = given(reading, P_MESSAGE);

    if (message == NULL) {
        return true;
    }
    if (!scenario_parse_message(reader, message, &step->vehicle.message)) {
        return false;
    }
    if (((row->what == (int)VEHICLE_DO_IGNORE) && row->of_vehicle)) {
        return ((int)vehicle_receiver_of(step->vehicle.message) == (int)reading->actor) ||
               yaml_reader_fail(reader, message, "message: %.40s is not a command that this node obeys",
                                yaml_node_text(message));
    }
    if ((reading->actor <= ACTOR_AI) && ((int)vehicle_sender_of(step->vehicle.message) != (int)reading->actor)) {
        return yaml_reader_fail(reader, message, "message: another node sends %.40s", yaml_node_text(message));
    }
    return true;
}

/** The numbers of an action: how many frames, how often, how long. */
static bool take_numbers(const yaml_reader_t *reader, const reading_t *reading, scenario_step_t *step) {
    static const struct {
        uint32_t parameter;
        const char *name;
        uint32_t lowest;
        uint32_t highest;
        bool is_count;
    } rows[] = {
        {P_FRAMES, "frames", 1u, UINT16_MAX - 1u, true},
        {P_TIMES, "times", 0u, UINT16_MAX - 1u, true},
        {P_BUTTON, "button", 1u, 2u, true},
        {P_PCT_S, "pct_s", 1u, 10000u, true},
        {P_BY_MS, "by_ms", 0u, 60000u, false},
        {P_EVERY_MS, "every_ms", 1u, 60000u, false},
        {P_OFF_MS, "off_ms", 0u, 3600000u, false},
        {P_FOR_MS, "for_ms", 1u, 3600000u, false},
        {P_BIT, "bit", 0u, 1000000u, false},
    };

    for (size_t i = 0u; i < COUNT(rows); i++) {
        const yaml_node_t *node = given(reading, rows[i].parameter);
        uint32_t number = 0u;
        if (node == NULL) {
            continue;
        }
        const bool is_time = (rows[i].parameter & (P_BY_MS | P_EVERY_MS | P_OFF_MS | P_FOR_MS)) != 0u;
        if (!(is_time ? scenario_parse_ms : scenario_parse_u32)(reader, node, rows[i].name, rows[i].lowest,
                                                                rows[i].highest, &number)) {
            return false;
        }
        if (rows[i].is_count) {
            step->vehicle.count = (uint16_t)number;
        } else {
            step->vehicle.ms = number;
        }
    }
    return true;
}

/** `every_frames`: again and again. */
static bool take_every(const yaml_reader_t *reader, const reading_t *reading, vehicle_action_t *action) {
    const yaml_node_t *node = given(reading, P_EVERY_FRAMES);
    uint32_t every = 0u;

    if (node == NULL) {
        return true;
    }
    if (given(reading, P_FRAMES) == NULL) {
        return yaml_reader_fail(reader, node, "every_frames: 'frames' is needed with it");
    }
    if (!scenario_parse_u32(reader, node, "every_frames", 2u, UINT16_MAX - 1u, &every)) {
        return false;
    }
    action->every = (uint16_t)every;
    return (action->count < action->every) ||
           yaml_reader_fail(reader, node, "every_frames: must be more than 'frames', which is %u", action->count);
}

/** `roll`: at this speed, or at the one that it has. */
static bool take_speed(const yaml_reader_t *reader, const reading_t *reading, vehicle_action_t *action) {
    const yaml_node_t *node = given(reading, P_SPEED);
    int64_t number = 0;

    if (node == NULL) {
        action->what = action->on ? VEHICLE_DO_VCU_ROLL_ON : VEHICLE_DO_VCU_ROLL;
        return true;
    }
    if (!yaml_reader_number(reader, node, "speed_mm_s", -VEHICLE_ROLL_MAX_MM_S, VEHICLE_ROLL_MAX_MM_S, &number)) {
        return false;
    }
    action->speed_mm_s = (int32_t)number;
    return true;
}

static bool take_driving(const yaml_reader_t *reader, const reading_t *reading, vehicle_action_t *action) {
    const yaml_node_t *gear = given(reading, P_GEAR);
    const yaml_node_t *throttle = given(reading, P_THROTTLE);
    const yaml_node_t *steer = given(reading, P_STEER);
    int word = 0;
    int64_t number = 0;

    if (gear != NULL) {
        if (!yaml_reader_word(reader, gear, "gear", SCENARIO_GEARS, &word)) {
            return false;
        }
        action->gear = (uint8_t)word;
    }
    if (throttle != NULL) {
        if (!yaml_reader_number(reader, throttle, "throttle_pct", 0, 100, &number)) {
            return false;
        }
        action->throttle_permille = (uint16_t)(number * 10);
    }
    if (steer != NULL) {
        if (!yaml_reader_number(reader, steer, "steer_deg", -900, 900, &number)) {
            return false;
        }
        action->angle_ddeg = (int32_t)number * 10;
    }
    return true;
}

static bool take_garbage(const yaml_reader_t *reader, const reading_t *reading, vehicle_action_t *action) {
    static const yaml_word_t words[] = {{"random", VEHICLE_GARBAGE_RANDOM},
                                        {"wrong_length", VEHICLE_GARBAGE_LENGTH},
                                        {"extended", VEHICLE_GARBAGE_EXTENDED},
                                        {"remote", VEHICLE_GARBAGE_REMOTE},
                                        {NULL, 0}};
    int word = 0;

    if (!yaml_reader_word(reader, given(reading, P_KIND), "kind", words, &word)) {
        return false;
    }
    action->garbage = (vehicle_garbage_t)word;
    return true;
}

/** The largest value of a field. */
static uint32_t highest_of(const scenario_field_row_t *row) {
    return (row->size > 1u) ? UINT32_MAX >> (BITS_OF_VALUE - (BITS_OF_BYTE * row->size))
                            : (uint32_t)row->mask >> row->shift;
}

/** `set`: a field keeps a value; `freeze_field`: the one that it has. */
static bool take_field(const yaml_reader_t *reader, const reading_t *reading, vehicle_action_t *action) {
    const yaml_node_t *node = given(reading, P_FIELD);
    const char *name = yaml_reader_text(reader, node, "field");
    uint32_t value = 0u;

    if (name == NULL) {
        return false;
    }
    const scenario_field_row_t *row = scenario_find_field(reading->actor, name);
    if (row == NULL) {
        return yaml_reader_fail(reader, node, "field: this node has no field '%.40s'", name);
    }
    const yaml_node_t *given_value = given(reading, P_VALUE);
    if ((given_value != NULL) && !yaml_reader_hex(reader, given_value, "value", highest_of(row), &value)) {
        return false;
    }
    action->message = row->message;
    memset(action->keep, UINT8_MAX, sizeof action->keep);
    for (unsigned i = 0u; i < row->size; i++) {
        action->keep[row->byte + i] = (uint8_t)~row->mask;
        action->value[row->byte + i] = (uint8_t)((value >> (BITS_OF_BYTE * i)) << row->shift);
    }
    return true;
}

/** `set_bytes`: bytes keep their values, `..` stays as it is. */
static bool take_patch_bytes(const yaml_reader_t *reader, const reading_t *reading, vehicle_action_t *action) {
    const yaml_node_t *node = given(reading, P_BYTES);
    uint8_t mask[AGV_DLC];
    uint8_t length = 0u;

    if (!yaml_reader_bytes(reader, node, "bytes", action->value, mask, &length)) {
        return false;
    }
    for (unsigned i = 0u; i < AGV_DLC; i++) {
        action->keep[i] = (uint8_t)~mask[i];
    }
    return (length == AGV_DLC) ||
           yaml_reader_fail(reader, node, "bytes: all 8 are needed, '..' for one that does not change");
}

/** @param on_wire whether the simulated bus is to carry it */
static bool take_kind(const yaml_reader_t *reader, const reading_t *reading, bool on_wire, hal_can_frame_t *frame) {
    static const yaml_word_t words[] = {{"data", 0},        {"extended", HAL_CAN_EXTENDED}, {"remote", HAL_CAN_REMOTE},
                                        {"fd", HAL_CAN_FD}, {"error", HAL_CAN_ERROR},       {NULL, 0}};
    const yaml_node_t *node = given(reading, P_KIND);
    int word = 0;

    if (node == NULL) {
        return true;
    }
    if (!yaml_reader_word(reader, node, "kind", words, &word)) {
        return false;
    }
    if (on_wire && ((word & (int)HAL_CAN_ERROR) != 0)) {
        return yaml_reader_fail(reader, node, "kind: error is only for deliver");
    }
    if (on_wire && reader->is_line && ((word & (int)HAL_CAN_FD) != 0)) {
        return yaml_reader_fail(reader, node, "kind: fd is for the simulated bus only");
    }
    frame->flags = (uint8_t)word;
    return true;
}

/** A raw frame: `id` or `message`, `kind`, `bytes`. */
static bool take_frame(const yaml_reader_t *reader, const reading_t *reading, const agv_config_t *config,
                       scenario_step_t *step, hal_can_frame_t *frame) {
    const yaml_node_t *id = given(reading, P_ID);

    if ((id != NULL) == (given(reading, P_MESSAGE) != NULL)) {
        return yaml_reader_fail(reader, reading->node, "either 'id' or 'message' is needed");
    }
    if (!take_kind(reader, reading, step->of_vehicle, frame) ||
        !yaml_reader_bytes(reader, given(reading, P_BYTES), "bytes", frame->data, NULL, &frame->length)) {
        return false;
    }
    if (id == NULL) {
        agv_ids_t ids;
        agv_config_ids(config, &ids);
        frame->id = ids.of[step->vehicle.message];
        return true;
    }
    return yaml_reader_id(reader, id, "id", (frame->flags == HAL_CAN_EXTENDED) ? 0x1FFFFFFFu : AGV_ID_MAX, &frame->id);
}

static bool take_side(const yaml_reader_t *reader, const reading_t *reading, const agv_config_t *config,
                      hal_can_side_t *side) {
    const yaml_node_t *node = given(reading, P_SIDE);
    int word = HAL_CAN_VEHICLE;

    if ((node != NULL) && !yaml_reader_word(reader, node, "side", SCENARIO_SIDES, &word)) {
        return false;
    }
    if ((word == (int)HAL_CAN_AI) && (config->topology != (uint16_t)AGV_TOPOLOGY_GATEWAY)) {
        return yaml_reader_fail(reader, node, "side: only topology: gateway has an AI side");
    }
    *side = (hal_can_side_t)word;
    return true;
}

static bool take_for_vehicle(const yaml_reader_t *reader, const reading_t *reading, const scenario_action_row_t *row,
                             const agv_config_t *config, scenario_step_t *step) {
    vehicle_action_t *action = &step->vehicle;

    action->what = (vehicle_do_t)row->what;
    action->on = row->on;
    action->node = (vehicle_node_t)reading->actor;
    action->count = ((row->takes & P_FRAMES) != 0u) ? VEHICLE_FOREVER : 0u;
    if (!take_numbers(reader, reading, step) || !take_every(reader, reading, action) ||
        !take_driving(reader, reading, action)) {
        return false;
    }
    switch (action->what) {
    case VEHICLE_DO_VCU_ROLL:
        return take_speed(reader, reading, action);
    case VEHICLE_DO_DELAY:
        return (action->ms <= VEHICLE_DELAY_MAX_MS) ||
               yaml_reader_fail(reader, given(reading, P_BY_MS), "by_ms: at most %u for 'delay'", VEHICLE_DELAY_MAX_MS);
    case VEHICLE_DO_HOLD:
        return take_field(reader, reading, action);
    case VEHICLE_DO_GARBAGE:
        return take_garbage(reader, reading, action);
    case VEHICLE_DO_PATCH:
        return ((row->needs & P_FIELD) != 0u) ? take_field(reader, reading, action)
                                              : take_patch_bytes(reader, reading, action);
    case VEHICLE_DO_SEND:
        if ((given(reading, P_EVERY_MS) != NULL) && (given(reading, P_TIMES) == NULL)) {
            action->count = VEHICLE_FOREVER;
        }
        return take_side(reader, reading, config, &action->side) &&
               take_frame(reader, reading, config, step, &action->frame);
    default:
        return true;
    }
}

static bool take_for_supervisor(const yaml_reader_t *reader, const reading_t *reading, const scenario_action_row_t *row,
                                const agv_config_t *config, scenario_step_t *step) {
    scenario_action_t *action = &step->supervisor;
    int cause = HAL_RESET_POWER_ON;

    if (!take_numbers(reader, reading, step) || !take_side(reader, reading, config, &action->side)) {
        return false;
    }
    action->what = (scenario_do_t)row->what;
    action->on = row->on;
    action->ms = (action->what == SCENARIO_CORRUPT_FRAMES) ? step->vehicle.count : step->vehicle.ms;
    if ((row->needs & P_CAUSE) != 0u) {
        if (!yaml_reader_word(reader, given(reading, P_CAUSE), "cause", SCENARIO_CAUSES, &cause)) {
            return false;
        }
        action->cause = (hal_reset_cause_t)cause;
    }
    switch (action->what) {
    case SCENARIO_DELIVER:
        return take_frame(reader, reading, config, step, &action->frame);
    case SCENARIO_BUTTON_BOUNCES:
        return scenario_parse_bounce(reader, given(reading, P_PATTERN), action);
    case SCENARIO_CLOCK:
        return scenario_parse_permille(reader, given(reading, P_PERMILLE), action);
    case SCENARIO_TEST_FAILS:
        return scenario_parse_tested_part(reader, given(reading, P_PART), &action->parts);
    default:
        return true;
    }
}

/** What the action needs is there, and nothing else. */
static bool has_what_it_needs(const yaml_reader_t *reader, const reading_t *reading, const scenario_action_row_t *row) {
    for (unsigned i = 0u; i < SCENARIO_PARAMETERS; i++) {
        if (((row->needs & (1u << i)) != 0u) && (reading->value_of[i] == NULL)) {
            return yaml_reader_fail(reader, reading->node, "'%s' needs '%s'", row->word, SCENARIO_PARAMETER_NAMES[i]);
        }
        if ((((row->needs | row->takes) & (1u << i)) == 0u) && (reading->value_of[i] != NULL)) {
            return yaml_reader_fail(reader, reading->value_of[i], "'%s' takes no '%s'", row->word,
                                    SCENARIO_PARAMETER_NAMES[i]);
        }
    }
    return true;
}

/** Take a key of the time. @return false: another key */
static bool is_time_key(const char *name, reading_t *reading, uint32_t **time) {
    static const char *const names[] = {"at_ms", "again_every_ms", "again_until_ms"};
    uint32_t *const times[] = {&reading->at_ms, &reading->again_every_ms, &reading->again_until_ms};

    for (size_t i = 0u; i < COUNT(names); i++) {
        if (strcmp(names[i], name) == 0) {
            *time = times[i];
            return true;
        }
    }
    return false;
}

static bool take_key(const yaml_reader_t *reader, const yaml_node_t *key, const yaml_node_t *value,
                     reading_t *reading) {
    const char *name = yaml_node_text(key);
    uint32_t *time = NULL;

    if (name == NULL) {
        return yaml_reader_fail(reader, key, "a key of a step must be a word");
    }
    if (is_time_key(name, reading, &time)) {
        return scenario_parse_ms(reader, value, name, (time == &reading->again_every_ms) ? 1u : 0u,
                                 SCENARIO_DURATION_MAX_MS, time);
    }
    for (const yaml_word_t *actor = SCENARIO_ACTORS; actor->word != NULL; actor++) {
        if (strcmp(actor->word, name) == 0) {
            if (reading->actor != ACTOR_NONE) {
                return yaml_reader_fail(reader, key, "a step has one actor; '%s' is the second", name);
            }
            reading->actor = (scenario_actor_t)actor->value;
            reading->word = value;
            return true;
        }
    }
    for (unsigned i = 0u; i < SCENARIO_PARAMETERS; i++) {
        if (strcmp(SCENARIO_PARAMETER_NAMES[i], name) == 0) {
            if (reading->value_of[i] != NULL) {
                return yaml_reader_fail(reader, key, "'%s' is given twice in a step", name);
            }
            reading->value_of[i] = value;
            return true;
        }
    }
    return yaml_reader_fail(reader, key, "unknown key '%.40s' in a step", name);
}

static bool take_keys(const yaml_reader_t *reader, reading_t *reading) {
    const yaml_node_t *node = reading->node;
    bool has_time = false;

    if (node->type != YAML_MAPPING_NODE) {
        return yaml_reader_fail(reader, node, "a step must be like {at_ms: 5000, ai: stop}");
    }
    for (const yaml_node_pair_t *pair = node->data.mapping.pairs.start; pair < node->data.mapping.pairs.top; pair++) {
        const yaml_node_t *key = yaml_document_get_node(reader->document, pair->key);
        const char *name = yaml_node_text(key);
        const bool is_time = (name != NULL) && (strcmp(name, "at_ms") == 0);
        if (is_time && has_time) {
            return yaml_reader_fail(reader, key, "'at_ms' is given twice in a step");
        }
        has_time = has_time || is_time;
        if (!take_key(reader, key, yaml_document_get_node(reader->document, pair->value), reading)) {
            return false;
        }
    }
    if (!has_time) {
        return yaml_reader_fail(reader, node, "a step: 'at_ms' is missing");
    }
    if ((reading->again_until_ms != UINT32_MAX) && (reading->again_every_ms == 0u)) {
        return yaml_reader_fail(reader, node, "a step: 'again_until_ms' needs 'again_every_ms'");
    }
    return (reading->actor != ACTOR_NONE) ||
           yaml_reader_fail(reader, node,
                            "a step: the actor is missing (vcu, eps, ai, operator, bus, supervisor or board)");
}

bool scenario_parse_step(const yaml_reader_t *reader, const yaml_node_t *node, const agv_config_t *config,
                         scenario_step_t *step) {
    reading_t reading = {.node = node, .again_until_ms = UINT32_MAX, .actor = ACTOR_NONE};

    if (!take_keys(reader, &reading)) {
        return false;
    }
    const char *word = yaml_reader_text(reader, reading.word, "a step");
    if (word == NULL) {
        return false;
    }
    const scenario_action_row_t *row = scenario_find_action(reading.actor, word);
    if (row == NULL) {
        return yaml_reader_fail(reader, reading.word, "%s: unknown action '%.40s'", SCENARIO_ACTORS[reading.actor].word,
                                word);
    }
    *step = (scenario_step_t){.at_ms = reading.at_ms,
                              .again_every_ms = reading.again_every_ms,
                              .again_until_ms = reading.again_until_ms,
                              .line = yaml_node_line(node),
                              .actor = SCENARIO_ACTORS[reading.actor].word,
                              .word = row->word,
                              .of_vehicle = row->of_vehicle};
    step->vehicle.message = AGV_MSG_NONE;
    if (!has_what_it_needs(reader, &reading, row) || !take_message(reader, &reading, row, step)) {
        return false;
    }
    return row->of_vehicle ? take_for_vehicle(reader, &reading, row, config, step)
                           : take_for_supervisor(reader, &reading, row, config, step);
}

/** Check that there is room for all repeated steps. */
static bool again_fits(const yaml_reader_t *reader, const yaml_node_t *node, const scenario_t *scenario) {
    size_t count = 0u;

    for (size_t i = 0u; i < scenario->step_count; i++) {
        count += (scenario->steps[i].again_every_ms != 0u) ? 1u : 0u;
    }
    return (count <= SCENARIO_AGAIN_MAX) ||
           yaml_reader_fail(reader, node, "more than %u steps with again_every_ms", SCENARIO_AGAIN_MAX);
}

static bool read_step(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_t *scenario = target;

    if (scenario->step_count == SCENARIO_STEPS_MAX) {
        return yaml_reader_fail(reader, node, "more than %u steps", SCENARIO_STEPS_MAX);
    }
    scenario_step_t *step = &scenario->steps[scenario->step_count];
    scenario->step_count++;
    return scenario_parse_step(reader, node, &scenario->config, step) &&
           scenario_parse_board_fits(reader, node, scenario, step) && again_fits(reader, node, scenario);
}

bool scenario_parse_steps(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_list(reader, node, "steps", read_step, target);
}

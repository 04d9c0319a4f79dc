/*
 * Scenario files: the steps. A step is a time, an actor with its action, and parameters:
 * `- {at_ms: 5000, ai: mute, message: gear_command}`. scenario_actions.c lists the actions of each actor and their
 * parameters.
 */
#include <string.h>

#include "io/yaml_file.h"
#include "scenario/parse/scenario_parse.h"
#include "scenario/parse/scenario_parse_step_keys.h"
#include "scenario/scenario_actions.h"
#include "text/suggest.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define BITS_OF_BYTE 8u

static const yaml_node_t *given(const scenario_reading_t *reading, uint32_t parameter) {
    for (unsigned i = 0; i < SCENARIO_PARAMETERS; i++) {
        if ((1u << i) == parameter) {
            return reading->value_of[i];
        }
    }
    return NULL;
}

static bool take_message(const yaml_reader_t *reader, const scenario_reading_t *reading,
                         const scenario_action_row_t *row, scenario_step_t *step) {
    const yaml_node_t *message = given(reading, P_MESSAGE);

    if (message == NULL) {
        return true;
    }
    if (!scenario_parse_message(reader, message, &step->vehicle.message)) {
        return false;
    }
    if (((row->what == VEHICLE_DO_IGNORE) && row->of_vehicle)) {
        return ((int)vehicle_receiver_of(step->vehicle.message) == (int)reading->actor) ||
               yaml_reader_fail(reader, message, "message: %.40s is not a command that this node obeys",
                                yaml_node_text(message));
    }
    if ((reading->actor <= ACTOR_AI) && ((int)vehicle_sender_of(step->vehicle.message) != (int)reading->actor)) {
        return yaml_reader_fail(reader, message, "message: another node sends %.40s", yaml_node_text(message));
    }
    return true;
}

/** Read a number by the row of its parameter. */
static bool read_number(const yaml_reader_t *reader, const scenario_reading_t *reading, uint32_t parameter,
                        int64_t *number) {
    const yaml_key_t *row = scenario_parameter(parameter);
    const yaml_node_t *node = given(reading, parameter);

    return (row->kind == YAML_KIND_TIME)
               ? yaml_reader_time(reader, node, row->name, row->unit, row->lowest, row->highest, number)
               : yaml_reader_number(reader, node, row->name, row->lowest, row->highest, number);
}

/** The numbers of an action: how many frames, how often, how long. */
static bool take_numbers(const yaml_reader_t *reader, const scenario_reading_t *reading, scenario_step_t *step) {
    static const uint32_t counts[] = {P_FRAMES, P_TIMES, P_BUTTON, P_PCT_S};
    static const uint32_t others[] = {P_BY_MS, P_EVERY_MS, P_OFF_MS, P_FOR_MS, P_BIT};
    int64_t number = 0;

    for (size_t i = 0; i < COUNT(counts); i++) {
        if (given(reading, counts[i]) != NULL) {
            if (!read_number(reader, reading, counts[i], &number)) {
                return false;
            }
            step->vehicle.count = (uint16_t)number;
        }
    }
    for (size_t i = 0; i < COUNT(others); i++) {
        if (given(reading, others[i]) != NULL) {
            if (!read_number(reader, reading, others[i], &number)) {
                return false;
            }
            step->vehicle.ms = (uint32_t)number;
        }
    }
    return true;
}

/** `every_frames`: again and again. */
static bool take_every(const yaml_reader_t *reader, const scenario_reading_t *reading, vehicle_action_t *action) {
    const yaml_node_t *node = given(reading, P_EVERY_FRAMES);
    int64_t every = 0;

    if (node == NULL) {
        return true;
    }
    if (given(reading, P_FRAMES) == NULL) {
        return yaml_reader_fail(reader, node, "every_frames: 'frames' is needed with it");
    }
    if (!read_number(reader, reading, P_EVERY_FRAMES, &every)) {
        return false;
    }
    action->every = (uint16_t)every;
    return (action->count < action->every) ||
           yaml_reader_fail(reader, node, "every_frames: must be more than 'frames', which is %u", action->count);
}

/** `roll`: at this speed, or at the one that it has. */
static bool take_speed(const yaml_reader_t *reader, const scenario_reading_t *reading, vehicle_action_t *action) {
    const yaml_node_t *node = given(reading, P_SPEED);
    int64_t number = 0;

    if (node == NULL) {
        action->what = action->on ? VEHICLE_DO_VCU_ROLL_ON : VEHICLE_DO_VCU_ROLL;
        return true;
    }
    if (!read_number(reader, reading, P_SPEED, &number)) {
        return false;
    }
    action->speed_mm_s = (int32_t)number;
    return true;
}

static bool take_driving(const yaml_reader_t *reader, const scenario_reading_t *reading, vehicle_action_t *action) {
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
        if (!read_number(reader, reading, P_THROTTLE, &number)) {
            return false;
        }
        action->throttle_permille = (uint16_t)(number * 10);
    }
    if (steer != NULL) {
        if (!read_number(reader, reading, P_STEER, &number)) {
            return false;
        }
        action->angle_ddeg = (int32_t)number * 10;
    }
    return true;
}

static bool take_garbage(const yaml_reader_t *reader, const scenario_reading_t *reading, vehicle_action_t *action) {
    int word = 0;

    if (!yaml_reader_word(reader, given(reading, P_KIND), "kind", SCENARIO_GARBAGE, &word)) {
        return false;
    }
    action->garbage = (vehicle_garbage_t)word;
    return true;
}

const char *scenario_parse_meant(const suggestion_t *suggestion, char text[SUGGEST_SIZE]) {
    return (suggestion->word != NULL) ? suggest_text(suggestion, text) : "; docs/scenarios.md lists them";
}

/** Report a field that the node does not have. */
static bool unknown_field(const yaml_reader_t *reader, const yaml_node_t *node, scenario_actor_t actor,
                          const char *name) {
    char meant[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin(name, strlen(name));
    for (size_t i = 0; scenario_field(i) != NULL; i++) {
        if (scenario_field(i)->actor == actor) {
            suggest_offer(&suggestion, scenario_field(i)->name, strlen(scenario_field(i)->name));
        }
    }
    return yaml_reader_fail(reader, node, "field: this node has no field '%.40s'%s", name,
                            scenario_parse_meant(&suggestion, meant));
}

/** `set`: a field keeps a value; `freeze_field`: the one that it has. */
static bool take_field(const yaml_reader_t *reader, const scenario_reading_t *reading, vehicle_action_t *action) {
    const yaml_node_t *node = given(reading, P_FIELD);
    const char *name = yaml_reader_text(reader, node, "field");
    uint32_t value = 0;

    if (name == NULL) {
        return false;
    }
    const scenario_field_row_t *row = scenario_find_field(reading->actor, name);
    if (row == NULL) {
        return unknown_field(reader, node, reading->actor, name);
    }
    const yaml_node_t *given_value = given(reading, P_VALUE);
    if ((given_value != NULL) && !yaml_reader_hex(reader, given_value, "value", scenario_field_highest(row), &value)) {
        return false;
    }
    action->message = row->message;
    memset(action->keep, UINT8_MAX, sizeof action->keep);
    for (unsigned i = 0; i < row->size; i++) {
        action->keep[row->byte + i] = (uint8_t)~row->mask;
        action->value[row->byte + i] = (uint8_t)((value >> (BITS_OF_BYTE * i)) << row->shift);
    }
    return true;
}

/** `set_bytes`: bytes keep their values, `..` stays as it is. */
static bool take_patch_bytes(const yaml_reader_t *reader, const scenario_reading_t *reading, vehicle_action_t *action) {
    const yaml_node_t *node = given(reading, P_BYTES);
    uint8_t mask[AGV_DLC];
    uint8_t length = 0;

    if (!yaml_reader_bytes(reader, node, "bytes", action->value, mask, &length)) {
        return false;
    }
    for (unsigned i = 0; i < AGV_DLC; i++) {
        action->keep[i] = (uint8_t)~mask[i];
    }
    return (length == AGV_DLC) ||
           yaml_reader_fail(reader, node, "bytes: all 8 are needed, '..' for one that does not change");
}

/** @param on_wire whether the simulated bus is to carry it */
static bool take_kind(const yaml_reader_t *reader, const scenario_reading_t *reading, bool on_wire,
                      hal_can_frame_t *frame) {
    const yaml_node_t *node = given(reading, P_KIND);
    int word = 0;

    if (node == NULL) {
        return true;
    }
    if (!yaml_reader_word(reader, node, "kind", SCENARIO_FRAME_KINDS, &word)) {
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
static bool take_frame(const yaml_reader_t *reader, const scenario_reading_t *reading, const agv_config_t *config,
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

static bool take_side(const yaml_reader_t *reader, const scenario_reading_t *reading, const agv_config_t *config,
                      hal_can_side_t *side) {
    const yaml_node_t *node = given(reading, P_SIDE);
    int word = HAL_CAN_VEHICLE;

    if ((node != NULL) && !yaml_reader_word(reader, node, "side", SCENARIO_SIDES, &word)) {
        return false;
    }
    if ((word == HAL_CAN_AI) && (config->topology != AGV_TOPOLOGY_GATEWAY)) {
        return yaml_reader_fail(reader, node, "side: only topology: gateway has an AI side");
    }
    *side = (hal_can_side_t)word;
    return true;
}

/** How often a raw frame is sent. */
static bool take_times(const yaml_reader_t *reader, const scenario_reading_t *reading, vehicle_action_t *action) {
    const yaml_node_t *times = given(reading, P_TIMES);

    if ((given(reading, P_EVERY_MS) != NULL) && (times == NULL)) {
        action->count = VEHICLE_FOREVER;
    }
    return (times == NULL) || (action->count > 0) || yaml_reader_fail(reader, times, "times: at least 1 for 'send'");
}

static bool take_for_vehicle(const yaml_reader_t *reader, const scenario_reading_t *reading,
                             const scenario_action_row_t *row, const agv_config_t *config, scenario_step_t *step) {
    vehicle_action_t *action = &step->vehicle;

    action->what = (vehicle_do_t)row->what;
    action->on = row->on;
    action->node = (vehicle_node_t)reading->actor;
    action->count = ((row->takes & P_FRAMES) != 0) ? VEHICLE_FOREVER : 0;
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
        return ((row->needs & P_FIELD) != 0) ? take_field(reader, reading, action)
                                             : take_patch_bytes(reader, reading, action);
    case VEHICLE_DO_SEND:
        return take_times(reader, reading, action) && take_side(reader, reading, config, &action->side) &&
               take_frame(reader, reading, config, step, &action->frame);
    default:
        return true;
    }
}

/** How wrong a clock is. */
static bool take_permille(const yaml_reader_t *reader, const scenario_reading_t *reading, scenario_action_t *action) {
    int64_t permille = 0;

    if (!read_number(reader, reading, P_PERMILLE, &permille)) {
        return false;
    }
    action->permille = (int16_t)(action->on ? permille : -permille);
    return true;
}

static bool take_for_supervisor(const yaml_reader_t *reader, const scenario_reading_t *reading,
                                const scenario_action_row_t *row, const agv_config_t *config, scenario_step_t *step) {
    scenario_action_t *action = &step->supervisor;
    int cause = HAL_RESET_POWER_ON;

    if (!take_numbers(reader, reading, step) || !take_side(reader, reading, config, &action->side)) {
        return false;
    }
    action->what = (scenario_do_t)row->what;
    action->on = row->on;
    action->ms = (action->what == SCENARIO_CORRUPT_FRAMES) ? step->vehicle.count : step->vehicle.ms;
    if ((row->needs & P_CAUSE) != 0) {
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
        return (row->needs == 0) || take_permille(reader, reading, action);
    case SCENARIO_TEST_FAILS:
        return scenario_parse_tested_part(reader, given(reading, P_PART), &action->parts);
    default:
        return true;
    }
}

static bool unknown_action(const yaml_reader_t *reader, const scenario_reading_t *reading, const char *word) {
    char meant[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin(word, strlen(word));
    for (size_t i = 0; scenario_action(i) != NULL; i++) {
        const scenario_action_row_t *row = scenario_action(i);
        if (scenario_action_is_of(row, reading->actor)) {
            suggest_offer(&suggestion, row->word, strlen(row->word));
        }
    }
    return yaml_reader_fail(reader, reading->word, "%s: unknown action '%.40s'%s", SCENARIO_ACTORS[reading->actor].word,
                            word, scenario_parse_meant(&suggestion, meant));
}

bool scenario_parse_step(const yaml_reader_t *reader, const yaml_node_t *node, const agv_config_t *config,
                         scenario_step_t *step) {
    scenario_reading_t reading;

    if (!scenario_read_step_keys(reader, node, &reading)) {
        return false;
    }
    const char *word = yaml_reader_text(reader, reading.word, "a step");
    if (word == NULL) {
        return false;
    }
    const scenario_action_row_t *row = scenario_find_action(reading.actor, word);
    if (row == NULL) {
        return unknown_action(reader, &reading, word);
    }
    *step = (scenario_step_t){.at_ms = reading.at_ms,
                              .again_every_ms = reading.again_every_ms,
                              .again_until_ms = reading.again_until_ms,
                              .line = yaml_node_line(node),
                              .actor = SCENARIO_ACTORS[reading.actor].word,
                              .word = row->word,
                              .of_vehicle = row->of_vehicle};
    step->vehicle.message = AGV_MSG_NONE;
    if (!scenario_has_what_it_needs(reader, &reading, row) || !take_message(reader, &reading, row, step)) {
        return false;
    }
    return row->of_vehicle ? take_for_vehicle(reader, &reading, row, config, step)
                           : take_for_supervisor(reader, &reading, row, config, step);
}

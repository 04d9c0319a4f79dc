/* The JSON Schema of a step: for each action what it needs and what it takes. */

#include "agv/names.h"
#include "io/yaml_schema.h"
#include "scenario/parse/scenario_parse.h"
#include "scenario/parse/scenario_schema.h"
#include "scenario/scenario_actions.h"

/** The keys of any step. */
static const yaml_shape_t STEP_NAME = {.kind = YAML_KIND_TEXT, .highest = SCENARIO_NAME_MAX - 1};
#define STEP_TIME(name_, low)                                                                                          \
    {.name = (name_), .kind = YAML_KIND_TIME, .unit = DURATION_MS, .lowest = (low), .highest = SCENARIO_DURATION_MAX_MS}
static const yaml_key_t STEP_KEYS[] = {
    STEP_TIME("at_ms", 0),          {.name = "after", .kind = YAML_KIND_CALL, .shape = &SCENARIO_TEXT_SHAPE},
    STEP_TIME("wait", 0),           {.name = "name", .kind = YAML_KIND_CALL, .shape = &STEP_NAME},
    STEP_TIME("again_every_ms", 1), STEP_TIME("again_until_ms", 0),
};
static const yaml_rule_t STEP_RULES[] = {{YAML_RULE_ONE_OF, "at_ms", "after"},
                                         {YAML_RULE_NEEDS, "wait", "after"},
                                         {YAML_RULE_NEEDS, "again_until_ms", "again_every_ms"},
                                         {YAML_RULE_NEEDS, "every_frames", "frames"}};

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/** The words of an actor. */
static json_t *words_of(scenario_actor_t actor) {
    json_t *list = json_array();
    const scenario_action_row_t *row = scenario_action(0);
    for (size_t i = 1; row != NULL; i++) {
        if (scenario_action_is_of(row, actor)) {
            (void)json_array_append_new(list, json_string(row->word));
        }
        row = scenario_action(i);
    }
    return json_pack("{s:o}", "enum", list);
}

/** The messages that an action of a node may name: those that it sends, or the commands that it obeys. */
static json_t *messages_of(const scenario_action_row_t *row, scenario_actor_t actor) {
    const bool obeys = row->of_vehicle && (row->what == VEHICLE_DO_IGNORE);
    json_t *list = json_array();
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        const agv_message_t message = (agv_message_t)m;
        const int node = obeys ? (int)vehicle_receiver_of(message) : (int)vehicle_sender_of(message);
        if ((actor > ACTOR_AI) || (node == (int)actor)) {
            (void)json_array_append_new(list, json_string(agv_message_name(message)));
        }
    }
    return json_pack("{s:o}", "enum", list);
}

/** The condition that a key is there and holds this word. */
static json_t *holds(const char *key, const char *word) {
    return json_pack("{s:{s:{s:s}}, s:[s]}", "properties", key, "const", word, "required", key);
}

/** The schema of a mapping with this one key. */
static json_t *with_key(const char *key, json_t *schema) {
    return json_pack("{s:{s:o}}", "properties", key, schema);
}

/** The fields of a node, and how large the value of each may be. */
static void add_fields(json_t *then, json_t *properties, scenario_actor_t actor) {
    json_t *list = json_array();
    const scenario_field_row_t *row = scenario_field(0);
    for (size_t i = 1; row != NULL; i++) {
        if (row->actor == actor) {
            const yaml_shape_t value = {.kind = YAML_KIND_HEX, .highest = scenario_field_highest(row)};
            (void)json_array_append_new(list, json_string(row->name));
            yaml_schema_also(then, json_pack("{s:o, s:o}", "if", holds("field", row->name), "then",
                                             with_key("value", yaml_schema(&value))));
        }
        row = scenario_field(i);
    }
    (void)json_object_set_new(properties, "field", json_pack("{s:o}", "enum", list));
}

/** A raw frame: the identifier has 11 bits, or 29 in an extended one. */
static void add_raw_frame(json_t *then, json_t *properties, bool on_wire) {
    const yaml_rule_t one_id = {YAML_RULE_ONE_OF, "id", "message"};
    const yaml_shape_t payload = {.kind = YAML_KIND_BYTES, .highest = AGV_DLC};
    const yaml_shape_t kind = {.kind = YAML_KIND_WORD, .words = SCENARIO_FRAME_KINDS};
    const yaml_shape_t identifier = {.kind = YAML_KIND_ID, .highest = AGV_ID_MAX};

    (void)json_object_set_new(properties, "bytes", yaml_schema(&payload));
    (void)json_object_set_new(properties, "kind", yaml_schema(&kind));
    yaml_schema_also(then, yaml_schema_of_rule(&one_id));
    yaml_schema_also(then, json_pack("{s:o, s:{}, s:o}", "if", holds("kind", "extended"), "then", "else",
                                     with_key("id", yaml_schema(&identifier))));
    if (on_wire) {
        yaml_key_t times = *scenario_parameter(P_TIMES);
        times.lowest = 1;
        (void)json_object_set_new(properties, times.name, yaml_schema_of_key(&times));
        yaml_schema_also(then, json_pack("{s:o}", "not", holds("kind", "error")));
    }
}

/** What an action says of its parameters beyond their limits. */
static void add_parameters(json_t *then, const scenario_action_row_t *row, scenario_actor_t actor) {
    json_t *properties = json_object();
    const uint32_t takes = row->needs | row->takes;
    const yaml_shape_t garbage = {.kind = YAML_KIND_WORD, .words = SCENARIO_GARBAGE};
    const yaml_shape_t all_bytes = {
        .kind = YAML_KIND_BYTES, .lowest = AGV_DLC, .highest = AGV_DLC, .may_be_open = true};

    if ((takes & P_MESSAGE) != 0) {
        (void)json_object_set_new(properties, "message", messages_of(row, actor));
    }
    if ((takes & P_FIELD) != 0) {
        add_fields(then, properties, actor);
    }
    if ((takes & P_ID) != 0) {
        add_raw_frame(then, properties, row->of_vehicle);
    } else if ((takes & P_BYTES) != 0) {
        (void)json_object_set_new(properties, "bytes", yaml_schema(&all_bytes));
    } else if ((takes & P_KIND) != 0) {
        (void)json_object_set_new(properties, "kind", yaml_schema(&garbage));
    } else if (row->of_vehicle && (row->what == VEHICLE_DO_DELAY)) {
        yaml_key_t by = *scenario_parameter(P_BY_MS);
        by.highest = VEHICLE_DELAY_MAX_MS;
        (void)json_object_set_new(properties, by.name, yaml_schema_of_key(&by));
    } else {
        /* their limits are the same in every action */
    }
    (void)json_object_set_new(then, "properties", properties);
}

/** What holds if an actor does this. */
static json_t *condition_of(const scenario_action_row_t *row, const yaml_word_t *actor) {
    json_t *names = json_pack("[s]", actor->word);
    json_t *required = json_array();
    for (size_t i = 0; i < COUNT(STEP_KEYS); i++) {
        (void)json_array_append_new(names, json_string(STEP_KEYS[i].name));
    }
    for (unsigned i = 0; i < SCENARIO_PARAMETERS; i++) {
        json_t *name = json_string(SCENARIO_PARAMETER_ROWS[i].name);
        if (((row->needs >> i) & 1) != 0) {
            (void)json_array_append(required, name);
        }
        if ((((row->needs | row->takes) >> i) & 1) != 0) {
            (void)json_array_append(names, name);
        }
        json_decref(name);
    }
    json_t *then = json_pack("{s:{s:o}, s:o}", "propertyNames", "enum", names, "required", required);
    add_parameters(then, row, (scenario_actor_t)actor->value);
    return json_pack("{s:o, s:o}", "if", holds(actor->word, row->word), "then", then);
}

static void add_actions(json_t *schema, const yaml_word_t *actor) {
    const scenario_action_row_t *row = scenario_action(0);
    for (size_t i = 1; row != NULL; i++) {
        if (scenario_action_is_of(row, (scenario_actor_t)actor->value)) {
            yaml_schema_also(schema, condition_of(row, actor));
        }
        row = scenario_action(i);
    }
}

json_t *scenario_schema_step(void) {
    json_t *properties = json_object();
    json_t *actors = json_array();
    for (size_t i = 0; i < COUNT(STEP_KEYS); i++) {
        (void)json_object_set_new(properties, STEP_KEYS[i].name, yaml_schema_of_key(&STEP_KEYS[i]));
    }
    for (size_t i = 0; i < SCENARIO_PARAMETERS; i++) {
        (void)json_object_set_new(properties, SCENARIO_PARAMETER_ROWS[i].name,
                                  yaml_schema_of_key(&SCENARIO_PARAMETER_ROWS[i]));
    }
    for (const yaml_word_t *actor = SCENARIO_ACTORS; actor->word != NULL; actor++) {
        (void)json_object_set_new(properties, actor->word, words_of((scenario_actor_t)actor->value));
        (void)json_array_append_new(actors, json_pack("{s:[s]}", "required", actor->word));
    }
    json_t *schema = json_pack("{s:s, s:o, s:o, s:b}", "type", "object", "properties", properties, "oneOf", actors,
                               "additionalProperties", 0);
    for (size_t i = 0; i < COUNT(STEP_RULES); i++) {
        yaml_schema_also(schema, yaml_schema_of_rule(&STEP_RULES[i]));
    }
    for (const yaml_word_t *actor = SCENARIO_ACTORS; actor->word != NULL; actor++) {
        add_actions(schema, actor);
    }
    return schema;
}

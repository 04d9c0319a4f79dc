/* Scenario files: the keys of a step, sorted. */
#include "scenario/parse/scenario_parse_step_keys.h"

#include <string.h>

#include "io/yaml_file.h"
#include "scenario/parse/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

/** What the action needs is there, and nothing else. */
bool scenario_has_what_it_needs(const yaml_reader_t *reader, const scenario_reading_t *reading,
                                const scenario_action_row_t *row) {
    for (unsigned i = 0; i < SCENARIO_PARAMETERS; i++) {
        if (((row->needs & (1u << i)) != 0) && (reading->value_of[i] == NULL)) {
            return yaml_reader_fail(reader, reading->node, "'%s' needs '%s'", row->word,
                                    SCENARIO_PARAMETER_ROWS[i].name);
        }
        if ((((row->needs | row->takes) & (1u << i)) == 0) && (reading->value_of[i] != NULL)) {
            return yaml_reader_fail(reader, reading->value_of[i], "'%s' takes no '%s'", row->word,
                                    SCENARIO_PARAMETER_ROWS[i].name);
        }
    }
    return true;
}

/** The keys of the time: where each goes, and its lowest value. */
static uint32_t *find_time(const char *name, scenario_reading_t *reading, uint32_t *lowest) {
    static const char *const names[] = {"at_ms", "wait", "again_every_ms", "again_until_ms"};
    uint32_t *const times[] = {&reading->at_ms, &reading->wait_ms, &reading->again_every_ms, &reading->again_until_ms};

    for (size_t i = 0; i < COUNT(names); i++) {
        if (strcmp(names[i], name) == 0) {
            *lowest = (times[i] == &reading->again_every_ms) ? 1 : 0;
            return times[i];
        }
    }
    return NULL;
}

/** Take a key of the time or the name. @return 1: taken; 0: another key; -1: reported */
static int take_time(const yaml_reader_t *reader, const yaml_node_t *key, const yaml_node_t *value,
                     scenario_reading_t *reading) {
    const char *name = yaml_node_text(key);
    const bool is_after = strcmp(name, "after") == 0;
    uint32_t lowest = 0;
    uint32_t *time = find_time(name, reading, &lowest);

    if (is_after || (strcmp(name, "name") == 0)) {
        if (is_after && reading->has_after) {
            (void)yaml_reader_fail(reader, key, "'after' is given twice in a step");
            return -1;
        }
        reading->has_after = reading->has_after || is_after;
        return reader->is_line ? 0 : 1;
    }
    if (time == NULL) {
        return 0;
    }
    if ((*time != SCENARIO_NO_TIME)) {
        (void)yaml_reader_fail(reader, key, "'%s' is given twice in a step", name);
        return -1;
    }
    return scenario_parse_ms(reader, value, name, lowest, SCENARIO_DURATION_MAX_MS, time) ? 1 : -1;
}

static bool unknown_key(const yaml_reader_t *reader, const yaml_node_t *key, const char *name) {
    char meant[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin(name, strlen(name));
    for (const yaml_word_t *actor = SCENARIO_ACTORS; actor->word != NULL; actor++) {
        suggest_offer(&suggestion, actor->word, strlen(actor->word));
    }
    for (unsigned i = 0; i < SCENARIO_PARAMETERS; i++) {
        suggest_offer(&suggestion, SCENARIO_PARAMETER_ROWS[i].name, strlen(SCENARIO_PARAMETER_ROWS[i].name));
    }
    return yaml_reader_fail(reader, key, "unknown key '%.40s' in a step%s", name,
                            scenario_parse_meant(&suggestion, meant));
}

static bool take_key(const yaml_reader_t *reader, const yaml_node_t *key, const yaml_node_t *value,
                     scenario_reading_t *reading) {
    const char *name = yaml_node_text(key);

    if (name == NULL) {
        return yaml_reader_fail(reader, key, "a key of a step must be a word");
    }
    const int taken = take_time(reader, key, value, reading);
    if (taken != 0) {
        return taken > 0;
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
    for (unsigned i = 0; i < SCENARIO_PARAMETERS; i++) {
        if (strcmp(SCENARIO_PARAMETER_ROWS[i].name, name) == 0) {
            if (reading->value_of[i] != NULL) {
                return yaml_reader_fail(reader, key, "'%s' is given twice in a step", name);
            }
            reading->value_of[i] = value;
            return true;
        }
    }
    return unknown_key(reader, key, name);
}

/** The keys of the time go together. */
static bool times_fit(const yaml_reader_t *reader, scenario_reading_t *reading) {
    const yaml_node_t *node = reading->node;
    const bool is_absolute = reading->at_ms != SCENARIO_NO_TIME;

    if (is_absolute && reading->has_after) {
        return yaml_reader_fail(reader, node, "a step: either 'at_ms' or 'after'");
    }
    if (!is_absolute && !reading->has_after) {
        return yaml_reader_fail(reader, node, "a step: 'at_ms' is missing");
    }
    if ((reading->wait_ms != SCENARIO_NO_TIME) && !reading->has_after) {
        return yaml_reader_fail(reader, node, "a step: 'wait' needs 'after'");
    }
    if ((reading->again_until_ms != SCENARIO_NO_TIME) && (reading->again_every_ms == SCENARIO_NO_TIME)) {
        return yaml_reader_fail(reader, node, "a step: 'again_until_ms' needs 'again_every_ms'");
    }
    if (!is_absolute) {
        reading->at_ms = (reading->wait_ms != SCENARIO_NO_TIME) ? reading->wait_ms : 0;
    }
    reading->again_every_ms = (reading->again_every_ms != SCENARIO_NO_TIME) ? reading->again_every_ms : 0;
    return true;
}

bool scenario_read_step_keys(const yaml_reader_t *reader, const yaml_node_t *node, scenario_reading_t *reading) {
    *reading = (scenario_reading_t){.node = node,
                                    .at_ms = SCENARIO_NO_TIME,
                                    .wait_ms = SCENARIO_NO_TIME,
                                    .again_every_ms = SCENARIO_NO_TIME,
                                    .again_until_ms = SCENARIO_NO_TIME,
                                    .actor = ACTOR_NONE};
    if (node->type != YAML_MAPPING_NODE) {
        return yaml_reader_fail(reader, node, "a step must be like {at_ms: 5000, ai: stop}");
    }
    for (const yaml_node_pair_t *pair = node->data.mapping.pairs.start; pair < node->data.mapping.pairs.top; pair++) {
        if (!take_key(reader, yaml_document_get_node(reader->document, pair->key),
                      yaml_document_get_node(reader->document, pair->value), reading)) {
            return false;
        }
    }
    if (!times_fit(reader, reading)) {
        return false;
    }
    return (reading->actor != ACTOR_NONE) ||
           yaml_reader_fail(reader, node,
                            "a step: the actor is missing (vcu, eps, ai, operator, bus, supervisor or board)");
}

/* Scenario files: the top level. */
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "common/report.h"
#include "config/config_file.h"
#include "io/yaml_file.h"
#include "scenario/parse/scenario_parse.h"
#include "scenario/parse/scenario_requirements.h"
#include "text/suggest.h"
#include "text/text.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
/* The first identifier of a vehicle that has those of the configuration. */
#define AS_CONFIGURED UINT16_MAX

enum { TICK_PHASE_MAX_US = 999 };

const yaml_word_t SCENARIO_GEARS[] = {
    {"P", AGV_GEAR_P}, {"R", AGV_GEAR_R}, {"N", AGV_GEAR_N}, {"D", AGV_GEAR_D}, {NULL, 0}};
const yaml_word_t SCENARIO_SIDES[] = {{"vehicle", HAL_CAN_VEHICLE}, {"ai", HAL_CAN_AI}, {NULL, 0}};
const yaml_word_t SCENARIO_ID_SETS[] = {{"heading", AGV_ID_SET_HEADING}, {"table", AGV_ID_SET_TABLE}, {NULL, 0}};
const yaml_word_t SCENARIO_CAUSES[] = {{"power-on", HAL_RESET_POWER_ON},
                                       {"watchdog", HAL_RESET_WATCHDOG},
                                       {"brown-out", HAL_RESET_BROWN_OUT},
                                       {"lock-up", HAL_RESET_LOCK_UP},
                                       {"software", HAL_RESET_SOFTWARE},
                                       {"unknown", HAL_RESET_UNKNOWN},
                                       {NULL, 0}};

bool scenario_parse_time(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t *ms) {
    return scenario_parse_ms(reader, node, what, 0, SCENARIO_DURATION_MAX_MS, ms);
}

bool scenario_parse_ms(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t lowest,
                       uint32_t highest, uint32_t *ms) {
    int64_t value = 0;

    if (!yaml_reader_time(reader, node, what, DURATION_MS, lowest, highest, &value)) {
        return false;
    }
    *ms = (uint32_t)value;
    return true;
}

bool scenario_parse_message(const yaml_reader_t *reader, const yaml_node_t *node, agv_message_t *message) {
    const char *text = yaml_reader_text(reader, node, "message");

    if (text == NULL) {
        return false;
    }
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        if (strcmp(agv_message_name((agv_message_t)m), text) == 0) {
            *message = (agv_message_t)m;
            return true;
        }
    }
    char meant[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin(text, strlen(text));
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        const char *name = agv_message_name((agv_message_t)m);
        suggest_offer(&suggestion, name, strlen(name));
    }
    return yaml_reader_fail(reader, node, "message: unknown message '%.40s'%s", text, suggest_text(&suggestion, meant));
}

bool scenario_parse_fault(const yaml_reader_t *reader, const yaml_node_t *node, agv_fault_t *fault) {
    const char *text = yaml_reader_text(reader, node, "fault");

    if (text == NULL) {
        return false;
    }
    *fault = agv_fault_from_name(text);
    if (*fault != AGV_FAULT_NONE) {
        return true;
    }
    char meant[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin(text, strlen(text));
    for (uint32_t i = 0; i < AGV_FAULT_COUNT; i++) {
        const char *name = agv_fault_name((agv_fault_t)i);
        suggest_offer(&suggestion, name, strlen(name));
    }
    return yaml_reader_fail(reader, node, "unknown fault '%.40s'%s", text, suggest_text(&suggestion, meant));
}

static bool read_name(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_t *scenario = target;
    const char *text = yaml_reader_text(reader, node, "name");

    if (text == NULL) {
        return false;
    }
    if (strlen(text) >= sizeof scenario->name) {
        return yaml_reader_fail(reader, node, "name: longer than %u bytes", SCENARIO_TEXT_MAX - 1);
    }
    if (!text_is_one_line(text)) {
        return yaml_reader_fail(reader, node, "name: must be one line of text");
    }
    (void)strcpy(scenario->name, text);
    return true;
}

static bool read_shown(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_t *scenario = target;
    const char *text = yaml_reader_text(reader, node, "shows");

    if (text == NULL) {
        return false;
    }
    if (scenario->shows_count == SCENARIO_SHOWS_MAX) {
        return yaml_reader_fail(reader, node, "shows: more than %u entries", SCENARIO_SHOWS_MAX);
    }
    if (!scenario_is_requirement(text) && (agv_fault_from_name(text) == AGV_FAULT_NONE)) {
        return yaml_reader_fail(reader, node,
                                "shows: '%.40s' is neither a requirement of docs/requirements.md or docs/protocol.md "
                                "nor a fault",
                                text);
    }
    (void)snprintf(scenario->shows[scenario->shows_count], SCENARIO_TEXT_MAX, "%s", text);
    scenario->shows_count++;
    return true;
}

static bool read_shows(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_list(reader, node, "shows", read_shown, target) &&
           ((((const scenario_t *)target)->shows_count > 0) ||
            yaml_reader_fail(reader, node, "shows: give at least one requirement or fault"));
}

static bool read_description(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    (void)target;
    return yaml_reader_text(reader, node, "description") != NULL;
}

static bool read_config(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_t *scenario = target;
    const uint16_t topology = scenario->config.topology;
    const uint16_t id_set = scenario->config.id_set;

    if (!config_read_mapping(reader->document, node, &scenario->config, &scenario->lines)) {
        return false;
    }
    scenario->config.topology = topology;
    scenario->config.id_set = id_set;
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const char *name = agv_setting_info(i)->name;
        if ((scenario->lines.settings[i] != 0) && ((strcmp(name, "topology") == 0) || (strcmp(name, "id_set") == 0))) {
            return report_at(reader->file, scenario->lines.settings[i], "%s: belongs to the top level of the file",
                             name);
        }
    }
    return true;
}

static bool read_vehicle(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_vehicle_config(reader, node, &((scenario_t *)target)->vehicle);
}

static const yaml_word_t TOPOLOGIES[] = {{"shared", AGV_TOPOLOGY_SHARED}, {"gateway", AGV_TOPOLOGY_GATEWAY}, {NULL, 0}};
static const yaml_word_t BITRATES[] = {
    {"125000", 125000}, {"250000", 250000}, {"500000", 500000}, {"1000000", 1000000}, {NULL, 0}};
static const yaml_word_t WATCHDOGS[] = {{"fitted", 0}, {"none", -1}, {NULL, 0}}; /* -1: UINT32_MAX ms */

#define MEMBER(kind, key, ...) YAML_##kind(key, scenario_t, __VA_ARGS__)

static const char *fault_name(size_t index) {
    return (index < AGV_FAULT_COUNT) ? agv_fault_name((agv_fault_t)index) : NULL;
}

static const char *message_name(size_t index) {
    return (index < AGV_MSG_COUNT) ? agv_message_name((agv_message_t)index) : NULL;
}

const yaml_shape_t SCENARIO_MESSAGE_SHAPE = {.kind = YAML_KIND_NAMES, .name = message_name};
const yaml_shape_t SCENARIO_FAULT_SHAPE = {.kind = YAML_KIND_NAMES, .name = fault_name};
static const yaml_shape_t NAME = {.kind = YAML_KIND_TEXT, .highest = SCENARIO_TEXT_MAX - 1};
static const yaml_shape_t SHOWN = {
    .kind = YAML_KIND_NAMES, .name = scenario_requirement, .other = &SCENARIO_FAULT_SHAPE};
static const yaml_shape_t SHOWS = {.kind = YAML_KIND_LIST, .items = &SHOWN, .lowest = 1, .highest = SCENARIO_SHOWS_MAX};
static const yaml_shape_t STEPS = {.kind = YAML_KIND_LIST, .highest = SCENARIO_STEPS_MAX};

static const yaml_key_t TOP[] = {
    YAML_REQUIRED(YAML_CALL("name", read_name, &NAME)),
    YAML_REQUIRED(YAML_CALL("shows", read_shows, &SHOWS)),
    YAML_OPTIONAL(YAML_CALL("description", read_description, &SCENARIO_TEXT_SHAPE)),
    YAML_OPTIONAL(MEMBER(WORD, "topology", config.topology, TOPOLOGIES), YAML_GIVEN(scenario_t, fixes_topology)),
    YAML_OPTIONAL(MEMBER(WORD, "id_set", config.id_set, SCENARIO_ID_SETS), YAML_GIVEN(scenario_t, fixes_id_set)),
    YAML_OPTIONAL(YAML_CALL("config", read_config, NULL)),
    YAML_OPTIONAL(MEMBER(FLAG, "config_unchecked", config_unchecked)),
    YAML_OPTIONAL(YAML_CALL("self_test", scenario_parse_self_test, &SCENARIO_SELF_TEST_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("board", scenario_parse_board, &SCENARIO_BOARD_SHAPE)),
    YAML_OPTIONAL(MEMBER(WORD, "bitrate", bitrate, BITRATES)),
    YAML_OPTIONAL(MEMBER(TIME, "clock_start_ms", clock_start_ms, 0, UINT32_MAX)),
    YAML_OPTIONAL(MEMBER(TIME_US, "tick_phase_us", tick_phase_us, 0, TICK_PHASE_MAX_US)),
    YAML_OPTIONAL(MEMBER(WORD, "hardware_watchdog", watchdog_ms, WATCHDOGS)),
    YAML_OPTIONAL(MEMBER(WORD, "reset_cause", reset_cause, SCENARIO_CAUSES)),
    YAML_OPTIONAL(YAML_CALL("vehicle", read_vehicle, &SCENARIO_VEHICLE_SHAPE)),
    YAML_REQUIRED(MEMBER(TIME, "duration_ms", duration_ms, 1, SCENARIO_DURATION_MAX_MS)),
    YAML_OPTIONAL(YAML_CALL("steps", scenario_parse_steps, &STEPS)),
    YAML_REQUIRED(YAML_CALL("expect", scenario_parse_expect, &SCENARIO_EXPECT_SHAPE)),
};

const yaml_shape_t SCENARIO_SHAPE = {YAML_MAP_SHAPE(TOP)};

static void preset(scenario_t *scenario, const scenario_options_t *options) {
    memset(scenario, 0, sizeof *scenario);
    agv_config_defaults(&scenario->config);
    if (options != NULL) {
        scenario->config = options->config;
        scenario->config.topology = (options->topology >= 0) ? (uint16_t)options->topology : options->config.topology;
        scenario->config.id_set = (options->id_set >= 0) ? (uint16_t)options->id_set : options->config.id_set;
    }
    scenario->bitrate = SCENARIO_DEFAULT_BITRATE;
    scenario->reset_cause = HAL_RESET_POWER_ON;
    vehicle_defaults(&scenario->vehicle);
    scenario->vehicle.ids.of[0] = AS_CONFIGURED;
}

/** What the file fixes, the command line cannot change. */
static bool agrees(const scenario_t *scenario, const char *file, const scenario_options_t *options) {
    if (scenario->fixes_topology && (options->topology >= 0) && (options->topology != (int)scenario->config.topology)) {
        return report("%s: the file fixes the topology, --topology names another", file);
    }
    if (scenario->fixes_id_set && (options->id_set >= 0) && (options->id_set != (int)scenario->config.id_set)) {
        return report("%s: the file fixes the ID set, --id-set names another", file);
    }
    return true;
}

/** What lies after the end would never be seen. */
static bool is_before_end(const scenario_t *scenario, const char *file, size_t line, uint32_t at_ms) {
    return (at_ms <= scenario->duration_ms) || report_at(file, line, "%u ms is after the end (duration_ms: %u)",
                                                         (unsigned)at_ms, (unsigned)scenario->duration_ms);
}

static bool steps_fit(const scenario_t *scenario, const char *file) {
    uint32_t last_ms = 0; /* of those that wait for no event */

    for (size_t i = 0; i < scenario->step_count; i++) {
        const scenario_step_t *step = &scenario->steps[i];
        if (!is_before_end(scenario, file, step->line, step->at_ms)) {
            return false;
        }
        if (step->after.kind != SCENARIO_FROM_START) {
            continue;
        }
        if (step->at_ms < last_ms) {
            return report_at(file, step->line, "the step is earlier than the one before it");
        }
        last_ms = step->at_ms;
    }
    return true;
}

static bool expectations_fit(const scenario_t *scenario, const char *file) {
    const scenario_expect_t *expect = &scenario->expect;
    bool good = true;

    for (size_t i = 0; good && (i < expect->vehicle.count); i++) {
        good = is_before_end(scenario, file, expect->vehicle.items[i].line, expect->vehicle.items[i].at_ms.to);
    }
    for (size_t i = 0; good && (i < expect->leds.count); i++) {
        good = is_before_end(scenario, file, expect->leds.items[i].line, expect->leds.items[i].at_ms.to);
    }
    for (size_t i = 0; good && (i < expect->frames.count); i++) {
        good = is_before_end(scenario, file, expect->frames.items[i].line, expect->frames.items[i].at_ms.to);
    }
    for (size_t i = 0; good && (i < expect->never.count); i++) {
        good = is_before_end(scenario, file, expect->never.items[i].line, expect->never.items[i].at_ms.from);
    }
    return good;
}

static bool read_document(scenario_t *scenario, yaml_document_t *document, const char *file) {
    const yaml_reader_t reader = {.file = file, .document = document};
    const yaml_node_t *root = yaml_document_get_root_node(document);

    if (root == NULL) {
        return report("%s: contains no scenario", file);
    }
    if (!yaml_reader_map(&reader, root, "a scenario", TOP, COUNT(TOP), scenario) || !steps_fit(scenario, file) ||
        !expectations_fit(scenario, file)) {
        return false;
    }
    scenario->vehicle.gateway = scenario->config.topology == AGV_TOPOLOGY_GATEWAY;
    agv_config_ids(&scenario->config, &scenario->ids);
    if (scenario->vehicle.ids.of[0] == AS_CONFIGURED) {
        scenario->vehicle.ids = scenario->ids;
    }
    return true;
}

/** Read what was loaded, and free it. */
static bool read_loaded(scenario_t *scenario, const char *file, yaml_document_t *document,
                        const scenario_options_t *options) {
    scenario->lines.path = file;
    const bool good = read_document(scenario, document, file);

    yaml_document_delete(document);
    return good && ((options == NULL) || agrees(scenario, file, options)) &&
           (scenario->config_unchecked || config_check(&scenario->config, &scenario->lines));
}

bool scenario_read(scenario_t *scenario, const char *file, const scenario_options_t *options) {
    yaml_document_t document;

    preset(scenario, options);
    return yaml_file_load(file, &document) && read_loaded(scenario, file, &document, options);
}

bool scenario_read_text(scenario_t *scenario, const char *name, const char *text, const scenario_options_t *options) {
    yaml_document_t document;

    preset(scenario, options);
    return yaml_text_load(name, text, &document) && read_loaded(scenario, name, &document, options);
}

uint32_t scenario_frame_id(const scenario_t *scenario, const scenario_frame_t *frame) {
    if (frame->message == AGV_MSG_NONE) {
        return frame->id;
    }
    return scenario->ids.of[frame->message];
}

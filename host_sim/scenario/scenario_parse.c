/* Scenario files: the top level. */
#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "config/config_file.h"
#include "io/report.h"
#include "io/yaml_file.h"
#include "scenario/scenario_parse.h"

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

/** What the file holds is read into this. */
typedef struct {
    scenario_t *scenario;
    config_lines_t lines;
} reading_t;

bool scenario_parse_u32(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t lowest,
                        uint32_t highest, uint32_t *number) {
    int64_t value = 0;

    if (!yaml_reader_number(reader, node, what, lowest, highest, &value)) {
        return false;
    }
    *number = (uint32_t)value;
    return true;
}

bool scenario_parse_time(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t *ms) {
    return scenario_parse_u32(reader, node, what, 0u, SCENARIO_DURATION_MAX_MS, ms);
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
    return yaml_reader_fail(reader, node, "message: '%.40s' is no message of the protocol", text);
}

bool scenario_parse_fault(const yaml_reader_t *reader, const yaml_node_t *node, agv_fault_t *fault) {
    const char *text = yaml_reader_text(reader, node, "fault");

    if (text == NULL) {
        return false;
    }
    *fault = agv_fault_from_name(text);
    return (*fault != AGV_FAULT_NONE) || yaml_reader_fail(reader, node, "'%.40s' is no fault", text);
}

static bool read_name(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_t *scenario = ((reading_t *)target)->scenario;
    const char *text = yaml_reader_text(reader, node, "name");

    if (text == NULL) {
        return false;
    }
    if (strlen(text) >= sizeof scenario->name) {
        return yaml_reader_fail(reader, node, "name: longer than %u bytes", SCENARIO_TEXT_MAX - 1u);
    }
    (void)strcpy(scenario->name, text);
    return true;
}

/** "SUP-2", "P15", "FSM-10": capital letters, a dash or none, digits. */
static bool is_requirement(const char *text) {
    size_t letters = 0u;
    size_t digits = 0u;

    while (isupper((unsigned char)text[letters]) != 0) {
        letters++;
    }
    const size_t dash = (text[letters] == '-') ? 1u : 0u;
    while (isdigit((unsigned char)text[letters + dash + digits]) != 0) {
        digits++;
    }
    return (letters > 0u) && (digits > 0u) && (text[letters + dash + digits] == '\0');
}

static bool read_shown(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_t *scenario = ((reading_t *)target)->scenario;
    const char *text = yaml_reader_text(reader, node, "shows");

    if (text == NULL) {
        return false;
    }
    if (scenario->shows_count == SCENARIO_SHOWS_MAX) {
        return yaml_reader_fail(reader, node, "shows: more than %u", SCENARIO_SHOWS_MAX);
    }
    if (!is_requirement(text) && (agv_fault_from_name(text) == AGV_FAULT_NONE)) {
        return yaml_reader_fail(reader, node, "shows: '%.40s' is neither a requirement such as SUP-2 nor a fault",
                                text);
    }
    (void)snprintf(scenario->shows[scenario->shows_count], SCENARIO_TEXT_MAX, "%s", text);
    scenario->shows_count++;
    return true;
}

static bool read_shows(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_list(reader, node, "shows", read_shown, target);
}

static bool read_description(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    (void)target;
    return yaml_reader_text(reader, node, "description") != NULL;
}

static bool read_topology(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_word_t words[] = {{"shared", AGV_TOPOLOGY_SHARED}, {"gateway", AGV_TOPOLOGY_GATEWAY}, {NULL, 0}};
    scenario_t *scenario = ((reading_t *)target)->scenario;
    int value = 0;

    scenario->fixes_topology = true;
    if (!yaml_reader_word(reader, node, "topology", words, &value)) {
        return false;
    }
    scenario->config.topology = (uint16_t)value;
    return true;
}

static bool read_id_set(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_t *scenario = ((reading_t *)target)->scenario;
    int value = 0;

    scenario->fixes_id_set = true;
    if (!yaml_reader_word(reader, node, "id_set", SCENARIO_ID_SETS, &value)) {
        return false;
    }
    scenario->config.id_set = (uint16_t)value;
    return true;
}

static bool read_config(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    reading_t *reading = target;
    const uint16_t topology = reading->scenario->config.topology;
    const uint16_t id_set = reading->scenario->config.id_set;

    if (!config_read_mapping(reader->document, node, &reading->scenario->config, &reading->lines)) {
        return false;
    }
    reading->scenario->config.topology = topology;
    reading->scenario->config.id_set = id_set;
    for (uint16_t i = 0u; i < AGV_SETTING_COUNT; i++) {
        const char *name = agv_setting_info(i)->name;
        if ((reading->lines.settings[i] != 0u) && ((strcmp(name, "topology") == 0) || (strcmp(name, "id_set") == 0))) {
            return report_at(reader->file, reading->lines.settings[i], "%s: belongs to the top level of the file",
                             name);
        }
    }
    return true;
}

static bool read_unchecked(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_bool(reader, node, "config_unchecked", &((reading_t *)target)->scenario->config_unchecked);
}

static bool read_self_test(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_word_t words[] = {{"passed", 1}, {"failed", 0}, {NULL, 0}};
    int value = 0;

    if (!yaml_reader_word(reader, node, "self_test", words, &value)) {
        return false;
    }
    ((reading_t *)target)->scenario->self_test_passed = value != 0;
    return true;
}

static bool read_bitrate(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_word_t words[] = {
        {"125000", 125000}, {"250000", 250000}, {"500000", 500000}, {"1000000", 1000000}, {NULL, 0}};
    int value = 0;

    if (!yaml_reader_word(reader, node, "bitrate", words, &value)) {
        return false;
    }
    ((reading_t *)target)->scenario->bitrate = (uint32_t)value;
    return true;
}

static bool read_clock(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_u32(reader, node, "clock_start_ms", 0u, UINT32_MAX,
                              &((reading_t *)target)->scenario->clock_start_ms);
}

static bool read_tick_phase(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    uint32_t us = 0u;

    if (!scenario_parse_u32(reader, node, "tick_phase_us", 0u, TICK_PHASE_MAX_US, &us)) {
        return false;
    }
    ((reading_t *)target)->scenario->tick_phase_us = (uint16_t)us;
    return true;
}

static bool read_watchdog(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_word_t words[] = {{"fitted", 0}, {"none", 1}, {NULL, 0}};
    int value = 0;

    if (!yaml_reader_word(reader, node, "hardware_watchdog", words, &value)) {
        return false;
    }
    ((reading_t *)target)->scenario->watchdog_ms = (value != 0) ? UINT32_MAX : 0u;
    return true;
}

static bool read_cause(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    int value = 0;

    if (!yaml_reader_word(reader, node, "reset_cause", SCENARIO_CAUSES, &value)) {
        return false;
    }
    ((reading_t *)target)->scenario->reset_cause = (hal_reset_cause_t)value;
    return true;
}

static bool read_duration(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_u32(reader, node, "duration_ms", 1u, SCENARIO_DURATION_MAX_MS,
                              &((reading_t *)target)->scenario->duration_ms);
}

static bool read_vehicle(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_vehicle_config(reader, node, &((reading_t *)target)->scenario->vehicle);
}

static bool read_steps(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_steps(reader, node, ((reading_t *)target)->scenario);
}

static bool read_expect(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_expect(reader, node, ((reading_t *)target)->scenario);
}

static const yaml_key_t TOP[] = {
    {"name", read_name, true},
    {"shows", read_shows, true},
    {"description", read_description, false},
    {"topology", read_topology, false},
    {"id_set", read_id_set, false},
    {"config", read_config, false},
    {"config_unchecked", read_unchecked, false},
    {"self_test", read_self_test, false},
    {"bitrate", read_bitrate, false},
    {"clock_start_ms", read_clock, false},
    {"tick_phase_us", read_tick_phase, false},
    {"hardware_watchdog", read_watchdog, false},
    {"reset_cause", read_cause, false},
    {"vehicle", read_vehicle, false},
    {"duration_ms", read_duration, true},
    {"steps", read_steps, false},
    {"expect", read_expect, true},
};

static void preset(scenario_t *scenario, const scenario_options_t *options) {
    memset(scenario, 0, sizeof *scenario);
    scenario->config = options->config;
    scenario->config.topology = (options->topology >= 0) ? (uint16_t)options->topology : options->config.topology;
    scenario->config.id_set = (options->id_set >= 0) ? (uint16_t)options->id_set : options->config.id_set;
    scenario->self_test_passed = true;
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
    return (at_ms <= scenario->duration_ms) || report_at(file, line, "%u ms lies after the end (duration_ms: %u)",
                                                         (unsigned)at_ms, (unsigned)scenario->duration_ms);
}

static bool steps_fit(const scenario_t *scenario, const char *file) {
    for (size_t i = 0u; i < scenario->step_count; i++) {
        const scenario_step_t *step = &scenario->steps[i];
        if (!is_before_end(scenario, file, step->line, step->at_ms)) {
            return false;
        }
        if ((i > 0u) && (step->at_ms < scenario->steps[i - 1u].at_ms)) {
            return report_at(file, step->line, "the step is earlier than the one before it");
        }
    }
    return true;
}

static bool expectations_fit(const scenario_t *scenario, const char *file) {
    const scenario_expect_t *expect = &scenario->expect;
    bool good = true;

    for (size_t i = 0u; good && (i < expect->vehicle.count); i++) {
        good = is_before_end(scenario, file, expect->vehicle.items[i].line, expect->vehicle.items[i].at_ms);
    }
    for (size_t i = 0u; good && (i < expect->leds.count); i++) {
        good = is_before_end(scenario, file, expect->leds.items[i].line, expect->leds.items[i].at_ms.to);
    }
    for (size_t i = 0u; good && (i < expect->frames.count); i++) {
        good = is_before_end(scenario, file, expect->frames.items[i].line, expect->frames.items[i].at_ms.to);
    }
    for (size_t i = 0u; good && (i < expect->never.count); i++) {
        good = is_before_end(scenario, file, expect->never.items[i].line, expect->never.items[i].at_ms.from);
    }
    return good;
}

static bool read_document(reading_t *reading, yaml_document_t *document, const char *file) {
    const yaml_reader_t reader = {.file = file, .document = document};
    const yaml_node_t *root = yaml_document_get_root_node(document);
    scenario_t *scenario = reading->scenario;

    if (root == NULL) {
        return report("%s: there is no scenario in it", file);
    }
    if (!yaml_reader_map(&reader, root, "a scenario", TOP, COUNT(TOP), reading) || !steps_fit(scenario, file) ||
        !expectations_fit(scenario, file)) {
        return false;
    }
    scenario->vehicle.gateway = scenario->config.topology == (uint16_t)AGV_TOPOLOGY_GATEWAY;
    agv_config_ids(&scenario->config, &scenario->ids);
    if (scenario->vehicle.ids.of[0] == AS_CONFIGURED) {
        scenario->vehicle.ids = scenario->ids;
    }
    return true;
}

/** Read what was loaded, and free it. */
static bool read_loaded(scenario_t *scenario, const char *file, yaml_document_t *document,
                        const scenario_options_t *options) {
    reading_t reading = {.scenario = scenario, .lines = {.path = file}};
    const bool good = read_document(&reading, document, file);

    yaml_document_delete(document);
    return good && agrees(scenario, file, options) &&
           (scenario->config_unchecked || config_check(&scenario->config, &reading.lines));
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

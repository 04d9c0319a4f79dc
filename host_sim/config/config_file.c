#include "config/config_file.h"

#include <ctype.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "common/report.h"
#include "config/config_text.h"
#include "io/yaml_file.h"
#include "text/duration.h"
#include "text/suggest.h"
#include "text/words.h"

enum { HEX_DIGITS_MAX = 8, CLASS_WORD_TRIP = 0, CLASS_WORD_WARN = 1, REASON_SIZE = 80 };

#define CLASS_WORDS "trip|warn"
#define SWITCH_WORDS "off|on"
#define SWITCH_BOOLEANS "false|true"

/** What is being read. */
typedef struct {
    agv_config_t *config;
    config_lines_t *lines;
    const char *key;
    size_t line;
    const yaml_node_t *value;
} reading_t;

static bool report_key(const reading_t *reading, const char *reason) {
    return report_at(reading->lines->path, reading->line, "%s: %s", reading->key, reason);
}

void config_class_key(agv_fault_t fault, char key[CONFIG_CLASS_KEY_SIZE]) {
    (void)snprintf(key, CONFIG_CLASS_KEY_SIZE, "class_%s", agv_fault_name(fault));
    for (char *at = key; *at != '\0'; at++) {
        *at = (char)tolower((unsigned char)*at);
    }
}

/** Read a number as YAML writes it: decimal, or hexadecimal with 0x and up to 8 digits. */
static bool read_number(const char *text, uint64_t *number) {
    if ((text[0] != '0') || (text[1] == '\0')) {
        return words_decimal(text, 0, UINT64_MAX, number);
    }
    const size_t length = strlen(&text[2]);
    return (text[1] == 'x') && (length <= HEX_DIGITS_MAX) && words_hex(&text[2], length, number);
}

/** Read a time that is more than a number of milliseconds. */
static bool take_time(const reading_t *reading, const char *text, const agv_setting_info_t *info, uint64_t *number) {
    char problem[DURATION_PROBLEM_SIZE];
    const duration_result_t result = duration_read(text, DURATION_MS, info->lowest, info->highest, number);
    return (result == DURATION_OK) ||
           report_key(reading, duration_problem(result, text, DURATION_MS, info->lowest, info->highest, problem));
}

/** Read a number by the kind of its setting. @return false: reported */
static bool read_value(const reading_t *reading, const char *text, const agv_setting_info_t *info, uint64_t *number) {
    if (config_is_id(info)) {
        return words_id(text, number) ||
               report_at(reading->lines->path, reading->line,
                         "%s: '%s' is not an identifier: 168h, 0x168, or decimal 360", reading->key, text);
    }
    if (read_number(text, number)) {
        return true;
    }
    const bool is_octal = (text[0] == '0') && (text[strspn(text, "0123456789")] == '\0');
    if ((strcmp(info->unit, "ms") == 0) && !is_octal) {
        return take_time(reading, text, info, number);
    }
    return report_at(reading->lines->path, reading->line, "%s: '%s' is not a whole number; %u to %u%s%s", reading->key,
                     text, info->lowest, info->highest, (info->unit[0] != '\0') ? " " : "", info->unit);
}

static bool take_number(const reading_t *reading, uint16_t setting, const agv_setting_info_t *info) {
    const char *text = yaml_node_plain(reading->value);
    uint64_t number = 0;
    if (text == NULL) {
        return report_key(reading, "write the number without quotes");
    }
    if (!read_value(reading, text, info, &number)) {
        return false;
    }
    if ((number < info->lowest) || (number > info->highest)) {
        if (config_is_id(info)) {
            return report_at(reading->lines->path, reading->line, "%s: %s is not within %03Xh to %03Xh", reading->key,
                             text, info->lowest, info->highest);
        }
        return report_at(reading->lines->path, reading->line, "%s: %" PRIu64 " is not within %u to %u%s%s",
                         reading->key, number, info->lowest, info->highest, (info->unit[0] != '\0') ? " " : "",
                         info->unit);
    }
    return agv_config_set(reading->config, setting, (uint16_t)number);
}

/** Read one of the words. @return its index; -1: reported. */
static int take_word(const reading_t *reading, const char *words) {
    const char *text = yaml_node_text(reading->value);
    int index = words_find(words, text);
    if ((index < 0) && (strcmp(words, SWITCH_WORDS) == 0)) {
        index = words_find(SWITCH_BOOLEANS, text); /* how YAML writers put off and on */
    }
    if (index < 0) {
        char meant[SUGGEST_SIZE];
        (void)report_at(reading->lines->path, reading->line, "%s: '%s' is not one of %s%s", reading->key, text, words,
                        suggest_from(words, text, meant));
    }
    return index;
}

static bool note_line(const reading_t *reading, size_t *line) {
    if (*line != 0) {
        return report_at(reading->lines->path, reading->line, "%s: already set on line %zu", reading->key, *line);
    }
    *line = reading->line;
    const char *text = yaml_node_text(reading->value);
    if (text == NULL) {
        return report_key(reading, (reading->value->type == YAML_SCALAR_NODE)
                                       ? "contains a NUL character"
                                       : "needs one value, not a list or a mapping");
    }
    return (text[0] != '\0') ? true : report_key(reading, "has no value");
}

static bool take_setting(const reading_t *reading, uint16_t setting) {
    const agv_setting_info_t *info = agv_setting_info(setting);
    if (!note_line(reading, &reading->lines->settings[setting])) {
        return false;
    }
    if (info->words == NULL) {
        return take_number(reading, setting, info);
    }
    int index = take_word(reading, info->words);
    return (index >= 0) && agv_config_set(reading->config, setting, (uint16_t)index);
}

static bool take_class(const reading_t *reading, agv_fault_t fault) {
    if (!note_line(reading, &reading->lines->classes[fault])) {
        return false;
    }
    int index = take_word(reading, CLASS_WORDS);
    if (index == CLASS_WORD_TRIP) {
        agv_fault_set_put(&reading->config->trips, fault, true);
    } else if (index == CLASS_WORD_WARN) {
        agv_fault_set_put(&reading->config->trips, fault, false);
    }
    return index >= 0;
}

static bool report_unknown_key(const reading_t *reading) {
    char keys[AGV_FAULT_COUNT][CONFIG_CLASS_KEY_SIZE];
    char meant[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin(reading->key, strlen(reading->key));
    for (uint16_t setting = 0; setting < AGV_SETTING_COUNT; setting++) {
        const char *name = agv_setting_info(setting)->name;
        suggest_offer(&suggestion, name, strlen(name));
    }
    for (uint32_t fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        config_class_key((agv_fault_t)fault, keys[fault]);
        suggest_offer(&suggestion, keys[fault], strlen(keys[fault]));
    }
    return report_at(reading->lines->path, reading->line, "%s: unknown setting%s", reading->key,
                     suggest_text(&suggestion, meant));
}

static bool take_pair(const reading_t *reading) {
    for (uint16_t setting = 0; setting < AGV_SETTING_COUNT; setting++) {
        if (strcmp(agv_setting_info(setting)->name, reading->key) == 0) {
            return take_setting(reading, setting);
        }
    }
    for (uint32_t fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        char key[CONFIG_CLASS_KEY_SIZE];
        config_class_key((agv_fault_t)fault, key);
        if (strcmp(key, reading->key) == 0) {
            return take_class(reading, (agv_fault_t)fault);
        }
    }
    return report_unknown_key(reading);
}

bool config_read_mapping(yaml_document_t *document, const yaml_node_t *mapping, agv_config_t *config,
                         config_lines_t *lines) {
    if (mapping->type != YAML_MAPPING_NODE) {
        return report_at(lines->path, yaml_node_line(mapping), "not a list of settings: a line is 'setting: value'");
    }
    bool good = true;
    for (const yaml_node_pair_t *pair = mapping->data.mapping.pairs.start;
         good && (pair < mapping->data.mapping.pairs.top); pair++) {
        const yaml_node_t *key = yaml_document_get_node(document, pair->key);
        const reading_t reading = {.config = config,
                                   .lines = lines,
                                   .key = yaml_node_text(key),
                                   .line = yaml_node_line(key),
                                   .value = yaml_document_get_node(document, pair->value)};
        good = (reading.key != NULL) ? take_pair(&reading)
                                     : report_at(lines->path, reading.line, "the name of a setting must be a word");
    }
    return good;
}

static bool take_root(yaml_document_t *document, agv_config_t *config, config_lines_t *lines) {
    const yaml_node_t *root = yaml_document_get_root_node(document);
    const char *text = (root != NULL) ? yaml_node_plain(root) : NULL;
    const bool is_marker = (text != NULL) && (text[0] == '\0');
    if ((root == NULL) || is_marker) {
        return true; /* nothing but comments, or a '---': the defaults */
    }
    return config_read_mapping(document, root, config, lines);
}

bool config_file_load(const char *path, agv_config_t *config, config_lines_t *lines) {
    (void)memset(lines, 0, sizeof *lines);
    lines->path = path;
    yaml_document_t document;
    if (!yaml_file_load(path, &document)) {
        return false;
    }
    bool good = take_root(&document, config, lines);
    yaml_document_delete(&document);
    return good;
}

static bool report_setting(const config_lines_t *lines, size_t line, const char *key, const char *reason) {
    if ((lines->path == NULL) || (line == 0)) {
        return report("%s: %s", key, reason);
    }
    return report_at(lines->path, line, "%s: %s", key, reason);
}

/** Of two settings with an identifier, the other one. The status frame may have no identifier of either set. */
static uint16_t other_of(const agv_ids_t *ids, uint16_t id, uint16_t blamed) {
    const bool is_status = blamed == (uint16_t)AGV_SETTING_status_frame_id;
    uint16_t other = (uint16_t)AGV_SETTING_status_frame_id;
    for (uint16_t i = 0; i < AGV_MSG_COUNT; i++) {
        const uint16_t setting = (uint16_t)((uint16_t)AGV_SETTING_ID + i);
        const bool is_of_a_set =
            (agv_message_id(i, AGV_ID_SET_HEADING) == id) || (agv_message_id(i, AGV_ID_SET_TABLE) == id);
        const bool has_it = (ids->of[i] == id) || (is_status && is_of_a_set);
        other = (has_it && (setting != blamed)) ? setting : other;
    }
    return other;
}

/** The setting of the file that gives a message the identifier of another. */
static bool blame_twice(const agv_config_t *config, const config_lines_t *lines, uint16_t setting) {
    agv_ids_t ids;
    agv_config_ids(config, &ids);
    const bool is_status = setting == (uint16_t)AGV_SETTING_status_frame_id;
    const uint16_t id = is_status ? config->status_frame_id : ids.of[setting - (uint16_t)AGV_SETTING_ID];
    uint16_t blamed = setting;
    for (uint16_t i = 0; (lines->settings[blamed] == 0) && (i < AGV_MSG_COUNT); i++) {
        blamed = (ids.of[i] == id) ? (uint16_t)((uint16_t)AGV_SETTING_ID + i) : blamed;
    }
    const uint16_t other = other_of(&ids, id, blamed);
    char reason[REASON_SIZE];
    (void)snprintf(reason, sizeof reason, "another message has this identifier: %s", agv_setting_info(other)->name);
    return report_setting(lines, lines->settings[blamed], agv_setting_info(blamed)->name, reason);
}

static const char NEEDS_GATEWAY[] = "has no effect on a shared bus; this value needs the gateway topology";

/** The setting of the file because of which no press would reset. */
static bool blame_press(const config_lines_t *lines) {
    const size_t longest = lines->settings[AGV_SETTING_reset_hold_max_ms];
    const size_t shortest = lines->settings[AGV_SETTING_reset_hold_ms];
    if ((longest == 0) && (shortest != 0)) {
        return report_setting(lines, shortest, "reset_hold_ms", "must be below reset_hold_max_ms");
    }
    return report_setting(lines, longest, "reset_hold_max_ms", "must be above reset_hold_ms");
}

/** Why a fault must keep its default class. */
static const char *class_reason(agv_fault_t fault) {
    if ((agv_fault_flags(fault) & AGV_FAULT_FLAG_FIXED) == 0) {
        return NEEDS_GATEWAY;
    }
    return (agv_fault_default_class(fault) == AGV_CLASS_TRIP) ? "this fault must stay a trip"
                                                              : "this fault must stay a warning";
}

bool config_check(const agv_config_t *config, const config_lines_t *lines) {
    const agv_config_verdict_t verdict = agv_config_check(config);
    const agv_setting_info_t *info = agv_setting_info(verdict.setting);
    const char *name = (info != NULL) ? info->name : "?";
    size_t line = (info != NULL) ? lines->settings[verdict.setting] : 0;
    char key[CONFIG_CLASS_KEY_SIZE];
    switch (verdict.problem) {
    case AGV_CONFIG_OK:
        return true;
    case AGV_CONFIG_OUT_OF_RANGE:
        return report_setting(lines, line, name, "the value is out of range");
    case AGV_CONFIG_ID_TWICE:
        return blame_twice(config, lines, verdict.setting);
    case AGV_CONFIG_NEEDS_GATEWAY:
        return report_setting(lines, line, name, NEEDS_GATEWAY);
    case AGV_CONFIG_PRESS_TOO_SHORT:
        return blame_press(lines);
    case AGV_CONFIG_CLASS_FIXED:
        config_class_key(verdict.fault, key);
        return report_setting(lines, lines->classes[verdict.fault], key, class_reason(verdict.fault));
    case AGV_CONFIG_NO_SUCH_FAULT:
    default:
        return report("the configuration is invalid");
    }
}

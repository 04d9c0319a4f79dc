#include "config/config_schema.h"

#include <stdio.h>
#include <string.h>

#include "agv/config.h"
#include "agv/faults.h"
#include "agv/names.h"
#include "config/config_file.h"
#include "config/config_text.h"
#include "io/yaml_schema.h"
#include "text/words.h"

#define NO_BIT "^0+h?$|^0x0+$"
#define TIME "^[0-9]+(\\.[0-9]+)? ?(us|ms|s|min|h|d)$"

enum { DESCRIPTION_SIZE = 400 };

/** The words of a setting. YAML writers put off and on as false and true. */
static json_t *words_of(const agv_setting_info_t *info) {
    json_t *list = json_array();
    const char *word = NULL;
    size_t length = words_at(info->words, 0, &word);
    for (size_t i = 1; length > 0; i++) {
        (void)json_array_append_new(list, json_stringn(word, length));
        length = words_at(info->words, i, &word);
    }
    if (strcmp(info->words, "off|on") == 0) {
        (void)json_array_append_new(list, json_false());
        (void)json_array_append_new(list, json_true());
        (void)json_array_append_new(list, json_string("false"));
        (void)json_array_append_new(list, json_string("true"));
    }
    return json_pack("{s:o}", "enum", list);
}

static json_t *number_of(const agv_setting_info_t *info) {
    const yaml_shape_t identifier = {.kind = YAML_KIND_HEX, .highest = info->highest}; /* decimal is an integer */
    if (config_is_id(info)) {
        json_t *schema = yaml_schema(&identifier);
        if (info->lowest > 0) {
            json_t *none =
                json_pack("{s:[{s:i}, {s:s, s:s}]}", "anyOf", "const", 0, "type", "string", "pattern", NO_BIT);
            (void)json_object_set_new(schema, "not", none);
        }
        return schema;
    }
    json_t *number =
        json_pack("{s:s, s:i, s:i}", "type", "integer", "minimum", (int)info->lowest, "maximum", (int)info->highest);
    if (strcmp(info->unit, "ms") != 0) {
        return number;
    }
    return json_pack("{s:[o, {s:s, s:s}]}", "anyOf", number, "type", "string", "pattern", TIME);
}

static json_t *default_of(const agv_setting_info_t *info) {
    char text[CONFIG_VALUE_SIZE];
    config_value_text(info, info->preset, text);
    return (info->words != NULL) ? json_string(text) : json_integer(info->preset);
}

static json_t *setting_of(const agv_setting_info_t *info) {
    char description[DESCRIPTION_SIZE];
    json_t *schema = (info->words != NULL) ? words_of(info) : number_of(info);
    (void)snprintf(description, sizeof description, "%s%s%s", info->meaning, (info->unit[0] != '\0') ? "; " : "",
                   info->unit);
    (void)json_object_set_new(schema, "description", json_string(description));
    (void)json_object_set_new(schema, "default", default_of(info));
    return schema;
}

/** A fault whose class is fixed has that one, but for a scenario with `config_unchecked`. */
static json_t *class_of(agv_fault_t fault, bool may_be_unchecked) {
    const bool is_fixed = !may_be_unchecked && ((agv_fault_flags(fault) & AGV_FAULT_FLAG_FIXED) != 0);
    const char *preset = agv_class_name(agv_fault_default_class(fault));
    json_t *schema = is_fixed ? json_pack("{s:[s]}", "enum", preset) : json_pack("{s:[s, s]}", "enum", "trip", "warn");
    (void)json_object_set_new(schema, "default", json_string(preset));
    return schema;
}

static bool is_of_top_level(const char *name) {
    return (strcmp(name, "topology") == 0) || (strcmp(name, "id_set") == 0);
}

json_t *config_schema(bool of_scenario) {
    json_t *properties = json_object();
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        if (!of_scenario || !is_of_top_level(info->name)) {
            (void)json_object_set_new(properties, info->name, setting_of(info));
        }
    }
    for (uint32_t i = 0; i < AGV_FAULT_COUNT; i++) {
        char key[CONFIG_CLASS_KEY_SIZE];
        config_class_key((agv_fault_t)i, key);
        (void)json_object_set_new(properties, key, class_of((agv_fault_t)i, of_scenario));
    }
    return json_pack("{s:s, s:o, s:b}", "type", "object", "properties", properties, "additionalProperties", 0);
}

#include "report/report_settings.h"

#include "agv/names.h"
#include "config/config_file.h"
#include "config/config_text.h"

static void append(json_t *array, const char *name, const char *value, const char *preset) {
    json_t *object = json_object();
    (void)json_object_set_new(object, "name", json_string(name));
    (void)json_object_set_new(object, "value", json_string(value));
    (void)json_object_set_new(object, "preset", json_string(preset));
    (void)json_array_append_new(array, object);
}

static void describe(const json_t *array, const char *unit, const char *meaning, bool weakens) {
    json_t *object = json_array_get(array, json_array_size(array) - 1);
    (void)json_object_set_new(object, "unit", json_string(unit));
    (void)json_object_set_new(object, "meaning", json_string(meaning));
    (void)json_object_set_new(object, "weakens", json_boolean(weakens));
}

static void append_class(json_t *array, const agv_config_t *config, agv_fault_t fault) {
    const bool trips = agv_config_is_trip(config, (uint32_t)fault);
    const agv_fault_class_t preset = agv_fault_default_class((uint32_t)fault);
    if (trips != (preset == AGV_CLASS_TRIP)) {
        char key[CONFIG_CLASS_KEY_SIZE];
        config_class_key(fault, key);
        append(array, key, agv_class_name(trips ? AGV_CLASS_TRIP : AGV_CLASS_WARN), agv_class_name(preset));
        describe(array, "", "class of this fault", !trips);
    }
}

json_t *report_settings_json(const agv_config_t *config) {
    json_t *array = json_array();
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        const uint16_t value = agv_config_get(config, i);
        if (value != info->preset) {
            char text[CONFIG_VALUE_SIZE];
            char preset[CONFIG_VALUE_SIZE];
            config_value_text(info, value, text);
            config_value_text(info, info->preset, preset);
            append(array, info->name, text, preset);
            describe(array, info->unit, info->meaning, agv_config_weakens(config, i));
        }
    }
    for (uint32_t i = 0; i < AGV_FAULT_COUNT; i++) {
        append_class(array, config, (agv_fault_t)i);
    }
    return array;
}

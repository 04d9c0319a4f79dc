#include "config/config_text.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "config/config_file.h"
#include "text/words.h"

bool config_is_id(const agv_setting_info_t *info) {
    return (strncmp(info->name, "id_", 3) == 0 && (info->words == NULL)) ||
           (strcmp(info->name, "status_frame_id") == 0);
}

void config_value_text(const agv_setting_info_t *info, uint16_t value, char text[CONFIG_VALUE_SIZE]) {
    if (config_is_id(info)) {
        (void)snprintf(text, CONFIG_VALUE_SIZE, "0x%03X", value);
    } else if (info->words == NULL) {
        (void)snprintf(text, CONFIG_VALUE_SIZE, "%u", value);
    } else {
        const char *word = NULL;
        size_t length = words_at(info->words, value, &word);
        (void)snprintf(text, CONFIG_VALUE_SIZE, "%.*s", (int)length, word);
    }
}

static const char *class_word(const agv_config_t *config, agv_fault_t fault) {
    return agv_class_name(agv_config_is_trip(config, fault) ? AGV_CLASS_TRIP : AGV_CLASS_WARN);
}

static const char *default_word(agv_fault_t fault) {
    return agv_class_name(agv_fault_default_class(fault));
}

/** Whether the class of a fault may be chosen at all. */
static bool may_be_chosen(agv_fault_t fault) {
    return (agv_fault_flags(fault) & AGV_FAULT_FLAG_FIXED) == 0;
}

static bool is_gateway_only(agv_fault_t fault) {
    return (agv_fault_flags(fault) & AGV_FAULT_FLAG_GATEWAY) != 0;
}

/** Which values weaken the supervision. */
static void print_weakens(const agv_setting_info_t *info) {
    static const struct {
        const char *weakens;
        const char *text;
    } values[] = {{"ABOVE", "a higher value"}, {"BELOW", "a lower value"}, {"ZERO", "0"}};
    const char *text = (strcmp(info->weakens, "CHOSEN") == 0) ? strchr(info->words, '|') + 1 : NULL;
    for (size_t i = 0; i < sizeof values / sizeof values[0]; i++) {
        if (strcmp(info->weakens, values[i].weakens) == 0) {
            text = values[i].text;
        }
    }
    if (text != NULL) {
        (void)printf("; %.*s weakens the supervision", (int)strcspn(text, "|"), text);
    }
}

void config_print_yaml(const agv_config_t *config) {
    (void)printf("# Configuration of the supervisor: every setting with its meaning, range and default.\n"
                 "# Checksum: %08" PRIX32 "\n",
                 agv_config_checksum(config));
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        char preset[CONFIG_VALUE_SIZE];
        char value[CONFIG_VALUE_SIZE];
        char lowest[CONFIG_VALUE_SIZE];
        char highest[CONFIG_VALUE_SIZE];
        config_value_text(info, info->preset, preset);
        config_value_text(info, agv_config_get(config, i), value);
        (void)printf("\n# %s\n", info->meaning);
        if (info->words == NULL) {
            config_value_text(info, info->lowest, lowest);
            config_value_text(info, info->highest, highest);
            (void)printf("# %s to %s%s%s, default %s", lowest, highest, (info->unit[0] != '\0') ? " " : "", info->unit,
                         preset);
        } else {
            (void)printf("# %s, default %s", info->words, preset);
        }
        print_weakens(info);
        (void)printf("%s\n", info->gateway_only ? "; gateway only" : "");
        (void)printf("%s: %s\n", info->name, value);
    }
    (void)printf("\n# Class of each fault: trip|warn. A mandatory class cannot be changed.\n");
    for (uint32_t i = 0; i < AGV_FAULT_COUNT; i++) {
        const agv_fault_t fault = (agv_fault_t)i;
        char key[CONFIG_CLASS_KEY_SIZE];
        config_class_key(fault, key);
        (void)printf("%s: %s  # default %s%s%s\n", key, class_word(config, fault), default_word(fault),
                     may_be_chosen(fault) ? "" : ", mandatory", is_gateway_only(fault) ? "; gateway only" : "");
    }
}

void config_print_kconfig(const agv_config_t *config) {
    (void)printf("# Configuration of the supervisor, for the firmware.\n"
                 "# Checksum: %08" PRIX32 "\n",
                 agv_config_checksum(config));
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        char value[CONFIG_VALUE_SIZE];
        config_value_text(info, agv_config_get(config, i), value);
        (void)printf("CONFIG_AGV_");
        words_print_upper(info->name);
        if (info->words == NULL) {
            (void)printf("=%s\n", value);
        } else {
            (void)putchar('_');
            words_print_upper(value);
            (void)printf("=y\n");
        }
    }
    for (uint32_t i = 0; i < AGV_FAULT_COUNT; i++) {
        const agv_fault_t fault = (agv_fault_t)i;
        if (may_be_chosen(fault)) {
            (void)printf("CONFIG_AGV_CLASS_%s_", agv_fault_name(fault));
            words_print_upper(class_word(config, fault));
            (void)printf("=y\n");
        }
    }
}

/** Begin or go on with the line of deviations. */
static void print_deviation(bool *any, const char *key, const char *value, const char *preset, bool weakens) {
    (void)fprintf(stderr, "%s%s: %s (default %s%s)", *any ? ", " : "host_sim: not the default: ", key, value, preset,
                  weakens ? ", WEAKER" : "");
    *any = true;
}

void config_note_deviations(const agv_config_t *config) {
    bool any = false;
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        if (agv_config_get(config, i) != info->preset) {
            char preset[CONFIG_VALUE_SIZE];
            char value[CONFIG_VALUE_SIZE];
            config_value_text(info, info->preset, preset);
            config_value_text(info, agv_config_get(config, i), value);
            print_deviation(&any, info->name, value, preset, agv_config_weakens(config, i));
        }
    }
    for (uint32_t i = 0; i < AGV_FAULT_COUNT; i++) {
        const agv_fault_t fault = (agv_fault_t)i;
        if (agv_config_is_trip(config, fault) != (agv_fault_default_class(fault) == AGV_CLASS_TRIP)) {
            char key[CONFIG_CLASS_KEY_SIZE];
            config_class_key(fault, key);
            print_deviation(&any, key, class_word(config, fault), default_word(fault),
                            !agv_config_is_trip(config, fault));
        }
    }
    if (any) {
        (void)fputc('\n', stderr);
    }
}

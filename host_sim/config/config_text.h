/**
 * @file config_text.h
 * A configuration in print: as YAML (config_file.h reads it back), as a Kconfig fragment for the firmware, and what of
 * it is not the default.
 */
#ifndef HOST_SIM_CONFIG_TEXT_H
#define HOST_SIM_CONFIG_TEXT_H

#include <stdbool.h>

#include "agv/config.h"

#define CONFIG_VALUE_SIZE 96u

/** Whether a setting is an identifier, which is written in hexadecimal. */
bool config_is_id(const agv_setting_info_t *info);

/** The value of a setting as it stands in a file: "350", "0x7F0", "shared". */
void config_value_text(const agv_setting_info_t *info, uint16_t value, char text[CONFIG_VALUE_SIZE]);

/** Print every setting on standard output, with meaning, range and default as comments. */
void config_print_yaml(const agv_config_t *config);

/**
 * Print the Kconfig fragment on standard output: CONFIG_AGV_<SETTING>=<number>, CONFIG_AGV_<SETTING>_<WORD>=y, and, for
 * every fault whose class may be chosen, CONFIG_AGV_CLASS_<FAULT>_TRIP=y or _WARN=y.
 */
void config_print_kconfig(const agv_config_t *config);

/** Print the settings that are not the default as one line on standard error: "setting: value (default)". */
void config_note_deviations(const agv_config_t *config);

#endif

/**
 * @file report_settings.h
 * The settings that differ from the defaults, for the report.
 */
#ifndef HOST_SIM_REPORT_SETTINGS_H
#define HOST_SIM_REPORT_SETTINGS_H

#include <jansson.h>

#include "agv/config.h"

/** An array of objects: `name`, `value`, `preset`, `unit`, `meaning`, `weakens` (whether it weakens the supervision). */
json_t *report_settings_json(const agv_config_t *config);

#endif

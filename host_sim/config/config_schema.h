/**
 * @file config_schema.h
 * The JSON Schema of a configuration, from the tables of settings and faults.
 */
#ifndef HOST_SIM_CONFIG_SCHEMA_H
#define HOST_SIM_CONFIG_SCHEMA_H

#include <jansson.h>
#include <stdbool.h>

/** @param of_scenario without the settings that stand at the top level of a scenario @return a new reference */
json_t *config_schema(bool of_scenario);

#endif

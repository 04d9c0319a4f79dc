/**
 * @file scenario_schema.h
 * The JSON Schema of a scenario file, from the tables that read it.
 */
#ifndef HOST_SIM_SCENARIO_SCHEMA_H
#define HOST_SIM_SCENARIO_SCHEMA_H

#include <jansson.h>

/** The schema of a file; a new reference. */
json_t *scenario_schema(void);

/** Private: that of a step. */
json_t *scenario_schema_step(void);

#endif

/**
 * @file yaml_schema.h
 * JSON Schemas (draft-07) from shapes. A schema is what a YAML 1.2 reader makes of a file: `0x168` is a number, `168h` a
 * text, `off` a text.
 */
#ifndef HOST_SIM_YAML_SCHEMA_H
#define HOST_SIM_YAML_SCHEMA_H

#include <jansson.h>

#include "io/yaml_shape.h"

/** The schema of a shape; a new reference. @param shape NULL: anything */
json_t *yaml_schema(const yaml_shape_t *shape);

/** The schema of what stands behind a key. */
json_t *yaml_schema_of_key(const yaml_key_t *key);

/** Add a condition to a schema: it holds besides all others. @param condition the reference is taken */
void yaml_schema_also(json_t *schema, json_t *condition);

/** The condition of a rule. */
json_t *yaml_schema_of_rule(const yaml_rule_t *rule);

/** Print a schema of a whole file on standard output. @param schema the reference is taken; NULL: no memory, reported */
bool yaml_schema_print(json_t *schema, const char *title);

#endif

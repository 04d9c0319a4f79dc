#include "scenario/parse/scenario_schema.h"

#include "config/config_schema.h"
#include "io/yaml_schema.h"
#include "scenario/parse/scenario_parse.h"

/** The schema of a key within that of a mapping. */
static json_t *property(json_t *schema, const char *key) {
    return json_object_get(json_object_get(schema, "properties"), key);
}

static json_t *items_of(json_t *expect, const char *list) {
    return json_object_get(property(expect, list), "items");
}

/** What a table of keys cannot say: what a reset must say depends on whether it is accepted. */
static void add_resets(json_t *resets) {
    yaml_schema_also(resets, json_pack("{s:{s:{s:{s:[b, s]}}, s:[s]}, s:{s:{s:{s:i}}}, s:{s:{s:{s:i}}, s:[s]}}", "if",
                                       "properties", "accepted", "enum", 1, "true", "required", "accepted", "then",
                                       "properties", "why", "maxItems", 0, "else", "properties", "why", "minItems", 1,
                                       "required", "why"));
}

/** Only one fault has parts. */
static void add_parts(json_t *faults) {
    yaml_schema_also(faults,
                     json_pack("{s:{s:{s:{s:i}}, s:[s]}, s:{s:{s:{s:s}}}}", "if", "properties", "parts", "minItems", 1,
                               "required", "parts", "then", "properties", "name", "const", "SELF_TEST_FAILED"));
}

json_t *scenario_schema(void) {
    json_t *schema = yaml_schema(&SCENARIO_SHAPE);
    json_t *expect = property(schema, "expect");

    (void)json_object_set_new(json_object_get(schema, "properties"), "config", config_schema(true));
    (void)json_object_set_new(property(schema, "steps"), "items", scenario_schema_step());
    add_resets(items_of(expect, "resets"));
    add_parts(items_of(expect, "faults"));
    return schema;
}

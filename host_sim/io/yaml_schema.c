#include "io/yaml_schema.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/report.h"

#define WHOLE_NUMBER "^(-?[0-9]+|0x[0-9A-Fa-f]+)$"
#define TIME "^([0-9]+|[0-9]+(\\.[0-9]+)? ?(us|ms|s|min|h|d))$"
#define BYTE "[0-9A-Fa-f]{2}"
#define OPEN_BYTE "(" BYTE "|\\.\\.)"

enum { PATTERN_SIZE = 256, BITS_PER_DIGIT = 4, DIGIT_MASK = 0xF, BYTE_OF_TWO_DIGITS_MAX = 99 };

static json_t *pattern(const char *text) {
    return json_pack("{s:s, s:s}", "type", "string", "pattern", text);
}

static json_t *integer(int64_t lowest, int64_t highest) {
    return json_pack("{s:s, s:I, s:I}", "type", "integer", "minimum", (json_int_t)lowest, "maximum",
                     (json_int_t)highest);
}

static json_t *either(json_t *first, json_t *second) {
    return json_pack("{s:[o, o]}", "anyOf", first, second);
}

/** A value, or a list of two. */
static json_t *one_or_two(json_t *value) {
    return json_pack("{s:[O, {s:s, s:o, s:i, s:i}]}", "anyOf", value, "type", "array", "items", value, "minItems", 2,
                     "maxItems", 2);
}

/** Hexadecimal digits up to @p highest, which is one digit and then only F. */
static json_t *bits(uint32_t highest, const char *decimal) {
    char text[PATTERN_SIZE];
    uint32_t first = highest;
    unsigned more = 0;
    for (; first > DIGIT_MASK; first >>= BITS_PER_DIGIT) {
        more++;
    }
    char digit[8];
    (void)snprintf(digit, sizeof digit, (first > 9) ? "0-9A-%X" : "0-%X", (unsigned)first);
    char lower[8] = "";
    if (first > 9) {
        (void)snprintf(lower, sizeof lower, "a-%x", (unsigned)first);
    }
    char number[PATTERN_SIZE / 3];
    if (more > 0) {
        (void)snprintf(number, sizeof number, "0*([%s%s][0-9A-Fa-f]{%u}|[0-9A-Fa-f]{1,%u})", digit, lower, more, more);
    } else {
        (void)snprintf(number, sizeof number, "0*[%s%s]", digit, lower);
    }
    (void)snprintf(text, sizeof text, "^(%sh|0x%s%s)$", number, number, decimal);
    return either(integer(0, highest), pattern(text));
}

/** A word as a file has it: YAML reads some as numbers or flags. */
static void add_word(json_t *list, const char *word) {
    char *end = NULL;
    const long long number = strtoll(word, &end, 10);
    (void)json_array_append_new(list, json_string(word));
    if ((*word != '\0') && (*end == '\0')) {
        (void)json_array_append_new(list, json_integer(number));
    } else if (strcmp(word, "true") == 0) {
        (void)json_array_append_new(list, json_true());
    } else if (strcmp(word, "false") == 0) {
        (void)json_array_append_new(list, json_false());
    } else {
        return;
    }
}

static json_t *word_schema(const yaml_shape_t *shape) {
    json_t *list = json_array();
    for (size_t i = 0; (shape->words != NULL) && (shape->words[i].word != NULL); i++) {
        add_word(list, shape->words[i].word);
    }
    for (size_t i = 0; (shape->name != NULL) && (shape->name(i) != NULL); i++) {
        add_word(list, shape->name(i));
    }
    return json_pack("{s:o}", "enum", list);
}

static json_t *flag(void) {
    static const yaml_word_t words[] = {{"true", 1}, {"false", 0}, {NULL, 0}};
    const yaml_shape_t shape = {.words = words};
    return word_schema(&shape);
}

static json_t *text_schema(const yaml_shape_t *shape) {
    json_t *schema = json_pack("{s:[s, s, s], s:i}", "type", "string", "number", "boolean", "minLength", 1);
    if (shape->highest != 0) {
        (void)json_object_set_new(schema, "maxLength", json_integer(shape->highest));
    }
    return schema;
}

/** Bytes. YAML reads one that is written without quotes and has no letters as a number. */
static json_t *bytes_of(const yaml_shape_t *shape) {
    char text[PATTERN_SIZE];
    const char *byte = shape->may_be_open ? OPEN_BYTE : BYTE;
    if (shape->lowest > 0) {
        (void)snprintf(text, sizeof text, "^%s( %s){%" PRId64 ",%" PRId64 "} ?$", byte, byte, shape->lowest - 1,
                       shape->highest - 1);
        return pattern(text);
    }
    (void)snprintf(text, sizeof text, "^(%s( %s){0,%" PRId64 "} ?)?$", byte, byte, shape->highest - 1);
    return either(pattern(text), integer(0, BYTE_OF_TWO_DIGITS_MAX));
}

static json_t *list_of(const yaml_shape_t *shape) {
    json_t *schema = json_pack("{s:s, s:o}", "type", "array", "items", yaml_schema(shape->items));
    if (shape->lowest > 0) {
        (void)json_object_set_new(schema, "minItems", json_integer(shape->lowest));
    }
    if (shape->highest > 0) {
        (void)json_object_set_new(schema, "maxItems", json_integer(shape->highest));
    }
    if (shape->is_unique) {
        (void)json_object_set_new(schema, "uniqueItems", json_true());
    }
    return schema;
}

void yaml_schema_also(json_t *schema, json_t *condition) {
    json_t *all = json_object_get(schema, "allOf");
    if (all == NULL) {
        all = json_array();
        (void)json_object_set_new(schema, "allOf", all);
    }
    (void)json_array_append_new(all, condition);
}

json_t *yaml_schema_of_rule(const yaml_rule_t *rule) {
    switch (rule->kind) {
    case YAML_RULE_ONE_OF:
        return json_pack("{s:[{s:[s]}, {s:[s]}]}", "oneOf", "required", rule->first, "required", rule->second);
    case YAML_RULE_NOT_BOTH:
        return json_pack("{s:{s:[s, s]}}", "not", "required", rule->first, rule->second);
    default:
        return json_pack("{s:{s:[s]}}", "dependencies", rule->first, rule->second);
    }
}

static json_t *map_of(const yaml_shape_t *shape) {
    json_t *properties = json_object();
    json_t *required = json_array();
    for (size_t i = 0; i < shape->count; i++) {
        (void)json_object_set_new(properties, shape->keys[i].name, yaml_schema_of_key(&shape->keys[i]));
        if (shape->keys[i].required) {
            (void)json_array_append_new(required, json_string(shape->keys[i].name));
        }
    }
    json_t *schema = json_pack("{s:s, s:o, s:o, s:b}", "type", "object", "properties", properties, "required", required,
                               "additionalProperties", 0);
    for (size_t i = 0; (i < YAML_RULES_MAX) && (shape->rules[i].first != NULL); i++) {
        yaml_schema_also(schema, yaml_schema_of_rule(&shape->rules[i]));
    }
    return schema;
}

/** The schema without the other form. */
static json_t *schema_of(const yaml_shape_t *shape) {
    switch (shape->kind) {
    case YAML_KIND_FLAG:
        return flag();
    case YAML_KIND_NUMBER:
        return either(integer(shape->lowest, shape->highest), pattern(WHOLE_NUMBER));
    case YAML_KIND_RANGE:
        return one_or_two(either(integer(shape->lowest, shape->highest), pattern(WHOLE_NUMBER)));
    case YAML_KIND_TIME:
        return either(integer(shape->lowest, shape->highest), pattern(TIME));
    case YAML_KIND_TIME_RANGE:
        return one_or_two(either(integer(shape->lowest, shape->highest), pattern(TIME)));
    case YAML_KIND_HEX:
        return bits((uint32_t)shape->highest, "");
    case YAML_KIND_ID:
        return bits((uint32_t)shape->highest, "|0|[1-9][0-9]*");
    case YAML_KIND_WORD:
    case YAML_KIND_NAMES:
        return word_schema(shape);
    case YAML_KIND_TEXT:
        return text_schema(shape);
    case YAML_KIND_BYTES:
        return bytes_of(shape);
    case YAML_KIND_LIST:
        return list_of(shape);
    case YAML_KIND_MAP:
        return map_of(shape);
    default:
        return json_object();
    }
}

json_t *yaml_schema(const yaml_shape_t *shape) {
    if (shape == NULL) {
        return json_object();
    }
    return (shape->other == NULL) ? schema_of(shape) : either(schema_of(shape), yaml_schema(shape->other));
}

json_t *yaml_schema_of_key(const yaml_key_t *key) {
    if (key->kind == YAML_KIND_CALL) {
        return yaml_schema(key->shape);
    }
    const yaml_shape_t shape = {.kind = key->kind,
                                .lowest = key->lowest,
                                .highest = key->highest,
                                .unit = key->unit,
                                .words = key->words,
                                .items = key->shape};
    return yaml_schema(&shape);
}

bool yaml_schema_print(json_t *schema, const char *title) {
    json_t *whole = json_pack("{s:s, s:s}", "$schema", "http://json-schema.org/draft-07/schema#", "title", title);
    char *text = NULL;
    if ((whole != NULL) && (schema != NULL) && (json_object_update(whole, schema) == 0)) {
        text = json_dumps(whole, JSON_INDENT(1));
    }
    json_decref(schema);
    json_decref(whole);
    if (text == NULL) {
        return report("out of memory");
    }
    (void)printf("%s\n", text);
    free(text);
    return true;
}

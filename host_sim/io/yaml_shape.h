/**
 * @file yaml_shape.h
 * What a reading function accepts, as a table: from these and the tables of keys the JSON Schemas are made
 * (yaml_schema.h). A function and its shape use the same tables of keys and words.
 */
#ifndef HOST_SIM_YAML_SHAPE_H
#define HOST_SIM_YAML_SHAPE_H

#include "io/yaml_reader.h"

/** How two keys of a mapping go together. */
typedef enum {
    YAML_RULE_ONE_OF,   /**< one of them is there, and not both */
    YAML_RULE_NOT_BOTH, /**< at most one of them is there */
    YAML_RULE_NEEDS     /**< with the first the second is there, too */
} yaml_rule_kind_t;

typedef struct {
    yaml_rule_kind_t kind;
    const char *first;
    const char *second;
} yaml_rule_t;

#define YAML_RULES_MAX 5u

/** A shape. Of the members those count that its kind needs. */
struct yaml_shape {
    yaml_kind_t kind;
    int64_t lowest;  /**< of a number or a time, or how many items or bytes there are */
    int64_t highest; /**< likewise, or the length of a text; 0 for a text and for a list: no limit */
    duration_unit_t unit;
    const yaml_word_t *words;
    const char *(*name)(size_t index); /**< of NAMES; NULL: no more */
    const yaml_shape_t *items;         /**< of LIST */
    bool is_unique;                    /**< no item of a LIST twice */
    bool may_be_open;                  /**< BYTES: `..` is a byte */
    const yaml_key_t *keys;            /**< of MAP */
    size_t count;
    yaml_rule_t rules[YAML_RULES_MAX]; /**< of MAP; ends with a rule without `first` */
    const yaml_shape_t *other;         /**< or this one; NULL: nothing else */
};

/** The keys of a mapping. */
#define YAML_MAP_SHAPE(table) .kind = YAML_KIND_MAP, .keys = (table), .count = sizeof(table) / sizeof(table)[0]

#endif

#include "io/yaml_reader.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "common/report.h"
#include "io/yaml_file.h"
#include "text/suggest.h"

enum { SHOWN_MAX = 40, LINE_SHOWN_MAX = 80 };

bool yaml_reader_fail(const yaml_reader_t *reader, const yaml_node_t *node, const char *format, ...) {
    char message[320];
    va_list arguments;

    va_start(arguments, format);
    (void)vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    return reader->is_line ? report("%.*s: %s", LINE_SHOWN_MAX, reader->file, message)
                           : report_at(reader->file, yaml_node_line(node), "%s", message);
}

/** Find the key of a pair in the table. @return its index, or `count`: reported. */
static size_t find_key(const yaml_reader_t *reader, const yaml_node_t *key, const char *what, const yaml_key_t *keys,
                       size_t count) {
    const char *name = yaml_node_text(key);

    if (name == NULL) {
        (void)yaml_reader_fail(reader, key, "a key of %s must be a word", what);
        return count;
    }
    for (size_t i = 0; i < count; i++) {
        if (strcmp(keys[i].name, name) == 0) {
            return i;
        }
    }
    char meant[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin(name, strlen(name));
    for (size_t i = 0; i < count; i++) {
        suggest_offer(&suggestion, keys[i].name, strlen(keys[i].name));
    }
    (void)yaml_reader_fail(reader, key, "unknown key '%.*s' in %s%s", SHOWN_MAX, name, what,
                           suggest_text(&suggestion, meant));
    return count;
}

/** Sort the values of a mapping by the rows of the table. */
static bool sort_pairs(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, const yaml_key_t *keys,
                       size_t count, const yaml_node_t *values[YAML_READER_KEYS_MAX]) {
    for (const yaml_node_pair_t *pair = node->data.mapping.pairs.start; pair < node->data.mapping.pairs.top; pair++) {
        const yaml_node_t *key = yaml_document_get_node(reader->document, pair->key);
        const size_t row = find_key(reader, key, what, keys, count);
        if (row == count) {
            return false;
        }
        if (values[row] != NULL) {
            return yaml_reader_fail(reader, key, "'%s' is given twice in %s", keys[row].name, what);
        }
        values[row] = yaml_document_get_node(reader->document, pair->value);
    }
    return true;
}

/** Store a number in the member of a row. */
static void store(const yaml_key_t *key, int64_t value, void *target) {
    const uint8_t byte = (uint8_t)value;
    const uint16_t half = (uint16_t)value;
    const uint32_t word = (uint32_t)value;
    uint8_t *member = (uint8_t *)target + key->offset;

    if (key->size == sizeof byte) {
        memcpy(member, &byte, sizeof byte);
    } else if (key->size == sizeof half) {
        memcpy(member, &half, sizeof half);
    } else {
        memcpy(member, &word, sizeof word);
    }
}

static bool read_range(const yaml_reader_t *reader, const yaml_node_t *node, const yaml_key_t *key, void *target) {
    int64_t range[2] = {0, 0};

    if ((key->kind == YAML_KIND_TIME_RANGE)
            ? !yaml_reader_time_range(reader, node, key->name, key->lowest, key->highest, range)
            : !yaml_reader_range(reader, node, key->name, key->lowest, key->highest, range)) {
        return false;
    }
    const uint32_t both[2] = {(uint32_t)range[0], (uint32_t)range[1]};
    memcpy((uint8_t *)target + key->offset, both, sizeof both);
    return true;
}

/** Read a value that is one number in the end. */
static bool read_number(const yaml_reader_t *reader, const yaml_node_t *node, const yaml_key_t *key, int64_t *value) {
    bool flag = false;
    uint32_t hex = 0;
    int word = 0;
    bool good = false;

    switch (key->kind) {
    case YAML_KIND_FLAG:
        good = yaml_reader_bool(reader, node, key->name, &flag);
        *value = flag ? 1 : 0;
        return good;
    case YAML_KIND_HEX:
        good = yaml_reader_hex(reader, node, key->name, (uint32_t)key->highest, &hex);
        *value = hex;
        return good;
    case YAML_KIND_ID:
        good = yaml_reader_id(reader, node, key->name, (uint32_t)key->highest, &hex);
        *value = hex;
        return good;
    case YAML_KIND_TIME:
        return yaml_reader_time(reader, node, key->name, key->unit, key->lowest, key->highest, value);
    case YAML_KIND_WORD:
        good = yaml_reader_word(reader, node, key->name, key->words, &word);
        *value = word;
        return good;
    default:
        return yaml_reader_number(reader, node, key->name, key->lowest, key->highest, value);
    }
}

static bool read_value(const yaml_reader_t *reader, const yaml_node_t *node, const yaml_key_t *key, void *target) {
    const bool given = true;
    int64_t value = 0;

    if (key->given != 0) {
        memcpy((uint8_t *)target + key->given, &given, sizeof given);
    }
    switch (key->kind) {
    case YAML_KIND_CALL:
        return key->read(reader, node, target);
    case YAML_KIND_LIST:
        return yaml_reader_list(reader, node, key->name, key->read, target);
    case YAML_KIND_RANGE:
    case YAML_KIND_TIME_RANGE:
        return read_range(reader, node, key, target);
    default:
        if (!read_number(reader, node, key, &value)) {
            return false;
        }
        store(key, value, target);
        return true;
    }
}

bool yaml_reader_map(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, const yaml_key_t *keys,
                     size_t count, void *target) {
    const yaml_node_t *values[YAML_READER_KEYS_MAX] = {NULL};

    if (node->type != YAML_MAPPING_NODE) {
        return yaml_reader_fail(reader, node, "%s must be lines of 'key: value'", what);
    }
    if (!sort_pairs(reader, node, what, keys, count, values)) {
        return false;
    }
    for (size_t i = 0; i < count; i++) {
        if (values[i] != NULL) {
            if (!read_value(reader, values[i], &keys[i], target)) {
                return false;
            }
        } else if (keys[i].required) {
            return yaml_reader_fail(reader, node, "%s: '%s' is missing", what, keys[i].name);
        } else {
            continue;
        }
    }
    return true;
}

const yaml_node_t *yaml_reader_value(const yaml_reader_t *reader, const yaml_node_t *mapping, const char *key) {
    for (const yaml_node_pair_t *pair = mapping->data.mapping.pairs.start; pair < mapping->data.mapping.pairs.top;
         pair++) {
        const char *name = yaml_node_text(yaml_document_get_node(reader->document, pair->key));
        if ((name != NULL) && (strcmp(name, key) == 0)) {
            return yaml_document_get_node(reader->document, pair->value);
        }
    }
    return NULL;
}

bool yaml_reader_list(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, yaml_read_fn *read,
                      void *target) {
    if (node->type != YAML_SEQUENCE_NODE) {
        return yaml_reader_fail(reader, node, "%s must be a list", what);
    }
    for (const yaml_node_item_t *item = node->data.sequence.items.start; item < node->data.sequence.items.top; item++) {
        if (!read(reader, yaml_document_get_node(reader->document, *item), target)) {
            return false;
        }
    }
    return true;
}

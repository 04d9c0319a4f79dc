#include "io/yaml_reader.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "common/hex.h"
#include "common/report.h"
#include "common/words.h"
#include "io/yaml_file.h"

#define DECIMAL_SET "0123456789"
#define HEX_SET DECIMAL_SET "abcdefABCDEF"

enum { SHOWN_MAX = 40, LINE_SHOWN_MAX = 80, HEX = 16, BYTES_MAX = 8 };

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
    for (size_t i = 0u; i < count; i++) {
        if (strcmp(keys[i].name, name) == 0) {
            return i;
        }
    }
    (void)yaml_reader_fail(reader, key, "unknown key '%.*s' in %s", SHOWN_MAX, name, what);
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

    if (!yaml_reader_range(reader, node, key->name, key->lowest, key->highest, range)) {
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
    for (size_t i = 0u; i < count; i++) {
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

const char *yaml_reader_text(const yaml_reader_t *reader, const yaml_node_t *node, const char *what) {
    const char *text = yaml_node_text(node);

    if ((text == NULL) || (text[0] == '\0')) {
        (void)yaml_reader_fail(reader, node, "%s: a word or a text is missing", what);
        return NULL;
    }
    return text;
}

/** Whether a text is digits and nothing else. */
static bool is_digits(const char *text, const char *digits) {
    return (text[0] != '\0') && (text[strspn(text, digits)] == '\0');
}

/** Read a decimal number, or a hexadecimal one with 0x. @return false: not a number. A larger one is INT64_MAX */
static bool read_whole(const char *text, int64_t *number) {
    const bool is_hex = (text[0] == '0') && (text[1] == 'x');
    const bool is_negative = text[0] == '-';
    const char *digits = &text[(is_hex ? 2 : 0) + (is_negative ? 1 : 0)];
    uint64_t value = 0u;

    if (!is_digits(digits, is_hex ? HEX_SET : DECIMAL_SET)) {
        return false;
    }
    if (is_hex ? !words_hex(digits, strlen(digits), &value) : !words_decimal(digits, 0u, INT64_MAX, &value)) {
        value = INT64_MAX;
    }
    value = (value > (uint64_t)INT64_MAX) ? (uint64_t)INT64_MAX : value;
    *number = is_negative ? -(int64_t)value : (int64_t)value;
    return true;
}

bool yaml_reader_number(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int64_t lowest,
                        int64_t highest, int64_t *number) {
    const char *text = yaml_reader_text(reader, node, what);

    if (text == NULL) {
        return false;
    }
    if (!read_whole(text, number)) {
        return yaml_reader_fail(reader, node, "%s: '%.*s' is not a whole number", what, SHOWN_MAX, text);
    }
    if ((*number < lowest) || (*number > highest)) {
        return yaml_reader_fail(reader, node, "%s: %.*s is not within %lld to %lld", what, SHOWN_MAX, text,
                                (long long)lowest, (long long)highest);
    }
    return true;
}

bool yaml_reader_hex(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t highest,
                     uint32_t *number) {
    const char *text = yaml_reader_text(reader, node, what);
    uint64_t value = 0u;

    if (text == NULL) {
        return false;
    }
    const bool prefixed = (text[0] == '0') && (text[1] == 'x');
    const char *digits = prefixed ? &text[2] : text;
    const size_t length = strspn(digits, HEX_SET);
    if ((length == 0u) || (strcmp(&digits[length], prefixed ? "" : "h") != 0)) {
        return yaml_reader_fail(reader, node, "%s: '%.*s' is not a hexadecimal number such as 168h or 0x168", what,
                                SHOWN_MAX, text);
    }
    if (!words_hex(digits, length, &value) || (value > highest)) {
        return yaml_reader_fail(reader, node, "%s: %.*s is above %Xh", what, SHOWN_MAX, text, (unsigned)highest);
    }
    *number = (uint32_t)value;
    return true;
}

bool yaml_reader_bool(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, bool *value) {
    static const yaml_word_t words[] = {{"true", 1}, {"false", 0}, {NULL, 0}};
    int number = 0;

    if (!yaml_reader_word(reader, node, what, words, &number)) {
        return false;
    }
    *value = number != 0;
    return true;
}

bool yaml_reader_word(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, const yaml_word_t *words,
                      int *value) {
    const char *text = yaml_reader_text(reader, node, what);
    char list[200] = "";

    if (text == NULL) {
        return false;
    }
    for (const yaml_word_t *word = words; word->word != NULL; word++) {
        if (strcmp(word->word, text) == 0) {
            *value = word->value;
            return true;
        }
        const size_t used = strlen(list);
        (void)snprintf(&list[used], sizeof list - used, "%s%s", (used == 0u) ? "" : ", ", word->word);
    }
    return yaml_reader_fail(reader, node, "%s: '%.*s' is not one of %s", what, SHOWN_MAX, text, list);
}

bool yaml_reader_range(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int64_t lowest,
                       int64_t highest, int64_t range[2]) {
    if (node->type != YAML_SEQUENCE_NODE) {
        if (!yaml_reader_number(reader, node, what, lowest, highest, &range[0])) {
            return false;
        }
        range[1] = range[0];
        return true;
    }
    if (node->data.sequence.items.top - node->data.sequence.items.start != 2) {
        return yaml_reader_fail(reader, node, "%s: a number or [lowest, highest]", what);
    }
    for (int i = 0; i < 2; i++) {
        const yaml_node_t *item = yaml_document_get_node(reader->document, node->data.sequence.items.start[i]);
        if (!yaml_reader_number(reader, item, what, lowest, highest, &range[i])) {
            return false;
        }
    }
    if (range[0] > range[1]) {
        return yaml_reader_fail(reader, node, "%s: the first is above the second", what);
    }
    return true;
}

/** Read one byte, or `..`. @return false: neither. */
static bool take_byte(const char *text, uint8_t *value, uint8_t *mask) {
    if ((mask != NULL) && (text[0] == '.') && (text[1] == '.')) {
        *value = 0u;
        *mask = 0u;
        return true;
    }
    if ((hex_digit(text[0]) >= HEX_NO_DIGIT) || (hex_digit(text[1]) >= HEX_NO_DIGIT)) {
        return false;
    }
    *value = (uint8_t)((hex_digit(text[0]) * HEX) + hex_digit(text[1]));
    if (mask != NULL) {
        *mask = UINT8_MAX;
    }
    return true;
}

bool yaml_reader_bytes(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint8_t value[8],
                       uint8_t *mask, uint8_t *length) {
    const char *text = yaml_node_text(node);
    unsigned count = 0u;

    if (text == NULL) {
        return yaml_reader_fail(reader, node, "%s: bytes are missing", what);
    }
    memset(value, 0, BYTES_MAX);
    if (mask != NULL) {
        memset(mask, 0, BYTES_MAX);
    }
    for (const char *at = text; *at != '\0'; count++) {
        if ((count == (unsigned)BYTES_MAX) || !take_byte(at, &value[count], (mask != NULL) ? &mask[count] : NULL) ||
            ((at[2] != ' ') && (at[2] != '\0'))) {
            return yaml_reader_fail(reader, node, "%s: '%.*s' is not a list of up to 8 bytes such as \"08 00 FF\"%s",
                                    what, SHOWN_MAX, text, (mask != NULL) ? ", '..' for any" : "");
        }
        at += (at[2] == ' ') ? 3 : 2;
    }
    *length = (uint8_t)count;
    return true;
}

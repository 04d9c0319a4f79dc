#include "io/yaml_reader.h"

#include <stdio.h>
#include <string.h>

#include "io/yaml_file.h"
#include "text/hex.h"
#include "text/suggest.h"
#include "text/words.h"

#define DECIMAL_SET "0123456789"
#define HEX_SET DECIMAL_SET "abcdefABCDEF"

enum { VALUE_SHOWN_MAX = 40, HEX = 16, BYTES_MAX = 8 };

static const char *scalar_text(const yaml_reader_t *reader, const yaml_node_t *node, const char *what,
                               const char *expected) {
    const char *text = yaml_node_text(node);

    if ((text == NULL) || (text[0] == '\0')) {
        (void)yaml_reader_fail(reader, node, "%s: %s is missing", what, expected);
        return NULL;
    }
    return text;
}

const char *yaml_reader_text(const yaml_reader_t *reader, const yaml_node_t *node, const char *what) {
    return scalar_text(reader, node, what, "a word or a text");
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
    uint64_t value = 0;

    if (!is_digits(digits, is_hex ? HEX_SET : DECIMAL_SET)) {
        return false;
    }
    if (is_hex ? !words_hex(digits, strlen(digits), &value) : !words_decimal(digits, 0, INT64_MAX, &value)) {
        value = INT64_MAX;
    }
    value = (value > INT64_MAX) ? (uint64_t)INT64_MAX : value;
    *number = is_negative ? -(int64_t)value : (int64_t)value;
    return true;
}

/** Report a number that is not within its limits. */
static bool check_limits(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, const char *text,
                         int64_t lowest, int64_t highest, const int64_t *number) {
    if ((*number < lowest) || (*number > highest)) {
        return yaml_reader_fail(reader, node, "%s: %.*s is not within %lld to %lld", what, VALUE_SHOWN_MAX, text,
                                (long long)lowest, (long long)highest);
    }
    return true;
}

bool yaml_reader_number(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int64_t lowest,
                        int64_t highest, int64_t *number) {
    const char *text = scalar_text(reader, node, what, "a number");

    if (text == NULL) {
        return false;
    }
    if (!read_whole(text, number)) {
        return yaml_reader_fail(reader, node, "%s: '%.*s' is not a whole number", what, VALUE_SHOWN_MAX, text);
    }
    return check_limits(reader, node, what, text, lowest, highest, number);
}

bool yaml_reader_time(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, duration_unit_t unit,
                      int64_t lowest, int64_t highest, int64_t *number) {
    const char *text = scalar_text(reader, node, what, "a time");
    char problem[DURATION_PROBLEM_SIZE];
    uint64_t value = 0;

    if (text == NULL) {
        return false;
    }
    if (read_whole(text, number)) {
        return check_limits(reader, node, what, text, lowest, highest, number);
    }
    const duration_result_t result = duration_read(text, unit, (uint64_t)lowest, (uint64_t)highest, &value);
    *number = (int64_t)value;
    return (result == DURATION_OK) ||
           yaml_reader_fail(reader, node, "%s: %s", what,
                            duration_problem(result, text, unit, (uint64_t)lowest, (uint64_t)highest, problem));
}

/** Store a number of bits that is not too large. */
static bool take_bits(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, const char *text,
                      uint64_t value, uint32_t highest, uint32_t *number) {
    if (value > highest) {
        return yaml_reader_fail(reader, node, "%s: %.*s is above %Xh", what, VALUE_SHOWN_MAX, text, (unsigned)highest);
    }
    *number = (uint32_t)value;
    return true;
}

bool yaml_reader_hex(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t highest,
                     uint32_t *number) {
    const char *text = yaml_reader_text(reader, node, what);
    uint64_t value = 0;

    if (text == NULL) {
        return false;
    }
    if (!words_bits(text, &value)) {
        return yaml_reader_fail(reader, node, "%s: '%.*s' is not a hexadecimal number such as 168h or 0x168", what,
                                VALUE_SHOWN_MAX, text);
    }
    return take_bits(reader, node, what, text, value, highest, number);
}

bool yaml_reader_id(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, uint32_t highest,
                    uint32_t *number) {
    const char *text = yaml_reader_text(reader, node, what);
    uint64_t value = 0;

    if (text == NULL) {
        return false;
    }
    if (!words_id(text, &value)) {
        return yaml_reader_fail(reader, node, "%s: '%.*s' is not an identifier: 168h, 0x168, or decimal 360", what,
                                VALUE_SHOWN_MAX, text);
    }
    return take_bits(reader, node, what, text, value, highest, number);
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

/** Report a word that is not one of those. */
static bool fail_word(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, const yaml_word_t *words,
                      const char *text) {
    char list[200] = "";
    char meant[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin(text, strlen(text));

    for (const yaml_word_t *word = words; word->word != NULL; word++) {
        const size_t used = strlen(list);
        (void)snprintf(&list[used], sizeof list - used, "%s%s", (used == 0) ? "" : ", ", word->word);
        suggest_offer(&suggestion, word->word, strlen(word->word));
    }
    return yaml_reader_fail(reader, node, "%s: '%.*s' is not one of %s%s", what, VALUE_SHOWN_MAX, text, list,
                            suggest_text(&suggestion, meant));
}

bool yaml_reader_word(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, const yaml_word_t *words,
                      int *value) {
    const char *text = yaml_reader_text(reader, node, what);

    if (text == NULL) {
        return false;
    }
    for (const yaml_word_t *word = words; word->word != NULL; word++) {
        if (strcmp(word->word, text) == 0) {
            *value = word->value;
            return true;
        }
    }
    return fail_word(reader, node, what, words, text);
}

/** Read one of the numbers of a range. */
typedef bool read_one_fn(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int64_t lowest,
                         int64_t highest, int64_t *number);

static bool read_ms(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int64_t lowest,
                    int64_t highest, int64_t *number) {
    return yaml_reader_time(reader, node, what, DURATION_MS, lowest, highest, number);
}

static bool read_both(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, read_one_fn *read,
                      int64_t lowest, int64_t highest, int64_t range[2]) {
    const char *text = yaml_node_text(node);
    if ((text != NULL) && (text[0] != '\0')) {
        if (!read(reader, node, what, lowest, highest, &range[0])) {
            return false;
        }
        range[1] = range[0];
        return true;
    }
    if ((node->type != YAML_SEQUENCE_NODE) || (node->data.sequence.items.top - node->data.sequence.items.start != 2)) {
        return yaml_reader_fail(reader, node, "%s must be %s or a range, [lowest, highest]", what,
                                (read == read_ms) ? "a time" : "a number");
    }
    for (int i = 0; i < 2; i++) {
        const yaml_node_t *item = yaml_document_get_node(reader->document, node->data.sequence.items.start[i]);
        if (!read(reader, item, what, lowest, highest, &range[i])) {
            return false;
        }
    }
    if (range[0] > range[1]) {
        return yaml_reader_fail(reader, node, "%s: the lowest value is above the highest", what);
    }
    return true;
}

bool yaml_reader_range(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int64_t lowest,
                       int64_t highest, int64_t range[2]) {
    return read_both(reader, node, what, yaml_reader_number, lowest, highest, range);
}

bool yaml_reader_time_range(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int64_t lowest,
                            int64_t highest, int64_t range[2]) {
    return read_both(reader, node, what, read_ms, lowest, highest, range);
}

/** Read one byte, or `..`. @return false: neither. */
static bool take_byte(const char *text, uint8_t *value, uint8_t *mask) {
    if ((mask != NULL) && (text[0] == '.') && (text[1] == '.')) {
        *value = 0;
        *mask = 0;
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
    unsigned count = 0;

    if (text == NULL) {
        return yaml_reader_fail(reader, node, "%s: bytes are missing", what);
    }
    memset(value, 0, BYTES_MAX);
    if (mask != NULL) {
        memset(mask, 0, BYTES_MAX);
    }
    for (const char *at = text; *at != '\0'; count++) {
        if ((count == BYTES_MAX) || !take_byte(at, &value[count], (mask != NULL) ? &mask[count] : NULL) ||
            ((at[2] != ' ') && (at[2] != '\0'))) {
            return yaml_reader_fail(reader, node, "%s: '%.*s' is not a list of up to 8 bytes such as \"08 00 FF\"%s",
                                    what, VALUE_SHOWN_MAX, text, (mask != NULL) ? ", '..' for any" : "");
        }
        at += (at[2] == ' ') ? 3 : 2;
    }
    *length = (uint8_t)count;
    return true;
}

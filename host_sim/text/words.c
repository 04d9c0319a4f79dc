#include "text/words.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

#include "text/hex.h"

enum { DECIMAL_BASE = 10, HEX_DIGIT_BITS = 4, HEX_DIGITS_MAX = 16 };

size_t words_at(const char *words, size_t index, const char **word) {
    const char *at = words;
    for (size_t i = 0; i < index; i++) {
        at += strcspn(at, "|");
        at += (*at == '|') ? 1 : 0;
    }
    *word = at;
    return strcspn(at, "|");
}

int words_find(const char *words, const char *word) {
    const size_t size = strlen(word);
    int index = 0;
    for (const char *at = words; *at != '\0'; index++) {
        const size_t length = strcspn(at, "|");
        if ((length == size) && (memcmp(at, word, size) == 0)) {
            return index;
        }
        at += length;
        at += (*at == '|') ? 1 : 0;
    }
    return -1;
}

bool words_decimal(const char *text, uint64_t lowest, uint64_t highest, uint64_t *number) {
    uint64_t value = 0;
    const char *at = text;
    for (; (*at >= '0') && (*at <= '9'); at++) {
        const uint64_t digit = (uint64_t)(*at - '0');
        if (value > (UINT64_MAX - digit) / DECIMAL_BASE) {
            return false;
        }
        value = (value * DECIMAL_BASE) + digit;
    }
    *number = value;
    return (at != text) && (*at == '\0') && (value >= lowest) && (value <= highest);
}

bool words_hex(const char *text, size_t length, uint64_t *number) {
    bool good = (length > 0) && (length <= HEX_DIGITS_MAX);
    *number = 0;
    for (size_t i = 0; good && (i < length); i++) {
        const uint32_t digit = hex_digit(text[i]);
        good = digit < HEX_NO_DIGIT;
        *number = (*number << HEX_DIGIT_BITS) | digit;
    }
    return good;
}

bool words_bits(const char *text, uint64_t *number) {
    const bool has_prefix = (text[0] == '0') && (text[1] == 'x');
    const char *digits = &text[has_prefix ? 2 : 0];
    const size_t length = strspn(digits, "0123456789abcdefABCDEF");
    if ((length == 0) || (strcmp(&digits[length], has_prefix ? "" : "h") != 0)) {
        return false;
    }
    if (!words_hex(digits, length, number)) {
        *number = UINT64_MAX;
    }
    return true;
}

bool words_id(const char *text, uint64_t *number) {
    if ((text[0] == '\0') || (text[strspn(text, "0123456789")] != '\0')) {
        return words_bits(text, number);
    }
    if ((text[0] == '0') && (text[1] != '\0')) {
        return false; /* 065 is more likely 065h than 65 */
    }
    if (!words_decimal(text, 0, UINT64_MAX, number)) {
        *number = UINT64_MAX;
    }
    return true;
}

const char *words_plural(uint64_t count) {
    return (count == 1) ? "" : "s";
}

void words_print_upper(const char *text) {
    for (const char *at = text; *at != '\0'; at++) {
        (void)putchar(toupper((unsigned char)*at));
    }
}

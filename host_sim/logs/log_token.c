#include "logs/log_token.h"

#include <string.h>
#include <strings.h>

#include "text/hex.h"
#include "text/units.h"

enum { DECIMAL = 10, SECONDS_DIGITS_MAX = 12, MICRO_DIGITS = 6, DECIMALS_MAX = 9 };

static bool is_blank(char character) {
    return (character == ' ') || (character == '\t') || (character == '\r');
}

log_token_t log_token_next(const char **cursor, const char *end) {
    const char *at = *cursor;
    while ((at < end) && is_blank(*at)) {
        at++;
    }
    const char *begin = at;
    while ((at < end) && !is_blank(*at)) {
        at++;
    }
    *cursor = at;
    return (log_token_t){.at = begin, .length = (size_t)(at - begin)};
}

bool log_token_begins(log_token_t token, const char *text) {
    const size_t length = strlen(text);
    return (token.length >= length) && (strncasecmp(token.at, text, length) == 0);
}

bool log_token_is(log_token_t token, const char *text) {
    return (token.length == strlen(text)) && log_token_begins(token, text);
}

bool log_token_number(log_token_t token, uint32_t base, uint32_t highest, uint32_t *number) {
    uint64_t value = 0;
    for (size_t i = 0; i < token.length; i++) {
        const uint32_t digit = hex_digit(token.at[i]);
        if ((digit >= base) || (value > highest)) {
            return false;
        }
        value = (value * base) + digit;
    }
    *number = (uint32_t)value;
    return (token.length > 0) && (value <= highest);
}

bool log_token_seconds(log_token_t token, uint64_t *us) {
    uint64_t value = 0;
    size_t i = 0;
    for (; (i < token.length) && (hex_digit(token.at[i]) < DECIMAL); i++) {
        value = (value * DECIMAL) + hex_digit(token.at[i]);
        if (i >= SECONDS_DIGITS_MAX) {
            return false;
        }
    }
    const bool has_seconds = i > 0;
    i += ((i < token.length) && (token.at[i] == '.')) ? 1 : 0;
    size_t decimals = 0;
    for (; (i < token.length) && (hex_digit(token.at[i]) < DECIMAL); i++) {
        value = (decimals < MICRO_DIGITS) ? ((value * DECIMAL) + hex_digit(token.at[i])) : value;
        decimals++;
    }
    const bool good = has_seconds && (i == token.length) && (decimals <= DECIMALS_MAX);
    for (; decimals < MICRO_DIGITS; decimals++) {
        value *= DECIMAL;
    }
    *us = value;
    return good;
}

#include "common/duration.h"

#include <inttypes.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

enum { DECIMAL = 10, FRACTION_DIGITS_MAX = 9 };

/** The units, the largest one last. */
static const struct {
    const char *name;
    uint64_t ms;
} units[] = {{"ms", 1u}, {"s", 1000u}, {"min", 60000u}, {"h", 3600000u}};

enum { UNITS = sizeof units / sizeof units[0] };

/** Milliseconds of a unit; 0: there is no such unit. */
static uint64_t unit_ms(const char *name) {
    for (size_t i = 0u; i < (size_t)UNITS; i++) {
        if (strcmp(units[i].name, name) == 0) {
            return units[i].ms;
        }
    }
    return 0u;
}

static bool is_digit(char character) {
    return (character >= '0') && (character <= '9');
}

/** Append a digit. @return false: the number is too large */
static bool append(uint64_t *value, char digit) {
    const uint64_t add = (uint64_t)(digit - '0');
    if (*value > (UINT64_MAX - add) / DECIMAL) {
        return false;
    }
    *value = (*value * DECIMAL) + add;
    return true;
}

/** Read "1.5" as 15 and a scale of 10. @return what follows; NULL: not a number */
static const char *read_number(const char *text, uint64_t *value, uint64_t *scale) {
    const char *at = text;
    for (; is_digit(*at); at++) {
        if (!append(value, *at)) {
            return NULL;
        }
    }
    if ((at == text) || (*at != '.')) {
        return (at == text) ? NULL : at;
    }
    at++;
    const char *fraction = at;
    for (; is_digit(*at); at++) {
        if (((at - fraction) >= (ptrdiff_t)FRACTION_DIGITS_MAX) || !append(value, *at)) {
            return NULL;
        }
        *scale *= DECIMAL;
    }
    return (at == fraction) ? NULL : at;
}

bool duration_ms(const char *text, uint64_t lowest_ms, uint64_t highest_ms, uint64_t *ms) {
    uint64_t value = 0u;
    uint64_t scale = 1u;
    const char *unit = read_number(text, &value, &scale);
    if (unit == NULL) {
        return false;
    }
    const bool has_unit = *unit != '\0';
    const uint64_t factor = has_unit ? unit_ms(unit) : 1u;
    if ((factor == 0u) || (!has_unit && (scale > 1u)) || (value > UINT64_MAX / factor) ||
        (((value * factor) % scale) != 0u)) {
        return false;
    }
    *ms = (value * factor) / scale;
    return (*ms >= lowest_ms) && (*ms <= highest_ms);
}

const char *duration_text(uint64_t ms, char text[DURATION_TEXT_SIZE]) {
    size_t unit = 0u;
    for (size_t i = 0u; i < (size_t)UNITS; i++) {
        unit = ((ms > 0u) && ((ms % units[i].ms) == 0u)) ? i : unit;
    }
    (void)snprintf(text, DURATION_TEXT_SIZE, "%" PRIu64 "%s", ms / units[unit].ms, units[unit].name);
    return text;
}

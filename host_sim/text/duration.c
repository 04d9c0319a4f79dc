#include "text/duration.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>
#include <string.h>

enum { DECIMAL = 10, FRACTION_DIGITS_MAX = 9, SHOWN_MAX = 40 };

static const struct {
    const char *name;
    const char *words;
    uint64_t us;
} units[] = {
    [DURATION_US] = {"us", "microseconds", 1},
    [DURATION_MS] = {"ms", "milliseconds", 1000},
    [DURATION_S] = {"s", "seconds", 1000000},
    [DURATION_MIN] = {"min", "minutes", 60000000},
    [DURATION_H] = {"h", "hours", UINT64_C(3600000000)},
    [DURATION_D] = {"d", "days", UINT64_C(86400000000)},
};

enum { UNITS = sizeof units / sizeof units[0] };

/** A number as it stands there: 1.5 is 15 with a scale of 10. */
typedef struct {
    uint64_t value;
    uint64_t scale;
    bool overflows;
    bool too_fine; /**< more digits of a fraction than any unit needs */
} decimal_t;

static bool is_digit(char character) {
    return (character >= '0') && (character <= '9');
}

static void append(decimal_t *decimal, char digit) {
    const uint64_t add = (uint64_t)(digit - '0');
    decimal->overflows = decimal->overflows || (decimal->value > (UINT64_MAX - add) / DECIMAL);
    decimal->value = (decimal->value * DECIMAL) + add;
}

/** Read the digits behind the point, without the zeros at their end. @return what follows */
static const char *read_fraction(const char *at, decimal_t *decimal) {
    const char *end = at;
    size_t length = 0;
    for (; is_digit(*end); end++) {
        length = (*end != '0') ? (size_t)(end - at) + 1 : length;
    }
    decimal->too_fine = length > FRACTION_DIGITS_MAX;
    for (size_t i = 0; (i < length) && !decimal->too_fine; i++) {
        append(decimal, at[i]);
        decimal->scale *= DECIMAL;
    }
    return end;
}

/** Read "1.5". @return what follows; NULL: not a number */
static const char *read_decimal(const char *text, decimal_t *decimal, bool *has_point) {
    const char *at = text;
    for (; is_digit(*at); at++) {
        append(decimal, *at);
    }
    *has_point = *at == '.';
    if ((at == text) || !*has_point) {
        return (at == text) ? NULL : at;
    }
    at++;
    return is_digit(*at) ? read_fraction(at, decimal) : NULL;
}

static size_t find_unit(const char *name) {
    size_t unit = 0;
    while ((unit < UNITS) && (strcmp(units[unit].name, name) != 0)) {
        unit++;
    }
    return unit;
}

/** @param b not 0 */
static uint64_t common_divisor(uint64_t a, uint64_t b) {
    do {
        const uint64_t rest = a % b;
        a = b;
        b = rest;
    } while (b != 0);
    return a;
}

/** Express in @p to what is given in @p from. */
static duration_result_t convert(const decimal_t *decimal, size_t from, size_t to, uint64_t *number) {
    const uint64_t divisor = common_divisor(units[from].us, decimal->scale * units[to].us);
    const uint64_t factor = units[from].us / divisor;
    const uint64_t part = (decimal->scale * units[to].us) / divisor;
    if (decimal->too_fine || (!decimal->overflows && ((decimal->value % part) != 0))) {
        return DURATION_TOO_FINE;
    }
    if (decimal->overflows || (decimal->value / part > UINT64_MAX / factor)) {
        return DURATION_OUT_OF_RANGE;
    }
    *number = (decimal->value / part) * factor;
    return DURATION_OK;
}

duration_result_t duration_read(const char *text, duration_unit_t unit, uint64_t lowest, uint64_t highest,
                                uint64_t *number) {
    decimal_t decimal = {.scale = 1};
    bool has_point = false;
    const char *name = read_decimal(text, &decimal, &has_point);
    if ((name == NULL) || (has_point && (*name == '\0'))) {
        return DURATION_NO_TIME;
    }
    const size_t from = (*name == '\0') ? (size_t)unit : find_unit(&name[(*name == ' ') ? 1 : 0]);
    if (from == UNITS) {
        return DURATION_NO_TIME;
    }
    uint64_t found = 0;
    const duration_result_t result = convert(&decimal, from, (size_t)unit, &found);
    if (result != DURATION_OK) {
        return result;
    }
    if ((found < lowest) || (found > highest)) {
        return DURATION_OUT_OF_RANGE;
    }
    *number = found;
    return DURATION_OK;
}

/** Times that are a whole number of a unit. */
static const char *examples_of(duration_unit_t unit) {
    if (unit >= DURATION_D) {
        return "2d";
    }
    return (unit >= DURATION_MIN) ? "2h" : &"250ms, 10s, 1.5min, 2h"[(unit == DURATION_S) ? strlen("250ms, ") : 0];
}

const char *duration_problem(duration_result_t result, const char *text, duration_unit_t unit, uint64_t lowest,
                             uint64_t highest, char problem[DURATION_PROBLEM_SIZE]) {
    char from[DURATION_TEXT_SIZE];
    char to[DURATION_TEXT_SIZE];
    if (result == DURATION_OUT_OF_RANGE) {
        (void)snprintf(problem, DURATION_PROBLEM_SIZE, "'%.*s' is not within %s to %s", SHOWN_MAX, text,
                       duration_text(lowest, unit, from), duration_text(highest, unit, to));
    } else if (result == DURATION_TOO_FINE) {
        (void)snprintf(problem, DURATION_PROBLEM_SIZE, "'%.*s' is not a whole number of %s", SHOWN_MAX, text,
                       units[unit].words);
    } else {
        (void)snprintf(problem, DURATION_PROBLEM_SIZE, "'%.*s' is not a time: %s, or whole %s alone", SHOWN_MAX, text,
                       examples_of(unit), units[unit].words);
    }
    return problem;
}

const char *duration_text(uint64_t number, duration_unit_t unit, char text[DURATION_TEXT_SIZE]) {
    size_t shown = (size_t)unit;
    for (size_t i = (size_t)unit + 1; i < UNITS; i++) {
        shown = ((number > 0) && ((number % (units[i].us / units[unit].us)) == 0)) ? i : shown;
    }
    (void)snprintf(text, DURATION_TEXT_SIZE, "%" PRIu64 "%s", number / (units[shown].us / units[unit].us),
                   units[shown].name);
    return text;
}

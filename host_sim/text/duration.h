/**
 * @file duration.h
 * Times as people write them: "250ms", "10 s", "1.5min", "2h". What a number alone means is for the caller to say.
 */
#ifndef HOST_SIM_DURATION_H
#define HOST_SIM_DURATION_H

#include <stdint.h>

/** What is counted: also the meaning of a number alone. */
typedef enum { DURATION_US, DURATION_MS, DURATION_S, DURATION_MIN, DURATION_H, DURATION_D } duration_unit_t;

/** Whether a text is a time. */
typedef enum {
    DURATION_OK,
    DURATION_NO_TIME,      /**< no number, a sign, an unknown unit, a fraction without a unit */
    DURATION_TOO_FINE,     /**< no whole number of what is counted */
    DURATION_OUT_OF_RANGE, /**< not within the limits */
} duration_result_t;

/**
 * Read a time: digits, perhaps a fraction, perhaps a blank, a unit (us, ms, s, min, h, d), or whole digits alone.
 * @param unit    what is counted
 * @param lowest  limits, in @p unit
 * @param number  how many; set if the result is DURATION_OK
 */
duration_result_t duration_read(const char *text, duration_unit_t unit, uint64_t lowest, uint64_t highest,
                                uint64_t *number);

/** Room for what duration_problem() writes. */
#define DURATION_PROBLEM_SIZE 160u

/**
 * Say what is wrong with a text: "'10 parsecs' is not a time: 250ms, 10s, 1.5min, 2h, or whole milliseconds alone". The
 * examples are whole numbers of @p unit: none that would be refused next.
 * @param result of duration_read() with the same arguments; not DURATION_OK
 * @return problem
 */
const char *duration_problem(duration_result_t result, const char *text, duration_unit_t unit, uint64_t lowest,
                             uint64_t highest, char problem[DURATION_PROBLEM_SIZE]);

/** Room for what duration_text() writes. */
#define DURATION_TEXT_SIZE 32u

/** Write a number of @p unit in the largest unit that is whole: "90s", "1500ms", "2h". @return text */
const char *duration_text(uint64_t number, duration_unit_t unit, char text[DURATION_TEXT_SIZE]);

#endif

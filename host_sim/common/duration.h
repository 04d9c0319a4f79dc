/**
 * @file duration.h
 * Times as people write them: "250ms", "10s", "1.5min", "2h"; a number alone is milliseconds.
 */
#ifndef HOST_SIM_DURATION_H
#define HOST_SIM_DURATION_H

#include <stdbool.h>
#include <stdint.h>

/**
 * Read a time. A fraction needs a unit, and must come to whole milliseconds.
 * @return false: not a time, or not within @p lowest_ms .. @p highest_ms; not reported
 */
bool duration_ms(const char *text, uint64_t lowest_ms, uint64_t highest_ms, uint64_t *ms);

/** Room for what duration_text() writes. */
#define DURATION_TEXT_SIZE 32u

/** Write a time in its largest unit that is whole: "90s", "1500ms", "2h". @return text */
const char *duration_text(uint64_t ms, char text[DURATION_TEXT_SIZE]);

#endif

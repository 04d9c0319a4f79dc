/**
 * @file log_token.h
 * Words of a line that blanks separate, and the numbers in them: for log formats that are made of columns.
 */
#ifndef HOST_SIM_LOG_TOKEN_H
#define HOST_SIM_LOG_TOKEN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** A word; points into the line. `length` 0: there are no more. */
typedef struct {
    const char *at;
    size_t length;
} log_token_t;

/** The next word of a line. @param cursor is moved behind it @param end the line's end */
log_token_t log_token_next(const char **cursor, const char *end);

/** Whether a word is this text, in either case. */
bool log_token_is(log_token_t token, const char *text);

/** Whether a word begins with this text, in either case. */
bool log_token_begins(log_token_t token, const char *text);

/** Read a whole word as a number. @param base 10 or 16 @return false: other characters, or above @p highest */
bool log_token_number(log_token_t token, uint32_t base, uint32_t highest, uint32_t *number);

/**
 * Read a whole word as seconds with 0 to 9 decimals.
 * @return false: other characters, or more than 12 digits of seconds
 */
bool log_token_seconds(log_token_t token, uint64_t *us);

#endif

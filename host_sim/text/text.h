/**
 * @file text.h
 * A text that is put together piece by piece.
 */
#ifndef HOST_SIM_TEXT_H
#define HOST_SIM_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define TEXT_MAX 8192u
#define TEXT_COLUMNS 100 /**< of a line in print */

/** All zero: empty. A piece that finds no room is left out. */
typedef struct {
    char bytes[TEXT_MAX];
    size_t used;
    bool full; /**< a piece was left out */
} text_t;

/** Add a piece. */
void text_add(text_t *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/** Read a character in UTF-8. @return its length; 0: malformed */
size_t text_character(const char *text, uint32_t *character);

/** Add "what: count", behind a comma where it is not the first; nothing for 0. */
void text_add_count(text_t *text, const char *what, uint64_t count);

/** Make it empty. */
void text_clear(text_t *text);

/** Whether a text is one line that a terminal can show: UTF-8 without control characters and other ends of a line. */
bool text_is_one_line(const char *text);

/** Make it one: each byte of another character, or of none, becomes `?`. */
void text_mask(char *text);

/** A copy of a text from outside, such as the name of a file, as one line. @return the bytes of @p copy */
const char *text_one_line(text_t *copy, const char *from);

/** Print a text on standard output from a column on, with further lines below it: TEXT_COLUMNS at most. */
void text_print_from(int column, const char *text);

/** Where to break a text that is longer than @p room: at a blank if there is one. @return length of what fits */
size_t text_break(const char *text, size_t room);

#endif

/*
 * What the parsers' targets share: the bytes of a fuzzer as a file, and what a parser prints.
 */
#ifndef CAPTURE_H
#define CAPTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The bytes as a file in memory. Returns its path, which holds no colon; valid until the next call. */
const char *capture_file(const uint8_t *data, size_t size);

/* From now on standard error, and standard output, are kept. */
void capture_begin(void);

/* No longer. Returns what went to standard error; until the next capture_begin(). */
const char *capture_end(void);

/* What went to standard output, and how much. */
const char *capture_out(size_t *size);

/* End the program, naming what is wrong. */
__attribute__((noreturn)) void capture_fail(const char *what, const char *detail);

/*
 * What was refused is reported in one line, "PATH:LINE: what", of a line that exists.
 * @param highest number of lines of the file
 * @return the number of the line
 */
size_t capture_line(const char *text, const char *path, size_t highest);

/* No more lines than a YAML file of these bytes has, whatever it is encoded in, and one for its end. */
size_t capture_yaml_lines(const uint8_t *data, size_t size);

/* One line, without control characters, and not empty. */
void capture_one_line(const char *text);

#endif

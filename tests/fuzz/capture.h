/*
 * Common parts of the parsers' targets: the bytes of a fuzzer as a file, and the output of a parser.
 */
#ifndef CAPTURE_H
#define CAPTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The bytes as a file in memory. @return its path, without a colon; valid until the next call */
const char *capture_file(const uint8_t *data, size_t size);

/* Start to capture standard error and standard output. */
void capture_begin(void);

/* End the capture. @return the text of standard error; valid until the next capture_begin() */
const char *capture_end(void);

/* The captured standard output, and its size. */
const char *capture_out(size_t *size);

/* End the program with a message. */
__attribute__((noreturn)) void capture_fail(const char *what, const char *detail);

/*
 * A refusal must be reported in one line, "PATH:LINE: reason", with the number of an existing line.
 * @param highest number of lines of the file
 * @return the number of the line
 */
size_t capture_line(const char *text, const char *path, size_t highest);

/* Upper limit of the lines of a YAML file with these bytes, in any encoding, plus one for its end. */
size_t capture_yaml_lines(const uint8_t *data, size_t size);

/* The text must be one line, not empty, without control characters. */
void capture_one_line(const char *text);

#endif

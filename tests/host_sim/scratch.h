/* A folder for the files of one test, and what the program says on standard error meanwhile. */
#ifndef TESTS_SCRATCH_H
#define TESTS_SCRATCH_H

#include <stdbool.h>
#include <stddef.h>

#define SCRATCH_TEXT_MAX 262144u

/* Make the folder, and keep standard error in it. For setUp(): that of the test before, and at last this one, is removed. */
void scratch_open(void);

/* Path of a file in the folder; is overwritten by the fourth call after it. */
const char *scratch_path(const char *name);

/* Write a file in the folder. Returns its path. */
const char *scratch_write(const char *name, const void *bytes, size_t size);

/* Read a file in the folder, as text; "" when it is not there. Is overwritten by the next call. */
const char *scratch_read(const char *name);

/* How many files there are in the folder, the one of standard error not among them. */
size_t scratch_count(void);

/* What was said on standard error since the last call. */
const char *scratch_said(void);

/* One line was said since the last call, with this text in it. Returns where the text begins. */
const char *scratch_said_line(const char *text);

#endif

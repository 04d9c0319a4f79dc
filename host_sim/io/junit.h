/**
 * @file junit.h
 * Results as JUnit XML, as CI servers read it.
 */
#ifndef HOST_SIM_JUNIT_H
#define HOST_SIM_JUNIT_H

#include <stddef.h>

#include "io/output.h"

/** The root element with its totals. */
void junit_begin(output_t *output, const char *suite, size_t tests, size_t failures, size_t errors);

/**
 * One test.
 * @param failures its failures, one line each; `count` of them, 0 = it passed
 * @param stride   size of a line in @p failures
 */
void junit_test(output_t *output, const char *class_name, const char *name, const char *failures, size_t count,
                size_t stride);

/** One that could not be run. */
void junit_error(output_t *output, const char *class_name, const char *name, const char *message);

/** The end of the root element. */
void junit_end(output_t *output);

/** Write text so that it is itself in XML; what XML cannot hold is written as '?'. */
void junit_text(output_t *output, const char *text);

#endif

/**
 * @file typed_lines.h
 * Reads lines from standard input without waiting, while a program runs: from a terminal, a pipe or a file.
 */
#ifndef HOST_SIM_TYPED_LINES_H
#define HOST_SIM_TYPED_LINES_H

#include <stdbool.h>
#include <stddef.h>

/** Longer lines are reported as too long. */
#define TYPED_LINE_MAX 1000u

/** What is being read. */
typedef struct {
    int fd;
    bool ended; /**< nothing more will come */
    bool too_long;
    size_t used;
    char bytes[TYPED_LINE_MAX + 1];
    char line[TYPED_LINE_MAX + 1];
} typed_lines_t;

/** Nothing read yet. */
void typed_lines_init(typed_lines_t *typed, int fd);

/**
 * The next line, if a whole one is there; reads at most once. A last line without an end counts.
 * @return NULL: none now. Else the line without its end; "" also for one that was too long, which was reported.
 *         It lives until the next call.
 */
const char *typed_lines_next(typed_lines_t *typed);

#endif

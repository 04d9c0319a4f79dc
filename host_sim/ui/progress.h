/**
 * @file progress.h
 * A progress bar on standard error, if that is a terminal.
 */
#ifndef HOST_SIM_PROGRESS_H
#define HOST_SIM_PROGRESS_H

#include <stdbool.h>
#include <stdint.h>

typedef struct {
    bool shown; /**< standard error is a terminal */
    uint64_t total;
    int64_t began_ms;
    int64_t next_ms;
} progress_t;

/** Begin. @param total what has to be done */
void progress_begin(progress_t *progress, uint64_t total);

/** So much of it is done. Cheap enough for every thousandth of a second. @param unit "runs" */
void progress_show(progress_t *progress, uint64_t done, const char *unit);

/** Take the bar away. */
void progress_end(progress_t *progress);

#endif

/**
 * @file exit_status.h
 * What the exit statuses of all commands mean, for `--help` and the man pages.
 */
#ifndef HOST_SIM_EXIT_STATUS_H
#define HOST_SIM_EXIT_STATUS_H

#include <stddef.h>

#include "common/report.h"

/** One exit status. */
typedef struct {
    status_t status;
    const char *means; /**< sentences */
} exit_status_t;

/** A row for each. */
extern const exit_status_t EXIT_STATUSES[];
extern const size_t EXIT_STATUS_COUNT;

#endif

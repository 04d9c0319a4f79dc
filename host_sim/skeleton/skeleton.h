/**
 * @file skeleton.h
 * A scenario file from a log: it brings about the first trip of the log with the simulated vehicle, and expects what the
 * supervisor did then. To be worked on by hand.
 */
#ifndef HOST_SIM_SKELETON_H
#define HOST_SIM_SKELETON_H

#include <stdbool.h>

#include "agv/config.h"
#include "common/report.h"

/** What to make. */
typedef struct {
    const char *log;          /**< a file; it is read twice */
    const char *out;          /**< does not exist yet; NULL: standard output */
    const char *ai_interface; /**< gateway: the AI side; NULL on the shared bus */
    bool skip_bad_lines;
    agv_config_t config;
} skeleton_request_t;

/**
 * Make it. The file is written only if it passes when it is run.
 * @return STATUS_UNMET: there is no trip in the log, or the simulated vehicle does not show it; STATUS_UNUSABLE: the log
 *         or the file cannot be used. Both were reported.
 */
status_t skeleton_make(const skeleton_request_t *request);

#endif

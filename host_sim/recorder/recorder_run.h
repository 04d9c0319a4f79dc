/**
 * @file recorder_run.h
 * What a device's flight recorder kept, told as `replay` tells a log.
 *
 * The recorder keeps events, each with the last payload of every message, but not when these came. So the times of a
 * cause are derived from the limits: they are right to a cycle of the message, or null.
 */
#ifndef HOST_SIM_RECORDER_RUN_H
#define HOST_SIM_RECORDER_RUN_H

#include <stdint.h>

#include "agv/config.h"
#include "analysis/analysis.h"
#include "common/report.h"

/** As a run: the newest one with a trip, else the newest. */
#define RECORDER_RUN_NEWEST UINT64_MAX

/** What to read. */
typedef struct {
    const char *path; /**< "-" = standard input */
    analysis_paths_t analysis;
    const char *events; /**< JSON Lines; NULL: none */
    uint64_t run;
    agv_config_t config;
} recorder_request_t;

/** Read, analyse and print. @return STATUS_UNUSABLE: reported */
status_t recorder_run(const recorder_request_t *request);

#endif

/**
 * @file monitor_run.h
 * `host_sim monitor`: the screen, or where there is no terminal a line for each transition.
 */
#ifndef HOST_SIM_MONITOR_RUN_H
#define HOST_SIM_MONITOR_RUN_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "cli/interface_options.h"
#include "common/report.h"

/** As a speed: as fast as possible. */
#define MONITOR_SPEED_ANY 0.0

/** What to watch. */
typedef struct {
    interface_options_t bus;  /**< no interfaces: a log */
    const char *log;          /**< NULL: the interfaces */
    const char *ai_interface; /**< of the log; NULL: none */
    const char *record;       /**< file to record the bus into from the start on; NULL: none */
    double speed;             /**< of the log; MONITOR_SPEED_ANY */
    bool shadow;
    bool skip_bad_lines; /**< of the log */
    agv_config_t config;
} monitor_request_t;

/**
 * Watch until a signal comes, `q` is pressed, or for so long; a log without a screen: until its end.
 * @return STATUS_OK, or STATUS_UNUSABLE: was reported
 */
status_t monitor_run(const monitor_request_t *request);

#endif

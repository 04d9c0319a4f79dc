/**
 * @file vehicle_run.h
 * A simulated vehicle in real time: the nodes on SocketCAN (vehicle_bus.h), the operator, faults at their times, and
 * what is typed.
 */
#ifndef HOST_SIM_VEHICLE_RUN_H
#define HOST_SIM_VEHICLE_RUN_H

#include <stdbool.h>
#include <stddef.h>

#include "agv/config.h"
#include "cli/interface_options.h"
#include "common/report.h"
#include "live/vehicle_words.h"

#define VEHICLE_RUN_FAULTS_MAX 64u

/** What to run. */
typedef struct {
    interface_options_t bus;                        /**< the AI side: NULL on the shared bus */
    agv_config_t config;                            /**< its ID set and its topology count */
    bool screen;                                    /**< the screen of the monitor, if there is a terminal */
    bool manual;                                    /**< the operator does not engage the autopilot */
    vehicle_words_t faults[VEHICLE_RUN_FAULTS_MAX]; /**< in the order of their time */
    size_t fault_count;
} vehicle_run_request_t;

/**
 * Run until SIGINT, SIGTERM or SIGHUP, `quit` is typed, or for so long. Events go to standard output, lines are typed
 * into standard input.
 * @return STATUS_OK, or STATUS_UNUSABLE: was reported
 */
status_t vehicle_run_nodes(const vehicle_run_request_t *request);

#endif

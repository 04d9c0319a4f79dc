/**
 * @file live.h
 * The supervisor alone as a node on SocketCAN, in real time.
 */
#ifndef HOST_SIM_LIVE_H
#define HOST_SIM_LIVE_H

#include <stdbool.h>

#include "agv/config.h"
#include "analysis/analysis.h"
#include "cli/interface_options.h"
#include "common/report.h"

/** What to run. */
typedef struct {
    interface_options_t bus;   /**< the AI side: NULL on the shared bus */
    const char *out;           /**< log of what was sent; NULL: none */
    const char *events;        /**< NULL: none */
    analysis_paths_t analysis; /**< written at the end */
    bool fail_on_trip;
    bool realtime; /**< SCHED_FIFO, memory locked */
    bool screen;   /**< the screen of the monitor, if there is a terminal */
    agv_config_t config;
} live_request_t;

/**
 * Run until SIGINT, SIGTERM or SIGHUP, or for so long. The files are written line by line as things happen.
 * @return STATUS_OK; STATUS_UNMET when it tripped and that is a failure; STATUS_UNUSABLE, which was reported.
 */
status_t live_run(const live_request_t *request);

#endif

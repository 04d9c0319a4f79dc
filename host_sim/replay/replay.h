/**
 * @file replay.h
 * A recorded log, supervised in virtual time.
 *
 * Time begins with the stamp of the first frame. Ticks fall on the whole milliseconds after it; a frame is handed over
 * at its own time, before the tick of the same moment. What a frame causes to be sent carries its stamp, what a tick
 * causes the tick's. A stamp that goes backwards is taken as the last one.
 */
#ifndef HOST_SIM_REPLAY_H
#define HOST_SIM_REPLAY_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "analysis/analysis.h"
#include "common/report.h"
#include "hal/reset.h"

/** The longest tail: 100 days. */
#define REPLAY_TAIL_MAX_MS 8640000000u

/** Who wants to know what came of it, instead of a text on standard output. */
typedef struct {
    session_observer_fn *on_event;
    void (*on_end)(void *ctx, const why_t *why); /**< the log is over */
    void *ctx;
} replay_listener_t;

/** What to replay. */
typedef struct {
    const char *log;    /**< "-" = standard input */
    const char *out;    /**< log of what was sent; NULL: none */
    const char *events; /**< NULL: none, a summary goes to standard output */
    const char *store;  /**< what outlives a reset; NULL: nothing does */
    analysis_paths_t analysis;
    bool timeline;            /**< a line for each action and event on standard output */
    bool fail_on_trip;        /**< STATUS_UNMET if it tripped, or if nothing was supervised */
    const char *ai_interface; /**< gateway: the AI side; NULL on the shared bus */
    uint32_t start_ms;        /**< what the supervisor's clock reads at the start */
    uint64_t until_ms;        /**< lines from this time on are left out; 0: none */
    uint64_t tail_ms;         /**< how long to go on after the last line */
    bool skip_bad_lines;
    hal_reset_cause_t reset_cause;
    agv_config_t config;
    const replay_listener_t *listener; /**< NULL: nobody, the text is printed */
} replay_request_t;

/**
 * Replay. Files are written as a whole at the end, or not at all.
 * @return STATUS_OK: it ran, also if the supervisor tripped (but see fail_on_trip); STATUS_UNMET; else
 *         STATUS_UNUSABLE, which was reported.
 */
status_t replay_run(const replay_request_t *request);

#endif

/**
 * @file analysis.h
 * The one hub that replay, scenario, demo, run and recorder feed with frames and events. It knows why the supervisor
 * tripped (why/), what was on the bus (traffic/) and how it went over time (report/), and writes the files that the
 * user asked for: `--why`, `--report`, `--trace`.
 *
 * All times are microseconds since the start of the run; the calls come in the order of time.
 */
#ifndef HOST_SIM_ANALYSIS_H
#define HOST_SIM_ANALYSIS_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"
#include "io/output.h"
#include "session/session.h"
#include "why/why.h"

/** The files that an analysis writes. */
typedef enum { ANALYSIS_WHY, ANALYSIS_REPORT, ANALYSIS_TRACE, ANALYSIS_FILES } analysis_file_t;

/** Their paths. */
typedef struct {
    const char *paths[ANALYSIS_FILES]; /**< NULL: not asked for; are not copied */
} analysis_paths_t;

/** Whether one of the files was asked for. */
bool analysis_paths_any(const analysis_paths_t *files);

/** Whether one of the files is standard output. */
bool analysis_paths_use_stdout(const analysis_paths_t *files);

/** What is analysed. */
typedef struct {
    const agv_config_t *config; /**< is copied */
    const char *log;            /**< name of the log, the interface or the scenario; is not copied */
    analysis_paths_t files;
    bool is_recording; /**< the frames do not obey the supervisor */
    bool is_recorder;  /**< the events come from a flight recorder, and no frames with them */
} analysis_request_t;

typedef struct analysis analysis_t;

/** Begin. @return NULL: no memory; was reported */
analysis_t *analysis_new(const analysis_request_t *request);

/** Open the files. @return false: one cannot be written; was reported */
bool analysis_open(analysis_t *analysis);

/** The name of a side's interface. Only the first call for a side counts. */
void analysis_name_side(analysis_t *analysis, hal_can_side_t side, const char *name, size_t length);

/** The time of day of the start of the run, in us since 1970; without it there is none. */
void analysis_set_clock(analysis_t *analysis, uint64_t first_us);

/** A frame was received. */
void analysis_frame(analysis_t *analysis, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** A frame of the supervisor was sent. */
void analysis_sent(analysis_t *analysis, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** An event of the supervisor: a session_observer_fn; @p ctx is the analysis_t. */
void analysis_event(void *ctx, const session_event_t *event);

/** The run is over. */
void analysis_end(analysis_t *analysis, uint64_t t_us);

/** Kinds of remarks. */
typedef enum {
    ANALYSIS_NOT_SUPERVISED, /**< a part of the run was not supervised: the page may not look like a pass */
    ANALYSIS_GOES_BACK,      /**< the same, because the time stamps go back */
    ANALYSIS_HINT            /**< what to try */
} analysis_remark_t;

/** A remark for the page. After analysis_end(). @param text is copied */
void analysis_remark(analysis_t *analysis, analysis_remark_t kind, const char *text);

/** Make the content of the files. Once, after analysis_end(). */
void analysis_write(analysis_t *analysis);

/** Write the files so far. @return false: one failed; was reported, and none is put in its place */
bool analysis_flush(analysis_t *analysis);

/** Put the files in their place. @return false: reported */
bool analysis_commit(analysis_t *analysis);

/** Why it tripped. */
const why_t *analysis_why(const analysis_t *analysis);

/** Whether nothing has failed to be written so far. */
bool analysis_works(const analysis_t *analysis);

/** Release it; files that are not committed are discarded. Nothing for NULL. */
void analysis_free(analysis_t *analysis);

#endif

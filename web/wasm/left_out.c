/*
 * What a page has no use for, or has by itself: functions of the host program that replay and analysis call. A page has
 * no signals; its files are always ready; it unpacks gzip itself; nothing of a run is kept on a disk, traced for
 * another program, or printed on a terminal. Of the C library, what would bring much with it.
 */
#include <string.h>

#include "analysis/trace.h"
#include "common/interrupt.h"
#include "io/store_file.h"
#include "logs/gunzip.h"
#include "ui/timeline.h"
#include "why/why_internal.h"

/* --- fcntl.h, string.h */

/** open() of candump_log.c: the log of web_replay() is standard input. */
int open_log(const char *path, int flags, ...);
int open_log(const char *path, int flags, ...) {
    (void)path;
    (void)flags;
    return 0;
}

char *strerror(int number) {
    (void)number;
    static char text[] = "no memory"; /* nothing else fails in a page */
    return text;
}

/* --- common/interrupt.h */

void interrupt_hold(void) {
}

void interrupt_release(void) {
}

bool interrupt_pending(void) {
    return false;
}

bool interrupt_wait(int fd, interrupt_for_t what) {
    (void)fd;
    (void)what;
    return true;
}

/* --- logs/gunzip.h */

void gunzip_init(gunzip_t *gunzip) {
    gunzip->is_packed = false;
}

ssize_t gunzip_read(gunzip_t *gunzip, gunzip_source_fn *source, void *ctx, void *bytes, size_t size,
                    const char **wrong) {
    (void)gunzip;
    *wrong = NULL;
    return source(ctx, bytes, size);
}

void gunzip_end(gunzip_t *gunzip) {
    (void)gunzip;
}

/* --- io/store_file.h: web_replay() names no store */

bool store_file_load(const char *path, sim_store_t *store, agv_recorder_t *recorder) {
    (void)path;
    (void)store;
    (void)recorder;
    return false;
}

void store_file_save(output_t *output, const sim_store_t *store, const agv_recorder_t *recorder) {
    (void)output;
    (void)store;
    (void)recorder;
}

/* --- analysis/trace.h: no trace is asked for */

void trace_begin(trace_t *trace, output_t *output, const agv_config_t *config) {
    (void)trace;
    (void)output;
    (void)config;
}

void trace_frame(trace_t *trace, hal_can_side_t side, const hal_can_frame_t *frame, bool sent, uint64_t t_us) {
    (void)trace;
    (void)side;
    (void)frame;
    (void)sent;
    (void)t_us;
}

void trace_event(trace_t *trace, const session_event_t *event) {
    (void)trace;
    (void)event;
}

void trace_end(trace_t *trace, uint64_t t_us) {
    (void)trace;
    (void)t_us;
}

/* --- texts for a terminal */

void timeline_init_run(timeline_t *timeline, const agv_config_t *config) {
    (void)timeline;
    (void)config;
}

void timeline_event(void *ctx, const session_event_t *event) {
    (void)ctx;
    (void)event;
}

void timeline_received(timeline_t *timeline, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    (void)timeline;
    (void)side;
    (void)frame;
    (void)t_us;
}

void timeline_sent(timeline_t *timeline, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us) {
    (void)timeline;
    (void)side;
    (void)frame;
    (void)t_us;
}

/* --- why/why_recorded.c: no page reads a flight recorder */

void why_cause_recorded(const why_t *why, const agv_event_t *event, why_trip_t *trip) {
    (void)why;
    (void)event;
    (void)trip;
}

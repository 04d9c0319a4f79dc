/**
 * @file monitor_internal.h
 * What the parts of the monitor share.
 */
#ifndef HOST_SIM_MONITOR_INTERNAL_H
#define HOST_SIM_MONITOR_INTERNAL_H

#include "monitor/monitor.h"

/** Half a second, in which the longest gap is kept. */
#define MONITOR_HALF_US 500000u

/** Add an entry to the log. */
void monitor_say(monitor_t *monitor, uint64_t t_us, monitor_level_t level, const char *who, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/** Make the rows of all messages. */
void monitor_rows_make(monitor_t *monitor);

/** A well-formed frame of a row. */
void monitor_rows_take(monitor_t *monitor, monitor_row_t *row, const uint8_t data[AGV_DLC], uint64_t t_us);

/** Find the rows that are late by now. */
void monitor_rows_time(monitor_t *monitor);

/** A half second is over: begin the next one. */
void monitor_rows_half(monitor_t *monitor);

/** Find the bits of each message whose change is listed. */
void monitor_changes_make(monitor_t *monitor);

/** List what has changed between the last payload of a row and this one. */
void monitor_changes_list(monitor_t *monitor, monitor_row_t *row, const uint8_t data[AGV_DLC], uint64_t t_us);

/** Begin to follow the supervisor. */
void monitor_supervisor_start(monitor_t *monitor);

/** A frame; the status frame is one of them. */
void monitor_supervisor_frame(monitor_t *monitor, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t t_us);

/** Time has passed. */
void monitor_supervisor_time(monitor_t *monitor);

/** Whether a frame is the status frame of a supervisor. */
bool monitor_is_status(const monitor_t *monitor, hal_can_side_t side, const hal_can_frame_t *frame);

#endif

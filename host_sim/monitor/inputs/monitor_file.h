/**
 * @file monitor_file.h
 * Feeds a monitor from a recorded log, as fast as its time stamps say, or by a factor faster or slower.
 */
#ifndef HOST_SIM_MONITOR_FILE_H
#define HOST_SIM_MONITOR_FILE_H

#include <stdbool.h>
#include <stdint.h>

#include "logs/candump_log.h"
#include "monitor/monitor.h"

/** As a time to pass on frames until: all. */
#define MONITOR_FILE_ALL UINT64_MAX

/** A log that is being read. Some 256 KiB: on the heap. */
typedef struct {
    candump_log_t log;
    candump_record_t next;
    const char *ai_interface;                  /**< frames of this one are the AI side's; NULL: none */
    char interface[CANDUMP_INTERFACE_MAX + 1]; /**< the first other one */
    uint64_t first_us;                         /**< stamp of the first frame */
    uint64_t next_us;                          /**< time of `next`; never goes back */
    uint64_t back_us;                          /**< the furthest that a time stamp went back; 0: none did */
    uint64_t back_line;                        /**< where */
    bool ai_was_heard;                         /**< a frame of the AI side was passed on */
    bool has_next;
    bool is_read; /**< to its end */
    bool failed;  /**< a bad line or a read error: was reported */
} monitor_file_t;

/** Open a log and read its first frame. @return false: was reported */
bool monitor_file_open(monitor_file_t *file, const char *path, const char *ai_interface, bool skip_bad);

/** Say on standard error what is wrong with the times, and how many lines were skipped. Nothing if all is well. */
void monitor_file_remark(const monitor_file_t *file);

/**
 * Pass on the frames up to a time, some thousand at most.
 * @return false: the log has ended, or `failed`
 */
bool monitor_file_pass(monitor_file_t *file, monitor_t *monitor, uint64_t until_us);

/** Close it. */
void monitor_file_close(monitor_file_t *file);

#endif

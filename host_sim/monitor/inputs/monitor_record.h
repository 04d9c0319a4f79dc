/**
 * @file monitor_record.h
 * Records what is heard into a candump log (as `candump -l` writes it), a file that did not exist before.
 */
#ifndef HOST_SIM_MONITOR_RECORD_H
#define HOST_SIM_MONITOR_RECORD_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/can.h"

#define MONITOR_RECORD_BUFFER 65536u
#define MONITOR_RECORD_NAME_SIZE 256u

/** A recording. Start from monitor_record_init(). Some 64 KiB: on the heap. */
typedef struct {
    int fd;            /**< -1: none */
    int error;         /**< errno of the first write that failed */
    uint64_t frames;   /**< written into the present file */
    uint64_t left_out; /**< CAN FD frames, of which the port passes on the first 8 bytes only */
    size_t used;
    char name[MONITOR_RECORD_NAME_SIZE];
    char buffer[MONITOR_RECORD_BUFFER];
} monitor_record_t;

/** Nothing is recorded. */
void monitor_record_init(monitor_record_t *record);

/** Begin. @param path NULL: a name of the present time, "monitor-20261123-093000.log" @return false: errno says why */
bool monitor_record_begin(monitor_record_t *record, const char *path);

/** Add a frame; nothing while nothing is recorded. */
void monitor_record_add(monitor_record_t *record, const char *interface, uint64_t stamp_us,
                        const hal_can_frame_t *frame);

/** Write what is in the buffer. @return false: a write failed, `error` says why; the file has ended there */
bool monitor_record_flush(monitor_record_t *record);

/** End it. @return as monitor_record_flush() */
bool monitor_record_end(monitor_record_t *record);

/** End it, and say on standard error what failed or is not in the file. @return as monitor_record_flush() */
bool monitor_record_close(monitor_record_t *record);

#endif

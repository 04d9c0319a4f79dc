/**
 * @file candump_log.h
 * A candump log, read from a file or a pipe as a stream: one buffer, no allocation, logs of any length.
 */
#ifndef HOST_SIM_CANDUMP_LOG_H
#define HOST_SIM_CANDUMP_LOG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/candump_line.h"

#define CANDUMP_BUFFER_SIZE 262144u

/** A log that is being read. Read the members freely. Some 256 KiB: not for the stack. */
typedef struct {
    const char *name; /**< for messages; stdin's is "standard input" */
    uint64_t line;    /**< number of the line that was read last, from 1 */
    uint64_t skipped; /**< bad lines skipped so far */
    bool skip_bad;    /**< skip and count bad lines; else they end the reading */
    bool interrupted; /**< a signal asked the program to end */
    int fd;
    bool at_end;
    size_t begin; /**< of what is not read yet, in `buffer` */
    size_t end;
    char buffer[CANDUMP_BUFFER_SIZE + 1u];
} candump_log_t;

/** What reading a line came to. */
typedef enum {
    CANDUMP_RECORD, /**< a frame was read */
    CANDUMP_END,    /**< there are no more */
    CANDUMP_FAILED  /**< a bad line, or a read error: was reported. Or `interrupted`, which was not. */
} candump_result_t;

/**
 * Open a log.
 * @param path "-" = standard input; must outlive the log
 * @return false: it cannot be read; was reported.
 */
bool candump_open(candump_log_t *log, const char *path, bool skip_bad);

/**
 * Read the next frame. Blank lines are passed over.
 * @param record is valid until the next call
 */
candump_result_t candump_next(candump_log_t *log, candump_record_t *record);

/**
 * Treat the line that was read last as a bad one after all.
 * @param wrong what is wrong with it
 * @return true: it is skipped and counted. false: that is the end; was reported.
 */
bool candump_reject(candump_log_t *log, const char *wrong);

/** Close it. */
void candump_close(candump_log_t *log);

#endif

/**
 * @file candump_log.h
 * A log of frames, read from a file or a pipe as a stream: fixed buffers, logs of any length.
 *
 * A line with a time stamp that is more than 100 days after the one before is a bad line. If the line after it is as
 * late, the clock was set: the reading ends there, also where bad lines are skipped, or the whole rest would be.
 *
 * Read are `candump -l`, what candump shows on the screen with time stamps (candump_screen.h), and Vector ASC
 * (vector_asc.h), each also compressed with gzip. The content tells the format, not the name. Of other known formats the
 * message says how to convert them (log_foreign.h).
 */
#ifndef HOST_SIM_CANDUMP_LOG_H
#define HOST_SIM_CANDUMP_LOG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "logs/candump_line.h"
#include "logs/candump_screen.h"
#include "logs/gunzip.h"
#include "logs/vector_asc.h"

#define CANDUMP_BUFFER_SIZE 262144u
#define CANDUMP_LONG_LINE_MAX 16383u /**< characters of a line of another format than `candump -l` */
/** @name A log in which so many bytes bring no frame is given up: before and after its format is known @{ */
#define CANDUMP_UNKNOWN_MAX (16ull << 20u)
#define CANDUMP_FRAMELESS_MAX (1024ull << 20u)
/** @} */

/** The format of a log. */
typedef enum { CANDUMP_FORMAT_UNKNOWN, CANDUMP_FORMAT_LOG, CANDUMP_FORMAT_SCREEN, CANDUMP_FORMAT_ASC } candump_format_t;

/** "candump -l", "candump -t", "Vector ASC"; "unknown" as long as no line said it. */
const char *candump_format_name(candump_format_t format);

/** A log that is being read. Read the members freely. Some 320 KiB: not for the stack. */
typedef struct {
    const char *name; /**< for messages; stdin's is "standard input" */
    uint64_t line;    /**< number of the line that was read last, from 1 */
    uint64_t skipped; /**< bad lines skipped so far */
    bool skip_bad;    /**< skip and count bad lines; else they end the reading */
    int fd;
    bool at_end;
    bool is_interrupted; /**< the reading failed because of a signal (interrupt.h) */
    bool is_cut_off;     /**< the line that was read last is the last one, and has no line feed */
    bool is_checked;     /**< its first bytes are not those of a binary format */
    candump_format_t format;
    uint64_t frameless; /**< bytes read since the last frame */
    uint64_t newest_us; /**< the latest time stamp; UINT64_MAX: none yet */
    uint64_t late_us;   /**< a time stamp that was too late, */
    uint64_t late_line; /**< and its line; 0: the last frame was in time */
    candump_screen_t screen;
    vector_asc_t asc;
    gunzip_t gunzip;
    size_t begin; /**< of what is not read yet, in `buffer` */
    size_t end;
    char buffer[CANDUMP_BUFFER_SIZE + 1];
} candump_log_t;

/** What reading a line came to. */
typedef enum {
    CANDUMP_RECORD, /**< a frame was read */
    CANDUMP_END,    /**< there are no more */
    CANDUMP_FAILED  /**< a bad line, or a read error: was reported. Or interrupted (a signal), not reported. */
} candump_result_t;

/**
 * Open a log. What its format is shows when it is read.
 * @param path "-" = standard input; must outlive the log
 * @return false: it cannot be read; was reported.
 */
bool candump_open(candump_log_t *log, const char *path, bool skip_bad);

/**
 * Read the next frame. Blank lines, and lines of the format that have no frame, are passed over.
 * @param record is valid until the next call
 */
candump_result_t candump_next(candump_log_t *log, candump_record_t *record);

/** Close it. */
void candump_close(candump_log_t *log);

#endif

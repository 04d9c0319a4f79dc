/**
 * @file live_output.h
 * A file that is written while a supervisor runs on a real bus: line by line and in place, so that it can be followed
 * (`tail -f`), and so that what ended the program hard took no more than the last line with it. Nothing here waits:
 * what a slow reader does not take stays in the buffer, and what finds no room there is lost and counted.
 */
#ifndef HOST_SIM_LIVE_OUTPUT_H
#define HOST_SIM_LIVE_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>

#include "io/output.h"

/** An output. All zero: not open. Some 64 KiB: not for the stack. */
typedef struct {
    output_t lines;      /**< where a writer puts its line when live_output_has_room() says so */
    uint64_t lost_lines; /**< that found no room */
    bool is_file;        /**< a regular one */
} live_output_t;

/**
 * Open an output. A file that is there stays as it is until live_output_begin(); for the reader of a named pipe nobody
 * waits.
 * @param path as output_open()
 * @return false: it cannot be written; was reported.
 */
bool live_output_open(live_output_t *output, const char *path);

/** Lines are to come: a file that was there is emptied. @return false: reported; true also when it is not open */
bool live_output_begin(live_output_t *output);

/** Whether a line can be put into `lines`: it is open and has room. A line that has none is counted. */
bool live_output_has_room(live_output_t *output);

/** Write what the reader takes now. */
void live_output_pass(live_output_t *output);

/**
 * No more is to come: hand over the rest, waiting a second at most for a slow reader, and close.
 * @return false: not everything arrived; was reported.
 */
bool live_output_end(live_output_t *output);

/** Whether a file takes something now, or within @p wait_ms. */
bool live_output_takes(int fd, int wait_ms);

#endif

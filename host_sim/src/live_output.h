/**
 * @file live_output.h
 * A file that is written while a supervisor runs on a real bus: line by line and in place, so that it can be followed
 * (`tail -f`), and so that what ended the program hard took no more than the last line with it. Nothing here waits: what
 * a slow reader does not take stays in the buffer, and what finds no room there is lost and counted.
 */
#ifndef HOST_SIM_LIVE_OUTPUT_H
#define HOST_SIM_LIVE_OUTPUT_H

#include <stdbool.h>
#include <stdint.h>

#include "output.h"

/** An output. All zero: not open. Some 64 KiB: not for the stack. */
typedef struct {
    output_t lines;      /**< where a writer puts its line when live_output_has_room() says so */
    uint64_t lost_lines; /**< that found no room */
} live_output_t;

/**
 * Open an output; a file that is there is emptied.
 * @param path as output_open()
 * @return false: it cannot be written; was reported.
 */
bool live_output_open(live_output_t *output, const char *path);

/** Whether a line can be put into `lines`: it is open and has room. A line that has none is counted. */
bool live_output_has_room(live_output_t *output);

/** Hand over what the reader takes at this moment. */
void live_output_pass(live_output_t *output);

/**
 * No more is to come: hand over the rest, waiting a second at most for a slow reader, and close.
 * @return false: not everything arrived; was reported.
 */
bool live_output_end(live_output_t *output);

/** Whether a file takes something now, or within @p wait_ms. */
bool live_output_takes(int fd, int wait_ms);

#endif

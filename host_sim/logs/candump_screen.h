/**
 * @file candump_screen.h
 * One line of what candump shows on the screen with time stamps: `candump -t a` (since 1970), `-t z` (since the first
 * frame), `-t A` (a date, taken as UTC): " (1700000000.000000)  can0  43F   [8]  00 00 00 00 00 00 00 11".
 *
 * The columns of -x ("RX - -") and -a (text in quotation marks) may be there. Lines that begin with a tab describe the
 * error frame before them (-e).
 */
#ifndef HOST_SIM_CANDUMP_SCREEN_H
#define HOST_SIM_CANDUMP_SCREEN_H

#include <stddef.h>

#include "logs/candump_line.h"

/** What has been read so far. All zero: nothing. */
typedef struct {
    uint64_t last_us;
    uint32_t lines;
    uint32_t backward; /**< time stamps that went backwards, among the first lines */
} candump_screen_t;

/**
 * Parse a line.
 * @param line its first character; line[length] is the line feed
 * @return NULL: @p record is filled in. LOG_NO_FRAME: a line without a frame. Else: what is wrong.
 */
const char *candump_screen_parse(candump_screen_t *screen, const char *line, size_t length, candump_record_t *record);

#endif

/**
 * @file vector_asc.h
 * One line of a Vector ASC log (CANalyzer, CANoe, python-can, log2asc):
 * "   0.010000 1  43F             Rx   d 8 00 00 00 00 00 00 00 11".
 *
 * Read are data, remote and error frames, CAN FD lines, and the state of the controller ("CAN 1 Status: ..."). Header
 * ("base hex|dec", "timestamps absolute|relative"), comments and all other events are passed over. Channel n is the
 * interface can<n-1>, as in can-utils and python-can. The date counts as UTC; without one, time begins at 0. It is that of the
 * header, or that of a "Begin Triggerblock" behind which "0.0 Start of measurement" stands (python-can's header has the time
 * of the conversion).
 */
#ifndef HOST_SIM_VECTOR_ASC_H
#define HOST_SIM_VECTOR_ASC_H

#include <stdbool.h>
#include <stddef.h>

#include "logs/candump_line.h"
#include "logs/log_token.h"

/** What has been read so far. All zero: nothing. */
typedef struct {
    uint64_t start_us; /**< the date of time 0 */
    uint64_t block_us; /**< the date of the last "Begin Triggerblock"; 0: none */
    uint64_t last_us;  /**< relative time stamps: of the last line, since the start */
    bool has_base;     /**< a line "base ..." was read, or its absence noted: hexadecimal, absolute */
    bool is_decimal;   /**< identifiers and data are decimal numbers */
    bool is_relative;  /**< a time stamp counts from the line before */
    char interface[CANDUMP_INTERFACE_MAX + 1];
} vector_asc_t;

/** Whether a line can be the first one of such a log. */
bool vector_asc_begins(const char *line, size_t length);

/**
 * Parse a line.
 * @param line its first character; line[length] is the line feed
 * @return NULL: @p record is filled in. LOG_NO_FRAME: a line without a frame. Else: what is wrong.
 */
const char *vector_asc_parse(vector_asc_t *asc, const char *line, size_t length, candump_record_t *record);

#endif

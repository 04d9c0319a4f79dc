/**
 * @file candump_line.h
 * One line of a candump log (`candump -l`, canplayer's input): "(1700000000.000000) can0 43F#0000000000000011".
 *
 * Read strictly: exactly what can-utils writes, so that a damaged log is noticed. In words:
 * - time stamp: 1 to 12 digits of seconds, 6 digits of microseconds (or 9 of nanoseconds, rounded down);
 * - one or more blanks, the interface's name (1 to 15 visible ASCII characters), one blank;
 * - 3 hexadecimal digits (up to 7FF) or 8 (29 bits: extended; 20000000 set: an error frame), `#`, then
 *   - 0 to 8 bytes in hexadecimal; 8 bytes may be followed by the raw DLC, `_9` to `_F`;
 *   - or `R`, and perhaps the requested length, 0 to 8 (8 perhaps with its raw DLC): a remote frame;
 *   - or `#`, a digit of flags, and 0 to 64 bytes: a CAN FD frame;
 * - perhaps ` R` or ` T` (received, sent: `candump -x`); perhaps a carriage return.
 */
#ifndef HOST_SIM_CANDUMP_LINE_H
#define HOST_SIM_CANDUMP_LINE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/can.h"

#define CANDUMP_ID_MAX 0x7FFu               /**< of 11 bits */
#define CANDUMP_EXTENDED_ID_MAX 0x1FFFFFFFu /**< of 29 bits */
#define CANDUMP_INTERFACE_MAX 15u           /**< characters of an interface's name */
#define CANDUMP_LINE_MAX 255u               /**< characters of a line; the longest valid one has fewer */
#define CANDUMP_ID_SIZE 9u                  /**< of the text of an identifier */
#define CANDUMP_WRITE_MAX 80u               /**< more than candump_write() ever writes */
#define CANDUMP_GAP_MAX_US 8640000000000u   /**< the longest that a log may be silent: 100 days */

/** What a parser returns for a line that is in order but has no frame: a header, a comment, another event. */
extern const char LOG_NO_FRAME[];

/** @name Classes and details of error frames (linux/can/error.h). @{ */
#define CANDUMP_ERROR_FLAG 0x20000000u /**< of the identifier in a line */
#define CANDUMP_ERROR_PROTOCOL 0x008u
#define CANDUMP_ERROR_CONTROLLER 0x004u /**< details in data[1] */
#define CANDUMP_ERROR_BUS_OFF 0x040u
#define CANDUMP_ERROR_RESTARTED 0x100u
#define CANDUMP_CONTROLLER_RX_OVERFLOW 0x01u
#define CANDUMP_CONTROLLER_WARNING 0x0Cu /**< of receiver or sender: above 96 errors, still error active */
#define CANDUMP_CONTROLLER_PASSIVE 0x30u /**< of receiver or sender */
#define CANDUMP_CONTROLLER_ACTIVE 0x40u  /**< error active again */
/** @} */

/** A parsed line. */
typedef struct {
    uint64_t stamp_us;       /**< time stamp in microseconds */
    const char *interface;   /**< not terminated; points into the line */
    size_t interface_length; /**< 1..CANDUMP_INTERFACE_MAX */
    hal_can_frame_t frame;   /**< time_ms is 0; the identifier of an error frame is its classes */
} candump_record_t;

/**
 * Parse a line.
 * @param line its first character; line[length] is the line feed
 * @return NULL: @p record is filled in. Else: what is wrong, a phrase for a message.
 */
const char *candump_parse(const char *line, size_t length, candump_record_t *record);

/** Whether a record is of an interface. @param interface NULL: it is of none */
bool candump_is_from(const candump_record_t *record, const char *interface);

/**
 * An identifier as candump writes it: three digits, or eight of an extended identifier and of an error frame.
 * @param flags HAL_CAN_* of the frame
 * @return text
 */
const char *candump_id_text(char text[CANDUMP_ID_SIZE], uint32_t id, uint8_t flags);

/**
 * Write a classic data frame as a line, line feed included.
 * @param line CANDUMP_WRITE_MAX bytes
 * @param interface at most CANDUMP_INTERFACE_MAX characters
 * @return length of the line
 */
size_t candump_write(char *line, uint64_t stamp_us, const char *interface, const hal_can_frame_t *frame);

#endif

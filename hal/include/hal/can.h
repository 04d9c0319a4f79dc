/**
 * @file can.h
 * The CAN controllers of the supervisor: the vehicle side, and in the gateway topology also the AI side.
 */
#ifndef HAL_CAN_H
#define HAL_CAN_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/hal.h"

/** A controller. On a shared bus there is only the vehicle side. */
typedef enum { HAL_CAN_VEHICLE = 0, HAL_CAN_AI = 1, HAL_CAN_SIDES = 2 } hal_can_side_t;

/** Properties of a frame. 0 is a classic data frame with an 11-bit identifier. Any combination may be set. */
#define HAL_CAN_EXTENDED 0x01u /**< 29-bit identifier */
#define HAL_CAN_REMOTE 0x02u   /**< remote request: no data */
#define HAL_CAN_FD 0x04u       /**< CAN FD format */
#define HAL_CAN_ERROR 0x08u    /**< error frame made by the controller, not received from the bus */

/**
 * A frame. A port passes on every received frame, including those that the supervisor rejects (and counts), but never a
 * frame that this supervisor sent.
 */
typedef struct {
    uint32_t id;      /**< 11 or 29 bits; with HAL_CAN_ERROR: not used */
    uint32_t time_ms; /**< clock at reception, rounded down (wraps); ignored when sending */
    uint16_t time_us; /**< microseconds within that millisecond, 0..999; 0 if the port does not know them */
    uint8_t flags;    /**< HAL_CAN_* bits */
    uint8_t length;   /**< payload bytes: 0..8, up to 64 with HAL_CAN_FD; requested length with HAL_CAN_REMOTE */
    uint8_t data[8];  /**< the first 8 payload bytes; those beyond length are 0 */
} hal_can_frame_t;

/** Error state of a controller (ISO 11898-1 fault confinement). */
typedef enum { HAL_CAN_ERROR_ACTIVE, HAL_CAN_ERROR_PASSIVE, HAL_CAN_BUS_OFF } hal_can_state_t;

/** State of a controller. Its counters only increase, and wrap. */
typedef struct {
    hal_can_state_t state;
    uint32_t tx_pending_ms; /**< age of the oldest accepted frame that is not sent yet, at least 1; 0 = none */
    uint16_t bus_off_count; /**< number of times that the controller entered bus-off */
    uint16_t overrun_count; /**< number of times that the controller or a queue lost received frames */
} hal_can_status_t;

/**
 * Request the transmission of a frame. Never blocks. Waiting frames are sent in the order of their identifiers, the lowest
 * first. A port with a queue keeps only the newest frame of an identifier in it (TOP-1, TOP-2). That frame takes over the age of
 * the oldest frame that it replaces. There is one exception: frames of an identifier that are given within 1 ms of each other
 * belong together, and all of them stay.
 * @param frame the core passes only classic data frames (no flags, 11-bit identifier, 8 bytes); a port refuses frames
 *              that its controller cannot send
 * @return true: accepted. The frame is sent as soon as the bus is free, unless hal_can_purge or bus-off discards it
 *         first. false: not accepted (queue full, bus-off, no such controller); the caller keeps the frame.
 */
bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);

/**
 * Discard all accepted frames that are not sent yet. At most one frame whose transmission has already begun may still be
 * sent. tx_pending_ms is 0 afterwards. Does nothing for a side that does not exist.
 */
void hal_can_purge(hal_t *hal, hal_can_side_t side);

/**
 * Start the recovery of a controller from bus-off. Does nothing if it is not in bus-off, or for a side that does not
 * exist. A port never recovers by itself.
 */
void hal_can_recover(hal_t *hal, hal_can_side_t side);

/** Read the state of a controller. For a side that does not exist: HAL_CAN_ERROR_ACTIVE and zeros. */
void hal_can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status);

#endif

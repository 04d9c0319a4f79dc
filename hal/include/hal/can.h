/**
 * @file can.h
 * CAN controllers of the supervisor: the vehicle side always, the AI side in the gateway topology.
 */
#ifndef HAL_CAN_H
#define HAL_CAN_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/hal.h"

/** Which controller. On the shared bus there is only the vehicle side. */
typedef enum { HAL_CAN_VEHICLE = 0, HAL_CAN_AI = 1, HAL_CAN_SIDES = 2 } hal_can_side_t;

/** What kind of frame it is, beyond a classic data frame with 11-bit identifier (0). Any combination may be set. */
#define HAL_CAN_EXTENDED 0x01u /**< 29-bit identifier */
#define HAL_CAN_REMOTE 0x02u   /**< remote request: no data */
#define HAL_CAN_FD 0x04u       /**< CAN FD format */
#define HAL_CAN_ERROR 0x08u    /**< error frame of the controller, no frame of the bus */

/**
 * One frame. A port hands over what it received, also what the supervisor will reject (it counts them), and never a
 * frame that this supervisor sent itself.
 */
typedef struct {
    uint32_t id;      /**< 11 or 29 bits */
    uint32_t time_ms; /**< received: clock at reception, rounded down (wraps); sent: ignored */
    uint16_t time_us; /**< and the microseconds within that millisecond, 0..999; 0 where a port does not know */
    uint8_t flags;    /**< HAL_CAN_* bits */
    uint8_t length;   /**< payload bytes: 0..8, up to 64 with HAL_CAN_FD; for HAL_CAN_REMOTE what was asked for */
    uint8_t data[8];  /**< the first 8 payload bytes; those beyond length are 0 */
} hal_can_frame_t;

/** Error state of a controller (ISO 11898-1 fault confinement). */
typedef enum { HAL_CAN_ERROR_ACTIVE, HAL_CAN_ERROR_PASSIVE, HAL_CAN_BUS_OFF } hal_can_state_t;

/** What a controller reports. Counters never go down but for their wrap. */
typedef struct {
    hal_can_state_t state;
    uint32_t tx_pending_ms; /**< age of the oldest frame taken and not sent yet, at least 1; 0 = none */
    uint16_t bus_off_count; /**< times that bus-off was entered */
    uint16_t overrun_count; /**< times that received frames were lost in controller or queue */
} hal_can_status_t;

/**
 * Ask for a frame to be sent. Never blocks.
 * @param frame the core hands over classic data frames alone (no flags, 11-bit identifier, 8 bytes); a port refuses what
 *              its controller cannot send
 * @return true: taken, it leaves when the bus lets it, or is discarded by hal_can_purge or bus-off, and then is never
 *         sent. false: not taken (queue full, bus-off, no such controller); the caller keeps it.
 */
bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);

/**
 * Discard every frame taken and not yet sent. At most one frame that the controller is already shifting out may still
 * leave. tx_pending_ms is 0 afterwards. Nothing on a side that does not exist.
 */
void hal_can_purge(hal_t *hal, hal_can_side_t side);

/**
 * Start the recovery of a controller that is in bus-off; does nothing otherwise, nor on a side that does not exist. A port
 * never recovers by itself.
 */
void hal_can_recover(hal_t *hal, hal_can_side_t side);

/** Read the controller's state. A side that does not exist reports HAL_CAN_ERROR_ACTIVE and zeros. */
void hal_can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status);

#endif

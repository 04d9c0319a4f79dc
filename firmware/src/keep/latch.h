/**
 * @file latch.h
 * The latch record: it keeps the latch over a reset of the MCU (FSM-7), in the store of the HAL.
 */
#ifndef AGV_LATCH_H
#define AGV_LATCH_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/faults.h"
#include "hal/hal.h"

/** Values of `latched`. All eight bits differ. */
enum { AGV_LATCH_OPEN = 0x69, AGV_LATCH_CLOSED = 0x96 };

/** The record as stored. */
typedef struct {
    uint8_t latched;      /**< AGV_LATCH_CLOSED: tripped; AGV_LATCH_OPEN: not */
    uint8_t first_reason; /**< agv_fault_t; AGV_FAULT_NONE while not tripped */
    uint8_t unresettable; /**< agv_fault_t that only a power-on ends, or AGV_FAULT_NONE */
    uint8_t version;      /**< of this layout: 1 */
    uint32_t checksum;    /**< CRC-32 over the four bytes before */
} agv_latch_t;

/** Result of reading the record. */
typedef enum { AGV_LATCH_NOTHING, AGV_LATCH_VALID, AGV_LATCH_CORRUPT } agv_latch_found_t;

/** Read the record. @p latch is filled in only if it is valid. */
agv_latch_found_t agv_latch_read(hal_t *hal, agv_latch_t *latch);

/**
 * Store the record, with version and checksum. A failure is ignored: the supervisor continues without it.
 * @param latched AGV_LATCH_CLOSED or AGV_LATCH_OPEN
 */
void agv_latch_write(hal_t *hal, uint8_t latched, uint32_t first_reason, uint32_t unresettable);

#endif

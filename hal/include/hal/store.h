/**
 * @file store.h
 * Storage that outlives a reset: the latch record, in RAM that a reset does not clear (but a power-on may), and a log
 * of the flight recorder's events in flash. The core never passes NULL pointers. Stored bytes may be read back corrupt:
 * the caller adds its own checksum.
 */
#ifndef HAL_STORE_H
#define HAL_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/hal.h"

/** Size in bytes of the largest latch record that a port must store. */
#define HAL_STORE_LATCH_SIZE_MAX 32u

/** Size in bytes of the largest log record that a port must store. */
#define HAL_STORE_RECORD_SIZE_MAX 256u

/**
 * Read the latch record.
 * @return size of the stored record, of which at most @p size bytes were copied; 0 = nothing is stored.
 */
size_t hal_store_read_latch(hal_t *hal, void *record, size_t size);

/**
 * Replace the latch record. It must be fast, because it is called while a trip is handled.
 * @param size 1..HAL_STORE_LATCH_SIZE_MAX
 * @return false if the record could not be stored, or @p size is out of range. The caller continues without it.
 */
bool hal_store_write_latch(hal_t *hal, const void *record, size_t size);

/**
 * Append a record to the log in flash. If the log is full, the port drops the oldest records. The call may stall the
 * processor for longer than the permitted reaction time: the core calls it only where INT-3 allows it. A power cut during
 * the call loses at most this record.
 * @param size 1..HAL_STORE_RECORD_SIZE_MAX
 * @return false if the record could not be stored, or @p size is out of range.
 */
bool hal_store_append(hal_t *hal, const void *record, size_t size);

/**
 * Read a record of the log.
 * @param index 0 = oldest
 * @return size of the record, of which at most @p size bytes were copied; 0 = there is no such record.
 */
size_t hal_store_read_record(hal_t *hal, uint32_t index, void *record, size_t size);

#endif

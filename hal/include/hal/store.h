/**
 * @file store.h
 * What outlives a reset: the latch record in RAM that a reset does not clear (and that may be gone after a power-on),
 * and a log of the flight recorder's events in flash. Pointers are never NULL. Bytes that come back may be corrupt: the
 * caller has its own checksum in them.
 */
#ifndef HAL_STORE_H
#define HAL_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/hal.h"

/** Largest latch record that a port must be able to keep. */
#define HAL_STORE_LATCH_SIZE_MAX 32u

/** Largest record of the log that a port must be able to keep. */
#define HAL_STORE_RECORD_SIZE_MAX 256u

/**
 * Read the latch record.
 * @return how many bytes are stored, at most @p size of them were copied; 0 = nothing is stored.
 */
size_t hal_store_read_latch(hal_t *hal, void *record, size_t size);

/**
 * Replace the latch record. Quick: it is called in the handling of a trip.
 * @param size 1..HAL_STORE_LATCH_SIZE_MAX
 * @return false when it could not be stored, or is of another size; the caller goes on without.
 */
bool hal_store_write_latch(hal_t *hal, const void *record, size_t size);

/**
 * Append one record of @p size bytes to the log in flash; when it is full the port drops the oldest ones. May stall the
 * processor for longer than a reaction may take: the core calls it only where INT-3 allows it. A power cut during the
 * call loses at most this record.
 * @param size 1..HAL_STORE_RECORD_SIZE_MAX
 * @return false when it could not be stored, or is of another size.
 */
bool hal_store_append(hal_t *hal, const void *record, size_t size);

/**
 * Read back a record of the log.
 * @param index 0 = oldest
 * @return its size, at most @p size bytes of which were copied; 0 = there is none with this index.
 */
size_t hal_store_read_record(hal_t *hal, uint32_t index, void *record, size_t size);

#endif

/**
 * @file sim_store.h
 * The memory behind hal_store_*: a latch in RAM that a reset does not clear, and a log in flash.
 *
 * A program owns one for each supervisor and passes it to sim_hal_init(). It keeps its content over sim_hal_reset(). All
 * members may be read. They may be written to continue from an earlier run (the host program keeps them in a file).
 */
#ifndef HAL_SIM_SIM_STORE_H
#define HAL_SIM_SIM_STORE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/store.h"

#define SIM_STORE_RECORDS_MAX 256u                          /**< records in the log; more drop the oldest */
#define SIM_STORE_RECORD_SIZE_MAX HAL_STORE_RECORD_SIZE_MAX /**< bytes in one record; a longer one is refused */

/** One record of the log. */
typedef struct {
    uint16_t size;
    uint8_t bytes[SIM_STORE_RECORD_SIZE_MAX];
} sim_store_record_t;

/** What outlives a reset: the latch and the log. The program owns it. */
typedef struct {
    uint8_t latch[HAL_STORE_LATCH_SIZE_MAX];
    uint8_t latch_size;   /**< 0 = nothing stored */
    bool keep_latch;      /**< the latch also survives a power-on (default: it is lost) */
    uint32_t capacity;    /**< records that the log holds: 1..SIM_STORE_RECORDS_MAX (default) */
    uint32_t first;       /**< index in log of the oldest record */
    uint32_t count;       /**< records in the log */
    uint32_t fail_writes; /**< number of the next writes, of latch or log, that store nothing and return false */
    bool tear;            /**< the next write is interrupted after tear_after bytes */
    size_t tear_after;
    sim_store_record_t log[SIM_STORE_RECORDS_MAX];
} sim_store_t;

/** Empty: no latch, no records, no faults. */
void sim_store_init(sim_store_t *store);

/** The next @p count writes (latch or log) store nothing and return false; UINT32_MAX = until it is set again. */
void sim_store_fail_writes(sim_store_t *store, uint32_t count);

/**
 * Cut the power during the next write (latch or log): only its first @p bytes bytes are stored. The rest of a latch keeps
 * its old content; the rest of a record reads FFh. The write returns false.
 */
void sim_store_tear_write(sim_store_t *store, size_t bytes);

/** Flip bits of the stored latch. @return false: it has no such byte. */
bool sim_store_corrupt_latch(sim_store_t *store, size_t byte, uint8_t mask);

/** Flip bits of a stored record, 0 = oldest. @return false: there is no such record or byte. */
bool sim_store_corrupt_record(sim_store_t *store, uint32_t index, size_t byte, uint8_t mask);

/** The functions of hal/store.h, for a program without a hal_t. @{ */
size_t sim_store_read_latch(const sim_store_t *store, void *record, size_t size);
bool sim_store_write_latch(sim_store_t *store, const void *record, size_t size);
bool sim_store_append(sim_store_t *store, const void *record, size_t size);
size_t sim_store_read_record(const sim_store_t *store, uint32_t index, void *record, size_t size);
/** @} */

#endif

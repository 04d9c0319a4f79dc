/* What frama-c is given: the contracts, then the shipped source as it is. */
#include "latch.h"

#include "agv/checksum.h"
#include "hal/store.h"

#ifdef __FRAMAC__
// The three calls that take a record as bytes, with the record's type.
/*@ requires start == AGV_CRC32_START && size == 4 && \valid_read(record);
    assigns \nothing;
    ensures \result == crc(record->latched, record->first_reason, record->unresettable, record->version);
*/
uint32_t crc_of(uint32_t start, const agv_latch_t *record, size_t size);

/*@ requires size == 8 && \valid(record) && \separated(record, &kept, &kept_size);
    assigns *record;
    ensures \result == kept_size;
    ensures kept_size == 8 ==> same_record(record, &kept);
*/
size_t read_record(agv_latch_t *record, size_t size);

/*@ requires size == 8 && \valid_read(record) && \separated(record, &kept, &kept_size);
    assigns kept, kept_size;
    ensures kept_size == 8 && same_record(record, &kept);
*/
bool write_record(const agv_latch_t *record, size_t size);

#define agv_crc32(start, bytes, size) crc_of((start), (bytes), (size))
#define hal_store_read_latch(hal, record, size) read_record((record), (size))
#define hal_store_write_latch(hal, record, size) write_record((record), (size))
#endif

// ---- Inside.

/*@ requires \valid_read(latch);
    assigns \nothing;
    ensures \result == (uint32_t)~crc(latch->latched, latch->first_reason, latch->unresettable, latch->version);
*/
static uint32_t checksum(const agv_latch_t *latch);

#include "keep/latch.c"

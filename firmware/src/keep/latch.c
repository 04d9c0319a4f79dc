#include "keep/latch.h"

#include "agv/checksum.h"
#include "hal/store.h"

enum { VERSION = 1, CHECKED_BYTES = 4 };

_Static_assert(sizeof(agv_latch_t) <= HAL_STORE_LATCH_SIZE_MAX, "every port can keep it");

static uint32_t checksum(const agv_latch_t *latch) {
    return ~agv_crc32(AGV_CRC32_START, latch, CHECKED_BYTES);
}

agv_latch_found_t agv_latch_read(hal_t *hal, agv_latch_t *latch) {
    agv_latch_t record = {0};
    const size_t size = hal_store_read_latch(hal, &record, sizeof record);
    if (size == 0u) {
        return AGV_LATCH_NOTHING;
    }
    if ((size != sizeof record) || (record.version != VERSION) || (record.checksum != checksum(&record))) {
        return AGV_LATCH_CORRUPT;
    }
    *latch = record;
    return AGV_LATCH_VALID;
}

void agv_latch_write(hal_t *hal, uint8_t latched, uint32_t first_reason, uint32_t unresettable) {
    agv_latch_t record = {.latched = latched,
                          .first_reason = (uint8_t)first_reason,
                          .unresettable = (uint8_t)unresettable,
                          .version = VERSION};
    record.checksum = checksum(&record);
    (void)hal_store_write_latch(hal, &record, sizeof record);
}

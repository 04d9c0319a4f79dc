/* hal/store.h: storage over a reset. */
#include "hal/store.h"

size_t hal_store_read_latch(hal_t *hal, void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    /*
     * TODO: copy it from RAM that the start-up code does not clear (a section of its own, or backup registers). After a
     * power-on its content is random. Return it all the same: the caller's checksum detects that.
     */
    return 0;
}

bool hal_store_write_latch(hal_t *hal, const void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    /* TODO: copy it to that RAM. Never write to flash here, because this is called while a trip is handled. */
    return false;
}

bool hal_store_append(hal_t *hal, const void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    /* TODO: append to a log in flash, dropping whole sectors of the oldest records. Verify after writing. */
    return false;
}

size_t hal_store_read_record(hal_t *hal, uint32_t index, void *record, size_t size) {
    (void)hal;
    (void)index;
    (void)record;
    (void)size;
    /* TODO: copy the record; index 0 is the oldest. */
    return 0;
}

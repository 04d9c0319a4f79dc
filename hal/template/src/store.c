/* hal/store.h: what outlives a reset. */
#include "hal/store.h"

size_t hal_store_read_latch(hal_t *hal, void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    /*
     * TODO: a few bytes of RAM that the startup code does not clear (a section of its own, backup registers). What is
     * found there after a power-on is random: hand it over, the caller has a checksum in it.
     */
    return 0;
}

bool hal_store_write_latch(hal_t *hal, const void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    /* TODO: copy it there. Never to flash: this is called in the handling of a trip. */
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
    /* TODO: 0 is the oldest. */
    return 0;
}

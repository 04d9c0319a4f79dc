/* The memory behind hal_store_*. */
#include "hal_sim/sim_store.h"

#include <string.h>

#define ERASED 0xFF

void sim_store_init(sim_store_t *store) {
    memset(store, 0, sizeof *store);
    store->capacity = SIM_STORE_RECORDS_MAX;
}

void sim_store_fail_writes(sim_store_t *store, uint32_t count) {
    store->fail_writes = count;
}

void sim_store_tear_write(sim_store_t *store, size_t bytes) {
    store->tear = true;
    store->tear_after = bytes;
}

static sim_store_record_t *record_at(sim_store_t *store, uint32_t index) {
    return &store->log[(store->first + index) % store->capacity];
}

bool sim_store_corrupt_latch(sim_store_t *store, size_t byte, uint8_t mask) {
    if (byte >= store->latch_size) {
        return false;
    }
    store->latch[byte] ^= mask;
    return true;
}

bool sim_store_corrupt_record(sim_store_t *store, uint32_t index, size_t byte, uint8_t mask) {
    if (index >= store->count || byte >= record_at(store, index)->size) {
        return false;
    }
    record_at(store, index)->bytes[byte] ^= mask;
    return true;
}

/* Whether this write is made to fail. */
static bool refuses(sim_store_t *store) {
    if (store->fail_writes == 0) {
        return false;
    }
    if (store->fail_writes != UINT32_MAX) {
        store->fail_writes--;
    }
    return true;
}

/* Number of bytes that this write stores. Below @p size: the power is cut during the write. */
static size_t bytes_stored(sim_store_t *store, size_t size) {
    if (!store->tear) {
        return size;
    }
    store->tear = false;
    return store->tear_after < size ? store->tear_after : size;
}

static size_t copy_out(const uint8_t *bytes, size_t stored, void *record, size_t size) {
    const size_t copied = stored < size ? stored : size;
    if (copied > 0) {
        memcpy(record, bytes, copied);
    }
    return stored;
}

size_t sim_store_read_latch(const sim_store_t *store, void *record, size_t size) {
    return copy_out(store->latch, store->latch_size, record, size);
}

bool sim_store_write_latch(sim_store_t *store, const void *record, size_t size) {
    if (size == 0 || size > sizeof store->latch || refuses(store)) {
        return false;
    }
    const size_t arrived = bytes_stored(store, size);
    memcpy(store->latch, record, arrived);
    store->latch_size = (uint8_t)size;
    return arrived == size;
}

bool sim_store_append(sim_store_t *store, const void *record, size_t size) {
    if (size == 0 || size > SIM_STORE_RECORD_SIZE_MAX || refuses(store)) {
        return false;
    }
    if (store->count == store->capacity) {
        store->first = (store->first + 1) % store->capacity;
        store->count--;
    }
    sim_store_record_t *slot = record_at(store, store->count++);
    const size_t arrived = bytes_stored(store, size);
    memset(slot->bytes, ERASED, sizeof slot->bytes);
    memcpy(slot->bytes, record, arrived);
    slot->size = (uint16_t)size;
    return arrived == size;
}

size_t sim_store_read_record(const sim_store_t *store, uint32_t index, void *record, size_t size) {
    if (index >= store->count) {
        return 0;
    }
    const sim_store_record_t *slot = &store->log[(store->first + index) % store->capacity];
    return copy_out(slot->bytes, slot->size, record, size);
}

/* The latch record: writing to the store and reading from it. */
#include "keep/latch.h"

#include <string.h>

#include "mock_store.h"
#include "unity.h"

/* The context of a port; the core never accesses its members. */
struct hal {
    int unused;
};
static hal_t hal;

/* Content of the store, and the size that it reports. */
static uint8_t stored[HAL_STORE_LATCH_SIZE_MAX];
static size_t stored_size;
static bool write_works;

static size_t read_stub(hal_t *port, void *record, size_t size, int calls) {
    (void)calls;
    TEST_ASSERT_EQUAL_PTR(&hal, port);
    memcpy(record, stored, (stored_size < size) ? stored_size : size);
    return stored_size;
}

static bool write_stub(hal_t *port, const void *record, size_t size, int calls) {
    (void)calls;
    TEST_ASSERT_EQUAL_PTR(&hal, port);
    TEST_ASSERT_LESS_OR_EQUAL_size_t(sizeof stored, size);
    memcpy(stored, record, size);
    stored_size = size;
    return write_works;
}

void setUp(void) {
    memset(stored, 0, sizeof stored);
    stored_size = 0;
    write_works = true;
}

static void use_stubs(void) {
    hal_store_read_latch_Stub(read_stub);
    hal_store_write_latch_Stub(write_stub);
}

/* Latched, first reason EPS_HEARTBEAT_LOST (rank 13), nothing unresettable (68 = none). */
static void write_tripped(void) {
    use_stubs();
    agv_latch_write(&hal, AGV_LATCH_CLOSED, AGV_FAULT_EPS_HEARTBEAT_LOST, AGV_FAULT_NONE);
}

/* Shows: FSM-7 */
void test_a_written_record_is_read_again(void) {
    agv_latch_t latch;
    write_tripped();
    TEST_ASSERT_EQUAL(AGV_LATCH_VALID, agv_latch_read(&hal, &latch));
    TEST_ASSERT_EQUAL_HEX8(0x96, latch.latched);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_EPS_HEARTBEAT_LOST, latch.first_reason);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_NONE, latch.unresettable);
    agv_latch_write(&hal, AGV_LATCH_OPEN, AGV_FAULT_NONE, AGV_FAULT_MEMORY_CORRUPTED);
    TEST_ASSERT_EQUAL(AGV_LATCH_VALID, agv_latch_read(&hal, &latch));
    TEST_ASSERT_EQUAL_HEX8(0x69, latch.latched);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_NONE, latch.first_reason);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_MEMORY_CORRUPTED, latch.unresettable);
}

/* 96h, rank, rank, version 1, CRC-32 of 96 0D 03 01 (by zlib: ED9D9162). */
void test_one_call_with_the_whole_record(void) {
    const agv_latch_t expected = {
        .latched = 0x96, .first_reason = 13, .unresettable = 3, .version = 1, .checksum = 0xED9D9162u};
    TEST_ASSERT_EQUAL_size_t(8, sizeof expected);
    hal_store_write_latch_ExpectWithArrayAndReturn(&hal, 1, &expected, 8, true);
    agv_latch_write(&hal, AGV_LATCH_CLOSED, AGV_FAULT_EPS_HEARTBEAT_LOST, AGV_FAULT_OUTPUT_FEEDBACK);
}

void test_one_call_to_read_it(void) {
    agv_latch_t latch;
    hal_store_read_latch_ExpectAndReturn(&hal, NULL, 8, 0);
    hal_store_read_latch_IgnoreArg_record();
    TEST_ASSERT_EQUAL(AGV_LATCH_NOTHING, agv_latch_read(&hal, &latch));
}

void test_a_write_that_fails_is_not_tried_again(void) {
    write_works = false;
    write_tripped();
    TEST_ASSERT_EQUAL_size_t(8, stored_size);
}

/* Shows: FSM-7, STORE_INVALID */
void test_every_changed_byte_is_found(void) {
    agv_latch_t latch = {.latched = 1, .first_reason = 2, .unresettable = 3, .version = 4, .checksum = 5};
    const agv_latch_t before = latch;
    write_tripped();
    for (unsigned at = 0; at < 8; at++) {
        const uint8_t good = stored[at];
        for (unsigned change = 1; change < 256; change++) {
            stored[at] = (uint8_t)(good ^ change);
            TEST_ASSERT_EQUAL(AGV_LATCH_CORRUPT, agv_latch_read(&hal, &latch));
        }
        stored[at] = good;
    }
    TEST_ASSERT_EQUAL_MEMORY(&before, &latch, sizeof latch); /* is not filled from a corrupt record */
}

/* Shows: FSM-7 */
void test_a_record_of_another_size_is_corrupt(void) {
    agv_latch_t latch;
    write_tripped();
    for (stored_size = 1; stored_size <= sizeof stored; stored_size++) {
        TEST_ASSERT_EQUAL((stored_size == 8) ? AGV_LATCH_VALID : AGV_LATCH_CORRUPT, agv_latch_read(&hal, &latch));
    }
}

static void store(const agv_latch_t *record, size_t size) {
    use_stubs();
    memcpy(stored, record, size);
    stored_size = size;
}

/* The last byte of the checksum is 0, as is the byte that is not read: 96 02 1F 01 (by zlib: 00B68B02). */
void test_a_record_without_its_last_byte_is_corrupt(void) {
    const agv_latch_t record = {
        .latched = 0x96, .first_reason = 2, .unresettable = 31, .version = 1, .checksum = 0x00B68B02u};
    agv_latch_t latch;
    store(&record, 7);
    TEST_ASSERT_EQUAL(AGV_LATCH_CORRUPT, agv_latch_read(&hal, &latch));
    store(&record, 8);
    TEST_ASSERT_EQUAL(AGV_LATCH_VALID, agv_latch_read(&hal, &latch));
}

/* A record of an earlier layout, with a checksum that fits: 96 0D 03 00 (by zlib: 9A9AA1F4). */
void test_an_earlier_layout_is_corrupt(void) {
    const agv_latch_t earlier = {
        .latched = 0x96, .first_reason = 13, .unresettable = 3, .version = 0, .checksum = 0x9A9AA1F4u};
    agv_latch_t latch;
    store(&earlier, sizeof earlier);
    TEST_ASSERT_EQUAL(AGV_LATCH_CORRUPT, agv_latch_read(&hal, &latch));
}

/* A record of a later layout, with a checksum that fits: 96 0A 38 02 (by zlib: 4D693965). */
void test_a_later_layout_is_corrupt(void) {
    const agv_latch_t later = {
        .latched = 0x96, .first_reason = 10, .unresettable = 56, .version = 2, .checksum = 0x4D693965u};
    agv_latch_t latch;
    store(&later, sizeof later);
    TEST_ASSERT_EQUAL(AGV_LATCH_CORRUPT, agv_latch_read(&hal, &latch));
}

/* RAM after a power-on: all 0, all 1. */
void test_empty_memory_is_corrupt(void) {
    agv_latch_t latch;
    use_stubs();
    stored_size = 8;
    TEST_ASSERT_EQUAL(AGV_LATCH_CORRUPT, agv_latch_read(&hal, &latch));
    memset(stored, 0xFF, sizeof stored);
    TEST_ASSERT_EQUAL(AGV_LATCH_CORRUPT, agv_latch_read(&hal, &latch));
}

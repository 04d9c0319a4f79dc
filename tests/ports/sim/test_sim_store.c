/* The memory behind the simulated port: latch and log, and their faults. */
#include <string.h>

#include "hal_sim/sim_store.h"
#include "unity.h"

static sim_store_t store;

void setUp(void) {
    memset(&store, 0xA5, sizeof store);
    sim_store_init(&store);
}

static void append(uint8_t value) {
    TEST_ASSERT_TRUE(sim_store_append(&store, &value, 1));
}

static unsigned record_at(uint32_t index) {
    uint8_t value = 0;
    return sim_store_read_record(&store, index, &value, 1) == 1 ? value : 0xFFFFu;
}

void test_an_empty_store_holds_nothing(void) {
    uint8_t byte = 0x55;
    TEST_ASSERT_EQUAL_size_t(0, sim_store_read_latch(&store, &byte, 1));
    TEST_ASSERT_EQUAL_size_t(0, sim_store_read_record(&store, 0, &byte, 1));
    TEST_ASSERT_EQUAL_HEX8(0x55, byte);
}

void test_the_latch_is_replaced_as_a_whole(void) {
    uint8_t read[HAL_STORE_LATCH_SIZE_MAX + 1] = {0};
    uint8_t full[HAL_STORE_LATCH_SIZE_MAX + 1];
    memset(full, 0x3C, sizeof full);
    TEST_ASSERT_TRUE(sim_store_write_latch(&store, full, HAL_STORE_LATCH_SIZE_MAX));
    TEST_ASSERT_EQUAL_size_t(HAL_STORE_LATCH_SIZE_MAX, sim_store_read_latch(&store, read, sizeof read));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(full, read, HAL_STORE_LATCH_SIZE_MAX);
    TEST_ASSERT_FALSE(sim_store_write_latch(&store, full, HAL_STORE_LATCH_SIZE_MAX + 1));
    TEST_ASSERT_FALSE(sim_store_write_latch(&store, full, 0));
    TEST_ASSERT_TRUE(sim_store_write_latch(&store, "abc", 3));
    memset(read, 0, sizeof read);
    TEST_ASSERT_EQUAL_size_t(3, sim_store_read_latch(&store, read, 2)); /* two of them copied */
    TEST_ASSERT_EQUAL_HEX8('b', read[1]);
    TEST_ASSERT_EQUAL_HEX8(0, read[2]);
    TEST_ASSERT_EQUAL_size_t(3, sim_store_read_latch(&store, NULL, 0));
}

void test_the_log_drops_the_oldest(void) {
    store.capacity = 3;
    for (uint8_t value = 1; value <= 3; value++) {
        append(value);
    }
    TEST_ASSERT_EQUAL_UINT(1, record_at(0));
    append(4);
    append(5);
    TEST_ASSERT_EQUAL_UINT(3, record_at(0));
    TEST_ASSERT_EQUAL_UINT(5, record_at(2));
    TEST_ASSERT_EQUAL_UINT(0xFFFF, record_at(3));
    append(6);
    append(7);
    TEST_ASSERT_EQUAL_UINT(5, record_at(0));
    TEST_ASSERT_EQUAL_UINT(7, record_at(2));
}

void test_the_log_holds_what_it_says(void) {
    static uint8_t record[SIM_STORE_RECORD_SIZE_MAX + 1];
    for (unsigned i = 0; i < SIM_STORE_RECORDS_MAX + 10; i++) {
        record[0] = (uint8_t)i;
        TEST_ASSERT_TRUE(sim_store_append(&store, record, SIM_STORE_RECORD_SIZE_MAX));
    }
    TEST_ASSERT_EQUAL_UINT32(SIM_STORE_RECORDS_MAX, store.count);
    TEST_ASSERT_EQUAL_size_t(SIM_STORE_RECORD_SIZE_MAX, sim_store_read_record(&store, 0, record, sizeof record));
    TEST_ASSERT_EQUAL_UINT8(10, record[0]);
    TEST_ASSERT_FALSE(sim_store_append(&store, record, SIM_STORE_RECORD_SIZE_MAX + 1));
    TEST_ASSERT_FALSE(sim_store_append(&store, record, 0));
}

void test_writes_fail_if_configured(void) {
    append(1);
    TEST_ASSERT_TRUE(sim_store_write_latch(&store, "a", 1));
    sim_store_fail_writes(&store, 2);
    TEST_ASSERT_FALSE(sim_store_append(&store, "x", 1));
    TEST_ASSERT_FALSE(sim_store_write_latch(&store, "bc", 2));
    TEST_ASSERT_EQUAL_UINT32(1, store.count);
    TEST_ASSERT_EQUAL_size_t(1, sim_store_read_latch(&store, NULL, 0));
    append(2);
    sim_store_fail_writes(&store, UINT32_MAX);
    for (unsigned i = 0; i < 5; i++) {
        TEST_ASSERT_FALSE(sim_store_append(&store, "x", 1));
    }
    sim_store_fail_writes(&store, 0);
    append(3);
}

/* Shows: INT-3 */
void test_a_torn_write_loses_at_most_the_newest_record(void) {
    uint8_t read[4];
    const uint8_t torn[4] = {'c', 'd', 0xFF, 0xFF};
    append(1);
    sim_store_tear_write(&store, 2);
    TEST_ASSERT_FALSE(sim_store_append(&store, "cdef", 4));
    append(3);
    TEST_ASSERT_EQUAL_UINT(1, record_at(0));
    TEST_ASSERT_EQUAL_UINT(3, record_at(2));
    TEST_ASSERT_EQUAL_size_t(4, sim_store_read_record(&store, 1, read, 4));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(torn, read, 4);
    TEST_ASSERT_TRUE(sim_store_append(&store, "cdef", 4));
}

void test_a_torn_latch_is_half_old_half_new(void) {
    uint8_t read[4];
    TEST_ASSERT_TRUE(sim_store_write_latch(&store, "abcd", 4));
    sim_store_tear_write(&store, 1);
    TEST_ASSERT_FALSE(sim_store_write_latch(&store, "wxyz", 4));
    TEST_ASSERT_EQUAL_size_t(4, sim_store_read_latch(&store, read, 4));
    TEST_ASSERT_EQUAL_MEMORY("wbcd", read, 4);
    sim_store_tear_write(&store, 9); /* beyond its end: whole */
    TEST_ASSERT_TRUE(sim_store_write_latch(&store, "wxyz", 4));
}

void test_stored_bits_can_be_flipped(void) {
    uint8_t read[2];
    TEST_ASSERT_FALSE(sim_store_corrupt_latch(&store, 0, 1));
    TEST_ASSERT_TRUE(sim_store_write_latch(&store, "ab", 2));
    TEST_ASSERT_TRUE(sim_store_corrupt_latch(&store, 1, 0x80));
    TEST_ASSERT_FALSE(sim_store_corrupt_latch(&store, 2, 0x80));
    sim_store_read_latch(&store, read, 2);
    TEST_ASSERT_EQUAL_HEX8('b' ^ 0x80, read[1]);
    store.capacity = 2;
    append(1);
    append(2);
    append(4);
    TEST_ASSERT_TRUE(sim_store_corrupt_record(&store, 1, 0, 0x80));
    TEST_ASSERT_EQUAL_UINT(2, record_at(0));
    TEST_ASSERT_EQUAL_UINT(0x84, record_at(1));
    TEST_ASSERT_FALSE(sim_store_corrupt_record(&store, 2, 0, 1));
    TEST_ASSERT_FALSE(sim_store_corrupt_record(&store, 1, 1, 1));
}

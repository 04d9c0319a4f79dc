/* A recording of the bus. */
#include "monitor/inputs/monitor_record.h"

#include <errno.h>

#include "scratch.h"
#include "unity.h"

static monitor_record_t record;

void setUp(void) {
    scratch_open();
    monitor_record_init(&record);
}

void tearDown(void) {
    (void)monitor_record_end(&record);
}

static void add(uint32_t id, uint8_t flags, uint8_t length) {
    const hal_can_frame_t frame = {.id = id, .flags = flags, .length = length, .data = {1, 2, 3, 4, 5, 6, 7, 8}};
    monitor_record_add(&record, "can0", 1700000000000001, &frame);
}

void test_all_kinds_of_frames(void) {
    TEST_ASSERT_TRUE(monitor_record_begin(&record, scratch_path("new.log")));
    add(0x168u, 0, 8);
    add(0x168u, 0, 0);
    add(0x1ABCDEu, HAL_CAN_EXTENDED, 2);
    add(0x168u, HAL_CAN_REMOTE, 8);
    add(0x4u, HAL_CAN_ERROR, 8);
    TEST_ASSERT_TRUE(monitor_record_end(&record));
    TEST_ASSERT_EQUAL_STRING("(1700000000.000001) can0 168#0102030405060708\n"
                             "(1700000000.000001) can0 168#\n"
                             "(1700000000.000001) can0 001ABCDE#0102\n"
                             "(1700000000.000001) can0 168#R8\n"
                             "(1700000000.000001) can0 20000004#0102030405060708\n",
                             scratch_read("new.log"));
}

void test_fd_frames_are_counted_as_left_out(void) {
    TEST_ASSERT_TRUE(monitor_record_begin(&record, scratch_path("new.log")));
    add(0x168u, HAL_CAN_FD, 8);
    TEST_ASSERT_EQUAL(1, record.left_out);
    TEST_ASSERT_EQUAL(0, record.frames);
}

void test_a_file_that_exists_is_refused(void) {
    const char *path = scratch_write("old.log", "mine", 4);
    TEST_ASSERT_FALSE(monitor_record_begin(&record, path));
    TEST_ASSERT_EQUAL(EEXIST, errno);
    TEST_ASSERT_EQUAL_STRING("mine", scratch_read("old.log"));
}

void test_more_than_the_buffer(void) {
    TEST_ASSERT_TRUE(monitor_record_begin(&record, scratch_path("new.log")));
    for (int i = 0; i < 2000; i++) {
        add(0x168u, 0, 0);
    }
    TEST_ASSERT_TRUE(monitor_record_end(&record));
    TEST_ASSERT_EQUAL(2000, record.frames);
    TEST_ASSERT_EQUAL_STRING_LEN("(1700000000.000001) can0 168#\n", scratch_read("new.log"), 30);
}

void test_nothing_while_nothing_is_recorded(void) {
    add(0x168u, 0, 8);
    TEST_ASSERT_TRUE(monitor_record_flush(&record));
    TEST_ASSERT_EQUAL(0, scratch_count());
}

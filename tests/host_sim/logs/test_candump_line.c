/* One line of a candump log: every form that can-utils writes, and everything that is none of them. */
#include "logs/candump_line.h"

#include <stdio.h>
#include <string.h>

#include "unity.h"

static candump_record_t record;

void setUp(void) {
    memset(&record, 0xA5, sizeof record);
}

/* Parse a text in a buffer of its own that ends with the line feed: reading on behind it would be seen. */
static const char *parse(const char *text) {
    static char line[512];
    size_t length = strlen(text);
    memset(line, 'F', sizeof line);
    memcpy(line, text, length);
    line[length] = '\n';
    return candump_parse(line, length, &record);
}

static void parse_good(const char *text) {
    const char *wrong = parse(text);
    TEST_ASSERT_NULL_MESSAGE(wrong, text);
}

static void parse_bad(const char *text, const char *expected) {
    const char *wrong = parse(text);
    TEST_ASSERT_NOT_NULL_MESSAGE(wrong, text);
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(wrong, expected), wrong);
}

static void is_frame(const char *text, uint32_t id, uint8_t flags, uint8_t length, const char *first_8_bytes) {
    parse_good(text);
    TEST_ASSERT_EQUAL_HEX32(id, record.frame.id);
    TEST_ASSERT_EQUAL_HEX8(flags, record.frame.flags);
    TEST_ASSERT_EQUAL_UINT8(length, record.frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(first_8_bytes, record.frame.data, 8);
    TEST_ASSERT_EQUAL_UINT32(0, record.frame.time_ms);
}

void test_a_classic_frame(void) {
    is_frame("(1700000000.000001) can0 43F#0000000000000011", 0x43F, 0, 8, "\0\0\0\0\0\0\0\x11");
    TEST_ASSERT_EQUAL_UINT64(1700000000000001u, record.stamp_us);
    TEST_ASSERT_EQUAL_UINT(4, record.interface_length);
    TEST_ASSERT_EQUAL_MEMORY("can0", record.interface, 4);
}

void test_every_length_of_a_classic_frame(void) {
    static const char digits[] = "0123456789ABCDEF";
    for (unsigned length = 0; length <= 8; length++) {
        char text[64];
        char expected[8] = {0};
        (void)snprintf(text, sizeof text, "(0.000000) c 7FF#%.*s", (int)(2 * length), digits);
        memcpy(expected, "\x01\x23\x45\x67\x89\xAB\xCD\xEF", length);
        is_frame(text, 0x7FF, 0, (uint8_t)length, expected);
    }
    parse_bad("(0.000000) c 7FF#0123456789ABCDEF01", "longer than 8 bytes");
}

void test_lower_case_digits_are_digits(void) {
    is_frame("(0.000000) c 0a3#abcdef", 0x0A3, 0, 3, "\xAB\xCD\xEF\0\0\0\0\0");
}

void test_an_extended_frame(void) {
    is_frame("(0.000000) c 0000043F#01", 0x43F, HAL_CAN_EXTENDED, 1, "\x01\0\0\0\0\0\0\0");
    is_frame("(0.000000) c 1FFFFFFF#", 0x1FFFFFFF, HAL_CAN_EXTENDED, 0, "\0\0\0\0\0\0\0\0");
}

void test_an_error_frame(void) {
    is_frame("(0.000000) c 20000004#0001000000000000", 4, HAL_CAN_ERROR, 8, "\0\x01\0\0\0\0\0\0");
    is_frame("(0.000000) c 3FFFFFFF#", 0x1FFFFFFF, HAL_CAN_ERROR, 0, "\0\0\0\0\0\0\0\0");
    parse_bad("(0.000000) c 20000004#R", "after the frame");
    parse_bad("(0.000000) c 20000004##000", "not CAN FD");
}

void test_a_remote_frame(void) {
    is_frame("(0.000000) c 43F#R", 0x43F, HAL_CAN_REMOTE, 0, "\0\0\0\0\0\0\0\0");
    is_frame("(0.000000) c 43F#R8", 0x43F, HAL_CAN_REMOTE, 8, "\0\0\0\0\0\0\0\0");
    is_frame("(0.000000) c 43F#R8_F", 0x43F, HAL_CAN_REMOTE, 8, "\0\0\0\0\0\0\0\0");
    is_frame("(0.000000) c 0000043F#R3", 0x43F, HAL_CAN_REMOTE | HAL_CAN_EXTENDED, 3, "\0\0\0\0\0\0\0\0");
    parse_good("(0.000000) c 43F#R R");
    parse_bad("(0.000000) c 43F#R9", "after the frame");
    parse_bad("(0.000000) c 43F#R7_9", "after the frame");
    parse_bad("(0.000000) c 43F#R00", "after the frame");
}

void test_a_can_fd_frame(void) {
    is_frame("(0.000000) c 43F##1", 0x43F, HAL_CAN_FD, 0, "\0\0\0\0\0\0\0\0");
    is_frame("(0.000000) c 43F##30011223344556677", 0x43F, HAL_CAN_FD, 8, "\x00\x11\x22\x33\x44\x55\x66\x77");
    is_frame("(0.000000) c 0000043F##F00112233445566778899AABB", 0x43F, HAL_CAN_FD | HAL_CAN_EXTENDED, 12,
             "\x00\x11\x22\x33\x44\x55\x66\x77");
    parse_bad("(0.000000) c 43F##", "flags");
    parse_bad("(0.000000) c 43F##G", "flags");
    parse_bad("(0.000000) c 43F##10", "odd number");
    parse_bad("(0.000000) c 43F##10011223344556677_9", "after the frame");
}

void test_the_longest_can_fd_frame(void) {
    char text[256] = "(0.000000) c 1FFFFFFF##1";
    for (unsigned i = 0; i < 64; i++) {
        strcat(text, "A5");
    }
    is_frame(text, 0x1FFFFFFF, HAL_CAN_FD | HAL_CAN_EXTENDED, 64, "\xA5\xA5\xA5\xA5\xA5\xA5\xA5\xA5");
    strcat(text, "00");
    parse_bad(text, "longer than 64 bytes");
}

void test_a_raw_dlc_is_a_frame_of_eight_bytes(void) {
    is_frame("(0.000000) c 43F#0011223344556677_9", 0x43F, 0, 8, "\x00\x11\x22\x33\x44\x55\x66\x77");
    parse_good("(0.000000) c 43F#0011223344556677_F T");
    parse_bad("(0.000000) c 43F#0011223344556677_8", "after the frame");
    parse_bad("(0.000000) c 43F#0011223344556677_G", "after the frame");
    parse_bad("(0.000000) c 43F#0011223344556677_", "after the frame");
    parse_bad("(0.000000) c 43F#00112233445566_9", "after the frame");
}

void test_direction_and_carriage_return_may_follow(void) {
    parse_good("(0.000000) c 43F#00 R");
    parse_good("(0.000000) c 43F#00 T");
    parse_good("(0.000000) c 43F#00\r");
    parse_good("(0.000000) c 43F#00 T\r");
    parse_bad("(0.000000) c 43F#00 X", "after the frame");
    parse_bad("(0.000000) c 43F#00  R", "after the frame");
    parse_bad("(0.000000) c 43F#00 RT", "after the frame");
    parse_bad("(0.000000) c 43F#00\r\r", "after the frame");
    parse_bad("(0.000000) c 43F#00\rR", "after the frame");
    parse_bad("(0.000000) c 43F#00 ", "after the frame");
}

void test_time_stamps(void) {
    parse_good("(0.000000) c 43F#");
    TEST_ASSERT_EQUAL_UINT64(0, record.stamp_us);
    parse_good("(0000000001.500000) c 43F#");
    TEST_ASSERT_EQUAL_UINT64(1500000u, record.stamp_us);
    parse_good("(000000000001.000002) c 43F#");
    TEST_ASSERT_EQUAL_UINT64(1000002u, record.stamp_us);
}

void test_time_stamps_of_nanoseconds_are_rounded_down(void) {
    parse_good("(12.345678999) c 43F#");
    TEST_ASSERT_EQUAL_UINT64(12345678u, record.stamp_us);
}

void test_the_latest_time_stamp(void) {
    parse_good("(999999999999.999999) c 43F#");
    TEST_ASSERT_EQUAL_UINT64(999999999999999999u, record.stamp_us);
    parse_bad("(1000000000000.000000) c 43F#", "number of seconds");
}

void test_what_is_no_time_stamp(void) {
    parse_bad("", "does not begin");
    parse_bad("1.000000 c 43F#", "does not begin");
    parse_bad(" (1.000000) c 43F#", "does not begin");
    parse_bad("(", "number of seconds");
    parse_bad("(-1.000000) c 43F#", "number of seconds");
    parse_bad("(+1.000000) c 43F#", "number of seconds");
    parse_bad("(.000000) c 43F#", "number of seconds");
    parse_bad("(1) c 43F#", "number of seconds");
    parse_bad("(1,000000) c 43F#", "number of seconds");
    parse_bad("(1.) c 43F#", "decimals");
    parse_bad("(1.00000) c 43F#", "decimals");
    parse_bad("(1.0000000) c 43F#", "decimals");
    parse_bad("(1.00000000) c 43F#", "decimals");
    parse_bad("(1.0000000000) c 43F#", "decimals");
    parse_bad("(1.00000x) c 43F#", "decimals");
    parse_bad("(1.000000 c 43F#", "parenthesis");
    parse_bad("(1.000000)c 43F#", "parenthesis");
    parse_bad("(1.000000)", "parenthesis");
    parse_bad("(2026-11-21 12:00:00.000000) c 43F#", "number of seconds");
}

void test_interfaces(void) {
    parse_good("(1.000000) 123456789012345 43F#");
    TEST_ASSERT_EQUAL_UINT(15, record.interface_length);
    parse_good("(1.000000)    can0 43F#"); /* candump aligns names to the right */
    TEST_ASSERT_EQUAL_UINT(4, record.interface_length);
    TEST_ASSERT_EQUAL_MEMORY("can0", record.interface, 4);
    parse_bad("(1.000000) 1234567890123456 43F#", "longer than 15");
    parse_bad("(1.000000) ", "the interface name is missing");
    parse_bad("(1.000000) can0", "the interface name is missing");
    parse_bad("(1.000000) can\xC3\xA4 43F#", "the interface name is missing");
    parse_bad("(1.000000) can\t0 43F#", "the interface name is missing");
    parse_bad("(1.000000) can0  43F#", "a hexadecimal identifier followed by # is missing");
}

void test_a_record_is_from_one_interface(void) {
    parse_good("(0.000000) can1 43F#");
    TEST_ASSERT_TRUE(candump_is_from(&record, "can1"));
    TEST_ASSERT_FALSE(candump_is_from(&record, "can0"));
    TEST_ASSERT_FALSE(candump_is_from(&record, "can"));
    TEST_ASSERT_FALSE(candump_is_from(&record, "can10"));
    TEST_ASSERT_FALSE(candump_is_from(&record, NULL));
}

void test_identifiers(void) {
    parse_bad("(1.000000) c 800#", "above 7FF");
    parse_bad("(1.000000) c FFF#", "above 7FF");
    parse_bad("(1.000000) c 40000000#", "above 1FFFFFFF");
    parse_bad("(1.000000) c 80000000#", "above 1FFFFFFF");
    parse_bad("(1.000000) c E0000004#", "above 1FFFFFFF");
    parse_bad("(1.000000) c #00", "neither 3 nor 8");
    parse_bad("(1.000000) c 3F#00", "neither 3 nor 8");
    parse_bad("(1.000000) c 043F#00", "neither 3 nor 8");
    parse_bad("(1.000000) c 00123#81:00:12345678#11", "CAN XL");
    parse_bad("(1.000000) c 00000043F#00", "neither 3 nor 8");
    parse_bad("(1.000000) c 000000000043F#00", "a hexadecimal identifier followed by # is missing");
    parse_bad("(1.000000) c 43G#00", "a hexadecimal identifier followed by # is missing");
    parse_bad("(1.000000) c 43F", "a hexadecimal identifier followed by # is missing");
    parse_bad("(1.000000) c ", "a hexadecimal identifier followed by # is missing");
}

void test_data(void) {
    parse_bad("(1.000000) c 43F#0", "odd number");
    parse_bad("(1.000000) c 43F#001", "odd number");
    parse_bad("(1.000000) c 43F#0 R", "odd number");
    parse_bad("(1.000000) c 43F#0G", "the data is not hexadecimal");
    parse_bad("(1.000000) c 43F#0Z00", "the data is not hexadecimal");
    parse_bad("(1.000000) c 43F#00.11", "after the frame");
    parse_bad("(1.000000) c 43F#G0", "after the frame");
    parse_bad("(1.000000) c 43F#00#", "after the frame");
    parse_bad("(1.000000) c 43F#r", "after the frame");
    parse_bad("DROPCOUNT: dropped 1 CAN frame on 'can0' socket (total drops 1)", "does not begin");
}

void test_a_nul_byte_is_no_end(void) {
    const char line[] = "(1.000000) c 43F#00\0\n";
    TEST_ASSERT_NOT_NULL(candump_parse(line, sizeof line - 2u, &record));
}

static void assert_written(const char *expected, uint64_t stamp_us, const char *interface, hal_can_frame_t frame) {
    char line[CANDUMP_WRITE_MAX + 1u];
    size_t length = candump_write(line, stamp_us, interface, &frame);
    line[length] = '\0';
    TEST_ASSERT_TRUE(length < CANDUMP_WRITE_MAX);
    TEST_ASSERT_EQUAL_STRING(expected, line);
    TEST_ASSERT_NULL(candump_parse(line, length - 1u, &record));
    TEST_ASSERT_EQUAL_UINT64(stamp_us, record.stamp_us);
    TEST_ASSERT_EQUAL_HEX32(frame.id, record.frame.id);
    TEST_ASSERT_EQUAL_UINT8(frame.length, record.frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(frame.data, record.frame.data, 8);
}

void test_what_is_written_is_read_back(void) {
    assert_written("(1700000000.000001) can0 43F#000000007000000A\n", 1700000000000001u, "can0",
                   (hal_can_frame_t){.id = 0x43F, .length = 8, .data = {0, 0, 0, 0, 0x70, 0, 0, 0x0A}});
    assert_written("(0000000000.000000) c 000#\n", 0, "c", (hal_can_frame_t){.id = 0});
    assert_written("(999999999999.999999) 123456789012345 1FFFFFFF#FFFFFFFFFFFFFFFF\n", 999999999999999999u,
                   "123456789012345",
                   (hal_can_frame_t){.id = 0x1FFFFFFF,
                                     .flags = HAL_CAN_EXTENDED,
                                     .length = 8,
                                     .data = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}});
}

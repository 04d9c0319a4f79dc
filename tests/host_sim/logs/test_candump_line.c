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

#define F "(1.000000) c "

typedef struct {
    const char *text; /* behind the interface */
    uint32_t id;
    uint8_t flags;
    uint8_t length;
    char data[9];
} row_t;

static void is_frame(const row_t *row) {
    char text[256];
    (void)snprintf(text, sizeof text, F "%s", row->text);
    parse_good(text);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(row->id, record.frame.id, text);
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(row->flags, record.frame.flags, text);
    TEST_ASSERT_EQUAL_UINT8_MESSAGE(row->length, record.frame.length, text);
    TEST_ASSERT_EQUAL_HEX8_ARRAY_MESSAGE(row->data, record.frame.data, 8, text);
    TEST_ASSERT_EQUAL_UINT32(0, record.frame.time_ms);
}

void test_frames_of_each_kind(void) {
    static const row_t rows[] = {
        {"43F#0000000000000011", 0x43F, 0, 8, "\0\0\0\0\0\0\0\x11"},
        {"0a3#abcdef", 0x0A3, 0, 3, "\xAB\xCD\xEF"},
        {"43F#00 R", 0x43F, 0, 1, ""},
        {"43F#00 T", 0x43F, 0, 1, ""},
        {"43F#00\r", 0x43F, 0, 1, ""},
        {"43F#00 T\r", 0x43F, 0, 1, ""},
        {"43F#0011223344556677_9", 0x43F, 0, 8, "\x00\x11\x22\x33\x44\x55\x66\x77"}, /* a raw DLC */
        {"43F#0011223344556677_F T", 0x43F, 0, 8, "\x00\x11\x22\x33\x44\x55\x66\x77"},
        {"0000043F#01", 0x43F, HAL_CAN_EXTENDED, 1, "\x01"},
        {"1FFFFFFF#", 0x1FFFFFFF, HAL_CAN_EXTENDED, 0, ""},
        {"20000004#0001000000000000", 4, HAL_CAN_ERROR, 8, "\0\x01"},
        {"3FFFFFFF#", 0x1FFFFFFF, HAL_CAN_ERROR, 0, ""},
        {"43F#R", 0x43F, HAL_CAN_REMOTE, 0, ""},
        {"43F#R R", 0x43F, HAL_CAN_REMOTE, 0, ""},
        {"43F#R8", 0x43F, HAL_CAN_REMOTE, 8, ""},
        {"43F#R8_F", 0x43F, HAL_CAN_REMOTE, 8, ""},
        {"0000043F#R3", 0x43F, HAL_CAN_REMOTE | HAL_CAN_EXTENDED, 3, ""},
        {"43F##1", 0x43F, HAL_CAN_FD, 0, ""},
        {"43F##30011223344556677", 0x43F, HAL_CAN_FD, 8, "\x00\x11\x22\x33\x44\x55\x66\x77"},
        {"0000043F##F00112233445566778899AABB", 0x43F, HAL_CAN_FD | HAL_CAN_EXTENDED, 12,
         "\x00\x11\x22\x33\x44\x55\x66\x77"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        is_frame(&rows[i]);
    }
}

void test_every_length_of_a_classic_frame(void) {
    static const char digits[] = "0123456789ABCDEF";
    for (unsigned length = 0; length <= 8; length++) {
        char text[64];
        row_t row = {.text = text, .id = 0x7FF, .length = (uint8_t)length};
        (void)snprintf(text, sizeof text, "7FF#%.*s", (int)(2 * length), digits);
        memcpy(row.data, "\x01\x23\x45\x67\x89\xAB\xCD\xEF", length);
        is_frame(&row);
    }
}

void test_the_longest_can_fd_frame(void) {
    char text[256] = F "1FFFFFFF##1";
    for (unsigned i = 0; i < 64; i++) {
        strcat(text, "A5");
    }
    is_frame(&(row_t){&text[sizeof F - 1], 0x1FFFFFFF, HAL_CAN_FD | HAL_CAN_EXTENDED, 64,
                      "\xA5\xA5\xA5\xA5\xA5\xA5\xA5\xA5"});
    strcat(text, "00");
    parse_bad(text, "longer than 64 bytes");
}

void test_time_stamps(void) {
    static const struct {
        const char *text;
        uint64_t us;
    } rows[] = {
        {"(0.000000) c 43F#", 0},
        {"(0000000001.500000) c 43F#", 1500000},
        {"(000000000001.000002) c 43F#", 1000002},
        {"(12.345678999) c 43F#", 12345678}, /* nanoseconds are rounded down */
        {"(999999999999.999999) c 43F#", 999999999999999999},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        parse_good(rows[i].text);
        TEST_ASSERT_EQUAL_UINT64(rows[i].us, record.stamp_us);
    }
}

void test_interfaces(void) {
    parse_good("(1.000000) 123456789012345 43F#");
    TEST_ASSERT_EQUAL_UINT(15, record.interface_length);
    parse_good("(1.000000)    can0 43F#"); /* candump aligns names to the right */
    TEST_ASSERT_EQUAL_UINT(4, record.interface_length);
    TEST_ASSERT_EQUAL_MEMORY("can0", record.interface, 4);
}

void test_a_record_is_from_one_interface(void) {
    parse_good("(0.000000) can1 43F#");
    TEST_ASSERT_TRUE(candump_is_from(&record, "can1"));
    TEST_ASSERT_FALSE(candump_is_from(&record, "can0"));
    TEST_ASSERT_FALSE(candump_is_from(&record, "can"));
    TEST_ASSERT_FALSE(candump_is_from(&record, "can10"));
    TEST_ASSERT_FALSE(candump_is_from(&record, NULL));
}

void test_what_is_no_line(void) {
    static const struct {
        const char *said;
        const char *const lines[20];
    } rows[] = {
        {"does not begin",
         {"", "1.000000 c 43F#", " (1.000000) c 43F#",
          "DROPCOUNT: dropped 1 CAN frame on 'can0' socket (total drops 1)"}},
        {"number of seconds",
         {"(", "(-1.000000) c 43F#", "(+1.000000) c 43F#", "(.000000) c 43F#", "(1) c 43F#", "(1,000000) c 43F#",
          "(2026-11-21 12:00:00.000000) c 43F#", "(1000000000000.000000) c 43F#"}},
        {"decimals",
         {"(1.) c 43F#", "(1.00000) c 43F#", "(1.0000000) c 43F#", "(1.00000000) c 43F#", "(1.0000000000) c 43F#",
          "(1.00000x) c 43F#"}},
        {"parenthesis", {"(1.000000 c 43F#", "(1.000000)c 43F#", "(1.000000)"}},
        {"longer than 15", {"(1.000000) 1234567890123456 43F#"}},
        {"the interface name is missing",
         {"(1.000000) ", "(1.000000) can0", "(1.000000) can\xC3\xA4 43F#", "(1.000000) can\t0 43F#"}},
        {"a hexadecimal identifier followed by # is missing", {"(1.000000) can0  43F#"}},
        {"longer than 8 bytes", {F "7FF#0123456789ABCDEF01"}},
        {"above 7FF", {F "800#", F "FFF#"}},
        {"above 1FFFFFFF", {F "40000000#", F "80000000#", F "E0000004#"}},
        {"neither 3 nor 8", {F "#00", F "3F#00", F "043F#00", F "00000043F#00"}},
        {"CAN XL", {F "00123#81:00:12345678#11"}},
        {"a hexadecimal identifier followed by # is missing", {F "000000000043F#00", F "43G#00", F "43F", F ""}},
        {"odd number", {F "43F#0", F "43F#001", F "43F#0 R", F "43F##10"}},
        {"the data is not hexadecimal", {F "43F#0G", F "43F#0Z00"}},
        {"flags", {F "43F##", F "43F##G"}},
        {"not CAN FD", {F "20000004##000"}},
        {"after the frame",
         {F "43F#00.11", F "43F#G0", F "43F#00#", F "43F#r", F "43F#00 X", F "43F#00  R", F "43F#00 RT", F "43F#00\r\r",
          F "43F#00\rR", F "43F#00 ", F "43F#R9", F "43F#R7_9", F "43F#R00", F "20000004#R",
          F "43F##10011223344556677_9", F "43F#0011223344556677_8", F "43F#0011223344556677_G",
          F "43F#0011223344556677_", F "43F#00112233445566_9"}},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        for (const char *const *line = rows[i].lines; *line != NULL; line++) {
            parse_bad(*line, rows[i].said);
        }
    }
}

void test_a_nul_byte_is_no_end(void) {
    const char line[] = "(1.000000) c 43F#00\0\n";
    TEST_ASSERT_NOT_NULL(candump_parse(line, sizeof line - 2, &record));
}

static void assert_written(const char *expected, uint64_t stamp_us, const char *interface, hal_can_frame_t frame) {
    char line[CANDUMP_WRITE_MAX + 1];
    size_t length = candump_write(line, stamp_us, interface, &frame);
    line[length] = '\0';
    TEST_ASSERT_TRUE(length < CANDUMP_WRITE_MAX);
    TEST_ASSERT_EQUAL_STRING(expected, line);
    TEST_ASSERT_NULL(candump_parse(line, length - 1, &record));
    TEST_ASSERT_EQUAL_UINT64(stamp_us, record.stamp_us);
    TEST_ASSERT_EQUAL_HEX32(frame.id, record.frame.id);
    TEST_ASSERT_EQUAL_UINT8(frame.length, record.frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(frame.data, record.frame.data, 8);
}

void test_what_is_written_is_read_back(void) {
    assert_written("(1700000000.000001) can0 43F#000000007000000A\n", 1700000000000001, "can0",
                   (hal_can_frame_t){.id = 0x43F, .length = 8, .data = {0, 0, 0, 0, 0x70, 0, 0, 0x0A}});
    assert_written("(0000000000.000000) c 000#\n", 0, "c", (hal_can_frame_t){.id = 0});
    assert_written("(999999999999.999999) 123456789012345 1FFFFFFF#FFFFFFFFFFFFFFFF\n", 999999999999999999,
                   "123456789012345",
                   (hal_can_frame_t){.id = 0x1FFFFFFF,
                                     .flags = HAL_CAN_EXTENDED,
                                     .length = 8,
                                     .data = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}});
}

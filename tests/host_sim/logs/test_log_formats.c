/* The formats of a log, told by its content: what candump shows on the screen, Vector ASC, each also with gzip; and what
 * the message says of those that are not read. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#include <zlib.h>

#include "logs/candump_log.h"
#include "scratch.h"
#include "unity.h"

static candump_log_t *log_file;
static candump_record_t record;

void setUp(void) {
    scratch_open();
    log_file = calloc(1, sizeof *log_file);
    TEST_ASSERT_NOT_NULL(log_file);
    log_file->fd = -1;
}

void tearDown(void) {
    candump_close(log_file);
    free(log_file);
}

static void open_bytes(const void *bytes, size_t size) {
    static char path[256];
    (void)snprintf(path, sizeof path, "%s", scratch_write("log", bytes, size));
    candump_close(log_file);
    TEST_ASSERT_TRUE(candump_open(log_file, path, false));
}

static void open_text(const char *text) {
    open_bytes(text, strlen(text));
}

/* The next frame: time, interface, identifier, flags, length, and the 8 bytes as one number, data[0] first. */
static void expect(uint64_t stamp_us, const char *interface, uint32_t id, uint8_t flags, uint8_t length,
                   uint64_t bytes) {
    const candump_result_t result = candump_next(log_file, &record);
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
    TEST_ASSERT_EQUAL_INT(CANDUMP_RECORD, result);
    TEST_ASSERT_EQUAL_UINT64(stamp_us, record.stamp_us);
    TEST_ASSERT_EQUAL_UINT(strlen(interface), record.interface_length);
    TEST_ASSERT_EQUAL_STRING_LEN(interface, record.interface, record.interface_length);
    TEST_ASSERT_EQUAL_HEX32(id, record.frame.id);
    TEST_ASSERT_EQUAL_HEX8(flags, record.frame.flags);
    TEST_ASSERT_EQUAL_UINT8(length, record.frame.length);
    uint64_t got = 0;
    for (size_t i = 0; i < 8; i++) {
        got = (got << 8) | record.frame.data[i];
    }
    TEST_ASSERT_EQUAL_HEX64(bytes, got);
}

static void expect_end(void) {
    TEST_ASSERT_EQUAL_INT(CANDUMP_END, candump_next(log_file, &record));
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
}

static void expect_failure(const char *part) {
    candump_result_t result = CANDUMP_RECORD;
    while (result == CANDUMP_RECORD) {
        result = candump_next(log_file, &record);
    }
    TEST_ASSERT_EQUAL_INT(CANDUMP_FAILED, result);
    (void)scratch_said_line(part);
}

static void refuse(const char *text, const char *part) {
    open_text(text);
    expect_failure(part);
}

void test_the_screen_of_candump(void) {
    open_text(" (1700000000.000001)  can0  43F   [8]  00 11 22 33 44 55 66 77\n"
              " (1700000000.000002)  vcan1       0A3   [1]  08\r\n"
              " (1700000000.000003)  can0  12345678   [2]  AB cd\n"
              " (1700000000.000004)  can0  123   [0]  remote request\n"
              " (1700000000.000005)  can0  123   [8]  remote request\n"
              " (1700000000.000006)  can0  123   [0]\n"
              " (1700000000.000007)  can0  123  [12]  01 02 03 04 05 06 07 08 09 0A 0B 0C\n"
              " (1700000000.000008)  can0  20000004   [8]  00 01 00 00 00 00 00 00   ERRORFRAME\n"
              "\tcontroller-problem{rx-overflow}\n"
              " (1700000000.000009)  can0  RX - -  043   [2]  41 42   'AB'\n"
              " (1700000000.000010)  can0  TX B E  043   [2]  41 42\n");
    expect(1700000000000001, "can0", 0x43F, 0, 8, 0x0011223344556677);
    TEST_ASSERT_EQUAL_STRING("candump -t", candump_format_name(log_file->format));
    expect(1700000000000002, "vcan1", 0x0A3, 0, 1, 0x0800000000000000);
    expect(1700000000000003, "can0", 0x12345678, HAL_CAN_EXTENDED, 2, 0xABCD000000000000);
    expect(1700000000000004, "can0", 0x123, HAL_CAN_REMOTE, 0, 0);
    expect(1700000000000005, "can0", 0x123, HAL_CAN_REMOTE, 8, 0);
    expect(1700000000000006, "can0", 0x123, 0, 0, 0);
    expect(1700000000000007, "can0", 0x123, HAL_CAN_FD, 12, 0x0102030405060708);
    expect(1700000000000008, "can0", 4, HAL_CAN_ERROR, 8, 0x0001000000000000);
    expect(1700000000000009, "can0", 0x043, 0, 2, 0x4142000000000000);
    expect(1700000000000010, "can0", 0x043, 0, 2, 0x4142000000000000);
    expect_end();
}

void test_the_screen_with_times_from_zero_and_with_dates(void) {
    open_text(" (000.000000)  can0  43F   [1]  01\n (012.345678)  can0  43F   [1]  02\n");
    expect(0, "can0", 0x43F, 0, 1, 0x0100000000000000);
    expect(12345678, "can0", 0x43F, 0, 1, 0x0200000000000000);
    expect_end();
    open_text(" (2023-11-14 22:13:20.250000)  can0  43F   [1]  01\n");
    expect(1700000000250000, "can0", 0x43F, 0, 1, 0x0100000000000000);
    expect_end();
}

/* Each bad line after these good ones. */
static void refuse_each(const char *good, const char *const bad[][2], size_t count) {
    for (size_t i = 0; i < count; i++) {
        char text[256];
        (void)snprintf(text, sizeof text, "%s%s", good, bad[i][0]);
        refuse(text, bad[i][1]);
    }
}

void test_lines_of_the_screen_that_are_damaged(void) {
    static const char *const bad[][2] = {
        {" (000.1)  can0  43F   [8]  00 11 22\n", "log:2: the data is shorter than its length says"},
        {" (000.1)  can0  43F   [1]  00 11\n", "log:2: unexpected text after the frame"},
        {" (000.1)  can0  43F   [1]  0\n", "log:2: the data is shorter"},
        {" (000.1)  can0  43F   1  00\n", "log:2: the length in brackets is missing"},
        {" (000.1)  can0  43F   [65]  00\n", "log:2: the length in brackets is missing"},
        {" (000.1)  can0  43   [1]  00\n", "log:2: an identifier of 3 or 8"},
        {" (000.1)  can0  843   [1]  00\n", "log:2: the identifier is above 7FF"},
        {" (000.1)\n", "log:2: the interface name is missing"},
        {" (000.1)  a-name-too-long-x  043   [1]  00\n", "log:2: the interface name is longer"},
        {" (abc)  can0  043   [1]  00\n", "log:2: the time stamp is neither"},
        {" (2023-02-30 22:13:20.0)  can0  043   [1]  00\n", "log:2: the time stamp is neither"},
        {" can0  043   [1]  00\n", "log:2: the line does not begin with a time stamp"},
    };
    refuse_each(" (000.000000)  can0  43F   [1]  01\n", bad, sizeof bad / sizeof bad[0]);
}

void test_differences_of_time_are_refused(void) {
    char *text = calloc(1, 16384);
    for (size_t i = 0; i < 200; i++) {
        (void)snprintf(&text[strlen(text)], 64, " (000.00%zu000)  can0  43F   [1]  01\n", i % 3);
    }
    open_text(text);
    free(text);
    expect_failure("candump -t d");
}

void test_vector_asc(void) {
    open_text(
        "date Tue Nov 14 10:13:20.500 pm 2023\n"
        "base hex  timestamps absolute\n"
        "internal events logged\n"
        "// version 9.0.0\n"
        "Begin Triggerblock Tue Nov 14 10:13:20.500 pm 2023\n"
        "   0.000000 Start of measurement\n"
        "   0.000001 1  43F             Rx   d 8 00 11 22 33 44 55 66 77  Length = 240000 BitCount = 124 ID = 1087\n"
        "   0.000002 2  a3              Tx   d 1 08\n"
        "   0.000003 1  12345678x       Rx   d 2 AB CD\n"
        "   0.000004 1  123             Rx   r\n"
        "   0.000005 1  123             Rx   r 4\n"
        "   0.000006 1  ErrorFrame\n"
        "   0.000007 1  Statistic: D 100 R 0 XD 0 XR 0 E 0 O 0 B 5.00%\n"
        "   0.000008 1  43F             TxRq d 1 00\n"
        "   0.000009 CAN 1 Status:chip status error passive - TxErr: 136 RxErr: 0\n"
        "   0.000010 CAN 1 Status:chip status bus off\n"
        "   0.000011 CAN 1 Status:chip status error active\n"
        "   0.000012 SV: 2 0 1 ::Speed = 12\n"
        "   0.000013 log trigger event\n"
        "   1.000000 CANFD   1 Rx        123  Name                             1 0 9 12 01 02 03 04 05 06 07 08 09 0A "
        "0B 0C   130000  130   303000 0 0 0 0 0\n"
        "   1.000001 CANFD   2 Tx        124                                   0 0 8  8 01 02 03 04 05 06 07 08   "
        "130000  130        0 0 0 0 0 0\n"
        "   1.5 CANFD   1 Rx ErrorFrame\n"
        "End TriggerBlock\n");
    const uint64_t start = 1700000000500000;
    expect(start + 1, "can0", 0x43F, 0, 8, 0x0011223344556677);
    TEST_ASSERT_EQUAL_STRING("Vector ASC", candump_format_name(log_file->format));
    expect(start + 2, "can1", 0x0A3, 0, 1, 0x0800000000000000);
    expect(start + 3, "can0", 0x12345678, HAL_CAN_EXTENDED, 2, 0xABCD000000000000);
    expect(start + 4, "can0", 0x123, HAL_CAN_REMOTE, 0, 0);
    expect(start + 5, "can0", 0x123, HAL_CAN_REMOTE, 4, 0);
    expect(start + 6, "can0", CANDUMP_ERROR_PROTOCOL, HAL_CAN_ERROR, 8, 0);
    expect(start + 9, "can0", CANDUMP_ERROR_CONTROLLER, HAL_CAN_ERROR, 8, 0x0030000000000000);
    expect(start + 10, "can0", CANDUMP_ERROR_BUS_OFF, HAL_CAN_ERROR, 8, 0);
    expect(start + 11, "can0", CANDUMP_ERROR_CONTROLLER | CANDUMP_ERROR_RESTARTED, HAL_CAN_ERROR, 8,
           0x0040000000000000);
    expect(start + 1000000, "can0", 0x123, HAL_CAN_FD, 12, 0x0102030405060708);
    expect(start + 1000001, "can1", 0x124, 0, 8, 0x0102030405060708);
    expect(start + 1500000, "can0", CANDUMP_ERROR_PROTOCOL, HAL_CAN_ERROR, 8, 0);
    expect_end();
}

/* As python-can writes it: the header has the time of the conversion. A block without a start of measurement changes nothing. */
void test_vector_asc_begins_at_the_date_of_its_first_block(void) {
    open_text("date Sun Nov 29 05:42:11.000 PM 2026\n"
              "base hex  timestamps absolute\n"
              "Begin Triggerblock Tue Nov 14 10:13:20.500 PM 2023\n"
              "   0.000000 Start of measurement\n"
              "   0.000001 1  43F             Rx   d 1 11\n"
              "End TriggerBlock\n"
              "Begin Triggerblock Tue Nov 14 10:13:30.500 PM 2023\n"
              "   10.00000 1  43F             Rx   d 1 22\n"
              "   11.00000 Start of measurement\n"
              "   12.00000 1  43F             Rx   d 1 33\n");
    expect(1700000000500001, "can0", 0x43F, 0, 1, 0x1100000000000000);
    expect(1700000010500000, "can0", 0x43F, 0, 1, 0x2200000000000000);
    expect(1700000012500000, "can0", 0x43F, 0, 1, 0x3300000000000000);
    expect_end();
}

void test_vector_asc_in_decimal_with_relative_times(void) {
    open_text("date Mit Okt 14 21:46:40 2026\n"
              "base dec  timestamps relative\n"
              "no internal events logged\n"
              "   0.100000 1  1087            Rx   d 8 0 17 34 51 68 85 102 255\n"
              "   0.100000 Start of measurement\n"
              "   0.200000 1  305419896x      Rx   d 1 10\n");
    expect(1792014400100000, "can0", 0x43F, 0, 8, 0x00112233445566FF);
    expect(1792014400400000, "can0", 0x12345678, HAL_CAN_EXTENDED, 1, 0x0A00000000000000);
    expect_end();
}

void test_a_wild_relative_time_does_not_shift_the_lines_behind_it(void) {
    open_text("base hex  timestamps relative\n"
              "   0.1 1  43F             Rx   d 1 11\n"
              "   99999999.0 1  43F      Rx   d 1 22\n"
              "   0.1 1  43F             Rx   d 1 33\n");
    log_file->skip_bad = true;
    expect(100000, "can0", 0x43F, 0, 1, 0x1100000000000000);
    TEST_ASSERT_EQUAL_INT(CANDUMP_RECORD, candump_next(log_file, &record));
    TEST_ASSERT_EQUAL_UINT64(200000, record.stamp_us);
    TEST_ASSERT_EQUAL_UINT64(1, log_file->skipped);
    expect_end();
}

void test_vector_asc_with_a_time_of_day_that_is_none(void) {
    open_text("date Tue Nov 14 10:13:260 pm 2023\n"
              "base hex\n"
              "   0.010000 1  43F             Rx   d 1 11\n");
    expect(10000, "can0", 0x43F, 0, 1, 0x1100000000000000);
}

void test_vector_asc_without_a_header(void) {
    open_text("   0.010000 1  43F             Rx   d 1 11\n"
              "   0.020000 1  43F             Rx   d 1 22\n");
    TEST_ASSERT_EQUAL_INT(CANDUMP_RECORD, candump_next(log_file, &record));
    TEST_ASSERT_EQUAL_UINT64(10000, record.stamp_us);
    TEST_ASSERT_EQUAL_HEX32(0x43F, record.frame.id);
    (void)scratch_said_line(
        "log:1: no line 'base hex|dec timestamps absolute|relative' before the first frame: read as "
        "hexadecimal with absolute time stamps");
    expect(20000, "can0", 0x43F, 0, 1, 0x2200000000000000); /* it is said once */
    expect_end();
}

void test_lines_of_vector_asc_that_are_damaged(void) {
    static const char *const bad[][2] = {
        {" 0.1 1 43F Rx d 8 00 11\n", "log:3: the data is shorter than its length says"},
        {" 0.1 1 43F Rx d 1 00 11\n", "log:3: the data is longer than its length says"},
        {" 0.1 1 43F Rx d\n", "log:3: the length of the data is missing"},
        {" 0.1 1 43F Rx\n", "log:3: neither a data nor a remote frame"},
        {" 0.1 1 43F\n", "log:3: the frame is cut off"},
        {" 0.1\n", "log:3: the line is cut off behind its time stamp"},
        {" 0.1 1 8FF Rx d 1 00\n", "log:3: the identifier is above 7FF"},
        {" 0.1 1 GearCommand Rx d 1 00\n", "log:3: the identifier is not a number"},
        {" 0.1 0 43F Rx d 1 00\n", "log:3: the channel is not a number from 1 to 255"},
        {" 0.1 CANFD 1 Rx 123 1 0 9\n", "log:3: bit rate switch"},
        {" 0.1 CANFD 1 Rx 123 1 0 9 12 00\n", "log:3: the data is shorter"},
        {"nonsense\n", "log:3: not a line of an ASC log"},
        {"base oct  timestamps absolute\n", "log:3: the base is neither hex nor dec"},
        {"base hex  timestamps foo\n", "log:3: timestamps are neither absolute nor relative"},
    };
    refuse_each("base hex  timestamps absolute\n 0.0 1 43F Rx d 1 00\n", bad, sizeof bad / sizeof bad[0]);
}

static size_t pack(const char *text, unsigned char *packed, size_t size) {
    z_stream stream = {0};
    TEST_ASSERT_EQUAL_INT(Z_OK, deflateInit2(&stream, 9, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY));
    unsigned char *copy = (unsigned char *)strdup(text);
    stream.next_in = copy;
    stream.avail_in = (uInt)strlen(text);
    stream.next_out = packed;
    stream.avail_out = (uInt)size;
    TEST_ASSERT_EQUAL_INT(Z_STREAM_END, deflate(&stream, Z_FINISH));
    const size_t used = stream.total_out;
    (void)deflateEnd(&stream);
    free(copy);
    return used;
}

#define LINE "(1.000000) can0 43F#0000000000000011\n"

void test_every_format_may_be_compressed(void) {
    static const char *const texts[] = {LINE, " (1.000000)  can0  43F   [8]  00 00 00 00 00 00 00 11\n",
                                        "base hex\n 1.0 1 43F Rx d 8 00 00 00 00 00 00 00 11\n"};
    unsigned char packed[512];
    for (size_t i = 0; i < 3; i++) {
        open_bytes(packed, pack(texts[i], packed, sizeof packed));
        expect(1000000, "can0", 0x43F, 0, 8, 0x11);
        expect_end();
    }
}

void test_compressed_files_one_after_the_other(void) {
    unsigned char packed[512];
    const size_t first = pack(LINE LINE, packed, sizeof packed);
    const size_t second = pack(LINE, &packed[first], sizeof packed - first);
    open_bytes(packed, first + second);
    for (size_t i = 0; i < 3; i++) {
        expect(1000000, "can0", 0x43F, 0, 8, 0x11);
    }
    expect_end();
}

void test_compressed_data_that_is_cut_off_or_damaged(void) {
    unsigned char packed[512];
    const size_t size = pack(LINE LINE LINE, packed, sizeof packed);
    for (size_t cut = 3; cut < size; cut++) {
        open_bytes(packed, cut);
        expect_failure("log: the gzip file is cut off; --skip-bad-lines reads up to there");
    }
    open_bytes(packed, size - 1);
    log_file->skip_bad = true;
    for (size_t i = 0; i < 3; i++) {
        expect(1000000, "can0", 0x43F, 0, 8, 0x11);
    }
    TEST_ASSERT_EQUAL_INT(CANDUMP_END, candump_next(log_file, &record));
    (void)scratch_said_line("log: the gzip file is cut off; read up to there");
    packed[size - 5] ^= 1; /* of the checksum */
    open_bytes(packed, size);
    expect_failure("log: the gzip data is damaged");
}

/* 15 MB of line feeds in 15 KB: all of them are passed over. */
void test_a_log_that_grows_a_thousandfold(void) {
    char *text = malloc(1u << 20);
    memset(text, '\n', 1u << 20);
    text[(1u << 20) - 1] = '\0';
    unsigned char *packed = malloc(1u << 19);
    size_t size = 0;
    for (size_t i = 0; i < 15; i++) {
        size += pack(text, &packed[size], (1u << 19) - size);
    }
    size += pack(LINE, &packed[size], (1u << 19) - size);
    open_bytes(packed, size);
    expect(1000000, "can0", 0x43F, 0, 8, 0x11);
    expect_end();
    free(text);
    free(packed);
}

void test_other_formats_are_named_with_what_converts_them(void) {
    static const struct {
        const char *bytes;
        size_t size;
        const char *name;
        const char *command;
    } formats[] = {
        {"LOGG\0\0\0\0", 8, "a Vector BLF log", "python3 -m can.logconvert"},
        {"MDF     4.10", 12, "an MDF log", "python3 -m can.logconvert"},
        {"UnFinMF 4.10", 12, "an MDF log that was not finalised", "python3 -m can.logconvert"},
        {"SQLite format 3\0", 16, "an SQLite log", "python3 -m can.logconvert"},
        {"\xD4\xC3\xB2\xA1\x02\0\x04\0", 8, "a pcap capture", "tshark -r "},
        {"\x0A\x0D\x0D\x0A\x1C\0\0\0", 8, "a pcapng capture", "tshark -r "},
        {"\xFD"
         "7zXZ\0",
         6, "compressed with xz", "xz -dc "},
        {"\x28\xB5\x2F\xFD", 4, "compressed with zstd", "zstd -dc "},
        {"\x04\x22\x4D\x18", 4, "compressed with lz4", "lz4 -dc "},
        {"BZh91AY", 7, "compressed with bzip2", "bzip2 -dc "},
        {"PK\x03\x04", 4, "a zip archive", "unzip -p "},
        {"\x89HDF\r\n\x1A\n", 8, "an HDF5 file", "export its CAN frames"},
        {"#ROSBAG V2.0\n", 13, "a ROS bag", "export its CAN frames"},
        {"\xFF\xFE(\0", 4, "text in UTF-16", "iconv "},
        {";$FILEVERSION=1.1\n", 18, "a PEAK TRC log", "python3 -m can.logconvert"},
        {";##########\n;   C:\\t.trc\n", 24, "a PEAK TRC log", "python3 -m can.logconvert"},
        {";   Start time: 11.03.2010 13:41:51.312\n", 40, "a PEAK TRC log", "python3 -m can.logconvert"},
        {"; CAN activities imported from the PCAN-Trace buffer\n", 53, "a PEAK TRC log", "python3 -m can.logconvert"},
        {"***BUSMASTER Ver 3.2.2***\n", 26, "a BUSMASTER log", "SavvyCAN"},
        {"timestamp,arbitration_id,extended\n", 34, "a CSV log of python-can", "python3 -m can.logconvert"},
        {"Time Stamp,ID,Extended,Dir,Bus\n", 31, "a CSV log of SavvyCAN", "SavvyCAN"},
        {"1;2;3;4\n", 8, "a CSV file", "one line a frame"},
        {" (000.000000)  \x1B[34mcan0\n", 25, "colour codes", "sed "},
        {"  can0  43F   [1]  00\n", 22, "without time stamps", "candump -l"},
    };
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        open_bytes(formats[i].bytes, formats[i].size);
        TEST_ASSERT_EQUAL_INT(CANDUMP_FAILED, candump_next(log_file, &record));
        const char *said = scratch_said_line(formats[i].name);
        TEST_ASSERT_NOT_NULL_MESSAGE(strstr(said, formats[i].command), said);
    }
}

void test_what_is_no_log(void) {
    open_bytes("\0\0\0\0", 4);
    expect_failure("log:1: binary data");
    refuse("nonsense\n", "log:1: unknown log format");
    refuse("a line without an end", "log:1: unknown log format");
    open_text("");
    expect_end();
}

void test_a_mark_of_utf8_at_the_beginning(void) {
    open_text("\xEF\xBB\xBF" LINE);
    expect(1000000, "can0", 0x43F, 0, 8, 0x11);
}

/* Endless input: given up after a bounded amount. */
void test_endless_input(void) {
    TEST_ASSERT_TRUE(candump_open(log_file, "/dev/zero", false));
    expect_failure("/dev/zero:1: binary data");
    candump_close(log_file);
    TEST_ASSERT_TRUE(candump_open(log_file, "/dev/zero", true));
    expect_failure("/dev/zero: contains no frame in 16 MiB; given up");
}

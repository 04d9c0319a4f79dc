/* A candump log as a stream: lines across the edges of the buffer, lines that are too long, ends of all kinds. */
#include "logs/candump_log.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scratch.h"
#include "unity.h"

static candump_log_t *log_file;
static candump_record_t record;

void setUp(void) {
    scratch_open();
    log_file = malloc(sizeof *log_file);
    TEST_ASSERT_NOT_NULL(log_file);
}

void tearDown(void) {
    candump_close(log_file);
    free(log_file);
}

static void open_text(const char *text, size_t size, bool skip_bad) {
    static char path[256];
    (void)snprintf(path, sizeof path, "%s", scratch_write("log", text, size));
    TEST_ASSERT_TRUE(candump_open(log_file, path, skip_bad));
}

static size_t read_all(candump_result_t end) {
    size_t count = 0;
    candump_result_t result = candump_next(log_file, &record);
    for (; result == CANDUMP_RECORD; result = candump_next(log_file, &record)) {
        count++;
    }
    TEST_ASSERT_EQUAL_INT(end, result);
    return count;
}

#define LINE "(1.000000) can0 43F#0000000000000011\n"

void test_an_empty_log(void) {
    open_text("", 0, false);
    TEST_ASSERT_EQUAL_UINT(0, read_all(CANDUMP_END));
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
}

void test_blank_lines_are_passed_over_and_counted_as_lines(void) {
    static const char text[] = "\n\r\n \t \n" LINE "\n(bad)\n";
    open_text(text, sizeof text - 1, false);
    TEST_ASSERT_EQUAL_INT(CANDUMP_RECORD, candump_next(log_file, &record));
    TEST_ASSERT_EQUAL_UINT64(4, log_file->line);
    TEST_ASSERT_EQUAL_INT(CANDUMP_FAILED, candump_next(log_file, &record));
    (void)scratch_said_line("log:6: ");
}

void test_the_last_line_may_lack_its_end(void) {
    open_text(LINE LINE, sizeof LINE LINE - 2, false);
    TEST_ASSERT_EQUAL_UINT(2, read_all(CANDUMP_END));
}

void test_a_line_that_was_cut_off_is_a_bad_one(void) {
    open_text(LINE LINE, sizeof LINE LINE - 3, false);
    TEST_ASSERT_EQUAL_UINT(1, read_all(CANDUMP_FAILED));
    (void)scratch_said_line(
        "log:2: the data has an odd number of digits; the log is cut off in this line; --skip-bad-lines skips it\n");
}

/* Else a log whose writer was stopped would show a frame of another length, which trips. */
void test_a_last_frame_that_may_lack_data_is_left_out(void) {
    static const char text[] = LINE "(1.000000) can0 075#0000000000";
    open_text(text, sizeof text - 1, false);
    TEST_ASSERT_EQUAL_UINT(1, read_all(CANDUMP_END));
    TEST_ASSERT_EQUAL_UINT64(1, log_file->skipped);
    (void)scratch_said_line("log:2: the last line may be cut off; it is left out\n");
}

void test_a_last_frame_with_fewer_bytes_counts_if_its_line_ends(void) {
    static const char text[] = LINE "(1.000000) can0 075#0000000000\n";
    open_text(text, sizeof text - 1, false);
    TEST_ASSERT_EQUAL_UINT(2, read_all(CANDUMP_END));
    TEST_ASSERT_EQUAL_UINT64(0, log_file->skipped);
}

void test_a_bad_line_ends_the_reading(void) {
    static const char text[] = LINE "nonsense\n" LINE;
    open_text(text, sizeof text - 1, false);
    TEST_ASSERT_EQUAL_UINT(1, read_all(CANDUMP_FAILED));
    (void)scratch_said_line("log:2: the line does not begin with a time stamp in parentheses\n");
}

void test_bad_lines_are_skipped_and_counted_on_demand(void) {
    static const char text[] = "nonsense\n" LINE "\0\n" LINE "(1.000000) can0 43F#1";
    open_text(text, sizeof text - 1, true);
    TEST_ASSERT_EQUAL_UINT(2, read_all(CANDUMP_END));
    TEST_ASSERT_EQUAL_UINT64(3, log_file->skipped);
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
}

#define DAYS_100 "(8640001.000000) can0 43F#\n"   /* the longest gap after LINE */
#define DAYS_101 "(8640001.000001) can0 43F#\n"   /* too long */
#define DAYS_200 "(17280001.000002) can0 43F#\n"  /* and too long after that */
#define DAYS_200B "(17280001.000001) can0 43F#\n" /* but not this one */

void test_a_time_stamp_of_100_days_later_is_a_bad_line(void) {
    open_text(LINE DAYS_100, sizeof LINE DAYS_100 - 1, false);
    TEST_ASSERT_EQUAL_UINT(2, read_all(CANDUMP_END));
    candump_close(log_file);
    open_text(LINE DAYS_101 LINE, sizeof LINE DAYS_101 LINE - 1, false);
    TEST_ASSERT_EQUAL_UINT(1, read_all(CANDUMP_FAILED));
    (void)scratch_said_line(
        "log:2: the time stamp jumps by more than 100 days: if the clock was set, cut the log here\n");
}

void test_single_wild_time_stamps_are_skipped(void) {
    static const char text[] = LINE DAYS_101 LINE DAYS_101 DAYS_200 LINE DAYS_200;
    open_text(text, sizeof text - 1, true);
    TEST_ASSERT_EQUAL_UINT(3, read_all(CANDUMP_END));
    TEST_ASSERT_EQUAL_UINT64(4, log_file->skipped);
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
}

/* Else the whole rest of the log would be skipped. */
void test_a_clock_that_was_set_ends_the_reading_also_where_bad_lines_are_skipped(void) {
    static const char *const pairs[] = {DAYS_101 DAYS_101 LINE, DAYS_101 DAYS_200B, DAYS_200B "bad\n" DAYS_101};
    for (size_t i = 0; i < sizeof pairs / sizeof pairs[0]; i++) {
        char text[256];
        (void)snprintf(text, sizeof text, LINE "bad\n%s", pairs[i]);
        open_text(text, strlen(text), true);
        TEST_ASSERT_EQUAL_UINT(1, read_all(CANDUMP_FAILED));
        (void)scratch_said_line("log:3: the clock was set by more than 100 days: cut the log here\n");
        candump_close(log_file);
    }
}

void test_a_blank_line_that_is_too_long_is_a_bad_one(void) {
    char text[300];
    memset(text, ' ', sizeof text);
    text[sizeof text - 1] = '\n';
    open_text(text, sizeof text, false);
    TEST_ASSERT_EQUAL_UINT(0, read_all(CANDUMP_FAILED));
    (void)scratch_said_line("log:1: the line is longer than 255 characters\n");
}

/* A line that is longer than the buffer, between two good ones. */
static void check_giant(size_t size, bool with_end) {
    const size_t good = sizeof LINE - 1;
    char *text = malloc(size + (2 * good) + 1);
    memcpy(text, LINE, good);
    memset(&text[good], '(', size);
    size_t total = good + size;
    if (with_end) {
        text[total++] = '\n';
        memcpy(&text[total], LINE, good);
        total += good;
    }
    open_text(text, total, true);
    free(text);
    TEST_ASSERT_EQUAL_UINT(with_end ? 2 : 1, read_all(CANDUMP_END));
    TEST_ASSERT_EQUAL_UINT64(1, log_file->skipped);
    TEST_ASSERT_EQUAL_UINT64(with_end ? 3 : 2, log_file->line);
    candump_close(log_file);
}

void test_lines_longer_than_the_buffer(void) {
    static const size_t sizes[] = {256,
                                   CANDUMP_BUFFER_SIZE - 1,
                                   CANDUMP_BUFFER_SIZE,
                                   CANDUMP_BUFFER_SIZE + 1,
                                   2 * CANDUMP_BUFFER_SIZE,
                                   (3 * CANDUMP_BUFFER_SIZE) + 17};
    for (size_t i = 0; i < sizeof sizes / sizeof sizes[0]; i++) {
        check_giant(sizes[i], true);
        check_giant(sizes[i], false);
    }
}

void test_a_long_log_is_read_across_the_edges_of_the_buffer(void) {
    enum { LINES = 20000 };
    const size_t size = (size_t)LINES * 48;
    char *text = malloc(size);
    size_t used = 0;
    for (unsigned i = 0; i < LINES; i++) {
        used += (size_t)snprintf(&text[used], size - used, "(%u.%06u) can%u 43F#%0*X\n", i, i, i % 10,
                                 (int)(2 * (1 + (i % 8))), i & 0xFFu);
    }
    TEST_ASSERT_TRUE(used > 2 * CANDUMP_BUFFER_SIZE);
    open_text(text, used, false);
    free(text);
    for (unsigned i = 0; i < LINES; i++) {
        TEST_ASSERT_EQUAL_INT(CANDUMP_RECORD, candump_next(log_file, &record));
        TEST_ASSERT_EQUAL_UINT64((i * 1000000ull) + i, record.stamp_us);
        TEST_ASSERT_EQUAL_UINT8(1 + (i % 8), record.frame.length);
        TEST_ASSERT_EQUAL_HEX8(i & 0xFFu, record.frame.data[i % 8]);
        TEST_ASSERT_EQUAL_INT('0' + (int)(i % 10), record.interface[3]);
    }
    TEST_ASSERT_EQUAL_INT(CANDUMP_END, candump_next(log_file, &record));
    TEST_ASSERT_EQUAL_INT(CANDUMP_END, candump_next(log_file, &record));
}

void test_a_pipe_that_gives_a_byte_at_a_time(void) {
    int ends[2];
    TEST_ASSERT_EQUAL_INT(0, pipe(ends));
    const pid_t child = fork();
    if (child == 0) {
        static const char text[] = LINE LINE LINE;
        for (size_t i = 0; i < sizeof text - 1; i++) {
            (void)!write(ends[1], &text[i], 1);
        }
        _exit(0);
    }
    (void)close(ends[1]);
    const int real_stdin = dup(STDIN_FILENO);
    (void)dup2(ends[0], STDIN_FILENO);
    (void)close(ends[0]);
    TEST_ASSERT_TRUE(candump_open(log_file, "-", false));
    TEST_ASSERT_EQUAL_STRING("standard input", log_file->name);
    TEST_ASSERT_EQUAL_UINT(3, read_all(CANDUMP_END));
    candump_close(log_file);
    (void)dup2(real_stdin, STDIN_FILENO);
    (void)close(real_stdin);
    (void)waitpid(child, NULL, 0);
}

void test_what_cannot_be_opened_or_read(void) {
    TEST_ASSERT_FALSE(candump_open(log_file, scratch_path("none"), false));
    (void)scratch_said_line("none: No such file or directory\n");
    TEST_ASSERT_TRUE(candump_open(log_file, "/", false));
    TEST_ASSERT_EQUAL_INT(CANDUMP_FAILED, candump_next(log_file, &record));
    (void)scratch_said_line("/: Is a directory\n");
}

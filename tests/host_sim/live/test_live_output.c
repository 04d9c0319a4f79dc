/* Files that are written while a supervisor runs: in place, never waiting. */
#include "live/live_output.h"

#include <fcntl.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/interrupt.h"
#include "scratch.h"
#include "unity.h"

static live_output_t *output;

void setUp(void) {
    scratch_open();
    output = calloc(1, sizeof *output);
    TEST_ASSERT_NOT_NULL(output);
}

void tearDown(void) {
    output_discard(&output->lines);
    free(output);
    interrupt_release();
}

/* Put a line of so many bytes. Returns whether there was room. */
static bool put(size_t size) {
    char line[1000];
    TEST_ASSERT_LESS_OR_EQUAL(sizeof line, size);
    memset(line, 'x', size);
    line[size - 1] = '\n';
    return live_output_has_room(output) && output_write(&output->lines, line, size);
}

void test_a_line_is_in_the_file_once_it_was_passed(void) {
    (void)scratch_write("a", "of an earlier run\n", 18);
    TEST_ASSERT_TRUE(live_output_open(output, scratch_path("a")));
    TEST_ASSERT_EQUAL_STRING("of an earlier run\n", scratch_read("a")); /* whoever opens it may still be refused */
    TEST_ASSERT_TRUE(live_output_begin(output));
    TEST_ASSERT_EQUAL_STRING("", scratch_read("a"));
    TEST_ASSERT_TRUE(put(3));
    live_output_pass(output);
    TEST_ASSERT_EQUAL_STRING("xx\n", scratch_read("a"));
    TEST_ASSERT_TRUE(put(2));
    TEST_ASSERT_TRUE(live_output_end(output));
    TEST_ASSERT_EQUAL_STRING("xx\nx\n", scratch_read("a"));
    TEST_ASSERT_EQUAL_UINT(1, scratch_count());
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
}

void test_what_is_not_open_takes_nothing_and_ends_well(void) {
    TEST_ASSERT_FALSE(put(3));
    live_output_pass(output);
    TEST_ASSERT_TRUE(live_output_end(output));
    TEST_ASSERT_EQUAL_UINT64(0, output->lost_lines);
}

void test_a_file_that_cannot_be_opened_is_named(void) {
    TEST_ASSERT_FALSE(live_output_open(output, "/no/such/folder/a"));
    TEST_ASSERT_NOT_NULL(strstr(scratch_said(), "/no/such/folder/a: No such file or directory"));
    TEST_ASSERT_FALSE(live_output_has_room(output));
}

void test_a_full_disk_is_reported_at_the_end(void) {
    TEST_ASSERT_TRUE(live_output_open(output, "/dev/full"));
    TEST_ASSERT_TRUE(put(3));
    live_output_pass(output);
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
    TEST_ASSERT_FALSE(live_output_end(output));
    TEST_ASSERT_EQUAL_STRING("host_sim: /dev/full: No space left on device\n", scratch_said());
}

void test_a_named_pipe_keeps_lines_for_a_reader_that_comes_later(void) {
    char name[] = "fifo";
    char read_line[10] = "";
    TEST_ASSERT_EQUAL_INT(0, mkfifo(scratch_path(name), 0600));
    TEST_ASSERT_TRUE(live_output_open(output, scratch_path(name)));
    TEST_ASSERT_TRUE(live_output_begin(output));
    TEST_ASSERT_TRUE(put(3));
    live_output_pass(output);
    const int reader = open(scratch_path(name), O_RDONLY | O_NONBLOCK);
    TEST_ASSERT_EQUAL_INT(3, read(reader, read_line, sizeof read_line));
    TEST_ASSERT_EQUAL_STRING("xx\n", read_line);
    TEST_ASSERT_TRUE(live_output_end(output));
    TEST_ASSERT_EQUAL_INT(0, read(reader, read_line, sizeof read_line)); /* the end */
    (void)close(reader);
}

void test_a_reader_that_does_not_read_is_not_waited_for(void) {
    char name[] = "fifo";
    TEST_ASSERT_EQUAL_INT(0, mkfifo(scratch_path(name), 0600));
    const int reader = open(scratch_path(name), O_RDONLY | O_NONBLOCK);
    TEST_ASSERT_TRUE(live_output_open(output, scratch_path(name)));
    unsigned taken = 0;
    for (unsigned i = 0; i < 1000; i++) {
        taken += put(1000) ? 1 : 0;
        live_output_pass(output);
    }
    TEST_ASSERT_LESS_THAN(1000, taken);
    TEST_ASSERT_EQUAL_UINT64(1000 - taken, output->lost_lines);
    /* The last line has room whatever was lost. */
    TEST_ASSERT_LESS_OR_EQUAL(OUTPUT_BUFFER_SIZE - 1000, output->lines.used);
    TEST_ASSERT_FALSE(live_output_end(output));
    const char *said = scratch_said();
    TEST_ASSERT_NOT_NULL(strstr(said, " lines were lost because they were not read fast enough\n"));
    TEST_ASSERT_NOT_NULL(strstr(said, "timed out\n"));
    (void)close(reader);
}

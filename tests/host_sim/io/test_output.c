/* Files that are written whole or not at all. */
#include "io/output.h"

#include <errno.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/interrupt.h"
#include "scratch.h"
#include "unity.h"

static output_t *output;

void setUp(void) {
    scratch_open();
    output = calloc(1, sizeof *output);
    TEST_ASSERT_NOT_NULL(output);
}

void tearDown(void) {
    output_discard(output);
    free(output);
    interrupt_release();
}

static void write_text(const char *text) {
    TEST_ASSERT_TRUE(output_write(output, text, strlen(text)));
}

void test_a_file_appears_when_it_is_complete(void) {
    TEST_ASSERT_TRUE(output_open(output, scratch_path("a")));
    write_text("one\n");
    TEST_ASSERT_TRUE(output_flush(output));
    TEST_ASSERT_EQUAL_STRING("", scratch_read("a"));
    write_text("two\n");
    TEST_ASSERT_TRUE(output_commit(output));
    TEST_ASSERT_EQUAL_STRING("one\ntwo\n", scratch_read("a"));
    TEST_ASSERT_EQUAL_UINT(1, scratch_count());
}

void test_a_file_that_is_given_up_leaves_nothing(void) {
    (void)scratch_write("a", "old", 3);
    TEST_ASSERT_TRUE(output_open(output, scratch_path("a")));
    write_text("new");
    output_discard(output);
    TEST_ASSERT_EQUAL_STRING("old", scratch_read("a"));
    TEST_ASSERT_EQUAL_UINT(1, scratch_count());
}

void test_what_is_larger_than_the_buffer(void) {
    static char big[OUTPUT_BUFFER_SIZE + 1];
    memset(big, 'x', sizeof big);
    TEST_ASSERT_TRUE(output_open(output, scratch_path("a")));
    write_text("1");
    TEST_ASSERT_TRUE(output_write(output, big, sizeof big));
    TEST_ASSERT_TRUE(output_write(output, big, OUTPUT_BUFFER_SIZE));
    write_text("2");
    TEST_ASSERT_TRUE(output_commit(output));
    struct stat file;
    TEST_ASSERT_EQUAL_INT(0, stat(scratch_path("a"), &file));
    TEST_ASSERT_EQUAL_INT64(2 * OUTPUT_BUFFER_SIZE + 3, file.st_size);
}

void test_a_link_stays_a_link_and_permissions_stay(void) {
    (void)scratch_write("target", "old", 3);
    TEST_ASSERT_EQUAL_INT(0, chmod(scratch_path("target"), 0640));
    TEST_ASSERT_EQUAL_INT(0, symlink("target", scratch_path("link")));
    TEST_ASSERT_TRUE(output_open(output, scratch_path("link")));
    write_text("new");
    TEST_ASSERT_TRUE(output_commit(output));
    TEST_ASSERT_EQUAL_STRING("new", scratch_read("target"));
    struct stat file;
    TEST_ASSERT_EQUAL_INT(0, lstat(scratch_path("link"), &file));
    TEST_ASSERT_TRUE(S_ISLNK(file.st_mode));
    TEST_ASSERT_EQUAL_INT(0, stat(scratch_path("target"), &file));
    TEST_ASSERT_EQUAL_HEX32(0640, file.st_mode & 0777);
}

void test_a_new_file_has_the_permissions_of_the_umask(void) {
    const mode_t mask = umask(027);
    TEST_ASSERT_TRUE(output_open(output, scratch_path("a")));
    TEST_ASSERT_TRUE(output_commit(output));
    (void)umask(mask);
    struct stat file;
    TEST_ASSERT_EQUAL_INT(0, stat(scratch_path("a"), &file));
    TEST_ASSERT_EQUAL_HEX32(0640, file.st_mode & 0777);
}

void test_a_device_is_written_directly(void) {
    TEST_ASSERT_TRUE(output_open(output, "/dev/null"));
    write_text("x");
    TEST_ASSERT_TRUE(output_commit(output));
    TEST_ASSERT_TRUE(output_open(output, "/dev/full"));
    write_text("x");
    TEST_ASSERT_FALSE(output_commit(output));
    TEST_ASSERT_EQUAL_STRING("host_sim: /dev/full: No space left on device\n", scratch_said());
}

void test_after_a_failure_nothing_more_is_written(void) {
    TEST_ASSERT_TRUE(output_open(output, "/dev/full"));
    write_text("x");
    TEST_ASSERT_FALSE(output_flush(output));
    TEST_ASSERT_FALSE(output_write(output, "y", 1));
    TEST_ASSERT_EQUAL_INT(ENOSPC, output->error);
    TEST_ASSERT_FALSE(output_commit(output));
}

void test_what_cannot_be_opened(void) {
    TEST_ASSERT_FALSE(output_open(output, "/none/a"));
    TEST_ASSERT_EQUAL_STRING("host_sim: /none/a: No such file or directory\n", scratch_said());
    TEST_ASSERT_FALSE(output_open(output, "/"));
    TEST_ASSERT_EQUAL_STRING("host_sim: /: Is a directory\n", scratch_said());
    TEST_ASSERT_FALSE(output_open(output, "/dev/null/a"));
    TEST_ASSERT_EQUAL_STRING("host_sim: /dev/null/a: Not a directory\n", scratch_said());
    TEST_ASSERT_TRUE(output_commit(output)); /* not open: nothing to do */
}

void test_a_file_that_cannot_take_its_place_leaves_nothing(void) {
    TEST_ASSERT_TRUE(output_open(output, scratch_path("a")));
    TEST_ASSERT_EQUAL_INT(0, mkdir(scratch_path("a"), 0700));
    TEST_ASSERT_FALSE(output_commit(output));
    TEST_ASSERT_NOT_NULL(strstr(scratch_said(), "/a: Is a directory\n"));
    TEST_ASSERT_EQUAL_UINT(1, scratch_count());
    TEST_ASSERT_EQUAL_INT(0, rmdir(scratch_path("a")));
}

static volatile sig_atomic_t noted;

static void note_signal(int signal) {
    noted = signal;
}

void test_a_signal_waits_until_the_unfinished_is_removed(void) {
    TEST_ASSERT_TRUE(output_open(output, scratch_path("a")));
    TEST_ASSERT_FALSE(interrupt_pending());
    TEST_ASSERT_TRUE(interrupt_wait(STDOUT_FILENO, INTERRUPT_WRITE));
    TEST_ASSERT_EQUAL_INT(0, raise(SIGTERM));
    TEST_ASSERT_TRUE(interrupt_pending());
    TEST_ASSERT_FALSE(interrupt_wait(STDOUT_FILENO, INTERRUPT_WRITE));
    output_discard(output);
    TEST_ASSERT_EQUAL_UINT(0, scratch_count());
    (void)signal(SIGTERM, note_signal); /* or it would end this test now */
    interrupt_release();
    (void)signal(SIGTERM, SIG_DFL);
    TEST_ASSERT_EQUAL_INT(SIGTERM, noted);
    TEST_ASSERT_FALSE(interrupt_pending());
}

void test_an_ignored_hangup_stays_ignored(void) {
    (void)signal(SIGHUP, SIG_IGN);
    interrupt_hold();
    TEST_ASSERT_EQUAL_INT(0, raise(SIGHUP));
    TEST_ASSERT_FALSE(interrupt_pending());
    interrupt_release();
    (void)signal(SIGHUP, SIG_DFL);
}

static bool are_distinct(const char *read, const char *written, const char *also_written) {
    const output_role_t roles[] = {{.role = "LOG", .path = read},
                                   {.role = "--out", .path = written, .is_written = true},
                                   {.role = "--events", .path = also_written, .is_written = true}};
    return output_check_distinct(roles, 3);
}

void test_a_file_has_one_role(void) {
    char a[256];
    char dotted[256];
    (void)snprintf(a, sizeof a, "%s", scratch_write("a", "x", 1));
    (void)snprintf(dotted, sizeof dotted, "%s", scratch_path("./a"));
    TEST_ASSERT_EQUAL_INT(0, symlink("a", scratch_path("link")));
    TEST_ASSERT_EQUAL_INT(0, link(a, scratch_path("twin")));
    TEST_ASSERT_TRUE(are_distinct(a, scratch_path("b"), scratch_path("c")));
    TEST_ASSERT_TRUE(are_distinct(a, NULL, NULL));
    TEST_ASSERT_TRUE(are_distinct("-", "-", NULL)); /* standard input and output */
    TEST_ASSERT_TRUE(are_distinct(a, "/dev/null", "/dev/null"));
    TEST_ASSERT_TRUE(are_distinct(a, "-", scratch_path("b")));
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
    TEST_ASSERT_FALSE(are_distinct(a, dotted, NULL));
    TEST_ASSERT_NOT_NULL(strstr(scratch_said(), "LOG and --out are the same file"));
    TEST_ASSERT_FALSE(are_distinct(a, scratch_path("link"), NULL));
    TEST_ASSERT_FALSE(are_distinct(a, scratch_path("twin"), NULL));
    TEST_ASSERT_FALSE(are_distinct(a, scratch_path("b"), scratch_path("./b")));
    TEST_ASSERT_FALSE(are_distinct(a, "-", "/dev/stdout"));
}

/* Lines from a pipe while a program runs. */
#include "live/typed_lines.h"

#include <string.h>
#include <unistd.h>

#include "scratch.h"
#include "unity.h"

static int ends[2];
static typed_lines_t typed;

void setUp(void) {
    scratch_open();
    TEST_ASSERT_EQUAL(0, pipe(ends));
    typed_lines_init(&typed, ends[0]);
}

void tearDown(void) {
    (void)close(ends[0]);
    if (ends[1] >= 0) {
        (void)close(ends[1]);
    }
}

static void type(const char *text) {
    TEST_ASSERT_EQUAL(strlen(text), write(ends[1], text, strlen(text)));
}

static void end(void) {
    (void)close(ends[1]);
    ends[1] = -1;
}

void test_nothing_is_waited_for(void) {
    TEST_ASSERT_NULL(typed_lines_next(&typed));
    type("half");
    TEST_ASSERT_NULL(typed_lines_next(&typed));
    type(" a line\nand");
    TEST_ASSERT_EQUAL_STRING("half a line", typed_lines_next(&typed));
    TEST_ASSERT_NULL(typed_lines_next(&typed));
    TEST_ASSERT_FALSE(typed.ended);
}

void test_several_lines_one_by_one(void) {
    type("one\r\n\ntwo\n");
    TEST_ASSERT_EQUAL_STRING("one", typed_lines_next(&typed));
    TEST_ASSERT_EQUAL_STRING("", typed_lines_next(&typed));
    TEST_ASSERT_EQUAL_STRING("two", typed_lines_next(&typed));
    TEST_ASSERT_NULL(typed_lines_next(&typed));
}

void test_the_last_line_may_lack_its_end(void) {
    type("one\ntwo");
    end();
    TEST_ASSERT_EQUAL_STRING("one", typed_lines_next(&typed));
    TEST_ASSERT_EQUAL_STRING("two", typed_lines_next(&typed));
    TEST_ASSERT_TRUE(typed.ended);
    TEST_ASSERT_NULL(typed_lines_next(&typed));
}

void test_a_file_that_cannot_be_read_has_ended(void) {
    typed_lines_init(&typed, ends[1]);
    end();
    TEST_ASSERT_NULL(typed_lines_next(&typed));
    TEST_ASSERT_TRUE(typed.ended);
}

void test_a_line_that_is_too_long_is_passed_over(void) {
    char most[TYPED_LINE_MAX + 1];
    memset(most, 'x', sizeof most);
    most[TYPED_LINE_MAX] = '\0';
    type(most);
    type("\n");
    TEST_ASSERT_EQUAL_STRING(most, typed_lines_next(&typed));
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
    type(most);
    type(most);
    type("x\nnext\n");
    TEST_ASSERT_NULL(typed_lines_next(&typed));
    TEST_ASSERT_EQUAL_STRING("", typed_lines_next(&typed));
    TEST_ASSERT_EQUAL_STRING("host_sim: a line of standard input is longer than 1000 characters\n", scratch_said());
    TEST_ASSERT_EQUAL_STRING("next", typed_lines_next(&typed));
}

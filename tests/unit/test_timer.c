/* Stop watches on the wrapping clock. Every test runs from several moments, of which some are just before the wrap. */
#include "agv/timer.h"

#include "unity.h"

void setUp(void) {
}

void tearDown(void) {
}

/* Shows: TIM-2 */
TEST_CASE(0)
TEST_CASE(1)
TEST_CASE(123456789)
TEST_CASE(0x7FFFFFFF)
TEST_CASE(0xFFFFFF9B)
TEST_CASE(0xFFFFFFFF)
void test_a_timer_is_reached_at_its_limit_and_exceeded_a_millisecond_later(uint32_t start_ms) {
    agv_timer_t reached = {0};
    agv_timer_t exceeded = {0};
    agv_timer_start(&reached, start_ms);
    agv_timer_start(&exceeded, start_ms);
    for (uint32_t ms = 0; ms <= 200; ms++) {
        TEST_ASSERT_EQUAL(ms >= 100, agv_timer_reached(&reached, start_ms + ms, 100));
        TEST_ASSERT_EQUAL(ms >= 101, agv_timer_exceeded(&exceeded, start_ms + ms, 100));
    }
}

void test_a_timer_without_a_limit_is_reached_at_once(void) {
    agv_timer_t timer = {0};
    agv_timer_start(&timer, 5);
    TEST_ASSERT_TRUE(agv_timer_reached(&timer, 5, 0));
}

void test_a_stopped_timer_reaches_nothing(void) {
    agv_timer_t timer = {0};
    TEST_ASSERT_FALSE(agv_timer_runs(&timer));
    TEST_ASSERT_FALSE(agv_timer_reached(&timer, 1000, 0));
    TEST_ASSERT_FALSE(agv_timer_exceeded(&timer, 1000, 0));
    agv_timer_start(&timer, 1000);
    TEST_ASSERT_TRUE(agv_timer_runs(&timer));
    TEST_ASSERT_TRUE(agv_timer_reached(&timer, 1010, 10));
    TEST_ASSERT_TRUE(agv_timer_runs(&timer));
    agv_timer_stop(&timer);
    TEST_ASSERT_FALSE(agv_timer_runs(&timer));
    TEST_ASSERT_FALSE(agv_timer_reached(&timer, 2000, 10));
}

/* Shows: TIM-2 */
void test_what_was_reached_stays_so_over_the_whole_turn_of_the_clock(void) {
    agv_timer_t timer = {0};
    agv_timer_start(&timer, 7);
    TEST_ASSERT_TRUE(agv_timer_reached(&timer, 107, 100));
    /* 2^32 ms are 49.7 days: in steps of one day, and once more around */
    for (uint32_t day = 0; day < 100; day++) {
        TEST_ASSERT_TRUE(agv_timer_reached(&timer, 107u + day * 86400000u, 100));
    }
    TEST_ASSERT_TRUE(agv_timer_reached(&timer, 7, 100));
}

void test_a_timer_that_is_started_anew_begins_anew(void) {
    agv_timer_t timer = {0};
    agv_timer_start(&timer, 0);
    TEST_ASSERT_TRUE(agv_timer_reached(&timer, 100, 100));
    agv_timer_start(&timer, 100);
    TEST_ASSERT_FALSE(agv_timer_reached(&timer, 199, 100));
    TEST_ASSERT_TRUE(agv_timer_reached(&timer, 200, 100));
}

void test_a_condition_that_breaks_starts_the_time_again(void) {
    agv_timer_t timer = {0};
    agv_timer_while(&timer, true, 10);
    agv_timer_while(&timer, true, 109);
    TEST_ASSERT_FALSE(agv_timer_reached(&timer, 109, 100));
    agv_timer_while(&timer, false, 110);
    TEST_ASSERT_FALSE(agv_timer_runs(&timer));
    agv_timer_while(&timer, true, 111);
    TEST_ASSERT_FALSE(agv_timer_reached(&timer, 210, 100));
    TEST_ASSERT_TRUE(agv_timer_reached(&timer, 211, 100));
}

/* Shows: TIM-2 */
void test_an_age_counts_across_the_wrap_and_what_lies_ahead_has_none(void) {
    TEST_ASSERT_EQUAL_UINT32(0, agv_age_ms(5, 5));
    TEST_ASSERT_EQUAL_UINT32(5, agv_age_ms(10, 5));
    TEST_ASSERT_EQUAL_UINT32(6, agv_age_ms(5, 0xFFFFFFFFu));
    TEST_ASSERT_EQUAL_UINT32(0x7FFFFFFFu, agv_age_ms(0x7FFFFFFFu, 0));
    TEST_ASSERT_EQUAL_UINT32(0, agv_age_ms(0x80000000u, 0));
    TEST_ASSERT_EQUAL_UINT32(0, agv_age_ms(5, 6));
    TEST_ASSERT_EQUAL_UINT32(0, agv_age_ms(0xFFFFFFFFu, 3));
}

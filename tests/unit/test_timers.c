/* Stop watches on the wrapping clock. Every test runs from several moments, of which some are just before the wrap. */
#include "agv/watch.h"

#include "agv/core.h"

#include "unity.h"

/* A watch that is reached at its limit of 100 ms, and a deadline of 100 ms, reached a millisecond later. */
static const uint32_t WATCH = AGV_WATCH_STANDSTILL;
static const uint32_t DEADLINE = AGV_WATCH_BOTH_MODES;

static agv_core_t core;

static bool reached(uint32_t watch, uint32_t now_ms) {
    core.now_ms = now_ms;
    return agv_watch_reached(&core, watch);
}

static void begin(uint32_t watch, uint32_t now_ms) {
    core.now_ms = now_ms;
    agv_watch_start(&core, watch);
}

static void go_on_while(bool condition, uint32_t now_ms) {
    core.now_ms = now_ms;
    (void)agv_watch_while(&core, WATCH, condition);
}

void setUp(void) {
    core = (agv_core_t){.config = {.standstill_ms = 100, .mode_invalid_ms = 100}};
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
void test_a_watch_is_reached_at_its_limit_and_a_deadline_a_millisecond_later(uint32_t start_ms) {
    begin(WATCH, start_ms);
    begin(DEADLINE, start_ms);
    for (uint32_t ms = 0; ms <= 200; ms++) {
        TEST_ASSERT_EQUAL(ms < 100, agv_watch_is_within(&core, WATCH) && !reached(WATCH, start_ms + ms));
        TEST_ASSERT_EQUAL(ms >= 100, reached(WATCH, start_ms + ms));
        TEST_ASSERT_EQUAL(ms >= 101, reached(DEADLINE, start_ms + ms));
    }
}

void test_a_watch_without_a_limit_is_reached_at_once(void) {
    core.config.standstill_ms = 0;
    begin(WATCH, 5);
    TEST_ASSERT_TRUE(reached(WATCH, 5));
}

void test_a_stopped_watch_reaches_nothing(void) {
    TEST_ASSERT_FALSE(agv_watch_runs(&core, WATCH));
    TEST_ASSERT_FALSE(agv_watch_is_within(&core, WATCH));
    TEST_ASSERT_FALSE(reached(WATCH, 1000));
    TEST_ASSERT_FALSE(reached(DEADLINE, 1000));
    begin(WATCH, 1000);
    TEST_ASSERT_TRUE(agv_watch_runs(&core, WATCH));
    TEST_ASSERT_TRUE(agv_watch_is_within(&core, WATCH));
    TEST_ASSERT_TRUE(reached(WATCH, 1100));
    TEST_ASSERT_TRUE(agv_watch_runs(&core, WATCH));
    TEST_ASSERT_FALSE(agv_watch_is_within(&core, WATCH));
    agv_watch_stop(&core, WATCH);
    TEST_ASSERT_FALSE(agv_watch_runs(&core, WATCH));
    TEST_ASSERT_FALSE(reached(WATCH, 2000));
}

/* Every watch has a limit of its own setting, and moves no other one. */
void test_every_watch_runs_alone(void) {
    for (uint32_t watch = 0; watch < AGV_WATCH_COUNT; watch++) {
        setUp();
        agv_config_defaults(&core.config);
        begin(watch, 7);
        for (uint32_t other = 0; other < AGV_WATCH_COUNT; other++) {
            TEST_ASSERT_EQUAL(other == watch, agv_watch_runs(&core, other));
            TEST_ASSERT_EQUAL(other == watch, reached(other, 70000));
        }
        agv_watch_stop(&core, watch);
        TEST_ASSERT_FALSE(agv_watch_runs(&core, watch));
    }
}

/* Shows: TIM-2 */
void test_what_was_reached_stays_so_over_the_whole_turn_of_the_clock(void) {
    begin(WATCH, 7);
    TEST_ASSERT_TRUE(reached(WATCH, 107));
    /* 2^32 ms are 49.7 days: in steps of one day, and once more around */
    for (uint32_t day = 0; day < 100; day++) {
        TEST_ASSERT_TRUE(reached(WATCH, 107u + day * 86400000u));
    }
    TEST_ASSERT_TRUE(reached(WATCH, 7));
}

void test_a_watch_that_is_started_anew_begins_anew(void) {
    begin(WATCH, 0);
    TEST_ASSERT_TRUE(reached(WATCH, 100));
    begin(WATCH, 100);
    TEST_ASSERT_FALSE(reached(WATCH, 199));
    TEST_ASSERT_TRUE(reached(WATCH, 200));
}

void test_a_condition_that_breaks_starts_the_time_again(void) {
    go_on_while(true, 10);
    go_on_while(true, 109);
    TEST_ASSERT_FALSE(reached(WATCH, 109));
    go_on_while(false, 110);
    TEST_ASSERT_FALSE(agv_watch_runs(&core, WATCH));
    go_on_while(true, 111);
    TEST_ASSERT_FALSE(reached(WATCH, 210));
    TEST_ASSERT_TRUE(reached(WATCH, 211));
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

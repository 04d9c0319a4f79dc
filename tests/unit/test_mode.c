/* The mode that 363h reports: manual, engaged, both at once; the engagement and its grace. */
#include "observe/mode.h"

#include "unity.h"

enum { MANUAL = 0x40, ENGAGED = 0x80, BOTH = 0xC0 }; /* 363h byte 7 */

static agv_mode_t mode;
static agv_timers_t timers;
static agv_config_t config;

/* Every test wraps. */
static uint32_t at(uint32_t ms) {
    return 0xFFFFFF80u + ms;
}

void setUp(void) {
    agv_config_defaults(&config);
    mode = (agv_mode_t){0};
    agv_timers_set_time(&timers, at(0));
    agv_timers_start(&timers, &config);
}

void tearDown(void) {
}

static agv_mode_change_t report(uint32_t flags, uint32_t ms) {
    agv_timers_set_time(&timers, at(ms));
    return agv_mode_report(&mode, &timers, flags, at(ms));
}

static agv_mode_change_t tick(uint32_t ms) {
    agv_timers_set_time(&timers, at(ms));
    agv_timers_tick(&timers);
    return agv_mode_tick(&mode, &timers);
}

static void expect_mode(bool manual, bool engaged) {
    TEST_ASSERT_EQUAL(manual, agv_mode_is_manual(&mode));
    TEST_ASSERT_EQUAL(engaged, agv_mode_is_engaged(&mode));
}

/* Of the eight bits of byte 7 only two count. */
void test_the_two_bits_of_the_mode(void) {
    expect_mode(false, false);
    for (unsigned flags = 0; flags < 256; flags++) {
        if ((flags & BOTH) != BOTH) {
            setUp();
            const bool engaged = (flags & ENGAGED) != 0;
            TEST_ASSERT_EQUAL(engaged ? AGV_MODE_BEGAN : AGV_MODE_SAME, report(flags, 0));
            expect_mode((flags & MANUAL) != 0, engaged);
            TEST_ASSERT_FALSE(agv_mode_is_ambiguous(&timers));
        }
    }
}

void test_the_engagement_begins_and_ends_once(void) {
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(MANUAL, 0));
    TEST_ASSERT_EQUAL(AGV_MODE_BEGAN, report(ENGAGED, 10));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(ENGAGED, 20));
    TEST_ASSERT_EQUAL(AGV_MODE_ENDED, report(MANUAL, 30));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(0, 40));
    expect_mode(false, false);
    TEST_ASSERT_EQUAL(AGV_MODE_BEGAN, report(ENGAGED, 50));
    TEST_ASSERT_EQUAL(AGV_MODE_ENDED, report(0, 60));
}

/* Shows: SUP-5 */
void test_the_grace_is_over_500_ms_after_the_engagement(void) {
    (void)report(ENGAGED, 10);
    (void)tick(509);
    TEST_ASSERT_FALSE(agv_mode_is_settled(&timers));
    (void)tick(510);
    TEST_ASSERT_TRUE(agv_mode_is_settled(&timers));
    (void)report(MANUAL, 511);
    TEST_ASSERT_FALSE(agv_mode_is_settled(&timers));
    (void)report(ENGAGED, 512);
    (void)tick(1011);
    TEST_ASSERT_FALSE(agv_mode_is_settled(&timers));
    (void)tick(1012);
    TEST_ASSERT_TRUE(agv_mode_is_settled(&timers));
}

/* The AI computer has its time from the stamp of the frame on. */
/* Shows: SUP-8 */
void test_at_the_engagement_the_ai_computer_is_awaited(void) {
    agv_timers_set_time(&timers, at(12));
    (void)agv_mode_report(&mode, &timers, ENGAGED, at(10));
    agv_timers_set_time(&timers, at(510));
    TEST_ASSERT_FALSE(agv_timer_reached(&timers, AGV_TIMER_AI_NEVER_SEEN));
    agv_timers_set_time(&timers, at(511));
    TEST_ASSERT_TRUE(agv_timer_reached(&timers, AGV_TIMER_AI_NEVER_SEEN));
}

/* Shows: MODE_INVALID */
void test_both_bits_leave_the_mode_before_until_they_last(void) {
    (void)report(ENGAGED, 0);
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(BOTH, 10));
    expect_mode(false, true);
    TEST_ASSERT_TRUE(agv_mode_is_ambiguous(&timers));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, tick(60));
    TEST_ASSERT_FALSE(agv_mode_is_invalid(&timers));
    TEST_ASSERT_EQUAL(AGV_MODE_ENDED, tick(61));
    TEST_ASSERT_TRUE(agv_mode_is_invalid(&timers));
    expect_mode(false, false);
    TEST_ASSERT_FALSE(agv_mode_is_settled(&timers));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, tick(62));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(BOTH, 70)); /* goes on */
    TEST_ASSERT_TRUE(agv_mode_is_invalid(&timers));
    TEST_ASSERT_EQUAL(AGV_MODE_BEGAN, report(ENGAGED, 80));
    TEST_ASSERT_FALSE(agv_mode_is_invalid(&timers));
    TEST_ASSERT_FALSE(agv_mode_is_ambiguous(&timers));
}

/* Shows: MODE_INVALID */
void test_one_good_frame_begins_the_time_of_both_bits_anew(void) {
    (void)report(MANUAL, 0);
    (void)report(BOTH, 10);
    (void)report(MANUAL, 60);
    (void)report(BOTH, 61);
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, tick(111));
    TEST_ASSERT_FALSE(agv_mode_is_invalid(&timers));
    expect_mode(true, false);
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, tick(112)); /* from manual to none: nothing was engaged */
    TEST_ASSERT_TRUE(agv_mode_is_invalid(&timers));
    expect_mode(false, false);
}

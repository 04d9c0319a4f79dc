/* The mode that 363h reports: manual, engaged, both at once; continued engagements, judged, SUP-9. */
#include "observe/mode.h"

#include "unity.h"

enum { NONE = 0, MANUAL = 0x40, ENGAGED = 0x80, BOTH = 0xC0 }; /* 363h byte 7 */

static agv_mode_t mode;
static uint32_t ticked_ms;
static agv_timers_t timers;
static agv_config_t config;
static agv_fault_monitor_t faults;

/* The clock wraps in every test. */
static uint32_t at(uint32_t ms) {
    return 0xFFFFFF80u + ms;
}

void setUp(void) {
    agv_config_defaults(&config);
    mode = (agv_mode_t){0};
    ticked_ms = 0;
    faults = (agv_fault_monitor_t){0};
    agv_timers_set_time(&timers, at(0));
    agv_timers_start(&timers);
}

static void advance(uint32_t ms) {
    agv_timers_advance(&timers, &config, at(ms), 0);
}

static agv_mode_change_t report(uint32_t flags, uint32_t ms) {
    advance(ms);
    return agv_mode_report(&mode, &timers, &config, flags, true, at(ms));
}

/* Three 363h, 10 ms apart, the first of them at that time. */
static agv_mode_change_t disengage(uint32_t ms) {
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(MANUAL, ms));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(MANUAL, ms + 10));
    return report(MANUAL, ms + 20);
}

static agv_mode_change_t tick(uint32_t ms) {
    const uint32_t elapsed_ms = ms - ticked_ms;
    advance(ms);
    ticked_ms = ms;
    return agv_mode_tick(&mode, &timers, &config, true, elapsed_ms);
}

/* In time, one each ms. */
static void ticks_to(uint32_t ms) {
    while (ticked_ms < ms) {
        (void)tick(ticked_ms + 1);
    }
}

static void expect_mode(bool manual, bool engaged) {
    TEST_ASSERT_EQUAL(manual, agv_mode_is_manual(&mode));
    TEST_ASSERT_EQUAL(engaged, agv_mode_is_engaged(&mode));
}

static bool is_judged(void) {
    return agv_mode_is_judged(&mode, &timers);
}

static bool is_active(unsigned fault) {
    return agv_fault_monitor_is_active(&faults, fault);
}

/* ---- The bits ---- */

/* Of the eight bits of byte 7 only two count. */
void test_the_two_bits_of_the_mode(void) {
    expect_mode(false, false);
    for (unsigned flags = 0; flags < 256; flags++) {
        setUp();
        const bool both = (flags & BOTH) == BOTH;
        const bool engaged = (flags & BOTH) == ENGAGED;
        TEST_ASSERT_EQUAL(engaged ? AGV_MODE_BEGAN : AGV_MODE_SAME, report(flags, 0));
        expect_mode((flags & BOTH) == MANUAL, engaged);
        TEST_ASSERT_EQUAL(both, agv_mode_is_ambiguous(&mode));
        TEST_ASSERT_EQUAL(engaged, agv_mode_reports_autopilot(&mode));
    }
}

/* Manual is what the last frame reports; the engagement ends with the third in a row. */
/* Shows: FSM-10 */
void test_the_third_frame_without_the_bit_ends_the_engagement(void) {
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(MANUAL, 0));
    TEST_ASSERT_EQUAL(AGV_MODE_BEGAN, report(ENGAGED, 10));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(ENGAGED, 20));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(MANUAL, 30));
    expect_mode(true, true);
    TEST_ASSERT_FALSE(agv_mode_reports_autopilot(&mode));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(NONE, 40));
    expect_mode(false, true);
    TEST_ASSERT_EQUAL(AGV_MODE_ENDED, report(MANUAL, 50));
    expect_mode(true, false);
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(MANUAL, 60));
}

/* In a row: the autopilot bit, alone or with that of manual, begins the count anew. */
TEST_CASE(0x80)
TEST_CASE(0xC0)
void test_a_frame_with_the_bit_begins_the_count_anew(unsigned flags) {
    (void)report(ENGAGED, 0);
    for (uint32_t ms = 10; ms < 1000; ms += 30) {
        TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(NONE, ms));
        TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(MANUAL, ms + 10));
        TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(flags, ms + 20));
    }
    TEST_ASSERT_TRUE(agv_mode_is_engaged(&mode));
    TEST_ASSERT_EQUAL(AGV_MODE_ENDED, disengage(1000));
}

/* What was counted before an engagement does not count in it. */
TEST_CASE(1)
TEST_CASE(5)
void test_the_number_of_frames_is_a_setting(unsigned frames) {
    config.mode_frames = (uint16_t)frames;
    for (uint32_t round = 0; round < 3; round++) {
        (void)report(NONE, 0);
        (void)report(ENGAGED, 0);
        for (unsigned i = 1; i < frames; i++) {
            TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(NONE, 0));
        }
        TEST_ASSERT_EQUAL(AGV_MODE_ENDED, report(NONE, 0));
    }
}

/* ---- The VCU ---- */

/* Without an alive VCU there is no engagement. */
void test_an_engagement_needs_a_vcu_that_is_alive(void) {
    advance(10);
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, agv_mode_report(&mode, &timers, &config, ENGAGED, false, at(10)));
    expect_mode(false, false);
    TEST_ASSERT_EQUAL(AGV_MODE_BEGAN, report(ENGAGED, 20));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, tick(30));
    TEST_ASSERT_EQUAL(AGV_MODE_ENDED, agv_mode_tick(&mode, &timers, &config, false, 1));
    expect_mode(false, false);
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, agv_mode_tick(&mode, &timers, &config, false, 1));
}

/* ---- One engagement ---- */

/* An engagement within 100 ms of the end of the last one, which is its third frame, continues it. The grace time does
 * not restart. */
/* Shows: SUP-5 */
TEST_CASE(100, 1)
TEST_CASE(101, 0)
void test_an_engagement_within_100_ms_of_the_last_one_continues_it(uint32_t gap_ms, int continued) {
    TEST_ASSERT_EQUAL(AGV_MODE_BEGAN, report(ENGAGED, 0));
    TEST_ASSERT_EQUAL(AGV_MODE_ENDED, disengage(380));
    TEST_ASSERT_EQUAL(continued ? AGV_MODE_CONTINUED : AGV_MODE_BEGAN, report(ENGAGED, 400 + gap_ms));
    (void)tick(599);
    TEST_ASSERT_EQUAL(continued, is_judged());
    (void)tick(400 + gap_ms + 499);
    TEST_ASSERT_EQUAL(continued, is_judged());
    (void)tick(400 + gap_ms + 500);
    TEST_ASSERT_TRUE(is_judged());
}

/* A continued engagement can be continued again. The time counts from each end. */
void test_a_continued_engagement_is_continued_again(void) {
    (void)report(ENGAGED, 0);
    for (uint32_t ms = 100; ms < 1000; ms += 100) {
        TEST_ASSERT_EQUAL(AGV_MODE_ENDED, disengage(ms));
        TEST_ASSERT_EQUAL(AGV_MODE_CONTINUED, report(ENGAGED, ms + 90));
    }
    TEST_ASSERT_TRUE(is_judged());
    (void)disengage(1100);
    TEST_ASSERT_EQUAL(AGV_MODE_BEGAN, report(ENGAGED, 2000));
    TEST_ASSERT_FALSE(is_judged());
}

void test_with_a_time_of_0_only_the_same_moment_continues(void) {
    config.reengage_ms = 0;
    (void)report(ENGAGED, 0);
    (void)disengage(10);
    TEST_ASSERT_EQUAL(AGV_MODE_BEGAN, report(ENGAGED, 31));
}

/* ---- Judged ---- */

/* Shows: SUP-5 */
void test_judged_from_500_ms_on_and_while_the_last_frame_has_the_bit(void) {
    TEST_ASSERT_FALSE(is_judged());
    (void)report(ENGAGED, 10);
    (void)tick(509);
    TEST_ASSERT_FALSE(is_judged());
    (void)tick(510);
    TEST_ASSERT_TRUE(is_judged());
    (void)report(MANUAL, 511);
    TEST_ASSERT_FALSE(is_judged());
    (void)report(BOTH, 521); /* the bit is set */
    TEST_ASSERT_TRUE(is_judged());
    (void)report(ENGAGED, 531);
    TEST_ASSERT_TRUE(is_judged());
    (void)disengage(541);
    TEST_ASSERT_FALSE(is_judged());
    (void)report(ENGAGED, 700);
    (void)tick(1200);
    TEST_ASSERT_TRUE(is_judged());
    (void)agv_mode_tick(&mode, &timers, &config, false, 0); /* the VCU is lost, and its last frame had the bit */
    TEST_ASSERT_FALSE(is_judged());
}

/* The time of the AI computer starts with the stamp of the frame. A continued engagement does not restart it. */
/* Shows: SUP-8 */
void test_at_the_engagement_the_ai_computer_is_awaited(void) {
    advance(12);
    (void)agv_mode_report(&mode, &timers, &config, ENGAGED, true, at(10));
    (void)disengage(100);
    TEST_ASSERT_EQUAL(AGV_MODE_CONTINUED, report(ENGAGED, 130));
    advance(510);
    TEST_ASSERT_FALSE(agv_timer_reached(&timers, AGV_TIMER_AI_NEVER_SEEN));
    advance(511);
    TEST_ASSERT_TRUE(agv_timer_reached(&timers, AGV_TIMER_AI_NEVER_SEEN));
}

/* ---- Both bits ---- */

static bool is_invalid(void) {
    agv_mode_check(&mode, &timers, &faults, &config, true, true);
    return is_active(AGV_FAULT_MODE_INVALID);
}

/* Shows: MODE_INVALID */
void test_both_bits_keep_the_previous_mode_for_a_limited_time(void) {
    (void)report(ENGAGED, 0);
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(BOTH, 10));
    expect_mode(false, true);
    TEST_ASSERT_TRUE(agv_mode_is_ambiguous(&mode));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, tick(60));
    TEST_ASSERT_FALSE(is_invalid());
    TEST_ASSERT_EQUAL(AGV_MODE_ENDED, tick(61));
    TEST_ASSERT_TRUE(is_invalid());
    expect_mode(false, false);
    TEST_ASSERT_FALSE(is_judged());
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, tick(62));
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, report(BOTH, 70)); /* continues */
    TEST_ASSERT_TRUE(is_invalid());
    TEST_ASSERT_EQUAL(AGV_MODE_BEGAN, report(ENGAGED, 200));
    TEST_ASSERT_FALSE(is_invalid());
    TEST_ASSERT_FALSE(agv_mode_is_ambiguous(&mode));
}

/* 50 ms, then one good frame of 10 ms: 45 ms are left of them. */
/* Shows: MODE_INVALID */
void test_a_good_frame_takes_half_its_time_off_that_of_both_bits(void) {
    (void)report(MANUAL, 0);
    (void)tick(9);
    (void)report(BOTH, 10);
    expect_mode(true, false);
    (void)tick(59);
    (void)report(MANUAL, 60);
    (void)tick(69);
    (void)report(BOTH, 70);
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, tick(75));
    TEST_ASSERT_FALSE(is_invalid());
    expect_mode(true, false);
    TEST_ASSERT_EQUAL(AGV_MODE_SAME, tick(76)); /* from manual to no mode, without an engagement */
    TEST_ASSERT_TRUE(is_invalid());
    expect_mode(false, false);
    (void)report(MANUAL, 77);
    TEST_ASSERT_FALSE(is_invalid());
    (void)tick(176);
    (void)report(BOTH, 177); /* the budget is empty after 100 ms */
    (void)tick(227);
    TEST_ASSERT_FALSE(is_invalid());
    (void)tick(228);
    TEST_ASSERT_TRUE(is_invalid());
}

/* Time without any mode counts, too: 40 ms of both bits, then 40 ms of neither while moving leave 20 ms. */
/* Shows: MODE_INVALID, MODE_NONE */
void test_neither_bit_takes_half_its_time_off_that_of_both_bits(void) {
    (void)tick(9);
    (void)report(BOTH, 10);
    (void)tick(49);
    (void)report(NONE, 50);
    for (uint32_t ms = 50; ms <= 90; ms += 40) {
        (void)tick(ms);
        agv_mode_check(&mode, &timers, &faults, &config, true, false);
    }
    (void)report(BOTH, 90);
    (void)tick(120);
    TEST_ASSERT_FALSE(is_invalid());
    (void)tick(121);
    TEST_ASSERT_TRUE(is_invalid());
}

/* ---- Flapping ---- */

static bool flaps_at(uint32_t ms) {
    advance(ms);
    faults = (agv_fault_monitor_t){0};
    agv_mode_count_engagement(&mode, &timers, &faults);
    return is_active(AGV_FAULT_MODE_FLAPPING);
}

/* Shows: SUP-9, MODE_FLAPPING */
TEST_CASE(5000, 1)
TEST_CASE(5001, 0)
void test_the_fourth_engagement_within_5_s_is_flapping(uint32_t fourth_ms, int flapping) {
    TEST_ASSERT_FALSE(flaps_at(0));
    TEST_ASSERT_FALSE(flaps_at(1000));
    TEST_ASSERT_FALSE(flaps_at(4000));
    TEST_ASSERT_EQUAL(flapping, flaps_at(fourth_ms));
    TEST_ASSERT_TRUE(flaps_at(6000));   /* four again: from 1000 on */
    TEST_ASSERT_TRUE(flaps_at(9000));   /* from 4000 on */
    TEST_ASSERT_FALSE(flaps_at(10002)); /* from 5000 or 5001 on */
}

/* Any three of them, a pause of more than 5 s between: never. */
/* Shows: SUP-9 */
void test_three_engagements_within_5_s_are_not_flapping(void) {
    for (uint32_t ms = 0; ms < 60000; ms += 5001) {
        TEST_ASSERT_FALSE(flaps_at(ms));
        TEST_ASSERT_FALSE(flaps_at(ms + 1));
        TEST_ASSERT_FALSE(flaps_at(ms + 2));
    }
}

/* 363h of 10 ms: manual for `manual_ms` of each `cycle_ms`, then autopilot. Whether it is flapping after the last cycle. */
static bool flickers(uint32_t from_ms, uint32_t manual_ms, uint32_t cycle_ms, unsigned cycles, bool supervising) {
    for (unsigned i = 0; i < cycles; i++) {
        const uint32_t at_ms = from_ms + (cycle_ms * i);
        (void)report(MANUAL, at_ms);
        ticks_to(at_ms + manual_ms - 1);
        (void)report(ENGAGED, at_ms + manual_ms);
        if (manual_ms < cycle_ms) {
            ticks_to(at_ms + cycle_ms - 1);
        }
    }
    agv_mode_check(&mode, &timers, &faults, &config, supervising, true);
    return is_active(AGV_FAULT_MODE_FLAPPING);
}

/* A second sender right behind the VCU: manual for 9 ms in 10, which leaves 17 half ms a cycle. 29 cycles are 261 - 14 ms. */
/* Shows: SUP-9, MODE_FLAPPING */
TEST_CASE(29, true, false)
TEST_CASE(30, true, true)
TEST_CASE(30, false, false)
void test_manual_that_flickers_while_engaged_is_flapping(unsigned cycles, bool supervising, bool flapping) {
    (void)report(MANUAL, 0);
    (void)report(ENGAGED, 9);
    (void)tick(9);
    TEST_ASSERT_EQUAL(flapping, flickers(10, 9, 10, cycles, supervising));
}

/* Autopilot for no time at all: exactly 250 ms after the tick that saw manual. */
/* Shows: SUP-9, MODE_FLAPPING */
void test_manual_may_be_reported_for_250_ms(void) {
    (void)report(ENGAGED, 0);
    TEST_ASSERT_FALSE(flickers(1, 10, 10, 24, true));
    (void)report(MANUAL, 241);
    ticks_to(250);
    agv_mode_check(&mode, &timers, &faults, &config, true, true);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_MODE_FLAPPING));
    ticks_to(251);
    agv_mode_check(&mode, &timers, &faults, &config, true, true);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_MODE_FLAPPING));
}

/* Half of mode_frames deadlines of 363h, if that is more than 250 ms: 5 * 189 / 2 ms. */
/* Shows: SUP-9 */
TEST_CASE(5, 189, 472)
TEST_CASE(3, 167, 250)
TEST_CASE(2, 251, 251)
void test_a_slow_363h_may_report_manual_for_longer(uint16_t frames, uint16_t deadline_ms, uint32_t limit_ms) {
    config.mode_frames = frames;
    config.vcu_heartbeat_timeout_ms = deadline_ms;
    (void)report(ENGAGED, 0);
    (void)report(MANUAL, 1);
    ticks_to(limit_ms);
    agv_mode_check(&mode, &timers, &faults, &config, true, true);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_MODE_FLAPPING));
    ticks_to(limit_ms + 1);
    agv_mode_check(&mode, &timers, &faults, &config, true, true);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_MODE_FLAPPING));
}

/* Manual in one frame of three: the time with autopilot takes it off again. Not in INIT, TRIPPED and SAFE. */
/* Shows: SUP-9 */
void test_manual_in_one_frame_of_three_is_not_flapping(void) {
    (void)report(ENGAGED, 0);
    TEST_ASSERT_FALSE(flickers(10, 10, 30, 200, true));
}

/* Neither bit is not manual. It lasts for 9 ms in 10, 900 ms in all. */
/* Shows: SUP-9 */
void test_neither_bit_while_engaged_is_not_flapping(void) {
    (void)report(ENGAGED, 0);
    for (uint32_t at_ms = 10; at_ms <= 1000; at_ms += 10) {
        (void)report(NONE, at_ms);
        ticks_to(at_ms + 8);
        (void)report(ENGAGED, at_ms + 9);
    }
    expect_mode(false, true);
    agv_mode_check(&mode, &timers, &faults, &config, true, true);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_MODE_FLAPPING));
}

/* The next engagement counts from 0. */
/* Shows: SUP-9 */
void test_the_end_of_an_engagement_ends_the_flicker(void) {
    (void)report(ENGAGED, 0);
    TEST_ASSERT_FALSE(flickers(1, 9, 10, 29, true));
    (void)disengage(1000);
    (void)tick(1100);
    (void)report(ENGAGED, 1499);
    (void)tick(1499);
    TEST_ASSERT_FALSE(flickers(1500, 9, 10, 29, true));
}

/* ---- No mode ---- */

static bool none_at(uint32_t ms, bool supervising, bool standstill) {
    (void)tick(ms);
    agv_mode_check(&mode, &timers, &faults, &config, supervising, standstill);
    return is_active(AGV_FAULT_MODE_NONE);
}

/* Shows: SUP-9, MODE_NONE */
void test_no_mode_for_500_ms_while_not_at_standstill(void) {
    (void)report(NONE, 0);
    TEST_ASSERT_FALSE(none_at(10, true, false));
    TEST_ASSERT_FALSE(none_at(509, true, false));
    TEST_ASSERT_TRUE(none_at(510, true, false));
    TEST_ASSERT_TRUE(none_at(520, true, false));
    TEST_ASSERT_FALSE(none_at(530, true, true)); /* standstill ends it */
    TEST_ASSERT_FALSE(none_at(1529, true, true));
    TEST_ASSERT_FALSE(none_at(1530, true, false)); /* a second later it begins again */
    TEST_ASSERT_FALSE(none_at(2029, true, false));
    TEST_ASSERT_TRUE(none_at(2030, true, false));
    (void)report(MANUAL, 2031); /* so does a mode */
    TEST_ASSERT_FALSE(none_at(2031, true, false));
}

/* 499 ms, then 100 ms with a mode: 449 ms are left of them. */
/* Shows: SUP-9, MODE_NONE */
TEST_CASE(0x40)
TEST_CASE(0x80)
void test_a_mode_takes_half_its_time_off_that_without_one(unsigned flags) {
    (void)report(flags, 0);
    (void)report(NONE, 0);
    TEST_ASSERT_FALSE(none_at(10, true, false));
    TEST_ASSERT_FALSE(none_at(508, true, false));
    (void)report(flags, 509);
    TEST_ASSERT_FALSE(none_at(509, true, false));
    (void)report(NONE, 608);
    TEST_ASSERT_FALSE(none_at(609, true, false));
    TEST_ASSERT_FALSE(none_at(659, true, false));
    TEST_ASSERT_TRUE(none_at(660, true, false));
}

/* It is checked in STANDBY and ACTIVE. The fault lasts as long as its cause. */
/* Shows: SUP-9, MODE_NONE */
void test_no_mode_counts_in_standby_and_active(void) {
    (void)report(NONE, 0);
    for (uint32_t ms = 10; ms < 2000; ms += 10) {
        TEST_ASSERT_FALSE(none_at(ms, false, false));
    }
    (void)none_at(2000, true, false);
    TEST_ASSERT_TRUE(none_at(2500, true, false));
    TEST_ASSERT_TRUE(none_at(2510, false, false)); /* tripped now */
    TEST_ASSERT_FALSE(none_at(2520, false, true));
    TEST_ASSERT_FALSE(none_at(2530, false, false));
}

/* One bit counts as a mode. Without any 363h nothing is checked. */
/* Shows: SUP-9 */
void test_cases_that_are_no_missing_mode(void) {
    static const uint32_t flags[] = {MANUAL, ENGAGED};
    for (uint32_t ms = 0; ms < 1000; ms += 10) {
        TEST_ASSERT_FALSE(none_at(ms, true, false));
    }
    for (unsigned i = 0; i < 2; i++) {
        setUp();
        for (uint32_t ms = 0; ms < 1000; ms += 10) {
            (void)report(flags[i], ms);
            TEST_ASSERT_FALSE(none_at(ms, true, false));
        }
    }
}

/* Both bits in turn with manual while engaged, or with neither: each for too short a time for a budget of its own. */
/* Shows: SUP-9, MODE_NONE */
TEST_CASE(0x80, 0x40)
TEST_CASE(0x40, 0)
void test_modes_that_change_in_turn_are_no_mode(int before, int in_turn) {
    (void)report((uint32_t)before, 0);
    TEST_ASSERT_FALSE(none_at(0, true, false));
    for (uint32_t ms = 10; ms <= 500; ms += 10) {
        (void)report(((ms % 20) == 0) ? BOTH : (uint32_t)in_turn, ms);
        TEST_ASSERT_FALSE(none_at(ms, true, false));
    }
    (void)report((uint32_t)in_turn, 510);
    TEST_ASSERT_TRUE(none_at(510, true, false));
}

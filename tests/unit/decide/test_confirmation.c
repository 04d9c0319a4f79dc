/* Whether the vehicle confirms the safe state in time: two sums of 500 ms, cleared by 5 s. */
#include "decide/confirmation.h"

#include "unity.h"

static agv_confirmation_t confirmation;
static agv_timers_t timers;
static agv_config_t config;

/* A trip, just before the wrap. */
void setUp(void) {
    agv_config_defaults(&config);
    agv_timers_set_time(&timers, 0xFFFFFF00u);
    agv_timers_start(&timers);
    agv_confirmation_start(&confirmation, &timers, true);
}

static void step(uint32_t elapsed_ms, bool autopilot_off, bool in_park) {
    agv_timers_advance(&timers, &config, timers.now_ms + elapsed_ms, 0);
    agv_confirmation_step(&confirmation, &timers, &config, elapsed_ms, autopilot_off, in_park);
}

static void run(uint32_t ms, bool autopilot_off, bool in_park) {
    for (uint32_t i = 0; i < ms; i++) {
        step(1, autopilot_off, in_park);
    }
}

/* A tick that sees what is confirmed from now on. The ms before it counts by what was. */
static void begin(bool autopilot_off, bool in_park) {
    step(1, autopilot_off, in_park);
}

static void expect(bool unconfirmed) {
    TEST_ASSERT_EQUAL(unconfirmed, confirmation.unconfirmed);
}

static void expect_fault_after(uint32_t ms, bool autopilot_off, bool in_park) {
    run(ms, autopilot_off, in_park);
    expect(true);
}

static void expect_no_fault_after(uint32_t ms, bool autopilot_off, bool in_park) {
    run(ms, autopilot_off, in_park);
    expect(false);
}

/* The fault must come exactly this many ms from now, in which the ticks see this. */
static void expect_after(uint32_t ms, bool autopilot_off, bool in_park) {
    expect_no_fault_after(ms - 1, autopilot_off, in_park);
    expect_fault_after(1, autopilot_off, in_park);
}

/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_autopilot_off_may_be_missing_for_500_ms(void) {
    expect_after(500, false, true);
    expect_fault_after(100, false, true);
    step(0, true, true); /* a frame confirms */
    expect(false);
}

/* After a trip in a tick it is missing from then on; after one between two ticks, from the next tick on. */
/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
TEST_CASE(true, 500)
TEST_CASE(false, 501)
void test_the_time_begins_with_a_tick(bool at_tick, uint32_t ticks) {
    agv_confirmation_start(&confirmation, &timers, at_tick);
    expect_no_fault_after(ticks - 1, false, true);
    TEST_ASSERT_EQUAL_UINT16(499, confirmation.off.sum_ms);
    expect_fault_after(1, false, true);
}

/* What the last tick saw stays: missing there and confirmed in a frame, and the other way round. */
/* Shows: FSM-4 */
void test_a_frame_between_two_ticks_does_not_count(void) {
    run(498, false, true);
    step(0, true, true);
    run(1, false, true);
    TEST_ASSERT_EQUAL_UINT16(499, confirmation.off.sum_ms);
    step(0, false, true);
    expect(false);
    TEST_ASSERT_EQUAL_UINT16(499, confirmation.off.sum_ms);
    expect_fault_after(1, false, true);
    agv_confirmation_start(&confirmation, &timers, false);
    begin(true, true);
    step(0, false, true);
    begin(false, true);
    TEST_ASSERT_EQUAL_UINT16(0, confirmation.off.sum_ms);
    expect_after(500, false, true);
}

/* From the first P on, however often it is sent. The trip itself came in a tick, or in a frame. */
/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
TEST_CASE(true)
TEST_CASE(false)
void test_p_may_be_missing_for_500_ms_since_the_first_p_was_sent(bool at_tick) {
    agv_confirmation_start(&confirmation, &timers, at_tick);
    expect_no_fault_after(3000, true, false);
    agv_confirmation_park_sent(&confirmation);
    run(300, true, false);
    agv_confirmation_park_sent(&confirmation);
    expect_after(200, true, false);
}

/* It is sent in the handling of a frame: the time counts from the next tick on. */
/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_a_p_that_is_sent_between_two_ticks_counts_from_the_next_one(void) {
    run(1000, true, false);
    step(0, true, false);
    agv_confirmation_park_sent(&confirmation);
    expect_after(501, true, false);
}

/* A VCU that refuses P above a speed needs a longer time for P. */
/* Shows: FSM-4 */
void test_the_two_limits_are_two_settings(void) {
    config.confirm_timeout_ms = 100;
    config.park_confirm_timeout_ms = 10000;
    agv_confirmation_park_sent(&confirmation);
    expect_after(10000, true, false);
    setUp();
    config.confirm_timeout_ms = 100;
    config.park_confirm_timeout_ms = 10000;
    agv_confirmation_park_sent(&confirmation);
    expect_after(100, false, false);
}

/* Each sum counts its own time: 300 ms without both are 300 ms in each. */
/* Shows: FSM-4 */
void test_the_two_sums_are_not_added_up(void) {
    agv_confirmation_park_sent(&confirmation);
    run(300, false, false);
    begin(false, true); /* 301 ms in each */
    run(197, false, true);
    begin(true, false); /* 499 without autopilot off */
    expect_after(199, true, false);
}

/* The sums keep interrupted times. */
/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_a_confirmation_that_comes_and_goes(void) {
    for (unsigned i = 0; i < 4; i++) {
        run(100, false, true);
        expect_no_fault_after(4999, true, true);
    }
    run(99, false, true); /* 101 since the trip, 3 times 100, 98 */
    expect(false);
    TEST_ASSERT_EQUAL_UINT16(499, confirmation.off.sum_ms);
    expect_fault_after(1, false, true);
}

/* Shows: FSM-4 */
void test_5_s_of_both_without_a_break_clear_the_sums(void) {
    agv_confirmation_park_sent(&confirmation);
    run(499, false, false);
    step(0, true, true);
    run(5000, true, true);
    begin(false, false);
    expect_no_fault_after(499, false, false);
    expect_fault_after(1, false, true);
}

/* A frame without P restarts the 5 s, even while autopilot off stays confirmed. */
/* Shows: FSM-4 */
void test_a_break_of_either_begins_the_5_s_anew(void) {
    run(498, false, true);
    begin(true, true); /* 499 */
    run(4000, true, true);
    step(0, true, false);
    run(4999, true, true);
    begin(false, true);
    expect(false);
    expect_fault_after(1, false, true);
}

/* The fault ends when both are confirmed, and is raised again by the next unconfirmed ms, until 5 s have cleared the
 * sums. */
/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_a_sum_at_its_limit_raises_it_again_at_once(void) {
    agv_confirmation_park_sent(&confirmation);
    expect_fault_after(500, false, true);
    run(10, true, false); /* only one of them is confirmed */
    expect(true);
    expect_no_fault_after(4000, true, true);
    step(0, false, true); /* no ms has passed */
    expect(false);
    begin(false, true);
    expect(true);
    step(0, true, true);
    run(5000, true, true);
    begin(false, true);
    expect_no_fault_after(499, false, true);
}

/* A full sum does not change the other one. */
/* Shows: FSM-4 */
void test_a_full_sum_of_the_one_raises_nothing_for_the_other(void) {
    agv_confirmation_start(&confirmation, &timers, false);
    agv_confirmation_park_sent(&confirmation);
    begin(false, true);
    expect_fault_after(500, false, true);
    step(0, true, true);
    expect_no_fault_after(1, true, true);
    begin(true, false);
    expect_after(500, true, false);
}

/* The ms in which the confirmation comes counts, but raises nothing by itself. */
/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_a_confirmation_within_the_last_ms_is_in_time(void) {
    run(499, false, true);
    step(0, true, true);
    expect_no_fault_after(1, true, true);
    TEST_ASSERT_EQUAL_UINT16(500, confirmation.off.sum_ms);
    begin(false, true);
    expect(true);
}

/* Missing in each second ms: all of it counts in the end. */
/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_a_confirmation_that_flickers_with_the_ticks(void) {
    for (unsigned i = 0; i < 499; i++) {
        run(1, true, true);
        expect_no_fault_after(1, false, true);
    }
    expect_no_fault_after(1, true, true);
    expect_fault_after(1, false, true);
}

/* Late steps count with their whole time, and the sums saturate. */
void test_late_steps(void) {
    step(499, false, true);
    expect(false);
    step(70000, false, true);
    step(70000, false, true);
    expect(true);
    TEST_ASSERT_EQUAL_UINT16(500, confirmation.off.sum_ms);
    TEST_ASSERT_EQUAL_UINT16(0, confirmation.park.sum_ms);
}

/* Writing flash in SAFE makes ticks late: P that is withdrawn and comes back with them hides nothing. */
/* Shows: FSM-4, TIM-4 */
void test_a_late_tick_counts_by_what_it_sees(void) {
    agv_confirmation_park_sent(&confirmation);
    run(100, true, true);
    for (unsigned i = 0; i < 5; i++) {
        step(90, true, false);
        step(90, true, true);
        expect(false);
    }
    step(90, true, false); /* 450, the ms after the trip, and 90 */
    expect(true);
}

/* 5 s of confirmation before the next trip do not count for it: the ms after the trip stays in the sum. */
/* Shows: FSM-4 */
void test_a_trip_begins_the_5_s_anew(void) {
    agv_confirmation_park_sent(&confirmation);
    run(6000, true, true);
    agv_confirmation_start(&confirmation, &timers, true);
    run(10, true, true);
    TEST_ASSERT_EQUAL_UINT16(1, confirmation.off.sum_ms);
    begin(false, true);
    expect_after(499, false, true);
}

/* Shows: FSM-4 */
void test_a_trip_clears_the_sums(void) {
    agv_confirmation_park_sent(&confirmation);
    expect_fault_after(600, false, false);
    agv_confirmation_start(&confirmation, &timers, true);
    expect(false);
    expect_no_fault_after(499, false, false);
    TEST_ASSERT_EQUAL_UINT16(0, confirmation.park.sum_ms); /* no P was sent yet */
}

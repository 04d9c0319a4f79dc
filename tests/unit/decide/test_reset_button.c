/* The reset by remote button 1: at its release, after 1 s to 5 s, if all conditions held in the last second. */
#include "decide/reset_button.h"

#include "unity.h"

static agv_reset_button_t reset;
static agv_timers_t timers;
static agv_config_t config;
static uint32_t lacking;
static uint32_t missing;
static uint32_t in_vain; /* number of refused presses, and the conditions missing at the last one */
static uint32_t resets;

static void step(uint32_t elapsed_ms) {
    uint32_t found = 0;
    const agv_press_result_t result = agv_reset_button_step(&reset, &timers, &config, elapsed_ms, lacking, &found);
    if (result == AGV_PRESS_IN_VAIN) {
        in_vain++;
        missing = found;
    }
    resets += (result == AGV_PRESS_RESETS) ? 1 : 0;
}

/* In each millisecond the frames come before the tick. */
static void run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        step(1);
        agv_timers_advance(&timers, &config, timers.now_ms + 1, 0);
    }
}

/* A 363h. */
static void frame(bool down) {
    agv_reset_button_report(&reset, true, false, down);
    step(0);
}

/* The first of the 363h is the release; after the third one the next press has a rising edge. */
static void release(void) {
    frame(false);
    frame(false);
    frame(false);
}

static void lose_vcu(void) {
    agv_reset_button_lose(&reset);
    lacking = AGV_MISSING_VCU_HEARTBEAT | AGV_MISSING_STATE | AGV_MISSING_TRIP_CAUSE | AGV_MISSING_STANDSTILL;
    step(1);
}

/* The button is down for this long, and stays down. */
static void hold(uint32_t ms) {
    frame(true);
    run(ms);
}

static void press(uint32_t ms) {
    hold(ms);
    release();
}

static void expect_reset(void) {
    TEST_ASSERT_EQUAL_UINT32(1, resets);
    TEST_ASSERT_EQUAL_UINT32(0, in_vain);
}

static void expect_in_vain(uint32_t bits) {
    TEST_ASSERT_EQUAL_UINT32(0, resets);
    TEST_ASSERT_EQUAL_UINT32(1, in_vain);
    TEST_ASSERT_EQUAL_HEX32(bits, missing);
}

static void expect_nothing(void) {
    TEST_ASSERT_EQUAL_UINT32(0, resets);
    TEST_ASSERT_EQUAL_UINT32(0, in_vain);
}

/* Tripped for 2 s, all conditions hold, button up. The clock wraps in every test. */
void setUp(void) {
    agv_config_defaults(&config);
    agv_timers_set_time(&timers, 0xFFFFF000u);
    agv_timers_start(&timers);
    reset = (agv_reset_button_t){0};
    lacking = 0;
    in_vain = 0;
    resets = 0;
    missing = 0;
    agv_reset_button_trip(&reset, &timers);
    release();
    run(2000);
}

/* ---- How long ---- */

/* 1000 and 5000 ms both count; a shorter press is not reported. */
/* Shows: FSM-3 */
TEST_CASE(999, 0)
TEST_CASE(1000, 1)
TEST_CASE(3000, 1)
TEST_CASE(5000, 1)
void test_a_press_of_1_s_to_5_s_resets_at_its_release(uint32_t ms, uint32_t expected) {
    hold(ms);
    expect_nothing();
    release();
    TEST_ASSERT_EQUAL_UINT32(expected, resets);
    TEST_ASSERT_EQUAL_UINT32(0, in_vain);
    run(10000);
    TEST_ASSERT_EQUAL_UINT32(expected, resets);
}

/* Reported once, at 5 s, not again at its release. */
/* Shows: FSM-3 */
void test_a_press_of_more_than_5_s_is_in_vain(void) {
    hold(5001);
    expect_nothing();
    run(1);
    expect_in_vain(AGV_MISSING_RELEASED);
    run(60000);
    release();
    run(100);
    expect_in_vain(AGV_MISSING_RELEASED);
    in_vain = 0;
    press(1000);
    expect_reset();
}

/* The release comes with the first frame after 5 s. */
/* Shows: FSM-3 */
void test_a_release_a_millisecond_late_is_in_vain(void) {
    press(5001);
    expect_in_vain(AGV_MISSING_RELEASED);
}

/* Shows: FSM-3 */
void test_both_times_are_settings(void) {
    config.reset_hold_ms = 500;
    config.reset_hold_max_ms = 1000;
    press(499);
    expect_nothing();
    press(1001);
    expect_in_vain(AGV_MISSING_RELEASED);
    in_vain = 0;
    press(500);
    expect_reset();
}

/* Two presses of 600 ms are not one of 1200. */
/* Shows: FSM-3 */
void test_a_release_between_begins_the_time_anew(void) {
    for (unsigned i = 0; i < 20; i++) {
        press(999);
        run(1);
    }
    expect_nothing();
}

/* ---- The edge ---- */

/* The press had no edge; the next one has. */
static void expect_release_in_vain_then_reset(void) {
    release();
    expect_in_vain(AGV_MISSING_BUTTON);
    in_vain = 0;
    run(10);
    press(1000);
    expect_reset();
}

/* Held at the trip and released 1 s later. */
/* Shows: FSM-3 */
void test_a_press_from_before_the_trip_does_not_count(void) {
    hold(500);
    agv_reset_button_trip(&reset, &timers);
    run(1500);
    expect_release_in_vain_then_reset();
}

/* The same when the button was not evaluated since the last reset: in STANDBY it was pressed, then came the trip. */
/* Shows: FSM-3 */
void test_a_press_in_standby_is_one_from_before_the_trip(void) {
    agv_reset_button_report(&reset, true, false, true);
    agv_timers_advance(&timers, &config, timers.now_ms + 50, 0);
    agv_reset_button_trip(&reset, &timers);
    run(1500);
    expect_release_in_vain_then_reset();
}

/* A button that was up in STANDBY and is pressed after the trip has an edge, whatever its state at the last reset. */
/* Shows: FSM-3 */
void test_a_press_after_a_trip_from_standby_counts(void) {
    frame(true);
    for (uint32_t i = 0; i < 3; i++) {
        agv_reset_button_report(&reset, true, false, false);
    }
    agv_reset_button_trip(&reset, &timers);
    press(1000);
    expect_reset();
}

/* The very first frame reports the button down, so there was no edge. */
/* Shows: FSM-3, FSM-7 */
void test_a_button_that_is_stuck_resets_nothing(void) {
    reset = (agv_reset_button_t){0};
    run(2000);
    hold(6000);
    expect_in_vain(AGV_MISSING_BUTTON | AGV_MISSING_RELEASED);
}

/* One or two 363h without the bit end a press, but are not followed by a rising edge; three are. */
/* Shows: FSM-3 */
TEST_CASE(1, false)
TEST_CASE(2, false)
TEST_CASE(3, true)
void test_a_glitch_of_a_button_that_is_stuck_is_no_rising_edge(uint32_t frames, bool resets_then) {
    reset = (agv_reset_button_t){0};
    hold(3000);
    for (uint32_t i = 0; i < frames; i++) {
        frame(false);
    }
    expect_in_vain(AGV_MISSING_BUTTON);
    in_vain = 0;
    press(1500);
    TEST_ASSERT_EQUAL_UINT32(resets_then ? 1 : 0, resets);
    TEST_ASSERT_EQUAL_UINT32(resets_then ? 0 : 1, in_vain);
}

/* The same at the trip itself. */
/* Shows: FSM-3 */
void test_a_glitch_at_the_trip_is_no_rising_edge(void) {
    frame(true);
    frame(false);
    agv_reset_button_trip(&reset, &timers);
    press(1500);
    expect_in_vain(AGV_MISSING_BUTTON);
}

/* Frames with the button up count only without a break: neither a loss nor a lost receiver is one. */
/* Shows: FSM-3 */
void test_a_loss_between_two_glitches_makes_no_rising_edge(void) {
    reset = (agv_reset_button_t){0};
    frame(false);
    frame(false);
    agv_reset_button_lose(&reset);
    step(1);
    frame(false);
    frame(false);
    press(1500);
    expect_in_vain(AGV_MISSING_BUTTON);
    in_vain = 0;
    frame(false);
    agv_reset_button_report(&reset, true, true, false);
    step(0);
    frame(false);
    frame(false);
    press(1500);
    expect_in_vain(AGV_MISSING_BUTTON);
}

/* Frames of a VCU that is not alive cause neither an edge nor a release. */
/* Shows: FSM-3 */
void test_frames_of_a_vcu_that_is_not_alive_are_ignored(void) {
    agv_reset_button_report(&reset, false, false, true);
    run(2000);
    agv_reset_button_report(&reset, false, false, false);
    run(10);
    expect_nothing();
    hold(500);
    agv_reset_button_report(&reset, false, false, false);
    run(500);
    expect_nothing();
    release();
    expect_reset();
}

/* ---- The conditions ---- */

/* Each condition is named when it was missing at the start of the last second. */
/* Shows: FSM-3 */
TEST_CASE(AGV_MISSING_STATE)
TEST_CASE(AGV_MISSING_VCU_HEARTBEAT)
TEST_CASE(AGV_MISSING_EPS_HEARTBEAT)
TEST_CASE(AGV_MISSING_TRIP_CAUSE)
TEST_CASE(AGV_MISSING_STANDSTILL)
TEST_CASE(AGV_MISSING_MANUAL)
TEST_CASE(AGV_MISSING_MESSAGES)
TEST_CASE(AGV_MISSING_THROTTLE)
void test_conditions_missing_at_any_time_in_the_last_second(uint32_t condition) {
    hold(2000);
    lacking = condition;
    step(0); /* a frame is enough */
    lacking = 0;
    run(999);
    release();
    expect_in_vain(condition);
    in_vain = 0;
    hold(2000);
    lacking = condition;
    step(0);
    lacking = 0;
    run(1000); /* a whole second ago */
    release();
    expect_reset();
}

/* The conditions must also hold in the releasing frame. */
/* Shows: FSM-3 */
void test_a_condition_missing_in_the_releasing_frame(void) {
    hold(3000);
    lacking = AGV_MISSING_MANUAL;
    release();
    expect_in_vain(AGV_MISSING_MANUAL);
}

/* All conditions that were missing at any time in the last second are named, but none that was missing before. */
/* Shows: FSM-3 */
void test_all_missing_conditions_are_reported(void) {
    lacking = AGV_MISSING_EPS_HEARTBEAT;
    hold(1000);
    lacking = AGV_MISSING_STANDSTILL;
    run(500);
    lacking = AGV_MISSING_THROTTLE | AGV_MISSING_STATE;
    run(499);
    lacking = 0;
    run(1);
    release();
    expect_in_vain(AGV_MISSING_STANDSTILL | AGV_MISSING_THROTTLE | AGV_MISSING_STATE);
}

/* Directly after the trip: no condition has held for a second. */
/* Shows: FSM-3 */
void test_time_before_the_trip_does_not_count(void) {
    agv_reset_button_trip(&reset, &timers);
    lacking = AGV_MISSING_STATE;
    release();
    run(1);
    lacking = 0;
    press(1000);
    expect_reset();
    agv_reset_button_trip(&reset, &timers);
    TEST_ASSERT_EQUAL_UINT16(0, reset.held_ms[0]);
    TEST_ASSERT_EQUAL_UINT16(0, reset.held_ms[AGV_RESET_CONDITIONS - 1]);
}

/* ---- The VCU is lost ---- */

/* Only the VCU is named, not the conditions that its loss affects. */
/* Shows: FSM-3 */
void test_a_press_that_the_loss_of_the_vcu_ends(void) {
    hold(2000);
    lose_vcu();
    expect_in_vain(AGV_MISSING_VCU_HEARTBEAT);
    run(100);
    expect_in_vain(AGV_MISSING_VCU_HEARTBEAT);
}

/* Conditions that were missing before its loss are named, too. */
/* Shows: FSM-3 */
void test_a_press_in_vain_that_the_loss_of_the_vcu_ends(void) {
    hold(1500);
    lacking = AGV_MISSING_THROTTLE;
    run(1);
    lose_vcu();
    expect_in_vain(AGV_MISSING_VCU_HEARTBEAT | AGV_MISSING_THROTTLE);
}

/* Shows: FSM-3 */
void test_a_short_press_ended_by_the_loss_of_the_vcu_is_not_reported(void) {
    hold(900);
    lose_vcu();
    run(1000);
    expect_nothing();
}

/* The state of the button is cleared. A button pressed all the time must be released first. */
/* Shows: FSM-3 */
void test_a_press_from_before_the_vcu_came_back_resets_nothing(void) {
    hold(500);
    lose_vcu();
    lacking = 0;
    run(100);
    hold(2000);
    expect_release_in_vain_then_reset();
}

/* ---- The remote receiver has lost signal or power ---- */

static void frame_without_receiver(bool down) {
    agv_reset_button_report(&reset, true, true, down);
    step(0);
}

/* Without the receiver "not pressed" does not count as a release. */
/* Shows: FSM-3 */
void test_a_press_that_the_loss_of_the_remote_ends(void) {
    hold(2000);
    frame_without_receiver(false);
    expect_in_vain(AGV_MISSING_BUTTON);
    run(10);
    release();
    run(10);
    in_vain = 0;
    press(1000);
    expect_reset();
}

/* A button that is pressed when the receiver comes back is no edge: it may have been held all the time. */
/* Shows: FSM-3 */
void test_a_press_from_before_the_remote_came_back_resets_nothing(void) {
    frame_without_receiver(false);
    run(2000);
    hold(2000);
    expect_release_in_vain_then_reset();
}

/* A short press that ends with the receiver's loss is not reported, as any other short press. */
/* Shows: FSM-3 */
void test_a_short_press_ended_by_the_loss_of_the_remote_is_not_reported(void) {
    hold(999);
    frame_without_receiver(false);
    run(2000);
    expect_nothing();
}

/* A receiver that is lost reports a button that nobody presses, or the last one that it heard. */
/* Shows: FSM-3 */
void test_a_press_that_begins_while_the_receiver_is_lost(void) {
    frame_without_receiver(true);
    run(1500);
    frame_without_receiver(false);
    run(1);
    release();
    run(1);
    TEST_ASSERT_EQUAL_UINT32(0, resets);
    frame_without_receiver(true);
    run(200);
    frame(true); /* no rising edge */
    run(1500);
    release();
    run(1);
    expect_in_vain(AGV_MISSING_BUTTON);
}

/* The operator lets go meanwhile. */
/* Shows: FSM-3 */
void test_a_press_during_which_the_receiver_is_lost(void) {
    release();
    run(1);
    hold(100);
    frame_without_receiver(true);
    run(1500);
    release();
    run(1);
    TEST_ASSERT_EQUAL_UINT32(0, resets);
    TEST_ASSERT_EQUAL_UINT32(0, in_vain);
}

/* ---- The push button ---- */

/* Debounced: at each tick it has this state. */
static void read_for(agv_button_t button, uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        agv_reset_button_read(&reset, (uint8_t)button);
        run(1);
    }
}

/* Tripped while the push button had this state. */
static void trip_with(agv_button_t button) {
    reset = (agv_reset_button_t){.is_pin = true};
    agv_reset_button_read(&reset, (uint8_t)button);
    agv_reset_button_trip(&reset, &timers);
}

/* Down from the trip on: no rising edge after it. The next press has one. */
/* Shows: HW-3 */
void test_a_push_button_that_is_down_at_the_trip_resets_nothing(void) {
    trip_with(AGV_BUTTON_DOWN);
    read_for(AGV_BUTTON_DOWN, 1500);
    read_for(AGV_BUTTON_UP, 1);
    expect_in_vain(AGV_MISSING_BUTTON);
    in_vain = 0;
    read_for(AGV_BUTTON_DOWN, 1500);
    read_for(AGV_BUTTON_UP, 1);
    expect_reset();
}

/* Before the press the input was not stable yet, or silent: this does not show that the button was up. */
/* Shows: HW-3 */
TEST_CASE(AGV_BUTTON_UNKNOWN)
TEST_CASE(AGV_BUTTON_UNHEARD)
void test_a_push_button_that_was_not_seen_up_resets_nothing(agv_button_t before) {
    trip_with(before);
    read_for(before, 1500);
    read_for(AGV_BUTTON_DOWN, 1500);
    read_for(AGV_BUTTON_UP, 1);
    expect_in_vain(AGV_MISSING_BUTTON);
}

/* ---- Late steps ---- */

/* No more than 1 s is kept. */
void test_the_time_for_which_all_conditions_hold_saturates(void) {
    run(3000);
    for (unsigned i = 0; i < AGV_RESET_CONDITIONS; i++) {
        TEST_ASSERT_EQUAL_UINT16(1000, reset.held_ms[i]);
    }
}

/* Their time counts, up to what is needed. */
void test_late_steps_count_with_all_their_time(void) {
    lacking = AGV_MISSING_ALL;
    hold(1000);
    lacking = 0;
    step(999);
    release();
    TEST_ASSERT_EQUAL_UINT32(1, in_vain);
    hold(1);
    step(0xFFFFFFFFu);
    agv_timers_advance(&timers, &config, timers.now_ms + 1000, 0);
    release();
    TEST_ASSERT_EQUAL_UINT32(1, resets);
}

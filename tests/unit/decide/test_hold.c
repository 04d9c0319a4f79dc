/* The held steering angle: the last one before the trip if it is recent enough, otherwise the first valid one after
 * it. */
#include "decide/hold.h"

#include "unity.h"

static agv_hold_t hold;
static agv_vehicle_t vehicle;
static agv_timers_t timers;
static agv_config_t config;

/* The clock wraps in every test. */
static uint32_t at(uint32_t ms) {
    return 0xFFFFFFE0u + ms;
}

/* A valid 067h with this angle, received at that time. */
static void measured(unsigned raw, uint32_t ms) {
    const hal_can_frame_t frame = {
        .time_ms = at(ms), .length = 8, .data = {0, 0, (uint8_t)(raw & 0xFFu), (uint8_t)(raw >> 8)}};
    agv_timers_advance(&timers, &config, at(ms), 0);
    agv_vehicle_steering(&vehicle, &timers, &frame, true);
}

static void trip(uint32_t ms) {
    agv_timers_advance(&timers, &config, at(ms), 0);
    agv_hold_trip(&hold, &vehicle, &timers);
}

/* This angle is recent at the trip, so it is held. */
static void trip_with_9123(void) {
    measured(9123, 0);
    trip(0);
}

/* A 067h after the trip. */
static void measured_later(uint16_t raw, uint32_t ms) {
    measured(raw, ms);
    agv_hold_take(&hold, &vehicle);
}

void setUp(void) {
    agv_config_defaults(&config);
    agv_timers_set_time(&timers, at(0));
    agv_timers_start(&timers);
    hold = (agv_hold_t){0};
    vehicle = (agv_vehicle_t){0};
}

static void expect_held(uint16_t raw) {
    TEST_ASSERT_TRUE(agv_hold_is_held(&hold));
    TEST_ASSERT_EQUAL_UINT16(raw, hold.raw);
}

static void expect_none(void) {
    TEST_ASSERT_FALSE(agv_hold_is_held(&hold));
}

/* Shows: FSM-10 */
void test_without_any_067h_none_is_held(void) {
    expect_none();
    trip(0);
    expect_none();
    measured_later(9123, 100);
    expect_held(9123);
}

/* An angle of up to 50 ms before the trip is recent enough. */
/* Shows: FSM-10 */
void test_an_angle_of_up_to_50_ms_before_the_trip_is_held(void) {
    measured(9123, 10);
    trip(60);
    expect_held(9123);
    setUp();
    measured(9123, 10);
    trip(61);
    expect_none();
}

/* Shows: FSM-10 */
void test_after_the_trip_the_first_one_is_held(void) {
    measured(9123, 0);
    trip(200);
    measured_later(5000, 201);
    expect_held(5000);
    measured_later(6000, 211);
    expect_held(5000);
    trip(212); /* another trip holds its own angle */
    expect_held(6000);
}

/* The angle of an earlier trip is not kept, even without a recent one. */
/* Shows: FSM-10 */
void test_another_trip_forgets_an_old_angle(void) {
    trip_with_9123();
    expect_held(9123);
    trip(51);
    expect_none();
}

/* Manual mode drops it, because the operator steers; so does a reset. */
/* Shows: FSM-10 */
void test_a_held_angle_is_dropped_and_another_one_held(void) {
    trip_with_9123();
    agv_hold_drop(&hold);
    expect_none();
    measured_later(4000, 500);
    expect_held(4000);
}

/* The angle that a 067h measures later is held only after 2 s without 065h, and until 065h is sent again. */
static void follow(uint32_t elapsed_ms) {
    agv_hold_follow(&hold, &timers, elapsed_ms);
}

/* 065h is sent. */
static void left(void) {
    agv_hold_handed_over(&hold);
    agv_hold_left(&hold);
}

/* Shows: FSM-10 */
void test_after_2_s_without_065h_the_angle_is_taken_anew(void) {
    trip_with_9123();
    follow(1999);
    measured_later(4000, 2000);
    expect_held(9123);
    follow(1);
    expect_none();
    measured_later(5000, 2010);
    expect_held(5000);
    follow(70000);
    expect_held(5000);
    measured_later(6000, 2020);
    expect_held(6000);
    left();
    measured_later(7000, 2030);
    expect_held(6000);
}

/* While no 065h leaves, an angle that was taken anew is dropped when it is older than hold_age_ms (50). */
/* Shows: FSM-10 */
void test_an_angle_that_was_taken_anew_goes_out_of_date(void) {
    trip_with_9123();
    follow(2000);
    measured_later(4000, 2010);
    agv_timers_advance(&timers, &config, at(2060), 0);
    follow(50);
    expect_held(4000);
    agv_timers_advance(&timers, &config, at(2061), 0);
    follow(1);
    expect_none();
    measured_later(5000, 2100);
    left();
    agv_timers_advance(&timers, &config, at(3000), 0);
    follow(900);
    expect_held(5000);
}

static void renew(uint32_t ms, uint32_t elapsed_ms) {
    agv_timers_advance(&timers, &config, at(ms), 0);
    agv_hold_renew(&hold, &vehicle, &timers, 50, elapsed_ms);
}

/* A tick that comes more than 50 ms (hold_age_ms) after the last one: the frames before it were handled late. */
/* Shows: FSM-10 */
void test_a_late_tick_replaces_an_angle_of_the_frames_before_it(void) {
    trip_with_9123();
    measured(4000, 40);
    renew(40, 0); /* a frame */
    expect_held(9123);
    renew(51, 51);
    expect_held(4000);
    measured(5000, 60);
    renew(110, 59); /* it was held before */
    expect_held(4000);
}

/* Shows: FSM-10 */
void test_a_tick_in_time_keeps_it(void) {
    trip_with_9123();
    measured(4000, 40);
    renew(50, 50);
    expect_held(9123);
    renew(101, 51);
    expect_held(9123);
}

/* Shows: FSM-10 */
void test_a_late_tick_drops_it_if_the_newest_is_older_than_50_ms(void) {
    trip_with_9123();
    measured(4000, 40);
    renew(91, 91);
    expect_none();
    measured_later(5000, 92);
    renew(93, 2);
    expect_held(5000);
}

/* Shows: FSM-10 */
void test_a_late_tick_holds_nothing_that_was_dropped(void) {
    trip_with_9123();
    agv_hold_drop(&hold);
    renew(40, 60);
    expect_none();
}

/* Each 065h that is sent begins the 2 s again, and so does a trip. A frame takes no time. */
/* Shows: FSM-10 */
void test_the_2_s_without_065h_are_uninterrupted(void) {
    trip_with_9123();
    follow(1999);
    left();
    follow(1999);
    follow(0);
    measured_later(4000, 40);
    expect_held(9123);
    trip(41);
    expect_held(4000);
    follow(1);
    measured_later(5000, 50);
    expect_held(4000);
}

/* Shows: INT-5 */
void test_a_flipped_bit_in_it_or_in_its_complement_drops_it(void) {
    trip_with_9123();
    for (unsigned bit = 0; bit < 16; bit++) {
        hold.raw = (uint16_t)(hold.raw ^ (1u << bit));
        expect_none();
        hold.raw = (uint16_t)(hold.raw ^ (1u << bit));
        hold.check = (uint16_t)(hold.check ^ (1u << bit));
        expect_none();
        hold.check = (uint16_t)(hold.check ^ (1u << bit));
    }
    expect_held(9123);
}

/* All values, the ends among them: 0 is an angle like any other. */
void test_every_angle_may_be_held(void) {
    for (unsigned raw = 0; raw <= 18000; raw++) {
        measured(raw, 0);
        trip(0);
        expect_held((uint16_t)raw);
    }
}

/* A 065h that has not left the controller, or is discarded there, does not begin the 2 s again. */
/* Shows: FSM-10, SUP-7 */
void test_a_065h_that_does_not_leave_does_not_begin_the_2_s_again(void) {
    trip_with_9123();
    follow(1999);
    agv_hold_handed_over(&hold);
    agv_hold_withdrawn(&hold);
    agv_hold_left(&hold); /* there is none */
    agv_hold_handed_over(&hold);
    follow(1);
    measured_later(4000, 2000);
    expect_held(4000);
    agv_hold_left(&hold);
    measured_later(5000, 2010);
    expect_held(4000);
}

/* Only in a stalled transmitter, and only when it may not be sent. */
/* Shows: FSM-10, SUP-7 */
void test_a_065h_that_may_not_be_sent_is_stuck_in_a_stalled_transmitter(void) {
    trip_with_9123();
    TEST_ASSERT_FALSE(agv_hold_is_stuck(&hold, true, false)); /* there is none */
    agv_hold_handed_over(&hold);
    TEST_ASSERT_FALSE(agv_hold_is_stuck(&hold, false, false));
    TEST_ASSERT_FALSE(agv_hold_is_stuck(&hold, true, true));
    TEST_ASSERT_TRUE(agv_hold_is_stuck(&hold, true, false));
    agv_hold_drop(&hold);
    TEST_ASSERT_TRUE(agv_hold_is_stuck(&hold, true, true)); /* no angle is held */
    agv_hold_withdrawn(&hold);
    TEST_ASSERT_FALSE(agv_hold_is_stuck(&hold, true, true));
    agv_hold_handed_over(&hold);
    trip(10); /* discards what waits */
    TEST_ASSERT_FALSE(agv_hold_is_stuck(&hold, true, false));
}

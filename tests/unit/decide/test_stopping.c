/* The vehicle must stop in the safe state: VEHICLE_NOT_STOPPING, MOVING_WHILE_SAFE. */
#include "decide/stopping.h"

#include "unity.h"

static agv_stopping_t stopping;
static agv_timers_t timers;
static agv_config_t config;
static agv_vehicle_t vehicle;
static bool wheels_fresh;

static void run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        agv_timers_advance(&timers, &config, timers.now_ms + 1, 0);
        agv_vehicle_evaluate(&vehicle, &timers, &config, wheels_fresh, true);
        agv_stopping_step(&stopping, &timers, &vehicle, 1);
    }
}

static void wheels(int32_t left_mm_s, int32_t right_mm_s) {
    vehicle.wheels = (agv_wheel_speed_t){.left_mm_s = left_mm_s, .right_mm_s = right_mm_s};
    agv_vehicle_evaluate(&vehicle, &timers, &config, wheels_fresh, true);
}

static void wheels_for(uint32_t ms, int32_t left_mm_s, int32_t right_mm_s) {
    wheels(left_mm_s, right_mm_s);
    run(ms);
}

/* A tick that sees the wheels turn: they have turned for 0 ms. */
static void begin(void) {
    run(1);
}

static void trip(void) {
    agv_stopping_start(&stopping, &timers);
}

static void expect(bool not_stopping, bool moving) {
    TEST_ASSERT_EQUAL(not_stopping, stopping.not_stopping);
    TEST_ASSERT_EQUAL(moving, stopping.moving);
}

static void expect_faults_after(uint32_t ms, bool not_stopping, bool moving) {
    run(ms);
    expect(not_stopping, moving);
}

/* The first fault must come exactly this many ms from now. */
static void expect_after(uint32_t ms, bool not_stopping, bool moving) {
    expect_faults_after(ms - 1, false, false);
    expect_faults_after(1, not_stopping, moving);
}

/* At 2 m/s, just before the wrap. */
void setUp(void) {
    agv_config_defaults(&config);
    agv_timers_set_time(&timers, 0xFFFFFF00u);
    agv_timers_start(&timers);
    stopping = (agv_stopping_t){0};
    vehicle = (agv_vehicle_t){0};
    wheels_fresh = true;
    wheels(2000, 2000);
}

/* Shows: FSM-12, VEHICLE_NOT_STOPPING */
void test_5_s_without_standing_wheels(void) {
    run(1000);
    trip();
    expect_after(5000, true, false);
    wheels(0, 0); /* the fault lasts until the wheels have stood for 100 ms */
    expect_faults_after(99, true, false);
    expect_faults_after(1, false, false);
    wheels(2000, 2000); /* they have stood since the trip, so this is the other fault */
    expect_faults_after(10000, false, true);
}

/* Slow wheels do not stand yet. A single standstill is enough. */
/* Shows: FSM-12 */
void test_wheels_that_stand_within_5_s(void) {
    trip();
    wheels_for(4899, 60, 0);
    wheels(0, 0);
    expect_faults_after(100, false, false);
    wheels(60, 0); /* too fast for standstill, too slow for a moving vehicle */
    expect_faults_after(10000, false, false);
}

/* Shows: FSM-12, VEHICLE_NOT_STOPPING */
void test_stale_wheel_speeds_are_no_standstill(void) {
    wheels_fresh = false;
    wheels(0, 0);
    trip();
    expect_after(5000, true, false);
}

/* Shows: FSM-12 */
void test_wheels_that_stand_at_the_trip_count_as_stopped(void) {
    wheels_for(100, 0, 0);
    trip();
    wheels_fresh = false;
    expect_faults_after(10000, false, false);
}

/* The 200 ms begin with the trip at the earliest. */
/* Shows: FSM-12, MOVING_WHILE_SAFE */
void test_wheels_that_turn_from_the_trip_on(void) {
    wheels_for(100, 0, 0);
    trip();
    wheels(2000, 2000);
    begin();
    expect_after(200, false, true);
}

/* A speed that counts as standstill by its setting does not count as moving. */
/* Shows: FSM-12 */
void test_wheels_that_are_slow_by_a_setting_stand(void) {
    config.standstill_speed_mm_s = 250;
    wheels_for(100, 150, 150);
    trip();
    expect_faults_after(1000, false, false);
}

/* The time is a setting. */
/* Shows: FSM-12 */
void test_the_time_to_stop_is_a_setting(void) {
    config.stop_timeout_ms = 30000;
    trip();
    expect_after(30000, true, false);
}

static void trip_and_stop(void) {
    trip();
    wheels(0, 0);
    expect_faults_after(100, false, false);
}

/* One wheel is enough, in either direction. */
/* Shows: FSM-12, MOVING_WHILE_SAFE */
TEST_CASE(100, 0)
TEST_CASE(0, -100)
TEST_CASE(99, 3000)
void test_a_wheel_that_turns_for_200_ms(int left_mm_s, int right_mm_s) {
    trip_and_stop();
    wheels(left_mm_s, right_mm_s);
    begin();
    expect_after(200, false, true);
    wheels(99, 99); /* slower, but they do not stand */
    expect_faults_after(1000, false, true);
    wheels(0, 0);
    expect_faults_after(99, false, true);
    expect_faults_after(1, false, false);
}

/* Shows: FSM-12 */
void test_slow_wheels_and_short_ones_do_not_move_the_vehicle(void) {
    trip_and_stop();
    wheels(99, -99);
    expect_faults_after(10000, false, false);
    for (unsigned i = 0; i < 20; i++) {
        wheels_for(199, 5000, 5000);
        wheels_for(5100, 0, 0); /* standing for 5 s, from 100 ms on, begins the sum anew */
    }
    expect(false, false);
}

/* Slow wheels take nothing from the sum, nor does a standstill of less than 5 s: 180 ms, 1 ms to the first slow reading, 19 ms. */
/* Shows: FSM-12, MOVING_WHILE_SAFE */
TEST_CASE(10, 0)
TEST_CASE(10000, 99)
TEST_CASE(5098, 0)
void test_motion_in_jerks_adds_up(unsigned slow_ms, int slow_mm_s) {
    trip_and_stop();
    wheels(5000, 5000);
    begin();
    run(180);
    wheels_for(slow_ms, slow_mm_s, slow_mm_s);
    wheels(5000, 5000);
    begin();
    expect_after(19, false, true);
    wheels_for(5099, 0, 0);
    expect(false, false);
    wheels(60, 0); /* the sum is still full, and the wheels do not stand */
    expect_after(1, false, true);
}

/* The 5 s are a setting. */
/* Shows: FSM-12, MOVING_WHILE_SAFE */
void test_how_long_a_standstill_ends_the_sum_is_a_setting(void) {
    config.hold_standstill_ms = 1000;
    trip_and_stop();
    wheels_for(199, 5000, 5000);
    wheels_for(1100, 0, 0);
    wheels_for(199, 5000, 5000);
    expect(false, false);
    wheels_for(1098, 0, 0);
    wheels(5000, 5000);
    expect_after(2, false, true);
}

/* The way to the stop is no motion after it. */
/* Shows: FSM-12 */
void test_motion_counts_from_the_first_stop_on(void) {
    trip();
    run(1000);
    wheels_for(100, 0, 0);
    wheels(2000, 2000);
    begin();
    expect_after(200, false, true);
}

/* 110 ms in 300 read 0: the wheels seem to stand for a moment. */
/* Shows: FSM-12, MOVING_WHILE_SAFE */
void test_wheels_that_seem_to_stand_now_and_then_hide_no_motion(void) {
    trip_and_stop();
    for (unsigned i = 0; i < 2; i++) {
        wheels(5000, 5000);
        expect_faults_after(190, false, i == 1);
        wheels(0, 0);
        expect_faults_after(110, false, false);
    }
}

/* Readings of 60 ms, then silence for 40. */
/* Shows: FSM-12, MOVING_WHILE_SAFE */
void test_speeds_that_drop_out_hide_no_motion(void) {
    trip_and_stop();
    wheels(5000, 5000);
    for (unsigned i = 0; i < 6; i++) {
        wheels_fresh = true;
        run(60);
        wheels_fresh = false;
        run(40);
    }
    expect(false, true);
}

/* The time of a stale 101h is neither added nor subtracted. */
/* Shows: FSM-12 */
void test_stale_wheel_speeds_say_nothing(void) {
    trip_and_stop();
    wheels(5000, 5000);
    begin();
    run(150);
    wheels_fresh = false;
    expect_faults_after(10000, false, false);
    wheels_fresh = true;
    expect_after(50, false, true);
}

/* 101h comes every 400 ms, and is fresh for 60 ms each time: 200 ms are complete in the fourth cycle. */
/* Shows: FSM-12 */
void test_a_slow_101h_hides_no_motion(void) {
    trip_and_stop();
    wheels(100, 0);
    begin();
    for (unsigned cycle = 0; cycle < 3; cycle++) {
        wheels_fresh = true;
        expect_faults_after(60, false, false);
        wheels_fresh = false;
        expect_faults_after(340, false, false);
    }
    wheels_fresh = true;
    expect_after(20, false, true);
}

/* Before the first standstill the wheels may turn, because the vehicle is stopping. */
/* Shows: FSM-12 */
void test_wheels_that_have_not_stood_yet_are_not_moving_while_safe(void) {
    trip();
    expect_faults_after(4000, false, false);
}

/* Late steps count with all their time. */
void test_late_steps(void) {
    trip_and_stop();
    wheels(5000, 5000);
    begin();
    agv_stopping_step(&stopping, &timers, &vehicle, 199);
    expect(false, false);
    agv_stopping_step(&stopping, &timers, &vehicle, 0); /* a frame */
    expect(false, false);
    TEST_ASSERT_EQUAL_UINT16(199, stopping.moved.value_ms);
    agv_stopping_step(&stopping, &timers, &vehicle, 100000);
    expect(false, true);
    TEST_ASSERT_EQUAL_UINT16(200, stopping.moved.value_ms);
}

/* Shows: FSM-12 */
void test_another_trip_begins_anew(void) {
    trip();
    expect_faults_after(5000, true, false);
    trip();
    expect(false, false);
}

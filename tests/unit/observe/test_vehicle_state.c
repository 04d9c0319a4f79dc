/* The last reported state of the vehicle: invalid values are not used, and standstill needs its time. */
#include "observe/vehicle.h"

#include "unity.h"

static agv_vehicle_t vehicle;
static agv_timers_t timers;
static agv_config_t config; /* 50 mm/s, 180 counts, 100 ms */
static bool wheels_fresh;
static bool vcu_alive;

void setUp(void) {
    agv_config_defaults(&config);
    vehicle = (agv_vehicle_t){0};
    wheels_fresh = true;
    vcu_alive = true;
    agv_timers_set_time(&timers, 0xFFFFFFF0u);
    agv_timers_start(&timers);
}

static void evaluate(void) {
    agv_vehicle_evaluate(&vehicle, &timers, &config, wheels_fresh, vcu_alive);
}

static void run(uint32_t ms) {
    evaluate();
    for (uint32_t i = 0; i < ms; i++) {
        agv_timers_advance(&timers, &config, timers.now_ms + 1, 0);
        evaluate();
    }
}

/* ---- What it reports ---- */

/* 363h bytes 1 and 2. */
/* Shows: SUP-12 */
void test_the_speed_of_363h(void) {
    static const uint8_t none[8] = {0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
    static const uint8_t low[8] = {1, 0};
    static const uint8_t high[8] = {0x34, 0x12};
    agv_vehicle_status(&vehicle, none);
    TEST_ASSERT_FALSE(vehicle.vcu_speed_seen);
    agv_vehicle_status(&vehicle, low);
    TEST_ASSERT_TRUE(vehicle.vcu_speed_seen);
    TEST_ASSERT_EQUAL_UINT16(1, vehicle.vcu_speed);
    agv_vehicle_status(&vehicle, high);
    TEST_ASSERT_EQUAL_UINT16(0x1234, vehicle.vcu_speed);
    agv_vehicle_status(&vehicle, none);
    TEST_ASSERT_TRUE(vehicle.vcu_speed_seen); /* once in this run */
    TEST_ASSERT_EQUAL_UINT16(0, vehicle.vcu_speed);
}

void test_a_gear_that_is_invalid_is_none(void) {
    static const uint8_t park[8] = {8};
    static const uint8_t other[8] = {3};
    agv_vehicle_gear(&vehicle, park, true);
    TEST_ASSERT_EQUAL_UINT8(8, vehicle.gear);
    agv_vehicle_gear(&vehicle, other, false);
    TEST_ASSERT_EQUAL_UINT8(0, vehicle.gear);
}

static void throttle(unsigned counts, bool valid) {
    agv_vehicle_throttle(&vehicle, (const uint8_t[8]){(uint8_t)counts}, valid);
}

void test_a_throttle_that_is_invalid_is_not_taken(void) {
    throttle(10, true);
    throttle(251, false);
    TEST_ASSERT_EQUAL_UINT8(10, vehicle.throttle);
}

/* At most 2 counts. An invalid 050h leaves the last valid one, but the throttle is no longer known. */
/* Shows: FSM-3 */
void test_idle_is_at_most_two_counts_of_the_last_valid_050h(void) {
    TEST_ASSERT_FALSE(vehicle.throttle_known);
    TEST_ASSERT_TRUE(agv_vehicle_throttle_is_idle(&vehicle, &config));
    throttle(2, true);
    TEST_ASSERT_TRUE(vehicle.throttle_known);
    TEST_ASSERT_TRUE(agv_vehicle_throttle_is_idle(&vehicle, &config));
    throttle(251, false);
    TEST_ASSERT_FALSE(vehicle.throttle_known);
    TEST_ASSERT_TRUE(agv_vehicle_throttle_is_idle(&vehicle, &config));
    throttle(3, true);
    TEST_ASSERT_FALSE(agv_vehicle_throttle_is_idle(&vehicle, &config));
    throttle(0, false);
    TEST_ASSERT_FALSE(agv_vehicle_throttle_is_idle(&vehicle, &config));
    config.throttle_idle_counts = 25;
    TEST_ASSERT_TRUE(agv_vehicle_throttle_is_idle(&vehicle, &config));
}

/* +12.3 degrees: 9123 = 23A3h, in bytes 3 and 4. Its age counts from the stamp of the frame. */
/* Shows: FSM-10 */
void test_an_angle_that_is_invalid_changes_nothing(void) {
    hal_can_frame_t frame = {.time_ms = timers.now_ms, .length = 8, .data = {1, 2, 0xFF, 0xFF}};
    agv_vehicle_steering(&vehicle, &timers, &frame, false);
    TEST_ASSERT_FALSE(vehicle.angle_known);
    TEST_ASSERT_FALSE(agv_timer_is_started(&timers, AGV_TIMER_ANGLE));
    frame.data[2] = 0xA3;
    frame.data[3] = 0x23;
    agv_vehicle_steering(&vehicle, &timers, &frame, true);
    TEST_ASSERT_TRUE(vehicle.angle_known);
    TEST_ASSERT_EQUAL_UINT16(9123, vehicle.angle_raw);
    run(40);
    frame = (hal_can_frame_t){.time_ms = timers.now_ms, .length = 8, .data = {1, 2, 0xFF, 0xFF}};
    agv_vehicle_steering(&vehicle, &timers, &frame, false);
    TEST_ASSERT_EQUAL_UINT16(9123, vehicle.angle_raw);
    run(10);
    TEST_ASSERT_FALSE(agv_timer_reached(&timers, AGV_TIMER_ANGLE));
    run(1);
    TEST_ASSERT_TRUE(agv_timer_reached(&timers, AGV_TIMER_ANGLE));
}

/* 167h byte 4: 1 is angle control. */
void test_the_mode_of_the_eps(void) {
    for (unsigned value = 0; value < 256; value++) {
        const uint8_t data[8] = {1, 1, 1, (uint8_t)value, 1, 1, 1, 1};
        agv_vehicle_eps(&vehicle, data);
        TEST_ASSERT_EQUAL(value == 1, vehicle.eps_in_angle_mode);
    }
}

/* ---- Standstill ---- */

/* Both wheels, 32 bit each, little-endian, mm/s with a sign: 101h. */
static void wheels(int left_mm_s, int right_mm_s) {
    const uint32_t left = (uint32_t)left_mm_s;
    const uint32_t right = (uint32_t)right_mm_s;
    const uint8_t data[8] = {(uint8_t)left,  (uint8_t)(left >> 8),  (uint8_t)(left >> 16),  (uint8_t)(left >> 24),
                             (uint8_t)right, (uint8_t)(right >> 8), (uint8_t)(right >> 16), (uint8_t)(right >> 24)};
    agv_vehicle_wheels(&vehicle, data);
}

static void vcu_speed(unsigned counts) {
    agv_vehicle_status(&vehicle, (const uint8_t[8]){(uint8_t)(counts & 0xFFu), (uint8_t)(counts >> 8)});
}

static bool stands_after(uint32_t ms) {
    run(ms);
    return agv_vehicle_is_at_standstill(&timers);
}

static bool wheels_stand_after(uint32_t ms) {
    run(ms);
    return agv_vehicle_wheels_stand(&timers);
}

/* Shows: TIM-2, FSM-3 */
void test_standstill_begins_after_100_ms_of_slow_speeds(void) {
    wheels(49, -49);
    vcu_speed(180);
    TEST_ASSERT_FALSE(stands_after(99));
    TEST_ASSERT_FALSE(wheels_stand_after(0));
    TEST_ASSERT_TRUE(agv_vehicle_is_slow(&vehicle, &config));
    TEST_ASSERT_TRUE(stands_after(1));
    TEST_ASSERT_TRUE(wheels_stand_after(50));
    wheels(0, 50);
    TEST_ASSERT_FALSE(stands_after(0));
    TEST_ASSERT_FALSE(wheels_stand_after(0));
    TEST_ASSERT_FALSE(agv_vehicle_is_slow(&vehicle, &config));
    wheels(0, 0);
    TEST_ASSERT_FALSE(stands_after(99));
    TEST_ASSERT_TRUE(stands_after(1));
}

/* The extremes of 32 bits among them. */
void test_a_fast_wheel_in_either_direction_ends_standstill(void) {
    static const int fast[] = {50, -50, 51, 1000, -1000, INT32_MAX, -INT32_MAX - 1};
    for (unsigned i = 0; i < sizeof fast / sizeof fast[0]; i++) {
        for (unsigned wheel = 0; wheel < 2; wheel++) {
            setUp();
            wheels(0, 0);
            TEST_ASSERT_TRUE(stands_after(100));
            wheels(wheel == 0 ? fast[i] : 0, wheel == 1 ? fast[i] : 0);
            TEST_ASSERT_FALSE(stands_after(200));
            TEST_ASSERT_FALSE(wheels_stand_after(0));
        }
    }
}

/* The VCU's speed counts for standstill, but not for standing wheels. */
void test_the_speed_of_the_vcu_is_checked(void) {
    wheels(0, 0);
    vcu_speed(181);
    TEST_ASSERT_FALSE(stands_after(200));
    TEST_ASSERT_TRUE(wheels_stand_after(0));
    vcu_speed(180);
    TEST_ASSERT_FALSE(stands_after(99)); /* all conditions together for 100 ms */
    TEST_ASSERT_TRUE(stands_after(1));
    vcu_speed(65535);
    TEST_ASSERT_FALSE(stands_after(0));
    config.standstill_vcu_counts = 65534;
    TEST_ASSERT_FALSE(stands_after(200));
    config.standstill_vcu_counts = 65535; /* not checked */
    TEST_ASSERT_TRUE(stands_after(100));
}

/* The VCU must be alive, even when its speed is not checked. */
void test_standstill_needs_a_vcu_that_is_alive(void) {
    config.standstill_vcu_counts = 65535;
    wheels(0, 0);
    TEST_ASSERT_TRUE(stands_after(100));
    vcu_alive = false;
    TEST_ASSERT_FALSE(stands_after(500));
    TEST_ASSERT_TRUE(wheels_stand_after(0));
    vcu_alive = true;
    TEST_ASSERT_FALSE(stands_after(99));
    TEST_ASSERT_TRUE(stands_after(1));
}

void test_without_fresh_wheel_speeds_there_is_no_standstill(void) {
    wheels(0, 0);
    TEST_ASSERT_TRUE(stands_after(100));
    wheels_fresh = false;
    TEST_ASSERT_FALSE(stands_after(1000));
    TEST_ASSERT_FALSE(wheels_stand_after(0));
}

/* 5 s after they began to stand, without interruption. */
/* Shows: FSM-10 */
void test_wheels_that_have_stood_for_5_s(void) {
    wheels(0, 0);
    run(100 + 4999);
    TEST_ASSERT_FALSE(agv_timer_reached(&timers, AGV_TIMER_WHEELS_STOOD));
    run(1);
    TEST_ASSERT_TRUE(agv_timer_reached(&timers, AGV_TIMER_WHEELS_STOOD));
    wheels(50, 0);
    run(0);
    TEST_ASSERT_FALSE(agv_timer_reached(&timers, AGV_TIMER_WHEELS_STOOD));
}

/* One wheel is enough, at that speed or faster. */
/* Shows: FSM-12 */
void test_a_wheel_that_turns(void) {
    static const int speeds[] = {100, -100, 5000, INT32_MAX, -INT32_MAX - 1};
    run(0);
    wheels(99, -99);
    TEST_ASSERT_FALSE(agv_vehicle_wheel_turns(&vehicle, 100));
    for (unsigned i = 0; i < sizeof speeds / sizeof speeds[0]; i++) {
        wheels(speeds[i], 0);
        TEST_ASSERT_TRUE(agv_vehicle_wheel_turns(&vehicle, 100));
        wheels(0, speeds[i]);
        TEST_ASSERT_TRUE(agv_vehicle_wheel_turns(&vehicle, 100));
    }
    wheels_fresh = false; /* the last 101h, however old it is */
    run(0);
    TEST_ASSERT_TRUE(agv_vehicle_wheel_turns(&vehicle, 100));
}

/* Standing wheels of a 101h that is doubted may move. */
/* Shows: FSM-12, SUP-12 */
void test_wheels_in_doubt_may_move(void) {
    run(0);
    TEST_ASSERT_FALSE(agv_vehicle_may_move(&vehicle, 100));
    agv_vehicle_doubt_wheels(&vehicle, &timers, &config, true);
    TEST_ASSERT_TRUE(agv_vehicle_may_move(&vehicle, 100));
    TEST_ASSERT_FALSE(agv_vehicle_wheel_turns(&vehicle, 100));
    agv_vehicle_doubt_wheels(&vehicle, &timers, &config, false);
    TEST_ASSERT_FALSE(agv_vehicle_may_move(&vehicle, 100));
    wheels(100, 0);
    run(0);
    TEST_ASSERT_TRUE(agv_vehicle_may_move(&vehicle, 100));
}

/* No tick comes for longer than standstill_ms, and frames go on: 101h that is doubted says nothing. */
/* Shows: FSM-12, SUP-12 */
void test_wheels_in_doubt_do_not_stand_however_late_the_tick_is(void) {
    evaluate();
    agv_vehicle_doubt_wheels(&vehicle, &timers, &config, true);
    run(150);
    TEST_ASSERT_FALSE(agv_vehicle_wheels_stand(&timers));
    agv_vehicle_doubt_wheels(&vehicle, &timers, &config, false);
    run(150);
    TEST_ASSERT_TRUE(agv_vehicle_wheels_stand(&timers));
}

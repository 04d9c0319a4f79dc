/* What the vehicle last reported of itself: nothing invalid is used, and standstill takes its time. */
#include "observe/vehicle.h"

#include "unity.h"

static agv_vehicle_t vehicle;
static agv_timers_t timers;
static agv_config_t config; /* 50 mm/s, 100 ms */

void setUp(void) {
    agv_config_defaults(&config);
    vehicle = (agv_vehicle_t){0};
    agv_timers_set_time(&timers, 0xFFFFFFF0u);
    agv_timers_start(&timers, &config);
}

void tearDown(void) {
}

void test_button_1_of_363h_byte_7(void) {
    TEST_ASSERT_EQUAL(AGV_BUTTON_UNKNOWN, vehicle.button);
    for (unsigned flags = 0; flags < 256; flags++) {
        const uint8_t data[8] = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, (uint8_t)flags, 0xFF};
        agv_vehicle_status(&vehicle, data);
        TEST_ASSERT_EQUAL((flags & 0x01u) != 0 ? AGV_BUTTON_DOWN : AGV_BUTTON_UP, vehicle.button);
    }
}

void test_a_gear_that_is_invalid_is_none(void) {
    static const uint8_t park[8] = {8};
    static const uint8_t other[8] = {3};
    agv_vehicle_gear(&vehicle, park, true);
    TEST_ASSERT_EQUAL_UINT8(8, vehicle.gear);
    agv_vehicle_gear(&vehicle, other, false);
    TEST_ASSERT_EQUAL_UINT8(0, vehicle.gear);
}

void test_a_throttle_that_is_invalid_changes_nothing(void) {
    static const uint8_t ten[8] = {10};
    static const uint8_t much[8] = {251};
    agv_vehicle_throttle(&vehicle, ten, true);
    agv_vehicle_throttle(&vehicle, much, false);
    TEST_ASSERT_EQUAL_UINT8(10, vehicle.throttle);
}

/* +12.3 degrees: 9123 = 23A3h, in bytes 3 and 4. */
void test_an_angle_that_is_invalid_changes_nothing(void) {
    static const uint8_t good[8] = {1, 2, 0xA3, 0x23, 5, 6, 7, 8};
    static const uint8_t bad[8] = {1, 2, 0xFF, 0xFF};
    agv_vehicle_steering(&vehicle, bad, false);
    TEST_ASSERT_FALSE(vehicle.angle_known);
    agv_vehicle_steering(&vehicle, good, true);
    TEST_ASSERT_TRUE(vehicle.angle_known);
    TEST_ASSERT_EQUAL_UINT16(9123, vehicle.angle_raw);
    agv_vehicle_steering(&vehicle, bad, false);
    TEST_ASSERT_TRUE(vehicle.angle_known);
    TEST_ASSERT_EQUAL_UINT16(9123, vehicle.angle_raw);
}

/* 167h byte 4: 1 is angle control. */
void test_the_mode_of_the_eps(void) {
    for (unsigned value = 0; value < 256; value++) {
        const uint8_t data[8] = {1, 1, 1, (uint8_t)value, 1, 1, 1, 1};
        agv_vehicle_eps(&vehicle, data);
        TEST_ASSERT_EQUAL(value == 1, vehicle.eps_in_angle_mode);
    }
}

/* Both wheels, 32 bit each, little-endian, mm/s with a sign: 101h. */
static void wheels(int left_mm_s, int right_mm_s) {
    const uint32_t left = (uint32_t)left_mm_s;
    const uint32_t right = (uint32_t)right_mm_s;
    const uint8_t data[8] = {(uint8_t)left,  (uint8_t)(left >> 8),  (uint8_t)(left >> 16),  (uint8_t)(left >> 24),
                             (uint8_t)right, (uint8_t)(right >> 8), (uint8_t)(right >> 16), (uint8_t)(right >> 24)};
    agv_vehicle_wheels(&timers, &config, data);
}

static bool stands_after(uint32_t ms) {
    agv_timers_set_time(&timers, timers.now_ms + ms);
    agv_timers_tick(&timers);
    return agv_vehicle_stands(&timers);
}

/* Shows: TIM-2 */
void test_it_stands_when_both_wheels_were_slow_for_100_ms(void) {
    TEST_ASSERT_FALSE(stands_after(1000));
    wheels(49, -49);
    TEST_ASSERT_FALSE(stands_after(99));
    wheels(0, 0);
    TEST_ASSERT_TRUE(stands_after(1));
    TEST_ASSERT_TRUE(stands_after(50));
    wheels(0, 50);
    TEST_ASSERT_FALSE(stands_after(0));
    wheels(0, 0);
    TEST_ASSERT_FALSE(stands_after(99));
    TEST_ASSERT_TRUE(stands_after(1));
}

/* The extremes of 32 bits among them. */
void test_each_wheel_that_is_fast_either_way_ends_it(void) {
    static const int fast[] = {50, -50, 51, 1000, -1000, INT32_MAX, -INT32_MAX - 1};
    for (unsigned i = 0; i < sizeof fast / sizeof fast[0]; i++) {
        for (unsigned wheel = 0; wheel < 2; wheel++) {
            setUp();
            wheels(0, 0);
            TEST_ASSERT_TRUE(stands_after(100));
            wheels(wheel == 0 ? fast[i] : 0, wheel == 1 ? fast[i] : 0);
            TEST_ASSERT_FALSE(stands_after(200));
        }
    }
}

void test_without_fresh_wheel_speeds_it_is_not_known_to_stand(void) {
    wheels(0, 0);
    TEST_ASSERT_TRUE(stands_after(100));
    agv_vehicle_wheels_lost(&timers);
    TEST_ASSERT_FALSE(stands_after(1000));
}

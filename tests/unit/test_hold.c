/* The held steering angle: that of the moment of the trip, or the first valid one after it. */
#include "decide/hold.h"

#include "unity.h"

static agv_hold_t hold;
static agv_vehicle_t vehicle;

void setUp(void) {
    hold = (agv_hold_t){0};
    vehicle = (agv_vehicle_t){.angle_raw = 9123, .angle_known = true};
}

void tearDown(void) {
}

static void expect_held(uint16_t raw) {
    TEST_ASSERT_TRUE(agv_hold_is_held(&hold));
    TEST_ASSERT_EQUAL_UINT16(raw, hold.raw);
}

void test_none_is_held_before_a_trip(void) {
    TEST_ASSERT_FALSE(agv_hold_is_held(&hold));
    agv_hold_step(&hold, &vehicle, false, false);
    TEST_ASSERT_FALSE(agv_hold_is_held(&hold));
}

/* Shows: FSM-10 */
void test_a_trip_holds_the_angle_of_that_moment(void) {
    agv_hold_step(&hold, &vehicle, true, true);
    expect_held(9123);
    vehicle.angle_raw = 5000;
    agv_hold_step(&hold, &vehicle, false, true);
    expect_held(9123);
    agv_hold_step(&hold, &vehicle, true, true); /* of another trip */
    expect_held(5000);
}

/* Shows: FSM-10 */
void test_without_an_angle_the_first_one_after_the_trip_is_held(void) {
    vehicle.angle_known = false;
    agv_hold_step(&hold, &vehicle, true, true);
    TEST_ASSERT_FALSE(agv_hold_is_held(&hold));
    agv_hold_step(&hold, &vehicle, false, true);
    TEST_ASSERT_FALSE(agv_hold_is_held(&hold));
    vehicle = (agv_vehicle_t){.angle_raw = 1, .angle_known = true};
    agv_hold_step(&hold, &vehicle, false, true);
    expect_held(1);
}

/* Shows: FSM-10 */
void test_a_reset_drops_it(void) {
    agv_hold_step(&hold, &vehicle, true, true);
    agv_hold_step(&hold, &vehicle, false, false);
    TEST_ASSERT_FALSE(agv_hold_is_held(&hold));
}

/* Shows: INT-5 */
void test_a_flipped_bit_in_it_or_in_its_complement_drops_it(void) {
    agv_hold_step(&hold, &vehicle, true, true);
    for (unsigned bit = 0; bit < 16; bit++) {
        hold.raw = (uint16_t)(hold.raw ^ (1u << bit));
        TEST_ASSERT_FALSE(agv_hold_is_held(&hold));
        hold.raw = (uint16_t)(hold.raw ^ (1u << bit));
        hold.check = (uint16_t)(hold.check ^ (1u << bit));
        TEST_ASSERT_FALSE(agv_hold_is_held(&hold));
        hold.check = (uint16_t)(hold.check ^ (1u << bit));
    }
    expect_held(9123);
}

/* All values, the ends among them: 0 is an angle like any other. */
void test_every_angle_may_be_held(void) {
    for (unsigned raw = 0; raw <= 18000; raw++) {
        vehicle.angle_raw = (uint16_t)raw;
        agv_hold_step(&hold, &vehicle, true, true);
        expect_held((uint16_t)raw);
    }
}

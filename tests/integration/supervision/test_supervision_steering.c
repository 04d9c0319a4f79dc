/* STEERING_DEVIATION (SUP-10): a budget of 500 ms with the measured steering more than 50.0 degrees from its command; each
 * 25.0 degrees by which the measured angle has come nearer by its own motion empty it. Raw counts are 0.1 degree: 500 is 50.0
 * degrees. Calculated by hand: the tick in the millisecond of a frame sees it for the first time, so 500 ms are reached 500 ms
 * later. */
#include "one_fixture.h"
#include "walk.h"

static const agv_fault_t FAULT = AGV_FAULT_STEERING_DEVIATION;

/* Set the commanded angle, and run until its next frame has come. */
static void command(uint16_t raw) {
    fixture_run_before(&f, AGV_MSG_STEERING_COMMAND);
    fixture_command_angle(&f, raw);
    fixture_run(&f, 1);
}

/* Set the measured angle, and run until its next frame has come. */
static void measure(uint16_t raw) {
    fixture_run_before(&f, AGV_MSG_STEERING_STATUS);
    fixture_angle(&f, raw);
    fixture_run(&f, 1);
}

static void expect_trip_at(uint32_t moment_ms, int32_t hold_raw) {
    walk_run_to(&f, moment_ms - 1);
    expect_nothing(&f, FAULT, AGV_STATE_ACTIVE);
    expect_trip_after(&f, 1, FAULT, hold_raw);
    expect_led(&f, 13);
}

/* 50.0 degrees are no deviation: the budget of 500 ms takes 1000 ms to decrease to 0. */
/* Shows: SUP-10, FSM-2, STEERING_DEVIATION */
void test_a_deviation_ends_when_its_budget_is_empty(void) {
    fixture_active(&f);
    command(9501);
    expect_trip_at(f.now_ms + 500, ANGLE_CENTRE);
    measure(9001);
    expect_fault_after(&f, 999, FAULT, true);
    expect_fault_after(&f, 1, FAULT, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, FAULT));
    expect_reason(&f, FAULT);
}

/* An invalid angle in between is no step: from one valid 067h to the next it is 25.0 degrees. */
/* Shows: SUP-10, P5, STEERING_DEVIATION */
void test_a_gain_across_an_invalid_angle(void) {
    fixture_active(&f);
    command(11000);
    fixture_run(&f, 200);
    measure(18001);
    measure(9250);
    expect_trip_at(f.now_ms + 500, 9250);
}

/* With a deviation from the start the 500 ms begin after the grace time of 500 ms. */
/* Shows: SUP-10, STEERING_DEVIATION */
void test_deviation_counts_after_the_grace(void) {
    fixture_standby(&f);
    fixture_command_angle(&f, 12000);
    expect_nothing_after(&f, 3000, FAULT, AGV_STATE_STANDBY); /* not in manual */
    walk_engage(&f);
    expect_trip_at(f.now_ms + 1000, ANGLE_CENTRE);
}

/* The steering is not compared with a command from before the engagement, neither from manual nor from an earlier
 * engagement. */
static void check_forgotten(uint8_t mode_before) {
    fixture_init(&f);
    f.config.engaged_grace_ms = 50;
    f.config.steering_deviation_ms = 100;
    f.config.steering_command_timeout_ms = 1000;
    fixture_standby(&f);
    fixture_mode(&f, mode_before);
    fixture_run(&f, 100);
    command(12000);
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    fixture_mode(&f, MODE_MANUAL);
    fixture_run(&f, 500);
    walk_engage(&f);
    expect_nothing_after(&f, 1000, FAULT, AGV_STATE_ACTIVE);
    expect_trip_after(&f, 1, AGV_FAULT_STEERING_COMMAND_TIMEOUT, ANGLE_CENTRE);
}

/* Shows: SUP-10, STEERING_DEVIATION, STEERING_COMMAND_TIMEOUT */
void test_a_command_from_before_the_engagement_is_forgotten(void) {
    check_forgotten(MODE_MANUAL);
    check_forgotten(MODE_ENGAGED);
}

/* A command out of range is not used: the steering is compared with the last valid one. */
/* Shows: SUP-5, SUP-10, AI_COMMAND_OUT_OF_RANGE, STEERING_DEVIATION */
void test_a_command_out_of_range_is_no_command(void) {
    fixture_active(&f);
    command(18001);
    expect_reason(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE);
    expect_fault_after(&f, 2000, FAULT, false);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, FAULT));
}

/* Limits and times are settings. */
/* Shows: SUP-10, STEERING_DEVIATION */
void test_the_limits_are_settings(void) {
    f.config.steering_deviation_ddeg = 100;
    f.config.steering_gain_ddeg = 10;
    f.config.steering_deviation_ms = 100;
    fixture_active(&f);
    command(9100);
    expect_nothing_after(&f, 1000, FAULT, AGV_STATE_ACTIVE);
    command(9200);
    fixture_run(&f, 60);
    measure(9010);
    expect_trip_at(f.now_ms + 100, 9010);
}

/* ---- Gateway: compared with the forwarded command ---- */

static void check_gateway(uint16_t slew_ddeg_s, uint32_t trips_after_ms) {
    fixture_init(&f);
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.config.steering_slew_ddeg_s = slew_ddeg_s;
    fixture_active(&f);
    command(12000);
    const uint32_t began_ms = f.now_ms;
    walk_run_to(&f, began_ms + trips_after_ms - 1);
    expect_nothing(&f, FAULT, AGV_STATE_ACTIVE);
    fixture_forget_sent(&f);
    expect_trip_after(&f, 1, FAULT, ANGLE_CENTRE);
}

/* Without a limit, 12000 is forwarded at once. With 400.0 degrees a second (100 counts each 25 ms) the forwarded
 * command is 9500 with the fifth frame and 9600 with the sixth: 125 ms later. */
/* Shows: SUP-10, TOP-2, STEERING_DEVIATION */
void test_a_gateway_compares_with_the_forwarded_command(void) {
    check_gateway(0, 500);
    check_gateway(4000, 625);
}

/* A tripped gateway forwards nothing, so the steering is not compared with later commands of the AI computer. */
/* Shows: SUP-10, TOP-2, STEERING_DEVIATION */
void test_a_command_that_was_not_forwarded_is_not_compared(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x80; /* S-driver alarm */
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state(&f, AGV_STATE_TRIPPED);
    fixture_command_angle(&f, 11000);
    fixture_run(&f, 1500);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, FAULT));
}

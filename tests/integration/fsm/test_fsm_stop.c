/* The vehicle must stop in the safe state (FSM-12): a vehicle that does not stop in time, and one that moves again. */
#include "expect.h"
#include "fixture.h"
#include "unity.h"
#include "walk.h"

static fixture_t f;

void setUp(void) {
    fixture_init(&f);
    f.long_run = true;
}

/* Autopilot off and P are confirmed, so only the motion is a fault. The wheels keep turning. */
static void confirm(void) {
    fixture_mode(&f, MODE_MANUAL);
    fixture_gear(&f, GEAR_P);
}

static void expect_moving_fault(agv_fault_t fault, bool active) {
    const agv_fault_set_t trips = agv_supervisor_active_trips(&f.supervisor);
    expect_fault(&f, fault, active);
    TEST_ASSERT_EQUAL(active, agv_fault_is_in(&trips, fault));
    expect_output(&f, !active);
    expect_reason(&f, AGV_FAULT_S_DRIVER_ALARM);
}

/* Standstill is 100 ms after the first slow 101h. The fault ends; the output stays open until the reset. */
static void expect_ends_when_the_wheels_stand(agv_fault_t fault) {
    fixture_drive(&f, 0);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    expect_fault_after(&f, 99, fault, true);
    expect_fault_after(&f, 1, fault, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, fault));
    expect_output(&f, false);
    expect_state_after(&f, 1500, AGV_STATE_SAFE);
    walk_reset(&f, 1000);
    expect_output(&f, true);
}

/* ---- VEHICLE_NOT_STOPPING ---- */

/* Shows: FSM-12, FSM-4, VEHICLE_NOT_STOPPING */
void test_a_vehicle_that_drives_on_for_5_s(void) {
    walk_to_tripped_driving(&f, 1000);
    confirm();
    fixture_run(&f, 4999);
    expect_moving_fault(AGV_FAULT_VEHICLE_NOT_STOPPING, false);
    fixture_run(&f, 1);
    expect_moving_fault(AGV_FAULT_VEHICLE_NOT_STOPPING, true);
    expect_state(&f, AGV_STATE_SAFE);
    expect_fault(&f, AGV_FAULT_MOVING_WHILE_SAFE, false);
    expect_fault_after(&f, 3000, AGV_FAULT_VEHICLE_NOT_STOPPING, true);
    expect_ends_when_the_wheels_stand(AGV_FAULT_VEHICLE_NOT_STOPPING);
}

/* 101h reads 0 for good, the VCU reports 1 m/s: after 1 s the wheels are not believed. */
/* Shows: FSM-12, SUP-12, VEHICLE_NOT_STOPPING, SPEED_IMPLAUSIBLE */
void test_wheels_that_the_vcu_contradicts_do_not_stand(void) {
    walk_driving(&f, 1000);
    fixture_wheels(&f, 0, 0);
    fixture_run(&f, 1100);
    expect_fault(&f, AGV_FAULT_SPEED_IMPLAUSIBLE, true);
    fixture_mute_ai(&f, true);
    (void)walk_until(&f, AGV_STATE_TRIPPED, 400);
    confirm();
    expect_fault_after(&f, 4999, AGV_FAULT_VEHICLE_NOT_STOPPING, false);
    expect_fault_after(&f, 1, AGV_FAULT_VEHICLE_NOT_STOPPING, true);
    expect_output(&f, false);
    fixture_drive(&f, 0);
    fixture_run(&f, 2200);
    expect_fault(&f, AGV_FAULT_VEHICLE_NOT_STOPPING, false);
}

/* The contradiction is the reason of the trip: the wheels, which have read 0 for a second, are not seen to stand at that moment. */
/* Shows: FSM-12, SUP-12, MOVING_WHILE_SAFE, SPEED_IMPLAUSIBLE */
void test_a_trip_by_wheels_that_the_vcu_contradicts(void) {
    agv_fault_set_put(&f.config.trips, AGV_FAULT_SPEED_IMPLAUSIBLE, true);
    walk_driving(&f, 1000);
    fixture_wheels(&f, 0, 0);
    (void)walk_until(&f, AGV_STATE_TRIPPED, 1100);
    expect_reason(&f, AGV_FAULT_SPEED_IMPLAUSIBLE);
    confirm();
    expect_fault_after(&f, 4999, AGV_FAULT_MOVING_WHILE_SAFE, false);
    expect_output(&f, true);
    expect_fault_after(&f, 1, AGV_FAULT_VEHICLE_NOT_STOPPING, true);
}

/* Shows: FSM-12, SUP-12, MOVING_WHILE_SAFE, SPEED_IMPLAUSIBLE */
void test_a_vehicle_that_rolls_away_while_101h_reads_0(void) {
    walk_to_safe(&f);
    fixture_speed(&f, 3600);
    fixture_run(&f, 1190);
    expect_moving_fault(AGV_FAULT_MOVING_WHILE_SAFE, false);
    fixture_run(&f, 30);
    expect_moving_fault(AGV_FAULT_MOVING_WHILE_SAFE, true);
}

/* Where the VCU's speed is not looked at, it contradicts nothing. */
/* Shows: FSM-12, SUP-12 */
void test_a_vcu_speed_that_is_not_looked_at_does_not_contradict(void) {
    fixture_init(&f);
    f.config.standstill_vcu_counts = 65535;
    walk_to_safe(&f);
    fixture_speed(&f, 3600);
    fixture_run(&f, 3000);
    expect_fault(&f, AGV_FAULT_SPEED_IMPLAUSIBLE, true);
    expect_moving_fault(AGV_FAULT_MOVING_WHILE_SAFE, false);
}

/* The vehicle stood before, but at the trip its wheel speeds are too old. */
/* Shows: FSM-12, VEHICLE_NOT_STOPPING, WHEEL_SPEED_TIMEOUT */
void test_a_trip_by_missing_wheel_speeds(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_WHEEL_SPEED].muted = true;
    (void)walk_until(&f, AGV_STATE_TRIPPED, 100);
    expect_reason(&f, AGV_FAULT_WHEEL_SPEED_TIMEOUT);
    confirm();
    expect_fault_after(&f, 4999, AGV_FAULT_VEHICLE_NOT_STOPPING, false);
    expect_fault_after(&f, 1, AGV_FAULT_VEHICLE_NOT_STOPPING, true);
    expect_output(&f, false);
}

/* Shows: FSM-12, FSM-7, VEHICLE_NOT_STOPPING */
void test_after_a_restart_the_5_s_run_from_the_start(void) {
    walk_driving(&f, 1000);
    fixture_mute_ai(&f, true);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    expect_fault_after(&f, 4999, AGV_FAULT_VEHICLE_NOT_STOPPING, false);
    expect_fault_after(&f, 1, AGV_FAULT_VEHICLE_NOT_STOPPING, true);
}

/* ---- MOVING_WHILE_SAFE ---- */

/* These wheel speeds for this time, from the next 101h on, then standstill. 101h comes every 10 ms. */
static void move_for(int32_t left_mm_s, int32_t right_mm_s, uint32_t ms) {
    fixture_run_before(&f, AGV_MSG_WHEEL_SPEED);
    fixture_wheels(&f, left_mm_s, right_mm_s);
    fixture_run(&f, ms);
    fixture_wheels(&f, 0, 0);
    fixture_run(&f, 10);
}

/* Shows: FSM-12, FSM-4, MOVING_WHILE_SAFE */
void test_a_vehicle_that_moves_again_for_200_ms(void) {
    walk_to_safe(&f);
    move_for(100, 100, 190);
    expect_moving_fault(AGV_FAULT_MOVING_WHILE_SAFE, false);
    fixture_run_before(&f, AGV_MSG_WHEEL_SPEED);
    fixture_drive(&f, 100);
    fixture_run(&f, 200);
    expect_moving_fault(AGV_FAULT_MOVING_WHILE_SAFE, true);
    expect_fault(&f, AGV_FAULT_VEHICLE_NOT_STOPPING, false);
    expect_ends_when_the_wheels_stand(AGV_FAULT_MOVING_WHILE_SAFE);
}

/* Also in TRIPPED: nothing is confirmed, but the vehicle has stood. */
/* Shows: FSM-12, MOVING_WHILE_SAFE */
void test_a_vehicle_that_moves_again_in_tripped(void) {
    walk_to_tripped(&f);
    move_for(100, 0, 200);
    expect_state(&f, AGV_STATE_TRIPPED);
    expect_fault(&f, AGV_FAULT_MOVING_WHILE_SAFE, true);
    expect_output(&f, false);
}

/* Before the first standstill the vehicle may roll. Outside the latch it may drive. */
/* Shows: FSM-12 */
void test_cases_that_are_not_moving_while_safe(void) {
    walk_to_tripped_driving(&f, 1000);
    confirm();
    expect_fault_after(&f, 3000, AGV_FAULT_MOVING_WHILE_SAFE, false);
    fixture_drive(&f, 0);
    fixture_run(&f, 1500);
    walk_reset(&f, 1000);
    fixture_drive(&f, 1000);
    expect_state_after(&f, 10000, AGV_STATE_STANDBY);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, AGV_FAULT_MOVING_WHILE_SAFE));
}

/* ---- what programs read ---- */

void test_standstill_can_be_read(void) {
    walk_to_safe(&f);
    fixture_run(&f, 200);
    TEST_ASSERT_TRUE(agv_supervisor_is_at_standstill(&f.supervisor));
    fixture_drive(&f, 60); /* standstill is below 50 mm/s */
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    TEST_ASSERT_FALSE(agv_supervisor_is_at_standstill(&f.supervisor));
    fixture_drive(&f, 0);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    fixture_run(&f, 99);
    TEST_ASSERT_FALSE(agv_supervisor_is_at_standstill(&f.supervisor));
    fixture_run(&f, 1);
    TEST_ASSERT_TRUE(agv_supervisor_is_at_standstill(&f.supervisor));
}

/* In the frame that reports the motion, not at the next tick. */
void test_standstill_ends_with_the_frame_that_reports_motion(void) {
    walk_to_safe(&f);
    fixture_run(&f, 200);
    fixture_wheels(&f, 60, 60);
    fixture_send_now(&f, AGV_MSG_WHEEL_SPEED);
    TEST_ASSERT_FALSE(agv_supervisor_is_at_standstill(&f.supervisor));
    fixture_init(&f);
    walk_to_safe(&f);
    fixture_run(&f, 200);
    fixture_speed(&f, 181); /* 180 m/h are 50 mm/s */
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    TEST_ASSERT_FALSE(agv_supervisor_is_at_standstill(&f.supervisor));
}

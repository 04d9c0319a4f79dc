/* Deadlines of messages (SUP-3) beyond the checks of test_causes, and MODE_INVALID. */
#include "one_fixture.h"

/* Engaged while the supervisor is still in INIT: the cause is active and latches nothing. */
/* Shows: SUP-3, STEERING_COMMAND_TIMEOUT */
void test_command_timeout_in_init(void) {
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    fixture_mode(&f, MODE_ENGAGED);
    fixture_start(&f);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS); /* the VCU is alive: engaged */
    expect_nothing_after(&f, 125, AGV_FAULT_STEERING_COMMAND_TIMEOUT, AGV_STATE_INIT);
    expect_fault_after(&f, 1, AGV_FAULT_STEERING_COMMAND_TIMEOUT, true);
    expect_state_after(&f, 1000, AGV_STATE_INIT);
    expect_reason(&f, AGV_FAULT_NONE);
}

/* A command out of range refreshes no deadline: 351 ms after the last good 168h its timeout is raised as well. */
/* Shows: SUP-5, GEAR_COMMAND_TIMEOUT */
void test_a_command_out_of_range_refreshes_nothing(void) {
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_GEAR_COMMAND);
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = 3;
    expect_reason_after(&f, 350, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE);
    expect_fault(&f, AGV_FAULT_GEAR_COMMAND_TIMEOUT, false);
    expect_fault_after(&f, 1, AGV_FAULT_GEAR_COMMAND_TIMEOUT, true);
}

/* ---- MODE_INVALID: both mode bits for more than 50 ms ---- */

/* While both bits are set the previous mode stays valid. After that there is no mode, so the steering may be held. */
static void check_both_modes(agv_state_t state, uint8_t mode_after) {
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_mode(&f, MODE_BOTH);
    fixture_run(&f, 1);
    expect_nothing_after(&f, 50, AGV_FAULT_MODE_INVALID, state);
    expect_trip_after(&f, 1, AGV_FAULT_MODE_INVALID, ANGLE_CENTRE);
    expect_led(&f, -1);
    expect_fault_after(&f, 500, AGV_FAULT_MODE_INVALID, true);
    fixture_mode(&f, mode_after);
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
    expect_fault(&f, AGV_FAULT_MODE_INVALID, true);
    expect_fault_after(&f, 1, AGV_FAULT_MODE_INVALID, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, AGV_FAULT_MODE_INVALID));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, AGV_FAULT_MODE_INVALID));
    expect_reason(&f, AGV_FAULT_MODE_INVALID);
}

/* Shows: FSM-2, MODE_INVALID */
void test_mode_invalid_in_manual(void) {
    fixture_standby(&f);
    check_both_modes(AGV_STATE_STANDBY, MODE_MANUAL);
}

/* Shows: FSM-2, MODE_INVALID */
void test_mode_invalid_while_engaged(void) {
    fixture_active(&f);
    check_both_modes(AGV_STATE_ACTIVE, MODE_NEITHER);
}

/* Shows: MODE_INVALID */
void test_mode_invalid_in_init(void) {
    fixture_mode(&f, MODE_BOTH);
    fixture_start(&f);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_nothing_after(&f, 50, AGV_FAULT_MODE_INVALID, AGV_STATE_INIT);
    expect_fault_after(&f, 1, AGV_FAULT_MODE_INVALID, true);
    expect_state_after(&f, 2000, AGV_STATE_INIT);
    expect_reason(&f, AGV_FAULT_NONE);
}

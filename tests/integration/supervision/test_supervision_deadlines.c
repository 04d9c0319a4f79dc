/* Deadlines of messages (SUP-3) and MODE_INVALID. Hand-worked: 60 ms after the last frame nothing, 61 ms after it the
 * fault, in that tick. */
#include "expect.h"
#include "one_fixture.h"

typedef struct {
    agv_fault_t fault;
    agv_fault_class_t fault_class;
    int led;
    agv_message_t message;
    uint32_t deadline_ms;
    int32_t hold_raw; /* at a trip while engaged */
} row_t;

static void fall_silent(const row_t *row, agv_state_t state) {
    fixture_run_past(&f, row->message);
    f.traffic[row->message].muted = true;
    fixture_run(&f, row->deadline_ms);
    expect_nothing(&f, row->fault, state);
    fixture_run(&f, 1);
}

static void speak_again(const row_t *row) {
    fixture_run(&f, 300);
    expect_fault(&f, row->fault, true);
    f.traffic[row->message].muted = false;
    fixture_run_before(&f, row->message);
    expect_fault(&f, row->fault, true);
    fixture_run(&f, 1);
    expect_fault(&f, row->fault, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, row->fault));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, row->fault));
}

static void check_trip(const row_t *row, agv_state_t state, int32_t hold_raw) {
    fall_silent(row, state);
    expect_trip(&f, row->fault, f.call, hold_raw);
    expect_led(&f, row->led);
    speak_again(row);
    expect_reason(&f, row->fault);
    expect_led(&f, row->led);
}

static void check_warning(const row_t *row, agv_state_t state) {
    fall_silent(row, state);
    expect_warning(&f, row->fault, state);
    expect_led(&f, row->led);
    speak_again(row);
    expect_state(&f, state);
    expect_silence(&f);
    expect_led(&f, 0);
}

/* A message that was never heard is not fresh either: its deadline runs from the start. */
static void check_never_heard(const row_t *row) {
    f.traffic[row->message].muted = true;
    fixture_start(&f);
    fixture_run(&f, row->deadline_ms);
    expect_nothing(&f, row->fault, AGV_STATE_INIT);
    fixture_run(&f, 1);
    expect_fault(&f, row->fault, true);
    expect_led(&f, row->led);
    fixture_run(&f, 2000);
    expect_reason(&f, AGV_FAULT_NONE);
    expect_state(&f, row->fault_class == AGV_CLASS_TRIP ? AGV_STATE_INIT : AGV_STATE_STANDBY);
}

static void check_status(const row_t *row) {
    f.what = "manual";
    fixture_standby(&f);
    if (row->fault_class == AGV_CLASS_TRIP) {
        check_trip(row, AGV_STATE_STANDBY, NO_HOLD);
    } else {
        check_warning(row, AGV_STATE_STANDBY);
    }
    fixture_init(&f);
    f.what = "engaged";
    fixture_active(&f);
    if (row->fault_class == AGV_CLASS_TRIP) {
        check_trip(row, AGV_STATE_ACTIVE, row->hold_raw);
    } else {
        check_warning(row, AGV_STATE_ACTIVE);
    }
    fixture_init(&f);
    f.what = "never heard";
    check_never_heard(row);
}

/* ---- Status messages: always ---- */

/* Shows: SUP-3, FSM-2, EPS_STATUS_TIMEOUT */
void test_eps_status_timeout(void) {
    check_status(&(row_t){AGV_FAULT_EPS_STATUS_TIMEOUT, AGV_CLASS_TRIP, 12, AGV_MSG_EPS_STATUS, 60, NO_HOLD});
}

/* Shows: SUP-3, FSM-2, GEAR_STATUS_TIMEOUT */
void test_gear_status_timeout(void) {
    check_status(&(row_t){AGV_FAULT_GEAR_STATUS_TIMEOUT, AGV_CLASS_TRIP, 8, AGV_MSG_GEAR_STATUS, 125, ANGLE_CENTRE});
}

/* Shows: SUP-3, FSM-2, THROTTLE_STATUS_TIMEOUT */
void test_throttle_status_timeout(void) {
    check_status(
        &(row_t){AGV_FAULT_THROTTLE_STATUS_TIMEOUT, AGV_CLASS_TRIP, 7, AGV_MSG_THROTTLE_STATUS, 60, ANGLE_CENTRE});
}

/* Shows: SUP-3, FSM-2, WHEEL_SPEED_TIMEOUT */
void test_wheel_speed_timeout(void) {
    check_status(&(row_t){AGV_FAULT_WHEEL_SPEED_TIMEOUT, AGV_CLASS_TRIP, 8, AGV_MSG_WHEEL_SPEED, 60, ANGLE_CENTRE});
}

/* Shows: SUP-3, STEERING_POSITION_TIMEOUT */
void test_steering_position_timeout_only_warns(void) {
    check_status(
        &(row_t){AGV_FAULT_STEERING_POSITION_TIMEOUT, AGV_CLASS_WARN, 12, AGV_MSG_STEERING_POSITION, 60, NO_HOLD});
}

/* ---- Commands: while engaged, afresh from the moment of engagement ---- */

static void check_never_in_manual(const row_t *row) {
    f.what = "manual";
    fixture_standby(&f);
    f.traffic[row->message].muted = true;
    fixture_run(&f, 5000);
    expect_nothing(&f, row->fault, AGV_STATE_STANDBY);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, row->fault));
}

/* Silent for 5 s already when it is engaged (the state before continues: no command has come since). */
static void check_afresh(const row_t *row) {
    f.what = "afresh at the engagement";
    fixture_wheels(&f, 800, 800);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state(&f, AGV_STATE_ACTIVE);
    fixture_run(&f, row->deadline_ms);
    expect_nothing(&f, row->fault, AGV_STATE_ACTIVE);
    fixture_run(&f, 1);
    expect_trip(&f, row->fault, f.call, ANGLE_CENTRE);
    expect_led(&f, row->led);
    fixture_mode(&f, MODE_MANUAL);
    for (unsigned i = 0; i < 3; i++) {
        expect_fault(&f, row->fault, true);
        fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    }
    expect_fault(&f, row->fault, false); /* not engaged: it does not count */
    expect_reason(&f, row->fault);
}

static void check_command(const row_t *row) {
    f.what = "engaged";
    fixture_active(&f);
    check_trip(row, AGV_STATE_ACTIVE, ANGLE_CENTRE);
    fixture_init(&f);
    check_never_in_manual(row);
    check_afresh(row);
}

/* Shows: SUP-3, FSM-2, GEAR_COMMAND_TIMEOUT */
void test_gear_command_timeout(void) {
    check_command(&(row_t){AGV_FAULT_GEAR_COMMAND_TIMEOUT, AGV_CLASS_TRIP, 14, AGV_MSG_GEAR_COMMAND, 350, 0});
}

/* Shows: SUP-3, FSM-2, THROTTLE_COMMAND_TIMEOUT */
void test_throttle_command_timeout(void) {
    check_command(&(row_t){AGV_FAULT_THROTTLE_COMMAND_TIMEOUT, AGV_CLASS_TRIP, 14, AGV_MSG_THROTTLE_COMMAND, 350, 0});
}

/* Shows: SUP-3, FSM-2, STEERING_COMMAND_TIMEOUT */
void test_steering_command_timeout(void) {
    check_command(&(row_t){AGV_FAULT_STEERING_COMMAND_TIMEOUT, AGV_CLASS_TRIP, 14, AGV_MSG_STEERING_COMMAND, 125, 0});
}

/* Engaged while the supervisor is still in INIT: the cause is there and latches nothing. */
/* Shows: SUP-3, STEERING_COMMAND_TIMEOUT */
void test_command_timeout_in_init(void) {
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    fixture_mode(&f, MODE_ENGAGED);
    fixture_start(&f);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS); /* the VCU is alive: engaged */
    fixture_run(&f, 125);
    expect_nothing(&f, AGV_FAULT_STEERING_COMMAND_TIMEOUT, AGV_STATE_INIT);
    fixture_run(&f, 1);
    expect_fault(&f, AGV_FAULT_STEERING_COMMAND_TIMEOUT, true);
    fixture_run(&f, 1000);
    expect_state(&f, AGV_STATE_INIT);
    expect_reason(&f, AGV_FAULT_NONE);
}

/* A command out of range refreshes no deadline: 351 ms after the last good 168h its timeout is there as well. */
/* Shows: SUP-5, GEAR_COMMAND_TIMEOUT */
void test_a_command_out_of_range_refreshes_nothing(void) {
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_GEAR_COMMAND);
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = 3;
    fixture_run(&f, 350);
    expect_reason(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE);
    expect_fault(&f, AGV_FAULT_GEAR_COMMAND_TIMEOUT, false);
    fixture_run(&f, 1);
    expect_fault(&f, AGV_FAULT_GEAR_COMMAND_TIMEOUT, true);
}

/* ---- A node that dies as a whole ---- */

static void check_death(void (*mute)(fixture_t *, bool), agv_message_t last, uint32_t after_ms, agv_fault_t fault,
                        int32_t hold_raw) {
    fixture_init(&f);
    fixture_active(&f);
    fixture_run_past(&f, last);
    mute(&f, true);
    fixture_run(&f, after_ms);
    expect_nothing(&f, fault, AGV_STATE_ACTIVE);
    fixture_run(&f, 1);
    expect_trip(&f, fault, f.call, hold_raw);
}

/* Shows: SUP-3, STEERING_COMMAND_TIMEOUT, VCU_HEARTBEAT_LOST, EPS_HEARTBEAT_LOST */
void test_what_notices_a_dead_node_first(void) {
    check_death(fixture_mute_ai, AGV_MSG_STEERING_COMMAND, 125, AGV_FAULT_STEERING_COMMAND_TIMEOUT, ANGLE_CENTRE);
    check_death(fixture_mute_vcu, AGV_MSG_VEHICLE_STATUS, 50, AGV_FAULT_VCU_HEARTBEAT_LOST, ANGLE_CENTRE);
    check_death(fixture_mute_eps, AGV_MSG_STEERING_STATUS, 50, AGV_FAULT_EPS_HEARTBEAT_LOST, NO_HOLD);
}

/* ---- MODE_INVALID: both mode bits for more than 50 ms ---- */

/* While both are set the mode before stands, then it is neither, so the steering may be held. */
static void check_both_modes(agv_state_t state, uint8_t mode_after) {
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_mode(&f, MODE_BOTH);
    fixture_run(&f, 1);
    fixture_run(&f, 50);
    expect_nothing(&f, AGV_FAULT_MODE_INVALID, state);
    fixture_run(&f, 1);
    expect_trip(&f, AGV_FAULT_MODE_INVALID, f.call, ANGLE_CENTRE);
    expect_led(&f, -1);
    fixture_run(&f, 500);
    expect_fault(&f, AGV_FAULT_MODE_INVALID, true);
    fixture_mode(&f, mode_after);
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
    expect_fault(&f, AGV_FAULT_MODE_INVALID, true);
    fixture_run(&f, 1);
    expect_fault(&f, AGV_FAULT_MODE_INVALID, false);
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
    fixture_run(&f, 50);
    expect_nothing(&f, AGV_FAULT_MODE_INVALID, AGV_STATE_INIT);
    fixture_run(&f, 1);
    expect_fault(&f, AGV_FAULT_MODE_INVALID, true);
    fixture_run(&f, 2000);
    expect_state(&f, AGV_STATE_INIT);
    expect_reason(&f, AGV_FAULT_NONE);
}

/* A frame with one bit only, or none, takes 5 ms off the 50 ms: the other 45 ms count on. */
/* Shows: MODE_INVALID */
void test_both_modes_with_interruptions(void) {
    static const uint8_t BETWEEN[] = {MODE_MANUAL, MODE_NEITHER};
    for (unsigned i = 0; i < 2; i++) {
        fixture_init(&f);
        fixture_standby(&f);
        fixture_mode(&f, MODE_BOTH);
        fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
        fixture_run(&f, 49);
        fixture_mode(&f, BETWEEN[i]);
        fixture_run(&f, 10);
        fixture_mode(&f, MODE_BOTH);
        fixture_run(&f, 6);
        expect_nothing(&f, AGV_FAULT_MODE_INVALID, AGV_STATE_STANDBY);
        fixture_run(&f, 1);
        expect_reason(&f, AGV_FAULT_MODE_INVALID);
    }
}

/* Every other frame with both bits: 20 ms in four frames are left, so it comes with the tenth. One in four is lived with. */
/* Shows: MODE_INVALID */
void test_both_modes_every_other_frame(void) {
    fixture_standby(&f);
    for (unsigned i = 0; i < 100; i++) {
        fixture_mode(&f, (i % 4 == 0) ? MODE_BOTH : MODE_MANUAL);
        fixture_run(&f, 10);
    }
    expect_nothing(&f, AGV_FAULT_MODE_INVALID, AGV_STATE_STANDBY);
    for (unsigned i = 0; i < 20; i++) {
        fixture_mode(&f, (i % 2 == 0) ? MODE_BOTH : MODE_MANUAL);
        fixture_run(&f, 10);
    }
    expect_reason(&f, AGV_FAULT_MODE_INVALID);
}

/* Neither bit is no fault, and not engaged. */
/* Shows: MODE_INVALID */
void test_neither_mode_is_not_engaged(void) {
    fixture_active(&f);
    fixture_mode(&f, MODE_NEITHER);
    fixture_run(&f, 500);
    expect_state(&f, AGV_STATE_STANDBY);
    TEST_ASSERT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_active(&f.supervisor));
}

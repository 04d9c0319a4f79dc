/* Times and counts are settings. Each is set to a different value and checked to the millisecond. Also frames that come
 * in the last possible millisecond. */
#include "agv/names.h"
#include "one_fixture.h"
#include "walk.h"

/* ---- Deadlines ---- */

typedef struct {
    agv_fault_t fault;
    agv_message_t message;
    uint32_t deadline_ms; /* default */
    uint32_t chosen_ms;
} deadline_t;

static const deadline_t DEADLINES[] = {
    {AGV_FAULT_VCU_HEARTBEAT_LOST, AGV_MSG_VEHICLE_STATUS, 50, 31},
    {AGV_FAULT_EPS_HEARTBEAT_LOST, AGV_MSG_STEERING_STATUS, 50, 34},
    {AGV_FAULT_AI_HEARTBEAT_LOST, AGV_MSG_TURN_SIGNAL_COMMAND, 350, 333},
    {AGV_FAULT_EPS_STATUS_TIMEOUT, AGV_MSG_EPS_STATUS, 60, 36},
    {AGV_FAULT_GEAR_STATUS_TIMEOUT, AGV_MSG_GEAR_STATUS, 125, 91},
    {AGV_FAULT_THROTTLE_STATUS_TIMEOUT, AGV_MSG_THROTTLE_STATUS, 60, 38},
    {AGV_FAULT_WHEEL_SPEED_TIMEOUT, AGV_MSG_WHEEL_SPEED, 60, 42},
    {AGV_FAULT_STEERING_POSITION_TIMEOUT, AGV_MSG_STEERING_POSITION, 60, 47},
    {AGV_FAULT_GEAR_COMMAND_TIMEOUT, AGV_MSG_GEAR_COMMAND, 350, 311},
    {AGV_FAULT_THROTTLE_COMMAND_TIMEOUT, AGV_MSG_THROTTLE_COMMAND, 350, 322},
    {AGV_FAULT_STEERING_COMMAND_TIMEOUT, AGV_MSG_STEERING_COMMAND, 125, 83},
};
enum { DEADLINE_COUNT = sizeof DEADLINES / sizeof DEADLINES[0] };

static void choose_deadlines(void) {
    f.config.vcu_heartbeat_timeout_ms = 31;
    f.config.eps_heartbeat_timeout_ms = 34;
    f.config.ai_heartbeat_timeout_ms = 333;
    f.config.eps_status_timeout_ms = 36;
    f.config.gear_status_timeout_ms = 91;
    f.config.throttle_status_timeout_ms = 38;
    f.config.wheel_speed_timeout_ms = 42;
    f.config.steering_position_timeout_ms = 47;
    f.config.gear_command_timeout_ms = 311;
    f.config.throttle_command_timeout_ms = 322;
    f.config.steering_command_timeout_ms = 83;
}

/* Shows: SUP-2, SUP-3, INT-2 */
void test_each_deadline_is_a_setting(void) {
    for (unsigned i = 0; i < DEADLINE_COUNT; i++) {
        fixture_init(&f);
        f.what = agv_fault_name(DEADLINES[i].fault);
        choose_deadlines();
        fixture_active(&f);
        fixture_run_past(&f, DEADLINES[i].message);
        f.traffic[DEADLINES[i].message].muted = true;
        expect_nothing_after(&f, DEADLINES[i].chosen_ms, DEADLINES[i].fault, AGV_STATE_ACTIVE);
        expect_fault_after(&f, 1, DEADLINES[i].fault, true);
    }
}

/* From its next frame on the message has this cycle. */
static void slow_down(agv_message_t message, uint32_t cycle_ms) {
    fixture_run_past(&f, message);
    f.traffic[message].cycle_ms = (uint16_t)cycle_ms;
    f.traffic[message].phase_ms = (uint16_t)(f.elapsed_ms % cycle_ms);
}

/* Frames are handled before the tick of their millisecond: one frame each deadline + 1 ms is always just in time. */
/* Shows: SUP-2, SUP-3 */
void test_a_frame_in_the_last_millisecond(void) {
    for (unsigned i = 0; i < DEADLINE_COUNT; i++) {
        fixture_init(&f);
        f.what = agv_fault_name(DEADLINES[i].fault);
        fixture_active(&f);
        slow_down(DEADLINES[i].message, DEADLINES[i].deadline_ms + 1);
        expect_nothing_after(&f, 3000, DEADLINES[i].fault, AGV_STATE_ACTIVE);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, fixture_raised(&f, DEADLINES[i].fault), f.what);
        slow_down(DEADLINES[i].message, DEADLINES[i].deadline_ms + 2);
        expect_nothing_after(&f, DEADLINES[i].deadline_ms, DEADLINES[i].fault, AGV_STATE_ACTIVE);
        expect_fault_after(&f, 1, DEADLINES[i].fault, true);
    }
}

/* ---- Other times and counts ---- */

/* Shows: SUP-8, AI_HEARTBEAT_LOST */
void test_ai_never_seen_timeout(void) {
    f.config.ai_never_seen_timeout_ms = 777;
    f.traffic[AGV_MSG_TURN_SIGNAL_COMMAND].muted = true;
    fixture_standby(&f);
    walk_engage(&f);
    expect_nothing_after(&f, 777, AGV_FAULT_AI_HEARTBEAT_LOST, AGV_STATE_STANDBY);
    expect_trip_after(&f, 1, AGV_FAULT_AI_HEARTBEAT_LOST, ANGLE_CENTRE);
}

/* Shows: MODE_INVALID */
void test_mode_invalid_time(void) {
    f.config.mode_invalid_ms = 123;
    fixture_standby(&f);
    fixture_mode(&f, MODE_BOTH);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_nothing_after(&f, 123, AGV_FAULT_MODE_INVALID, AGV_STATE_STANDBY);
    expect_trip_after(&f, 1, AGV_FAULT_MODE_INVALID, ANGLE_CENTRE);
}

/* Grace 123 ms, then a budget of 67 ms, of which the tick at 123 ms is the first. */
/* Shows: SUP-5, THROTTLE_IN_PARK */
void test_grace_and_throttle_in_park_time(void) {
    f.config.engaged_grace_ms = 123;
    f.config.throttle_in_park_ms = 67;
    fixture_standby(&f);
    f.traffic[AGV_MSG_THROTTLE_STATUS].data[0] = 10;
    walk_engage(&f);
    expect_nothing_after(&f, 123 + 66, AGV_FAULT_THROTTLE_IN_PARK, AGV_STATE_ACTIVE);
    expect_trip_after(&f, 1, AGV_FAULT_THROTTLE_IN_PARK, ANGLE_CENTRE);
}

static void check_count(agv_message_t message, const uint8_t bad[8], unsigned frames, agv_fault_t fault) {
    fixture_active(&f);
    f.what = agv_fault_name(fault);
    fixture_run_past(&f, message);
    for (unsigned i = 0; i < 8; i++) {
        f.traffic[message].data[i] = bad[i];
    }
    for (unsigned i = 1; i < frames; i++) {
        fixture_run_past(&f, message);
        expect_nothing(&f, fault, AGV_STATE_ACTIVE);
    }
    fixture_run_past(&f, message);
    expect_fault(&f, fault, true);
    expect_reason(&f, fault);
}

/* Shows: SUP-4, SUP-5, EPS_MODE_OFF, GEAR_STATUS_INVALID, THROTTLE_STATUS_INVALID, STEERING_ANGLE_INVALID */
void test_counts_of_frames(void) {
    static const struct {
        agv_message_t message;
        uint8_t bad[8];
        unsigned frames;
        agv_fault_t fault;
    } rows[] = {{AGV_MSG_EPS_STATUS, {0, 0, 0, 1, 0, 0, 0, 0x01}, 2, AGV_FAULT_EPS_UNDER_VOLTAGE},
                {AGV_MSG_EPS_STATUS, {0, 0, 0, 0xFF}, 7, AGV_FAULT_EPS_MODE_OFF},
                {AGV_MSG_GEAR_STATUS, {0}, 4, AGV_FAULT_GEAR_STATUS_INVALID},
                {AGV_MSG_THROTTLE_STATUS, {251}, 4, AGV_FAULT_THROTTLE_STATUS_INVALID},
                {AGV_MSG_STEERING_STATUS, {0, 100, 0xFF, 0xFF}, 4, AGV_FAULT_STEERING_ANGLE_INVALID}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        fixture_init(&f);
        f.config.eps_supply_fault_frames = 2;
        f.config.eps_mode_frames = 7;
        f.config.status_invalid_frames = 4;
        check_count(rows[i].message, rows[i].bad, rows[i].frames, rows[i].fault);
    }
}

/* Shows: SUP-7, TX_STALLED, BUS_OFF */
void test_times_of_the_bus(void) {
    f.config.tx_stalled_ms = 20;
    f.config.bus_off_recovery_ms = 33;
    fixture_standby(&f);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 20);
    expect_nothing_after(&f, 1, AGV_FAULT_TX_STALLED, AGV_STATE_STANDBY);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 21);
    expect_trip_after(&f, 1, AGV_FAULT_TX_STALLED, NO_HOLD);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    fixture_run(&f, 1);
    fixture_run(&f, 32);
    TEST_ASSERT_EQUAL_UINT32(0, f.hal.can[HAL_CAN_VEHICLE].recover_requests);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1, f.hal.can[HAL_CAN_VEHICLE].recover_requests);
}

/* Shows: SUP-5, AI_COMMAND_OUT_OF_RANGE */
void test_the_duration_of_a_transient(void) {
    f.config.event_hold_ms = 250;
    fixture_active(&f);
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, (const uint8_t[8]){0});
    expect_fault_after(&f, 249, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, true);
    expect_fault_after(&f, 1, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, false);
}

/* Shows: STARTUP_TIMEOUT */
void test_startup_timeout(void) {
    f.config.startup_timeout_ms = 1234;
    fixture_mode(&f, MODE_NEITHER);
    fixture_start(&f);
    expect_nothing_after(&f, 1234, AGV_FAULT_STARTUP_TIMEOUT, AGV_STATE_INIT);
    fixture_run(&f, 1);
    expect_warning(&f, AGV_FAULT_STARTUP_TIMEOUT, AGV_STATE_INIT);
}

/* ---- Engaged, not engaged, engaged again ---- */

/* Each engagement has its own grace: 500 ms, and five frames of 167h. One that is continued has none. */
/* Shows: SUP-5, EPS_MODE_OFF */
void test_every_engagement_has_its_grace(void) {
    f.config.mode_flapping_ms = 1000;
    fixture_active(&f);
    walk_disengage(&f);
    f.traffic[AGV_MSG_EPS_STATUS].data[3] = 0xFF;
    fixture_run(&f, 1000);
    for (unsigned i = 0; i < 3; i++) {
        walk_engage(&f);
        expect_nothing_after(&f, 530, AGV_FAULT_EPS_MODE_OFF, AGV_STATE_ACTIVE); /* of which four frames count */
        walk_disengage(&f);
        expect_nothing(&f, AGV_FAULT_EPS_MODE_OFF, AGV_STATE_STANDBY);
        fixture_run(&f, 110);
    }
    walk_engage(&f);
    fixture_run(&f, 530);
    walk_disengage(&f);
    expect_nothing_after(&f, 50, AGV_FAULT_EPS_MODE_OFF, AGV_STATE_STANDBY);
    walk_engage(&f);
    expect_reason_after(&f, 5, AGV_FAULT_EPS_MODE_OFF);
}

/* Faults that count only while engaged end with the engagement. */
/* Shows: SUP-5, STEERING_DEVIATION, THROTTLE_IN_PARK */
void test_faults_that_end_with_the_engagement(void) {
    fixture_active(&f);
    fixture_gear(&f, GEAR_P);
    f.traffic[AGV_MSG_THROTTLE_STATUS].data[0] = 10;
    fixture_command_angle(&f, 12000);
    expect_fault_after(&f, 1000, AGV_FAULT_STEERING_DEVIATION, true);
    expect_fault(&f, AGV_FAULT_THROTTLE_IN_PARK, true);
    walk_disengage(&f);
    expect_fault(&f, AGV_FAULT_STEERING_DEVIATION, false);
    expect_fault(&f, AGV_FAULT_THROTTLE_IN_PARK, false);
}

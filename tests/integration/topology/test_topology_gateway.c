/* The gateway: frames that pass in each state, and frames that do not pass. */
#include "one_gateway.h"

/* ---- Commands ---- */

/* Shows: TOP-2, P14 */
void test_in_active_the_four_commands_pass_packed_anew(void) {
    fixture_active(&f);
    pause_ai();
    expect_pass(0x43F, SIGNALS, SIGNALS_PACKED);
    expect_pass(0x168, DRIVE, DRIVE_PACKED);
    expect_pass(0x075, THROTTLE, THROTTLE_PACKED);
    expect_pass(0x065, ANGLE, ANGLE_PACKED);
}

/* Shows: TOP-2 */
void test_in_standby_only_43f_passes(void) {
    fixture_standby(&f);
    expect_pass(0x43F, SIGNALS, SIGNALS_PACKED);
    expect_dropped(0x168, DRIVE);
    expect_dropped(0x075, THROTTLE);
    expect_dropped(0x065, ANGLE);
}

/* Shows: TOP-2 */
void test_in_standby_all_four_pass_if_so_chosen_and_the_throttle_as_0(void) {
    f.config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    fixture_standby(&f);
    expect_pass(0x43F, SIGNALS, SIGNALS_PACKED);
    expect_pass(0x168, DRIVE, DRIVE_PACKED);
    expect_pass(0x075, THROTTLE, ZERO);
    expect_pass(0x065, ANGLE, ANGLE_PACKED);
}

/* INIT and SAFE are in test_gateway. */
/* Shows: TOP-2, FSM-6 */
void test_in_tripped_a_command_is_dropped_and_counted(void) {
    walk_to_tripped(&f);
    expect_dropped(0x168, DRIVE);
}

static void expect_invalid_commands_are_dropped(void) {
    expect_dropped(0x168, NO_GEAR);
    expect_dropped(0x075, TOO_MUCH_THROTTLE);
    expect_dropped(0x065, TOO_MUCH_ANGLE);
    expect_state(&f, AGV_STATE_STANDBY);
}

/* Shows: TOP-2, SUP-5 */
void test_a_command_out_of_range_does_not_pass_in_standby(void) {
    fixture_standby(&f);
    expect_invalid_commands_are_dropped();
    setUp();
    f.config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    fixture_standby(&f);
    expect_invalid_commands_are_dropped();
}

/* Shows: TOP-2, AI_COMMAND_OUT_OF_RANGE */
void test_a_command_out_of_range_does_not_pass_in_active(void) {
    static const struct {
        uint32_t id;
        const uint8_t *data;
    } ROWS[] = {{0x168, NO_GEAR}, {0x075, TOO_MUCH_THROTTLE}, {0x065, TOO_MUCH_ANGLE}};
    for (unsigned i = 0; i < 3; i++) {
        setUp();
        fixture_active(&f);
        from_ai(ROWS[i].id, ROWS[i].data); /* the oracle allows none of them in TRIPPED */
        expect_reason(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE);
        TEST_ASSERT_EQUAL_UINT32(4, f.sent_count);
    }
}

/* Shows: TOP-2, P1 */
void test_the_table_set_passes_on_its_own_identifiers(void) {
    f.config.id_set = AGV_ID_SET_TABLE;
    fixture_standby(&f);
    expect_pass(0x201, SIGNALS, SIGNALS_PACKED);
    expect_dropped(0x43F, SIGNALS);
}

/* ---- Status frames ---- */

static void expect_status_passes(agv_state_t state) {
    static const agv_message_t STATUS[] = {AGV_MSG_VEHICLE_STATUS,  AGV_MSG_GEAR_STATUS, AGV_MSG_THROTTLE_STATUS,
                                           AGV_MSG_STEERING_STATUS, AGV_MSG_EPS_STATUS,  AGV_MSG_STEERING_POSITION,
                                           AGV_MSG_WHEEL_SPEED};
    expect_state(&f, state);
    for (unsigned i = 0; i < 7; i++) {
        fixture_forget_sent(&f);
        fixture_send_now(&f, STATUS[i]);
        expect_passed(HAL_CAN_AI, f.traffic[STATUS[i]].id, f.traffic[STATUS[i]].data);
    }
    expect_state(&f, state);
}

/* Shows: TOP-2 */
void test_status_frames_pass_to_the_ai_side_in_every_state(void) {
    fixture_start(&f);
    expect_status_passes(AGV_STATE_INIT);
    setUp();
    fixture_standby(&f);
    expect_status_passes(AGV_STATE_STANDBY);
    setUp();
    fixture_active(&f);
    expect_status_passes(AGV_STATE_ACTIVE);
    setUp();
    walk_to_tripped(&f);
    expect_status_passes(AGV_STATE_TRIPPED);
    setUp();
    walk_to_safe(&f);
    expect_status_passes(AGV_STATE_SAFE);
}

/* Also values that the supervisor cannot use. */
/* Shows: TOP-2 */
void test_a_status_frame_passes_as_it_is(void) {
    static const uint8_t odd[8] = {0xFF, 1, 2, 3, 4, 5, 6, 7};
    fixture_standby(&f);
    fixture_frame(&f, AGV_MSG_GEAR_STATUS, odd);
    expect_passed(HAL_CAN_AI, 0x0A3, odd);
}

/* ---- Nothing else ---- */

static void expect_dropped_from(hal_can_side_t side, uint32_t id) {
    const uint32_t before = dropped();
    fixture_forget_sent(&f);
    fixture_raw(&f, side, (hal_can_frame_t){.id = id, .length = 8});
    expect_silence(&f);
    TEST_ASSERT_EQUAL_UINT32(before + 1, dropped());
}

/* Shows: TOP-2 */
void test_no_other_identifier_passes(void) {
    fixture_active(&f);
    for (uint32_t id = 0; id <= 0x7FF; id++) {
        if (id != 0x43F && id != 0x168 && id != 0x075 && id != 0x065) {
            expect_dropped_from(HAL_CAN_AI, id);
        }
    }
    expect_state(&f, AGV_STATE_ACTIVE);
    for (uint32_t id = 0; id <= 0x7FF; id++) {
        if (id != 0x363 && id != 0x0A3 && id != 0x050 && id != 0x067 && id != 0x167 && id != 0x267 && id != 0x101 &&
            id != 0x43F && id != 0x168 && id != 0x075 && id != 0x065) {
            expect_dropped_from(HAL_CAN_VEHICLE, id);
        }
    }
    expect_state(&f, AGV_STATE_ACTIVE);
}

/* Shows: TOP-1 */
void test_on_the_shared_bus_the_ai_side_is_ignored(void) {
    f.config.topology = AGV_TOPOLOGY_SHARED;
    fixture_active(&f);
    expect_dropped(0x168, NO_GEAR);
    expect_dropped(0x363, ZERO);
    expect_dropped(0x7FF, ZERO);
    const uint32_t before = dropped();
    fixture_raw(&f, HAL_CAN_AI, (hal_can_frame_t){.id = 0x168, .length = 7}); /* on the vehicle side it would trip */
    TEST_ASSERT_EQUAL_UINT32(before + 1, dropped());
    expect_state(&f, AGV_STATE_ACTIVE);
}

/* ---- Only while the last 363h reports autopilot ---- */

static void report(uint8_t mode) {
    fixture_mode(&f, mode);
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state(&f, AGV_STATE_ACTIVE);
}

static void expect_no_motion_passes(void) {
    expect_dropped(0x168, DRIVE);
    expect_dropped(0x075, THROTTLE);
    expect_dropped(0x065, ANGLE);
    expect_pass(0x43F, SIGNALS, SIGNALS_PACKED);
}

/* Still engaged, because the engagement ends with the third 363h. Settings for manual do not matter. */
/* Shows: TOP-2 */
void test_no_motion_passes_when_the_last_363h_does_not_report_autopilot(void) {
    static const uint8_t MODES[] = {MODE_MANUAL, MODE_NEITHER, MODE_BOTH};
    for (unsigned i = 0; i < 6; i++) {
        setUp();
        f.config.gateway_in_manual = i < 3 ? AGV_IN_MANUAL_HEARTBEAT : AGV_IN_MANUAL_ALL;
        fixture_active(&f);
        pause_ai();
        report(MODES[i % 3]);
        expect_no_motion_passes();
        report(MODE_ENGAGED);
        expect_pass(0x075, THROTTLE, THROTTLE_PACKED);
    }
}

/* The gateway: frames that wait, frames that come too soon, and the throttle 0 at the end of an engagement. */
#include "one_gateway.h"

/* ---- A side that accepts nothing ---- */

/* Shows: TOP-2 */
void test_towards_a_stalled_ai_side_the_newest_of_each_is_kept(void) {
    static const uint8_t neutral[8] = {4};
    static const uint8_t park[8] = {8};
    fixture_standby(&f);
    sim_hal_set_full(&f.hal, HAL_CAN_AI, true);
    fixture_frame(&f, AGV_MSG_GEAR_STATUS, neutral);
    const uint32_t before = dropped();
    fixture_frame(&f, AGV_MSG_GEAR_STATUS, park);
    TEST_ASSERT_EQUAL_UINT32(before + 1, dropped());
    expect_silence(&f);
    sim_hal_set_full(&f.hal, HAL_CAN_AI, false);
    fixture_jump(&f, 1);
    expect_sent_once(0x0A3, park);
    expect_state(&f, AGV_STATE_STANDBY);
}

/* ---- Waiting commands are dropped ---- */

/* Commands that waited in ACTIVE are dropped with the first 363h without autopilot, without a trip. The throttle 0 of
 * the end of the engagement waits instead. */
/* Shows: TOP-2 */
void test_waiting_commands_are_dropped_when_the_autopilot_is_disengaged(void) {
    fixture_active(&f);
    pause_ai();
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    from_ai(0x168, DRIVE);
    from_ai(0x075, THROTTLE);
    from_ai(0x065, ANGLE);
    const uint32_t before = dropped();
    fixture_mode(&f, MODE_MANUAL);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state(&f, AGV_STATE_ACTIVE);
    TEST_ASSERT_EQUAL_UINT32(before + 3, dropped());
    disengage();
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    expect_count_after(&f, 50, 0x168, 0);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x065));
    expect_sent_once(0x075, ZERO);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->gate_refused);
    expect_state(&f, AGV_STATE_STANDBY);
}

/* In STANDBY a 43Fh without "autopilot off" waits for a full queue; then comes a trip. */
/* Shows: TOP-2, FSM-2, FSM-6 */
void test_waiting_commands_are_dropped_at_a_trip_in_manual(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_standby(&f);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    fixture_run_past(&f, AGV_MSG_TURN_SIGNAL_COMMAND);
    fixture_mute_ai(&f, true);
    walk_trip(&f);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    fixture_run(&f, 20);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->gate_refused);
    expect_fault(&f, AGV_FAULT_TX_GATE_REFUSED, false);
    TEST_ASSERT_EQUAL_HEX8(0x70, fixture_nth_sent(&f, 0x43F, 0)->data[4]);
}

/* R came at standstill; before it can be sent, the vehicle moves in D. The throttle that passes is then 0. */
/* Shows: TOP-2 */
void test_a_gear_that_waits_is_dropped_when_the_vehicle_moves(void) {
    static const uint8_t reverse[8] = {2};
    fixture_active(&f);
    fixture_gear(&f, GEAR_D);
    pause_ai();
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    from_ai(0x168, reverse);
    const uint32_t before = dropped();
    fixture_drive(&f, 500);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    TEST_ASSERT_EQUAL_UINT32(before + 1, dropped());
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    expect_count_after(&f, 10, 0x168, 0);
    expect_pass(0x075, THROTTLE, ZERO);
    expect_state(&f, AGV_STATE_ACTIVE);
}

/* The queue is full at the end of an engagement, and in manual a 075h waits beside the throttle 0. */
static void throttle_waits_in_manual(void) {
    f.config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    fixture_active(&f);
    pause_ai();
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    disengage();
    from_ai(0x075, THROTTLE);
}

/* A 075h that waits in manual is dropped at the engagement; the throttle 0 of the end of the last one is not. */
/* Shows: TOP-2 */
void test_the_throttle_0_of_the_end_outlasts_a_throttle_that_waits(void) {
    throttle_waits_in_manual();
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state(&f, AGV_STATE_ACTIVE);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    fixture_jump(&f, 1);
    expect_sent_once(0x075, ZERO);
}

/* A later 075h that leaves takes its place. */
/* Shows: TOP-2 */
void test_the_throttle_0_of_the_end_is_not_sent_after_another_one(void) {
    throttle_waits_in_manual();
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    expect_count_after(&f, 60, 0x075, 1);
}

/* ---- At most one frame in half a cycle ---- */

typedef struct {
    agv_message_t message;
    uint32_t id;
    uint8_t first[8];
    uint8_t second[8];
} too_soon_t;

static const too_soon_t TOO_SOON[] = {
    {AGV_MSG_TURN_SIGNAL_COMMAND, 0x43F, {0, 0, 0, 0, 0x80, 0, 0, 1}, {0, 0, 0, 0, 0x80, 0, 0, 2}},
    {AGV_MSG_GEAR_COMMAND, 0x168, {8}, {4}},
    {AGV_MSG_THROTTLE_COMMAND, 0x075, {10}, {20}},
    {AGV_MSG_STEERING_COMMAND, 0x065, {0x28, 0x23}, {0x29, 0x23}}};

/* Only the test sends this command, and the last one is more than half a cycle ago. */
static void active_without(const too_soon_t *row) {
    setUp();
    fixture_active(&f);
    f.traffic[row->message].muted = true;
    fixture_run(&f, 60);
}

/* Waiting commands are dropped at a trip and never sent. */
/* Shows: TOP-2, FSM-2, FSM-6 */
void test_commands_that_came_too_soon_are_dropped_at_a_trip(void) {
    for (unsigned i = 0; i < 4; i++) {
        setUp();
        fixture_active(&f);
        pause_ai();
        from_ai(TOO_SOON[i].id, TOO_SOON[i].first);
        from_ai(TOO_SOON[i].id, TOO_SOON[i].second);
        walk_trip(&f);
        fixture_run(&f, 200); /* the oracle checks each frame */
        TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->gate_refused);
    }
}

/* P passes, N waits, an invalid gear does not replace it. */
/* Shows: TOP-2, SUP-5 */
void test_an_invalid_frame_does_not_replace_one_that_waits(void) {
    static const uint8_t park[8] = {8};
    static const uint8_t neutral[8] = {4};
    f.config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    fixture_standby(&f);
    pause_ai();
    expect_pass(0x168, park, park);
    from_ai(0x168, neutral);
    expect_dropped(0x168, NO_GEAR);
    fixture_run(&f, 50);
    expect_sent_once(0x168, neutral);
}

/* ---- The end of an engagement ---- */

/* One 075h with throttle 0, in the call of the 363h that ends the engagement, and no other motion command. */
/* Shows: TOP-2 */
void test_the_end_of_an_engagement_sends_throttle_0(void) {
    fixture_active(&f);
    pause_ai();
    from_ai(0x075, THROTTLE);
    fixture_mode(&f, MODE_MANUAL);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x075));
    fixture_forget_sent(&f);
    fixture_run(&f, 1);
    expect_sent_once(0x075, ZERO);
    TEST_ASSERT_EQUAL_UINT32(f.traffic[AGV_MSG_VEHICLE_STATUS].call, fixture_nth_sent(&f, 0x075, 0)->call);
    expect_count_after(&f, 500, 0x075, 1);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x065));
}

/* A 43Fh is no command of motion: it waits for its half cycle of 50 ms also over the end of the engagement. */
/* Shows: TOP-2 */
void test_a_43fh_that_came_too_soon_outlasts_the_engagement(void) {
    const too_soon_t *const row = &TOO_SOON[0];
    active_without(row);
    fixture_mode(&f, MODE_MANUAL);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_pass(row->id, row->first, row->first);
    fixture_run(&f, 1);
    from_ai(row->id, row->second);
    expect_state_after(&f, 48, AGV_STATE_STANDBY);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, row->id));
    fixture_run(&f, 1);
    expect_sent_once(row->id, row->second);
}

/* With one frame for the end of an engagement, a throttle may wait at it. In STANDBY only 0 would pass. */
/* Shows: TOP-2, INT-4 */
void test_a_throttle_that_waits_does_not_outlast_the_engagement(void) {
    f.config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    f.config.mode_frames = 1;
    fixture_active(&f);
    pause_ai();
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
    from_ai(0x075, (const uint8_t[8]){10});
    from_ai(0x075, (const uint8_t[8]){20});
    fixture_forget_sent(&f);
    fixture_mode(&f, MODE_MANUAL);
    fixture_run(&f, 1);
    expect_state(&f, AGV_STATE_STANDBY);
    expect_sent_once(0x075, ZERO);
    expect_count_after(&f, 200, 0x075, 1);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->gate_refused);
    expect_state(&f, AGV_STATE_STANDBY);
}

/* What came in manual, and waits for its half cycle when the engagement begins, is no command of this engagement. */
/* Shows: TOP-2, SUP-11 */
void test_a_motion_command_that_waits_in_manual_is_not_sent_in_the_engagement(void) {
    for (unsigned i = 1; i < 4; i++) { /* the commands of motion */
        const too_soon_t *const row = &TOO_SOON[i];
        setUp();
        f.config.gateway_in_manual = AGV_IN_MANUAL_ALL;
        fixture_standby(&f);
        pause_ai();
        fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
        from_ai(row->id, row->first);
        from_ai(row->id, row->second);
        fixture_forget_sent(&f);
        fixture_mode(&f, MODE_ENGAGED);
        fixture_run(&f, 1);
        expect_state(&f, AGV_STATE_ACTIVE);
        fixture_run(&f, 100);
        TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, row->id));
        expect_state(&f, AGV_STATE_ACTIVE);
    }
}

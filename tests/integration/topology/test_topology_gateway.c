/* The gateway: frames that pass in each state, their packing and limits, and frames that do not pass. */
#include <string.h>

#include "fixture.h"
#include "unity.h"
#include "walk.h"

static fixture_t f;

void setUp(void) {
    fixture_init(&f);
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
}

static void from_ai(uint32_t id, const uint8_t data[8]) {
    hal_can_frame_t frame = {.id = id, .length = 8};
    memcpy(frame.data, data, 8);
    fixture_forget_sent(&f);
    fixture_raw(&f, HAL_CAN_AI, frame);
}

/* Exactly this frame was sent in this call, to that side. */
static void expect_passed(hal_can_side_t side, uint32_t id, const uint8_t expected[8]) {
    TEST_ASSERT_EQUAL_UINT32(1, f.sent_count);
    TEST_ASSERT_EQUAL_UINT32(f.call, f.sent[0].call);
    TEST_ASSERT_EQUAL_INT(side, f.sent[0].side);
    TEST_ASSERT_EQUAL_HEX32(id, f.sent[0].id);
    TEST_ASSERT_EQUAL_UINT8(8, f.sent[0].length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, f.sent[0].data, 8);
}

static uint32_t dropped(void) {
    return agv_supervisor_counters(&f.supervisor)->dropped;
}

static void expect_dropped(uint32_t id, const uint8_t data[8]) {
    const uint32_t before = dropped();
    from_ai(id, data);
    expect_silence(&f);
    TEST_ASSERT_EQUAL_UINT32(before + 1, dropped());
}

/* Commands with every reserved bit set, and as they must be sent. */
static const uint8_t SIGNALS[8] = {0xFF, 0xFF, 0xFF, 0xFF, 0xAF, 0xFF, 0xFF, 0x5A};
static const uint8_t SIGNALS_PACKED[8] = {0, 0, 0, 0, 0xA0, 0, 0, 0x5A};
static const uint8_t DRIVE[8] = {1, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
static const uint8_t DRIVE_PACKED[8] = {1};
static const uint8_t THROTTLE[8] = {77, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
static const uint8_t THROTTLE_PACKED[8] = {77};
static const uint8_t ANGLE[8] = {0x34, 0x22, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
static const uint8_t ANGLE_PACKED[8] = {0x34, 0x22};
static const uint8_t ZERO[8] = {0};

static const uint8_t NO_GEAR[8] = {3};
static const uint8_t TOO_MUCH_THROTTLE[8] = {251};
static const uint8_t TOO_MUCH_ANGLE[8] = {0x51, 0x46}; /* 18001 */

/* Silent for longer than half of each cycle: the next frame of each command passes at once. */
static void pause_ai(void) {
    fixture_mute_ai(&f, true);
    fixture_run(&f, 60);
}

/* ---- Commands ---- */

/* Shows: TOP-2, P14 */
void test_in_active_the_four_commands_pass_packed_anew(void) {
    fixture_active(&f);
    pause_ai();
    from_ai(0x43F, SIGNALS);
    expect_passed(HAL_CAN_VEHICLE, 0x43F, SIGNALS_PACKED);
    from_ai(0x168, DRIVE);
    expect_passed(HAL_CAN_VEHICLE, 0x168, DRIVE_PACKED);
    from_ai(0x075, THROTTLE);
    expect_passed(HAL_CAN_VEHICLE, 0x075, THROTTLE_PACKED);
    from_ai(0x065, ANGLE);
    expect_passed(HAL_CAN_VEHICLE, 0x065, ANGLE_PACKED);
}

/* Shows: TOP-2 */
void test_in_standby_only_43f_passes(void) {
    fixture_standby(&f);
    from_ai(0x43F, SIGNALS);
    expect_passed(HAL_CAN_VEHICLE, 0x43F, SIGNALS_PACKED);
    expect_dropped(0x168, DRIVE);
    expect_dropped(0x075, THROTTLE);
    expect_dropped(0x065, ANGLE);
}

/* Shows: TOP-2 */
void test_in_standby_all_four_pass_if_so_chosen_and_the_throttle_as_0(void) {
    f.config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    fixture_standby(&f);
    from_ai(0x43F, SIGNALS);
    expect_passed(HAL_CAN_VEHICLE, 0x43F, SIGNALS_PACKED);
    from_ai(0x168, DRIVE);
    expect_passed(HAL_CAN_VEHICLE, 0x168, DRIVE_PACKED);
    from_ai(0x075, THROTTLE);
    expect_passed(HAL_CAN_VEHICLE, 0x075, ZERO);
    from_ai(0x065, ANGLE);
    expect_passed(HAL_CAN_VEHICLE, 0x065, ANGLE_PACKED);
}

static void expect_no_command_passes(agv_state_t state) {
    expect_state(&f, state);
    expect_dropped(0x43F, SIGNALS);
    expect_dropped(0x168, DRIVE);
    expect_dropped(0x075, THROTTLE);
    expect_dropped(0x065, ANGLE);
}

/* Shows: TOP-2, FSM-6 */
void test_in_init_tripped_and_safe_no_command_passes(void) {
    for (uint16_t choice = AGV_IN_MANUAL_HEARTBEAT; choice <= AGV_IN_MANUAL_ALL; choice++) {
        setUp();
        f.config.gateway_in_manual = choice;
        fixture_start(&f);
        expect_no_command_passes(AGV_STATE_INIT);
        setUp();
        f.config.gateway_in_manual = choice;
        walk_to_tripped(&f);
        expect_no_command_passes(AGV_STATE_TRIPPED);
        setUp();
        f.config.gateway_in_manual = choice;
        walk_to_safe(&f);
        expect_no_command_passes(AGV_STATE_SAFE);
    }
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
    from_ai(0x201, SIGNALS);
    expect_passed(HAL_CAN_VEHICLE, 0x201, SIGNALS_PACKED);
    expect_dropped(0x43F, SIGNALS);
}

/* ---- Limits ---- */

static void expect_throttle(uint16_t ceiling_pct, uint8_t commanded, uint8_t passed) {
    const uint8_t command[8] = {commanded};
    const uint8_t expected[8] = {passed};
    setUp();
    f.config.throttle_ceiling_pct = ceiling_pct;
    fixture_active(&f);
    from_ai(0x075, command);
    expect_passed(HAL_CAN_VEHICLE, 0x075, expected);
}

/* 250 counts are 100 %. */
/* Shows: TOP-2 */
void test_the_throttle_is_limited_to_the_ceiling(void) {
    expect_throttle(100, 250, 250);
    expect_throttle(40, 250, 100);
    expect_throttle(40, 101, 100);
    expect_throttle(40, 100, 100);
    expect_throttle(40, 99, 99);
    expect_throttle(33, 250, 82); /* 82.5: never more than the ceiling */
    expect_throttle(1, 250, 2);
    expect_throttle(0, 250, 0);
}

static void expect_steering(uint16_t commanded, uint16_t passed) {
    const uint8_t command[8] = {(uint8_t)commanded, (uint8_t)(commanded >> 8)};
    const uint8_t expected[8] = {(uint8_t)passed, (uint8_t)(passed >> 8)};
    fixture_run(&f, 25);
    from_ai(0x065, command);
    expect_passed(HAL_CAN_VEHICLE, 0x065, expected);
}

/* Shows: TOP-2 */
void test_steering_is_not_limited_by_default(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    expect_steering(0, 0);
    expect_steering(18000, 18000);
}

/* 100.0 degrees a second are 2.5 degrees, 25 counts, in 25 ms. */
/* Shows: TOP-2 */
void test_steering_is_limited_to_the_slew_rate(void) {
    f.config.steering_slew_ddeg_s = 1000;
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_STEERING_COMMAND); /* 9000, as measured */
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    expect_steering(9060, 9025);
    expect_steering(9060, 9050);
    expect_steering(9060, 9060);
    expect_steering(8000, 9035);
    expect_steering(8000, 9010);
    expect_steering(9005, 9005);
}

/* The first command after the engagement starts from where the wheels are. */
/* Shows: TOP-2 */
void test_the_slew_rate_starts_from_the_measured_angle(void) {
    f.config.steering_slew_ddeg_s = 1000;
    fixture_angle(&f, 9300);
    fixture_standby(&f);
    fixture_mute_ai(&f, true);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state(&f, AGV_STATE_ACTIVE);
    expect_steering(9000, 9275);
}

/* So does the first command of the next engagement, independent of the last one of this engagement. */
/* Shows: TOP-2 */
void test_the_slew_rate_starts_anew_with_every_engagement(void) {
    f.config.steering_slew_ddeg_s = 1000;
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    expect_steering(9000, 9000);
    fixture_mode(&f, MODE_MANUAL);
    fixture_angle(&f, 9300);
    fixture_run(&f, 50);
    expect_state(&f, AGV_STATE_STANDBY);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_steering(9000, 9275);
}

/* 2.0 degrees a second are half a count in 25 ms: one count every 50 ms. */
/* Shows: TOP-2 */
void test_a_slow_slew_rate_adds_up(void) {
    f.config.steering_slew_ddeg_s = 20;
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_STEERING_COMMAND);
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    expect_steering(9010, 9000);
    expect_steering(9010, 9001);
    expect_steering(9010, 9001);
    expect_steering(9010, 9002);
    expect_steering(8000, 9002);
    expect_steering(8000, 9001);
}

/* Without a measured angle the rate starts from the first command. */
/* Shows: TOP-2 */
void test_without_a_measured_angle_the_slew_rate_starts_from_the_first_command(void) {
    f.config.steering_slew_ddeg_s = 1000;
    fixture_angle(&f, 18001);
    fixture_standby(&f);
    fixture_mute_ai(&f, true);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_steering(9400, 9400);
    expect_steering(9000, 9375);
}

/* ---- A side that accepts nothing ---- */

/* Shows: TOP-2 */
void test_towards_a_stalled_vehicle_side_the_newest_of_each_is_kept(void) {
    static const uint8_t reverse[8] = {2};
    static const uint8_t neutral[8] = {4};
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    const uint32_t before = dropped();
    from_ai(0x168, DRIVE);
    from_ai(0x168, reverse);
    from_ai(0x168, neutral);
    from_ai(0x075, THROTTLE);
    fixture_run(&f, 30);
    TEST_ASSERT_EQUAL_UINT32(before + 2, dropped());
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x168));
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(neutral, fixture_nth_sent(&f, 0x168, 0)->data, 8);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x075));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(THROTTLE_PACKED, fixture_nth_sent(&f, 0x075, 0)->data, 8);
    fixture_run(&f, 50);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168)); /* once */
    expect_state(&f, AGV_STATE_ACTIVE);
}

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
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x0A3));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(park, fixture_nth_sent(&f, 0x0A3, 0)->data, 8);
    expect_state(&f, AGV_STATE_STANDBY);
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

static void expect_nothing_passes(hal_can_side_t side, hal_can_frame_t frame) {
    fixture_forget_sent(&f);
    fixture_raw(&f, side, frame);
    expect_silence(&f);
}

static void expect_dropped_from(hal_can_side_t side, uint32_t id) {
    const uint32_t before = dropped();
    expect_nothing_passes(side, (hal_can_frame_t){.id = id, .length = 8});
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

/* Shows: TOP-2, INT-2, P15 */
void test_no_malformed_frame_passes(void) {
    static const uint32_t IDS[] = {0x43F, 0x168, 0x075, 0x065, 0x363, 0x0A3, 0x050, 0x067, 0x167, 0x267, 0x101};
    fixture_standby(&f); /* engaged, malformed commands trip */
    for (unsigned i = 0; i < sizeof IDS / sizeof IDS[0]; i++) {
        const hal_can_side_t side = i < 4 ? HAL_CAN_AI : HAL_CAN_VEHICLE;
        for (uint8_t length = 0; length < 8; length++) {
            expect_nothing_passes(side, (hal_can_frame_t){.id = IDS[i], .length = length});
        }
        for (uint8_t flags = 1; flags < 16; flags++) {
            expect_nothing_passes(side, (hal_can_frame_t){.id = IDS[i], .flags = flags, .length = 8});
        }
    }
    expect_state(&f, AGV_STATE_STANDBY);
}

/* Shows: TOP-2, FOREIGN_COMMAND_SENDER, SUP-6 */
void test_a_command_of_the_vehicle_side_passes_nowhere_and_trips(void) {
    fixture_active(&f);
    fixture_forget_sent(&f);
    const uint32_t before = dropped();
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x168, .length = 8, .data = {GEAR_P}});
    TEST_ASSERT_EQUAL_UINT32(before + 1, dropped());
    expect_reason(&f, AGV_FAULT_FOREIGN_COMMAND_SENDER);
    for (uint32_t i = 0; i < f.sent_count; i++) {
        TEST_ASSERT_EQUAL_INT(HAL_CAN_VEHICLE, f.sent[i].side);
        TEST_ASSERT_EQUAL_UINT32(f.call, f.sent[i].call);
    }
}

/* Shows: TOP-1 */
void test_on_the_shared_bus_the_ai_side_is_ignored(void) {
    f.config.topology = AGV_TOPOLOGY_SHARED;
    fixture_active(&f);
    expect_dropped(0x168, NO_GEAR);
    expect_dropped(0x363, ZERO);
    expect_state(&f, AGV_STATE_ACTIVE);
}

/* The third 363h without bit 8 ends the engagement. */
static void disengage(void) {
    fixture_mode(&f, MODE_MANUAL);
    for (unsigned i = 0; i < 3; i++) {
        fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    }
    expect_state(&f, AGV_STATE_STANDBY);
}

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
    fixture_run(&f, 50);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x065));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x075));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(ZERO, fixture_nth_sent(&f, 0x075, 0)->data, 8);
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
    from_ai(0x43F, SIGNALS);
    expect_passed(HAL_CAN_VEHICLE, 0x43F, SIGNALS_PACKED);
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
        from_ai(0x075, THROTTLE);
        expect_passed(HAL_CAN_VEHICLE, 0x075, THROTTLE_PACKED);
    }
}

/* ---- At most one frame in half a cycle ---- */

typedef struct {
    agv_message_t message;
    uint32_t id;
    uint32_t half_ms; /* the first whole millisecond of the other half */
    uint8_t first[8];
    uint8_t second[8];
    uint8_t third[8];
} too_soon_t;

static const too_soon_t TOO_SOON[] = {{AGV_MSG_TURN_SIGNAL_COMMAND,
                                       0x43F,
                                       50,
                                       {0, 0, 0, 0, 0x80, 0, 0, 1},
                                       {0, 0, 0, 0, 0x80, 0, 0, 2},
                                       {0, 0, 0, 0, 0x80, 0, 0, 3}},
                                      {AGV_MSG_GEAR_COMMAND, 0x168, 50, {8}, {4}, {8}},
                                      {AGV_MSG_THROTTLE_COMMAND, 0x075, 50, {10}, {20}, {30}},
                                      {AGV_MSG_STEERING_COMMAND, 0x065, 13, {0x28, 0x23}, {0x29, 0x23}, {0x2A, 0x23}}};

/* Only the test sends this command, and the last one is more than half a cycle ago. */
static void active_without(const too_soon_t *row) {
    setUp();
    fixture_active(&f);
    f.traffic[row->message].muted = true;
    fixture_run(&f, 60);
}

/* The first passes. The second and the third come too soon: the newest is sent once, at the end of the half cycle. */
static void check_newest(const too_soon_t *row) {
    active_without(row);
    const uint32_t before = dropped();
    from_ai(row->id, row->first);
    expect_passed(HAL_CAN_VEHICLE, row->id, row->first);
    fixture_run(&f, 1);
    from_ai(row->id, row->second);
    expect_silence(&f);
    fixture_run(&f, row->half_ms - 2);
    from_ai(row->id, row->third);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, row->id));
    TEST_ASSERT_EQUAL_UINT32(before + 1, dropped());
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, row->id));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(row->third, fixture_nth_sent(&f, row->id, 0)->data, 8);
    fixture_run(&f, row->half_ms - 1);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, row->id));
    from_ai(row->id, row->first); /* that one counted as a pass */
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, row->id));
    TEST_ASSERT_EQUAL_UINT32(before + 1, dropped());
}

static void check_in_time(const too_soon_t *row) {
    active_without(row);
    from_ai(row->id, row->first);
    fixture_run(&f, row->half_ms);
    from_ai(row->id, row->second);
    expect_passed(HAL_CAN_VEHICLE, row->id, row->second);
}

/* Shows: TOP-2 */
void test_of_commands_that_come_too_soon_the_newest_goes(void) {
    for (unsigned i = 0; i < 4; i++) {
        check_newest(&TOO_SOON[i]);
        check_in_time(&TOO_SOON[i]);
    }
}

/* 5 frames a millisecond for 950 ms: one each 50 ms is forwarded. */
/* Shows: TOP-2, SUP-6 */
void test_a_flood_from_the_ai_side_does_not_fill_the_vehicles_bus(void) {
    fixture_active(&f);
    pause_ai();
    fixture_mute_ai(&f, false);
    f.traffic[AGV_MSG_GEAR_COMMAND].muted = true;
    uint32_t passed = 0;
    const uint32_t before = dropped();
    for (unsigned i = 0; i < 5 * 950; i++) {
        from_ai(0x168, (const uint8_t[8]){GEAR_P});
        passed += fixture_count_sent(&f, 0x168);
        fixture_forget_sent(&f);
        if (i % 5 == 4) {
            fixture_run(&f, 1);
            passed += fixture_count_sent(&f, 0x168);
        }
    }
    TEST_ASSERT_UINT32_WITHIN(1, 20, passed);
    TEST_ASSERT_UINT32_WITHIN(1, 5 * 950 - 20, dropped() - before);
    expect_state(&f, AGV_STATE_ACTIVE);
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
    from_ai(0x168, park);
    expect_passed(HAL_CAN_VEHICLE, 0x168, park);
    from_ai(0x168, neutral);
    expect_dropped(0x168, NO_GEAR);
    fixture_run(&f, 50);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(neutral, fixture_nth_sent(&f, 0x168, 0)->data, 8);
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
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x075));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(ZERO, fixture_nth_sent(&f, 0x075, 0)->data, 8);
    TEST_ASSERT_EQUAL_UINT32(f.traffic[AGV_MSG_VEHICLE_STATUS].call, fixture_nth_sent(&f, 0x075, 0)->call);
    fixture_run(&f, 500);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x075));
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x065));
}

/* It does not count as forwarded: the next 075h of the AI computer (in manual, as 0) does not wait for it. */
/* Shows: TOP-2 */
void test_the_supervisors_throttle_0_is_no_pass(void) {
    f.config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    fixture_active(&f);
    pause_ai();
    disengage();
    from_ai(0x075, THROTTLE);
    expect_passed(HAL_CAN_VEHICLE, 0x075, ZERO);
}

/* On a shared bus nothing is sent: the AI computer commands there itself. */
/* Shows: TOP-1, TOP-2 */
void test_on_the_shared_bus_the_end_of_an_engagement_sends_nothing(void) {
    f.config.topology = AGV_TOPOLOGY_SHARED;
    fixture_active(&f);
    disengage();
    fixture_run(&f, 200);
    expect_silence(&f);
}

/* ---- Changes of the gear ---- */

static const uint8_t REVERSE[8] = {2};
static const uint8_t PARK[8] = {8};
static const uint8_t NEUTRAL[8] = {4};

/* The vehicle reports D and moves. */
static void active_on_the_move(void) {
    fixture_active(&f);
    fixture_drive(&f, 500);
    fixture_run(&f, 50);
    f.traffic[AGV_MSG_GEAR_COMMAND].muted = true;
    fixture_run(&f, 60);
}

/* Shows: TOP-2 */
void test_the_gear_does_not_change_to_d_or_r_in_motion(void) {
    active_on_the_move();
    expect_dropped(0x168, REVERSE);
    from_ai(0x168, DRIVE_PACKED); /* as reported */
    expect_passed(HAL_CAN_VEHICLE, 0x168, DRIVE_PACKED);
    fixture_run(&f, 50);
    from_ai(0x168, NEUTRAL);
    expect_passed(HAL_CAN_VEHICLE, 0x168, NEUTRAL);
    fixture_gear(&f, GEAR_N);
    fixture_run_past(&f, AGV_MSG_GEAR_STATUS);
    expect_dropped(0x168, DRIVE_PACKED); /* no longer as reported */
    fixture_run(&f, 50);
    from_ai(0x168, PARK);
    expect_passed(HAL_CAN_VEHICLE, 0x168, PARK);
}

/* Standstill is 100 ms of it. */
/* Shows: TOP-2 */
void test_the_gear_changes_at_standstill(void) {
    active_on_the_move();
    fixture_drive(&f, 0);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    fixture_run(&f, 99);
    expect_dropped(0x168, REVERSE);
    fixture_run(&f, 1);
    from_ai(0x168, REVERSE);
    expect_passed(HAL_CAN_VEHICLE, 0x168, REVERSE);
}

/* Shows: TOP-2 */
void test_the_gear_changes_in_motion_if_so_chosen(void) {
    f.config.gear_change = AGV_GEAR_CHANGE_ANY;
    active_on_the_move();
    from_ai(0x168, REVERSE);
    expect_passed(HAL_CAN_VEHICLE, 0x168, REVERSE);
}

/* A 168h that is dropped for this reason still refreshes its deadline. */
/* Shows: TOP-2, SUP-3, GEAR_COMMAND_TIMEOUT */
void test_a_gear_command_that_is_dropped_came_all_the_same(void) {
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = GEAR_R;
    fixture_active(&f);
    fixture_drive(&f, 500);
    f.long_run = true;
    fixture_run(&f, 2000);
    expect_state(&f, AGV_STATE_ACTIVE);
    fixture_forget_sent(&f);
    fixture_run(&f, 500);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x168));
}

/* ---- The rest of the envelope ---- */

static uint32_t limited(void) {
    return agv_supervisor_counters(&f.supervisor)->limited;
}

static void expect_rise(uint8_t commanded, uint8_t passed) {
    const uint32_t before = limited();
    const uint8_t command[8] = {commanded};
    const uint8_t expected[8] = {passed};
    from_ai(0x075, command);
    expect_passed(HAL_CAN_VEHICLE, 0x075, expected);
    TEST_ASSERT_EQUAL_UINT32(before + (commanded != passed ? 1u : 0u), limited());
    fixture_run(&f, 100);
}

/* 100 % a second is 25 counts in 100 ms, from 0 on; down at once. */
/* Shows: TOP-2 */
void test_the_throttle_rises_no_faster_than_its_rate(void) {
    f.config.throttle_rise_pct_s = 100;
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_THROTTLE_COMMAND);
    f.traffic[AGV_MSG_THROTTLE_COMMAND].muted = true;
    fixture_run(&f, 100);
    expect_rise(250, 25);
    expect_rise(250, 50);
    expect_rise(60, 60);
    expect_rise(250, 85);
    expect_rise(10, 10);
    expect_rise(250, 35);
    expect_rise(0, 0);
    expect_rise(250, 25);
}

/* With each engagement from 0. */
/* Shows: TOP-2 */
void test_the_rise_begins_anew_with_every_engagement(void) {
    f.config.throttle_rise_pct_s = 100;
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_THROTTLE_COMMAND);
    f.traffic[AGV_MSG_THROTTLE_COMMAND].muted = true;
    fixture_run(&f, 100);
    expect_rise(250, 25);
    expect_rise(250, 50);
    disengage();
    fixture_run(&f, 50);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_rise(250, 25);
}

/* 30.0 degrees to both sides above 1000 mm/s. */
static void active_and_fast(int32_t mm_s) {
    setUp();
    f.config.steering_fast_max_ddeg = 300;
    f.config.fast_mm_s = 1000;
    fixture_active(&f);
    fixture_drive(&f, mm_s);
    fixture_run(&f, 50);
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
}

/* Shows: TOP-2 */
void test_steering_is_limited_above_a_speed(void) {
    active_and_fast(1000);
    expect_steering(9400, 9400);
    TEST_ASSERT_EQUAL_UINT32(0, limited());
    active_and_fast(1001);
    expect_steering(9400, 9300);
    expect_steering(8600, 8700);
    TEST_ASSERT_EQUAL_UINT32(2, limited());
    expect_steering(9300, 9300);
    expect_steering(8700, 8700);
    TEST_ASSERT_EQUAL_UINT32(2, limited());
    active_and_fast(-1001);
    expect_steering(9400, 9300);
}

/* One wheel is enough, and a stale 101h (here a warning) counts as fast. */
/* Shows: TOP-2, WHEEL_SPEED_TIMEOUT */
void test_speeds_that_count_as_fast(void) {
    active_and_fast(0);
    fixture_wheels(&f, 0, 1001);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    expect_steering(9400, 9300);
    setUp();
    agv_fault_set_put(&f.config.trips, AGV_FAULT_WHEEL_SPEED_TIMEOUT, false);
    f.config.steering_fast_max_ddeg = 300;
    f.config.fast_mm_s = 1000;
    fixture_active(&f);
    f.traffic[AGV_MSG_WHEEL_SPEED].muted = true;
    fixture_run(&f, 100);
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    expect_steering(9400, 9300);
}

/* The slew rate applies to the limit, too: the vehicle becomes fast at 40.0 degrees; the limit is reached in steps of
 * 2.5. */
/* Shows: TOP-2 */
void test_the_slew_rate_applies_to_the_limit_above_a_speed(void) {
    f.config.steering_fast_max_ddeg = 300;
    f.config.fast_mm_s = 1000;
    f.config.steering_slew_ddeg_s = 1000;
    fixture_angle(&f, 9340);
    fixture_command_angle(&f, 9340);
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_STEERING_COMMAND);
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    fixture_drive(&f, 2000);
    expect_steering(9340, 9315);
    expect_steering(9340, 9300);
    expect_steering(9340, 9300);
}

/* An unchanged command is not counted as limited. */
/* Shows: TOP-2 */
void test_nothing_is_limited_by_default(void) {
    fixture_active(&f);
    f.long_run = true;
    fixture_run(&f, 2000);
    pause_ai();
    from_ai(0x075, (const uint8_t[8]){250, 0xFF});
    from_ai(0x065, (const uint8_t[8]){0x50, 0x46, 0xFF});
    TEST_ASSERT_EQUAL_UINT32(0, limited());
}

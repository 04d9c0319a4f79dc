/* The oracle itself: it allows the safe commands and reports each kind of forbidden frame. That it drops the
 * angle in manual is shown by a seeded fault of tests/proofs/explorer. */
#include "oracle.h"
#include "unity.h"

static oracle_t oracle;

static hal_can_frame_t frame_of(uint32_t id, uint8_t first, uint8_t second) {
    return (hal_can_frame_t){.id = id, .length = 8, .data = {first, second}};
}

static hal_can_frame_t signals(uint8_t fifth, uint8_t counter) {
    return (hal_can_frame_t){.id = 0x43F, .length = 8, .data = {0, 0, 0, 0, fifth, 0, 0, counter}};
}

static uint32_t forbidden(hal_can_side_t side, hal_can_frame_t frame, agv_state_t state) {
    const uint32_t before = oracle.forbidden;
    oracle_sent(&oracle, side, &frame, state);
    return oracle.forbidden - before;
}

/* 067h with this raw angle. */
static void measured(uint16_t raw) {
    const uint8_t counter = (uint8_t)(oracle.eps_counter + 1u);
    const hal_can_frame_t frame = {
        .id = 0x067, .length = 8, .data = {counter, 100, (uint8_t)raw, (uint8_t)(raw >> 8u)}, .time_ms = oracle.now_ms};
    oracle_heard(&oracle, HAL_CAN_VEHICLE, &frame);
}

/* 363h with these mode bits. */
static void reported(uint8_t bits) {
    const hal_can_frame_t frame = {
        .id = 0x363, .length = 8, .data = {0, 0, 0, 0, 0, 0, bits}, .time_ms = oracle.now_ms};
    oracle_heard(&oracle, HAL_CAN_VEHICLE, &frame);
}

void setUp(void) {
    oracle = (oracle_t){.signal_id = 0x43F, .vehicle_id = 0x363, .hold_age_ms = 50, .mode_invalid_ms = 50};
    oracle_restart(&oracle);
}

static void judge_commands_in(agv_state_t state) {
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, signals(0x70, 0), state));
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, signals(0x70, 255), state));
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 8, 0), state));
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 0, 0), state));

    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, signals(0x30, 0), state)); /* autopilot not off */
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, signals(0xF0, 0), state)); /* headlight off */
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, signals(0x60, 0), state)); /* no hazard lights */
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 1, 0), state));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 2, 0), state));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 4, 0), state));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 8, 1), state));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 1, 0), state));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x28, 0x23), state)); /* no angle is held */
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x363, 0, 0), state));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x123, 0, 0), state));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_AI, frame_of(0x363, 0, 0), state)); /* there is no AI side */

    hal_can_frame_t frame = frame_of(0x075, 0, 0);
    frame.length = 1;
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame, state));
    frame.length = 8;
    frame.flags = HAL_CAN_EXTENDED;
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame, state));
}

/* Shows: FSM-6 */
void test_only_safe_commands(void) {
    judge_commands_in(AGV_STATE_INIT);
    judge_commands_in(AGV_STATE_TRIPPED);
    judge_commands_in(AGV_STATE_SAFE);
    judge_commands_in((agv_state_t)0x00); /* an invalid state code is latched, too */
    judge_commands_in((agv_state_t)0x54);
    TEST_ASSERT_EQUAL(5 * 18, oracle.judged);
    TEST_ASSERT_EQUAL(5 * 14, oracle.forbidden);
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 8, 0), AGV_STATE_STANDBY));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, signals(0x70, 0), AGV_STATE_ACTIVE));
}

/* Shows: FSM-6, FSM-10 */
void test_the_held_angle_is_that_of_the_moment_of_the_trip(void) {
    measured(9100);
    oracle_returned(&oracle, AGV_STATE_ACTIVE);
    measured(9200);
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x8C, 0x23), AGV_STATE_TRIPPED)); /* 9100 */
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_TRIPPED)); /* 9200 */
    oracle_returned(&oracle, AGV_STATE_TRIPPED);
    measured(9100);
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x8C, 0x23), AGV_STATE_SAFE));
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_SAFE));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_INIT));
}

/* Shows: FSM-6, FSM-10 */
void test_an_eps_that_could_not_take_angles_gets_a_new_one(void) {
    hal_can_frame_t status = {.id = 0x167, .length = 8, .data = {0, 0, 0, 1, 0, 0, 0, 0}};
    measured(9200);
    oracle_returned(&oracle, AGV_STATE_TRIPPED);
    measured(9100);
    oracle_heard(&oracle, HAL_CAN_VEHICLE, &status);
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x8C, 0x23), AGV_STATE_TRIPPED)); /* 9100 */
    status.data[7] = 0x02;                                                                            /* over-voltage */
    oracle_heard(&oracle, HAL_CAN_VEHICLE, &status);
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x8C, 0x23), AGV_STATE_TRIPPED));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_TRIPPED)); /* 9200 */
}

/* Shows: FSM-6, FSM-10 */
void test_after_a_restart_the_first_valid_angle_is_held(void) {
    measured(9200);
    oracle_restart(&oracle);
    oracle_returned(&oracle, AGV_STATE_TRIPPED);
    measured(18001);
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_TRIPPED));
    measured(9100);
    measured(9200);
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x8C, 0x23), AGV_STATE_TRIPPED));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_TRIPPED));
}

/* Shows: FSM-6, FSM-10 */
void test_an_angle_of_more_than_50_ms_before_the_trip_is_not_held(void) {
    measured(9200);
    oracle.now_ms = 50;
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_TRIPPED));
    oracle_returned(&oracle, AGV_STATE_STANDBY);
    oracle.now_ms = 51;
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_TRIPPED));
    measured(9100);
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x8C, 0x23), AGV_STATE_TRIPPED));
}

/* A tick that is 51 ms late: the frames before it were handled late. */
/* Shows: FSM-6, FSM-10 */
void test_a_late_tick_replaces_an_angle_of_the_frames_before_it(void) {
    measured(9200);
    oracle_returned(&oracle, AGV_STATE_TRIPPED);
    measured(9100);
    oracle_tick(&oracle, 50);
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_TRIPPED)); /* 9200 */
    oracle_tick(&oracle, 101);
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_TRIPPED));
    oracle_restart(&oracle);
    measured(9200);
    oracle_returned(&oracle, AGV_STATE_TRIPPED);
    oracle.now_ms = 102;
    measured(9100); /* 8C 23 */
    oracle_tick(&oracle, 152);
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x8C, 0x23), AGV_STATE_TRIPPED));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0xF0, 0x23), AGV_STATE_TRIPPED));
}

/* Shows: FSM-6, TOP-2 */
void test_a_gateway_passes_only_motion_that_the_mode_allows(void) {
    oracle.gateway = true;
    oracle_returned(&oracle, AGV_STATE_ACTIVE);
    reported(0x40); /* one 363h does not end the engagement */
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 1, 0), AGV_STATE_ACTIVE));
    reported(0xC0);
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x28, 0x23), AGV_STATE_ACTIVE));
    reported(0x80);
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 1, 0), AGV_STATE_ACTIVE));
}

/* Shows: FSM-6, TOP-2 */
void test_one_throttle_0_ends_an_engagement(void) {
    oracle.gateway = true;
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 0, 0), AGV_STATE_STANDBY));
    oracle_returned(&oracle, AGV_STATE_ACTIVE);
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 1, 0), AGV_STATE_STANDBY));
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 0, 0), AGV_STATE_STANDBY));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 0, 0), AGV_STATE_STANDBY));
}

/* Shows: FSM-6, TOP-2 */
void test_frames_that_a_gateway_passes(void) {
    oracle.gateway = true;
    reported(0x80);
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, signals(0x80, 1), AGV_STATE_STANDBY));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, signals(0x81, 1), AGV_STATE_STANDBY)); /* a reserved bit */
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 1, 0), AGV_STATE_STANDBY));
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 1, 0), AGV_STATE_ACTIVE));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 3, 0), AGV_STATE_ACTIVE));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 1, 0), AGV_STATE_TRIPPED));
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 250, 0), AGV_STATE_ACTIVE));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 251, 0), AGV_STATE_ACTIVE));
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x50, 0x46), AGV_STATE_ACTIVE)); /* 18000 */
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x065, 0x51, 0x46), AGV_STATE_ACTIVE));
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_AI, frame_of(0x363, 0, 0), AGV_STATE_TRIPPED));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_AI, frame_of(0x168, 8, 0), AGV_STATE_ACTIVE));
    oracle.pass_all_in_manual = true;
    TEST_ASSERT_EQUAL(0, forbidden(HAL_CAN_VEHICLE, frame_of(0x168, 1, 0), AGV_STATE_STANDBY));
    TEST_ASSERT_EQUAL(1, forbidden(HAL_CAN_VEHICLE, frame_of(0x075, 1, 0), AGV_STATE_STANDBY));
}

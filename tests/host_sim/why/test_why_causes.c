/* When a cause began, by kind: frames and trips are fed by hand. */
#include "unity.h"
#include "why_feed.h"

#define AUTOPILOT "\0\0\0\0\0\0\x80"
static why_t *why;
static agv_config_t config;

void setUp(void) {
    agv_config_defaults(&config);
    why = why_new(&config);
    TEST_ASSERT_NOT_NULL(why);
}

void tearDown(void) {
    why_free(why);
}

static const why_trip_t *trip_by(agv_fault_t fault, uint64_t t_ms) {
    feed_trip(why, (uint8_t)fault, t_ms);
    TEST_ASSERT_EQUAL_UINT(1, why_trip_count(why));
    return why_trip(why, 0);
}

void test_silence_begins_a_cycle_after_the_last_frame(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1025);
    const why_trip_t *trip = trip_by(AGV_FAULT_GEAR_STATUS_TIMEOUT, 1151);
    TEST_ASSERT_EQUAL(WHY_SILENCE, trip->kind);
    TEST_ASSERT_EQUAL_HEX32(0x0A3, trip->id);
    TEST_ASSERT_EQUAL_UINT64(1025000, trip->last_good_us);
    TEST_ASSERT_EQUAL_UINT64(1050000, trip->cause_us);
    TEST_ASSERT_EQUAL_INT64(125, trip->limit);
    TEST_ASSERT_EQUAL_UINT(2, trip->evidence_count);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->next_us);
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1300);
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1325);
    TEST_ASSERT_EQUAL_UINT64(1300000, why_trip(why, 0)->next_us);
    TEST_ASSERT_EQUAL_UINT(3, why_trip(why, 0)->evidence_count); /* the frame that ended it is shown too */
}

void test_a_frame_of_another_length_does_not_end_a_silence(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1000);
    const hal_can_frame_t shorter = {.id = 0x0A3, .length = 7};
    why_frame(why, HAL_CAN_VEHICLE, &shorter, 1020000);
    TEST_ASSERT_EQUAL_UINT64(1000000, trip_by(AGV_FAULT_GEAR_STATUS_TIMEOUT, 1126)->last_good_us);
}

void test_a_message_that_never_came(void) {
    feed_state(why, 0, AGV_STATE_INIT, AGV_FAULT_NONE, 5);
    const why_trip_t *trip = trip_by(AGV_FAULT_EPS_STATUS_TIMEOUT, 100);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->last_good_us);
    TEST_ASSERT_EQUAL_UINT64(5000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT(0, trip->evidence_count);
}

void test_a_command_is_silent_from_the_engagement_on(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x168, "\x08\0\0\0\0\0\0", 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 5000);
    const why_trip_t *trip = trip_by(AGV_FAULT_GEAR_COMMAND_TIMEOUT, 5351);
    TEST_ASSERT_EQUAL_UINT64(1000000, trip->last_good_us);
    TEST_ASSERT_EQUAL_UINT64(5000000, trip->cause_us);
}

void test_an_ai_computer_that_was_never_seen_has_a_deadline_of_its_own(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 5000);
    const why_trip_t *trip = trip_by(AGV_FAULT_AI_HEARTBEAT_LOST, 5501);
    TEST_ASSERT_EQUAL_INT64(500, trip->limit);
    TEST_ASSERT_EQUAL_UINT64(5000000, trip->cause_us);
}

void test_a_counter_that_is_stuck(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x01\0\0\0\0\0\0", 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x02\0\0\0\0\0\0", 1010);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x02\0\0\0\0\0\0", 1020);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x02\0\0\0\0\0\0", 1030);
    const why_trip_t *trip = trip_by(AGV_FAULT_EPS_HEARTBEAT_STUCK, 1061);
    TEST_ASSERT_EQUAL(WHY_STUCK, trip->kind);
    TEST_ASSERT_EQUAL_UINT64(1010000, trip->last_good_us);
    TEST_ASSERT_EQUAL_UINT64(1020000, trip->cause_us);
}

void test_a_wrong_step_counts_as_stuck_where_the_counter_has_to_increment(void) {
    config.eps_counter = AGV_COUNTER_INCREMENTS;
    why_free(why);
    why = why_new(&config);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x01\0\0\0\0\0\0", 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x02\0\0\0\0\0\0", 1010);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x20\0\0\0\0\0\0", 1020);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x01\0\0\0\0\0\0", 1030);
    TEST_ASSERT_EQUAL_UINT64(1020000, trip_by(AGV_FAULT_EPS_HEARTBEAT_STUCK, 1061)->cause_us);
}

void test_a_bit_began_with_the_first_frame_that_has_it(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\x01\0\x40", 900); /* an earlier time */
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\0\0\x40\x01", 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\x01\0\x40\x02", 1010);
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\x01\0\x40\x03", 1020);
    const why_trip_t *trip = trip_by(AGV_FAULT_REMOTE_SIGNAL_LOST, 1020);
    TEST_ASSERT_EQUAL(WHY_BIT, trip->kind);
    TEST_ASSERT_EQUAL_UINT64(1010000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT64(1000000, trip->last_good_us);
    TEST_ASSERT_NULL(trip->unit);
}

void test_a_score_began_where_it_left_0(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0\x01", 1000); /* 2 */
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0\0", 1010);   /* 1 */
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0\0", 1020);   /* 0 */
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0\x01", 1030); /* 2: here */
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0\0", 1040);   /* 1 */
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0\x01", 1050); /* 3 */
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0\x01", 1060); /* 5 */
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0\x01", 1070); /* 6 */
    const why_trip_t *trip = trip_by(AGV_FAULT_EPS_UNDER_VOLTAGE, 1070);
    TEST_ASSERT_EQUAL(WHY_SCORE, trip->kind);
    TEST_ASSERT_EQUAL_UINT64(1030000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT64(1020000, trip->last_good_us);
    TEST_ASSERT_EQUAL_STRING("frames", trip->unit);
}

void test_a_mode_of_the_eps_counts_from_the_engagement_on(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\0\0\0\0", 900); /* assists, in manual */
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000);
    for (uint64_t t_ms = 1010; t_ms <= 1540; t_ms += 10) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\0\0\0\0", t_ms);
    }
    TEST_ASSERT_EQUAL_UINT64(1000000, trip_by(AGV_FAULT_EPS_MODE_NOT_ANGLE, 1540)->cause_us);
}

void test_a_budget_began_with_the_condition(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x065, "\x28\x23\0\0\0\0\0", 1001);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x01\x64\x28\x23\0\0\0", 1990);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x02\x64\x1D\x25\0\0\0", 2000); /* 501: 50.1 deg off */
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x03\x64\x1D\x25\0\0\0", 2490);
    const why_trip_t *trip = trip_by(AGV_FAULT_STEERING_DEVIATION, 2500);
    TEST_ASSERT_EQUAL(WHY_BUDGET, trip->kind);
    TEST_ASSERT_EQUAL_UINT64(2000000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT64(1990000, trip->last_good_us);
    TEST_ASSERT_EQUAL_INT64(500, trip->limit);
    TEST_ASSERT_EQUAL_STRING("ddeg", trip->unit);
}

void test_progress_begins_a_budget_anew(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x065, "\x28\x23\0\0\0\0\0", 1001);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x02\x64\x28\x2B\0\0\0", 2000); /* 204.8 deg off */
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x03\x64\x28\x27\0\0\0", 2300); /* 102.4 deg off: better by 102.4 */
    TEST_ASSERT_EQUAL_UINT64(2300000, trip_by(AGV_FAULT_STEERING_DEVIATION, 2800)->cause_us);
}

void test_a_fourth_engagement(void) {
    for (uint64_t i = 0; i < 4; i++) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000 + (i * 1000));
        for (uint64_t off = 1; off <= 3; off++) {
            feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\0\0\x40", 1000 + (i * 1000) + (off * 10));
        }
    }
    const why_trip_t *trip = trip_by(AGV_FAULT_MODE_FLAPPING, 4000);
    TEST_ASSERT_EQUAL_UINT64(1000000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT(4, trip->evidence_count);
}

void test_the_command_that_is_out_of_range(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x065, "\x28\x23\0\0\0\0\0", 1020);
    feed_frame(why, HAL_CAN_VEHICLE, 0x065, "\x51\x46\0\0\0\0\0", 1045); /* 18001 */
    const why_trip_t *trip = trip_by(AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, 1045);
    TEST_ASSERT_EQUAL(WHY_VALUE, trip->kind);
    TEST_ASSERT_EQUAL(AGV_MSG_STEERING_COMMAND, trip->message);
    TEST_ASSERT_EQUAL_UINT64(1045000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT64(1020000, trip->last_good_us);
    TEST_ASSERT_EQUAL_INT64(18000, trip->limit);
    TEST_ASSERT_EQUAL_STRING("ddeg", trip->unit);
}

void test_a_command_of_another_length(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000);
    const hal_can_frame_t shorter = {.id = 0x075, .length = 2};
    why_frame(why, HAL_CAN_VEHICLE, &shorter, 1100000);
    const why_trip_t *trip = trip_by(AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, 1100);
    TEST_ASSERT_EQUAL(AGV_MSG_THROTTLE_COMMAND, trip->message);
    TEST_ASSERT_EQUAL_INT64(WHY_NO_LIMIT, trip->limit);
}

void test_the_command_that_comes_too_fast(void) {
    for (uint64_t i = 0; i <= 10; i++) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x168, "\x08\0\0\0\0\0\0", 1000 + (i * 30));
        feed_frame(why, HAL_CAN_VEHICLE, 0x075, "\0\0\0\0\0\0\0", 1000 + (i * 100));
    }
    const why_trip_t *trip = trip_by(AGV_FAULT_COMMAND_TOO_FAST, 1300);
    TEST_ASSERT_EQUAL(AGV_MSG_GEAR_COMMAND, trip->message);
    TEST_ASSERT_EQUAL_UINT64(1030000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT64(1000000, trip->last_good_us);
    TEST_ASSERT_EQUAL_INT64(10, trip->limit);
}

void test_an_error_frame_shows_a_bus_off(void) {
    const hal_can_frame_t error = {.id = 0x40, .length = 8, .flags = HAL_CAN_ERROR};
    why_frame(why, HAL_CAN_VEHICLE, &error, 2000500);
    const why_trip_t *trip = trip_by(AGV_FAULT_BUS_OFF, 2001);
    TEST_ASSERT_EQUAL(WHY_BUS, trip->kind);
    TEST_ASSERT_EQUAL_UINT64(2000500, trip->cause_us);
    TEST_ASSERT_EQUAL_HEX32(WHY_NO_ID, trip->id);
}

/* Trips, states and faults over a run. The kind of each fault that a campaign causes: program/logs/why_campaign.py. */
#include "one_why.h"

void test_how_long_each_state_lasted(void) {
    feed_state(why, 0, AGV_STATE_INIT, AGV_FAULT_NONE, 0);
    feed_state(why, AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_FAULT_NONE, 510);
    feed_state(why, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_FAULT_NONE, 1000);
    feed_state(why, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED, AGV_FAULT_EMERGENCY_STOP, 3000);
    feed_state(why, AGV_STATE_TRIPPED, AGV_STATE_SAFE, AGV_FAULT_NONE, 3300);
    feed_state(why, AGV_STATE_SAFE, AGV_STATE_TRIPPED, AGV_FAULT_NONE, 3400); /* withdrawn: no other trip */
    feed_state(why, AGV_STATE_TRIPPED, AGV_STATE_SAFE, AGV_FAULT_NONE, 3600);
    why_end(why, 5000000);
    const uint64_t expected_us[WHY_STATES] = {510000, 490000, 2000000, 500000, 1500000};
    for (size_t i = 0; i < WHY_STATES; i++) {
        TEST_ASSERT_EQUAL_UINT64(expected_us[i], why_state_us(why, i));
    }
    TEST_ASSERT_EQUAL_UINT64(4490000, why_supervised_us(why));
    TEST_ASSERT_EQUAL_UINT(1, why_trip_count(why));
    TEST_ASSERT_EQUAL_UINT64(3300000, why_trip(why, 0)->confirmed_us); /* for the first time */
}

void test_the_time_without_power_is_not_supervised(void) {
    const session_event_t again = {
        .t_ms = 3500,
        .stopped_ms = 3000,
        .recorded = {.kind = AGV_EVENT_STATE, .b = AGV_STATE_TRIPPED, .c = AGV_FAULT_SUPERVISOR_RESET}};
    feed_state(why, 0, AGV_STATE_INIT, AGV_FAULT_NONE, 0);
    feed_state(why, AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_FAULT_NONE, 510);
    feed_fault(why, AGV_FAULT_WRONG_ID_SET, AGV_CLASS_WARN, true, 2900);
    why_event(why, &again);
    why_end(why, 4000000);
    TEST_ASSERT_EQUAL_UINT64(2990000, why_supervised_us(why)); /* 510 to 3000, 3500 to 4000 */
    TEST_ASSERT_EQUAL_UINT64(100000, why_fault(why, 0)->active_us);
    TEST_ASSERT_FALSE(why_fault(why, 0)->active);
}

void test_a_run_that_begins_in_tripped_does_not_know_the_cause(void) {
    feed_state(why, 0, AGV_STATE_TRIPPED, AGV_FAULT_STEERING_COMMAND_TIMEOUT, 0);
    feed_frame(why, HAL_CAN_VEHICLE, 0x065, "\0\0\0\0\0\0\0", 6);
    const why_trip_t *trip = why_trip(why, 0);
    TEST_ASSERT_TRUE(trip->from_earlier_run);
    TEST_ASSERT_EQUAL_INT(WHY_SILENCE, trip->kind);
    TEST_ASSERT_EQUAL_INT(AGV_MSG_STEERING_COMMAND, trip->message);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->cause_us);
    TEST_ASSERT_EQUAL_INT64(WHY_NO_LIMIT, trip->limit);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->next_us);
    TEST_ASSERT_EQUAL_UINT(0, trip->evidence_count);
}

void test_what_the_start_itself_finds_is_of_this_run(void) {
    feed_state(why, 0, AGV_STATE_TRIPPED, AGV_FAULT_SUPERVISOR_RESET, 0);
    TEST_ASSERT_FALSE(why_trip(why, 0)->from_earlier_run);
    TEST_ASSERT_EQUAL_UINT64(0, why_trip(why, 0)->cause_us);
}

void test_when_a_warning_became_a_fault_that_trips(void) {
    feed_fault(why, AGV_FAULT_AI_HEARTBEAT_LOST, AGV_CLASS_WARN, true, 1000);
    feed_fault(why, AGV_FAULT_AI_HEARTBEAT_LOST, AGV_CLASS_TRIP, true, 3000);
    TEST_ASSERT_EQUAL_UINT64(1000000, why_fault(why, 0)->first_us);
    TEST_ASSERT_EQUAL_UINT64(3000000, why_fault(why, 0)->trip_us);
}

void test_the_first_safe_frame_may_be_reported_before_the_trip(void) {
    const hal_can_frame_t park = {.id = 0x168, .length = 8, .data = {0x08}};
    const hal_can_frame_t drive = {.id = 0x168, .length = 8, .data = {0x01}};
    feed_state(why, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_FAULT_NONE, 1000);
    why_sent(why, HAL_CAN_VEHICLE, &drive, 2000200);
    why_sent(why, HAL_CAN_VEHICLE, &park, 2000300);
    feed_trip(why, AGV_FAULT_EMERGENCY_STOP, 2000);
    TEST_ASSERT_EQUAL_UINT64(2000300, why_trip(why, 0)->first_safe_us);
}

void test_a_safe_frame_of_long_before_is_not_the_first(void) {
    const hal_can_frame_t park = {.id = 0x168, .length = 8, .data = {0x08}};
    why_sent(why, HAL_CAN_VEHICLE, &park, 1000000);
    feed_trip(why, AGV_FAULT_EMERGENCY_STOP, 2000);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, why_trip(why, 0)->first_safe_us);
    why_sent(why, HAL_CAN_AI, &park, 2001000);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, why_trip(why, 0)->first_safe_us);
    why_sent(why, HAL_CAN_VEHICLE, &park, 2002000);
    TEST_ASSERT_EQUAL_UINT64(2002000, why_trip(why, 0)->first_safe_us);
}

void test_when_it_stands(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x101, "\x2C\x01\0\0\x2C\x01\0", 1000); /* 300 mm/s */
    feed_trip(why, AGV_FAULT_EMERGENCY_STOP, 2000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x101, "\x32\0\0\0\0\0\0", 2100); /* 50 mm/s: not slower than the limit */
    feed_frame(why, HAL_CAN_VEHICLE, 0x101, "\x31\0\0\0\x31\0\0", 2200);
    TEST_ASSERT_EQUAL_UINT64(2200000, why_trip(why, 0)->stopped_us);
}

void test_what_a_recording_cannot_obey(void) {
    why_is_recording(why);
    feed_trip(why, AGV_FAULT_EMERGENCY_STOP, 2000);
    feed_fault(why, AGV_FAULT_SAFE_STATE_UNCONFIRMED, AGV_CLASS_TRIP, true, 2500);
    feed_fault(why, AGV_FAULT_EPS_TEMP_ABOVE_110, AGV_CLASS_WARN, true, 2600);
    TEST_ASSERT_EQUAL_UINT(2, why_trip_count(why));
    TEST_ASSERT_FALSE(why_trip(why, 0)->from_recording);
    TEST_ASSERT_TRUE(why_trip(why, 1)->from_recording);
    TEST_ASSERT_EQUAL(WHY_VEHICLE, why_trip(why, 1)->kind);
    TEST_ASSERT_TRUE(why_fault(why, 1)->from_recording);
    TEST_ASSERT_FALSE(why_fault(why, 2)->from_recording);
}

void test_a_vehicle_that_is_there_could_have_obeyed(void) {
    feed_trip(why, AGV_FAULT_EMERGENCY_STOP, 2000);
    feed_fault(why, AGV_FAULT_VEHICLE_NOT_STOPPING, AGV_CLASS_TRIP, true, 7000);
    TEST_ASSERT_FALSE(why_trip(why, 1)->from_recording);
    TEST_ASSERT_EQUAL_UINT64(2000000, why_trip(why, 1)->cause_us); /* the trip, 5000 ms before */
}

void test_faults_in_the_order_of_their_first_time(void) {
    feed_state(why, 0, AGV_STATE_INIT, AGV_FAULT_NONE, 0);
    feed_fault(why, AGV_FAULT_WRONG_ID_SET, AGV_CLASS_WARN, true, 100);
    feed_state(why, AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_FAULT_NONE, 150);
    feed_fault(why, AGV_FAULT_BUS_OFF, AGV_CLASS_TRIP, true, 200);
    feed_fault(why, AGV_FAULT_WRONG_ID_SET, AGV_CLASS_WARN, false, 300);
    feed_fault(why, AGV_FAULT_WRONG_ID_SET, AGV_CLASS_WARN, true, 400);
    why_end(why, 1000000);
    TEST_ASSERT_EQUAL_UINT(2, why_fault_count(why));
    const why_fault_t *first = why_fault(why, 0);
    TEST_ASSERT_EQUAL(AGV_FAULT_WRONG_ID_SET, first->fault);
    TEST_ASSERT_EQUAL_UINT64(100000, first->first_us);
    TEST_ASSERT_EQUAL_UINT32(2, first->times);
    TEST_ASSERT_EQUAL_UINT64(800000, first->active_us);
    TEST_ASSERT_TRUE(first->active);
    TEST_ASSERT_FALSE(first->in_init); /* the second time it was not */
    TEST_ASSERT_EQUAL_UINT64(800000, why_fault(why, 1)->active_us);
}

void test_in_init_only_an_unresettable_fault_trips(void) {
    feed_state(why, 0, AGV_STATE_INIT, AGV_FAULT_NONE, 0);
    feed_fault(why, AGV_FAULT_EPS_TEMP_ABOVE_120, AGV_CLASS_TRIP, true, 100);
    feed_fault(why, AGV_FAULT_OUTPUT_FEEDBACK, AGV_CLASS_TRIP, true, 200);
    TEST_ASSERT_TRUE(why_did_not_trip(why_fault(why, 0)));
    TEST_ASSERT_FALSE(why_did_not_trip(why_fault(why, 1)));
}

void test_a_fault_that_is_raised_again_with_another_class_is_one_time(void) {
    feed_fault(why, AGV_FAULT_AI_HEARTBEAT_LOST, AGV_CLASS_WARN, true, 100);
    feed_fault(why, AGV_FAULT_AI_HEARTBEAT_LOST, AGV_CLASS_TRIP, true, 300);
    TEST_ASSERT_EQUAL_UINT32(1, why_fault(why, 0)->times);
    TEST_ASSERT_EQUAL(AGV_CLASS_TRIP, why_fault(why, 0)->fault_class);
}

void test_what_init_lacked(void) {
    feed_state(why, 0, AGV_STATE_INIT, AGV_FAULT_NONE, 0);
    for (uint64_t t_ms = 0; t_ms <= 3000; t_ms += 10) {
        const char vcu[9] = {0, 0, 0, 0, 0, 0, (char)0x80, (char)(t_ms / 10)};
        feed_frame(why, HAL_CAN_VEHICLE, 0x363, vcu, t_ms);
    }
    why_end(why, 3000000);
    TEST_ASSERT_EQUAL_HEX16(AGV_MISSING_MANUAL | AGV_MISSING_EPS_HEARTBEAT | AGV_MISSING_MESSAGES |
                                AGV_MISSING_STANDSTILL, /* no 101h */
                            why_missing(why));
    TEST_ASSERT_EQUAL_UINT64(0, why_supervised_us(why));
}

/* The supervisor names what held at 10 s; the traffic names what held at the end. */
void test_what_init_lacked_is_what_supervisor_and_traffic_say(void) {
    const session_event_t startup = {
        .t_ms = 10001, .recorded = {.kind = AGV_EVENT_STARTUP, .missing = AGV_MISSING_OUTPUT | AGV_MISSING_MANUAL}};
    feed_state(why, 0, AGV_STATE_INIT, AGV_FAULT_NONE, 0);
    why_event(why, &startup);
    why_end(why, 11000000);
    TEST_ASSERT_EQUAL_HEX16(AGV_MISSING_OUTPUT | AGV_MISSING_MANUAL | AGV_MISSING_VCU_HEARTBEAT |
                                AGV_MISSING_EPS_HEARTBEAT | AGV_MISSING_STANDSTILL | AGV_MISSING_MESSAGES,
                            why_missing(why));
}

static const char *pending(agv_fault_t fault) {
    static text_t text;
    text_clear(&text);
    return why_words_pending(&text, why, fault) ? text.bytes : NULL;
}

void test_a_command_counts_from_the_engagement_on_at_the_end_too(void) {
    feed_state(why, AGV_STATE_INIT, AGV_STATE_ACTIVE, AGV_FAULT_NONE, 900);
    feed_frame(why, HAL_CAN_VEHICLE, 0x065, "\0\0\0\0\0\0\0", 880);
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\0\0\x80", 1000);
    why_end(why, 1094000);
    TEST_ASSERT_EQUAL_STRING("065h steering_command was silent for 94 ms, deadline 125 ms",
                             pending(AGV_FAULT_STEERING_COMMAND_TIMEOUT));
}

void test_the_usual_cycle_of_a_slow_sender_is_no_silence(void) {
    feed_state(why, AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_FAULT_NONE, 900);
    for (char i = 0; i < 5; i++) {
        const char signals[9] = {0, 0, 0, 0, 0, 0, 0, i};
        feed_frame(why, HAL_CAN_VEHICLE, 0x43F, signals, 1000 + ((uint64_t)i * 300));
    }
    why_end(why, 2500000); /* 300 ms after the last one */
    TEST_ASSERT_NULL(pending(AGV_FAULT_AI_HEARTBEAT_LOST));
    why_end(why, 2700000);
    TEST_ASSERT_EQUAL_STRING("43Fh turn_signal_command was silent for 500 ms, deadline 350 ms",
                             pending(AGV_FAULT_AI_HEARTBEAT_LOST));
}

void test_an_ai_computer_that_never_came_has_begun_to_be_missing(void) {
    feed_state(why, AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_FAULT_NONE, 900);
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\0\0\x80", 1000);
    why_end(why, 1300000);
    TEST_ASSERT_EQUAL_STRING("43Fh turn_signal_command was silent for 300 ms, deadline 500 ms",
                             pending(AGV_FAULT_AI_HEARTBEAT_LOST));
    TEST_ASSERT_NULL(pending(AGV_FAULT_AI_HEARTBEAT_STUCK));
}

void test_a_bit_that_does_not_count_has_not_begun(void) {
    feed_state(why, AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_FAULT_NONE, 900);
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\x08\0\x40", 1000);
    why_end(why, 1005000);
    TEST_ASSERT_NULL(pending(AGV_FAULT_VCU_AI_CAN_LOST));
}

void test_a_vcu_that_reports_no_speed_is_not_compared(void) {
    feed_state(why, AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_FAULT_NONE, 900);
    feed_frame(why, HAL_CAN_VEHICLE, 0x101, "\xE8\x03\0\0\xE8\x03\0", 1000); /* 1000 mm/s */
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\0\0\x40", 1010);
    why_end(why, 1500000);
    TEST_ASSERT_NULL(pending(AGV_FAULT_SPEED_IMPLAUSIBLE));
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\x01\0\0\0\0\0\x40", 1520);
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\0\0\x40", 1530);
    why_end(why, 1600000);
    TEST_ASSERT_EQUAL_STRING("SPEED_IMPLAUSIBLE had begun at 1.520 s", pending(AGV_FAULT_SPEED_IMPLAUSIBLE));
}

void test_bad_modes_at_the_end_are_named_after_the_last_one(void) {
    feed_state(why, AGV_STATE_INIT, AGV_STATE_ACTIVE, AGV_FAULT_NONE, 900);
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\0\0\x80", 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\xFF\0\0\0", 1500);
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\0\0\0\0", 1510);
    why_end(why, 1515000);
    TEST_ASSERT_NULL(pending(AGV_FAULT_EPS_MODE_OFF));
    TEST_ASSERT_NULL(pending(AGV_FAULT_EPS_MODE_INVALID));
    TEST_ASSERT_EQUAL_STRING("EPS_MODE_NOT_ANGLE had begun at 1.500 s", pending(AGV_FAULT_EPS_MODE_NOT_ANGLE));
}

/* Less than mode_frames 363h without autopilot: it is engaged, but not judged. */
void test_what_is_not_judged_has_not_begun(void) {
    feed_state(why, AGV_STATE_INIT, AGV_STATE_ACTIVE, AGV_FAULT_NONE, 900);
    for (uint64_t t_ms = 1000; t_ms < 1600; t_ms += 10) {
        feed_mode(why, 0x80, t_ms);
    }
    feed_mode(why, 0, 1600);
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\0\0\0\0", 1601);
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1602);
    feed_frame(why, HAL_CAN_VEHICLE, 0x050, "\x64\0\0\0\0\0\0", 1603); /* throttle in P */
    feed_mode(why, 0x80, 1610);
    why_end(why, 1611000);
    TEST_ASSERT_NULL(pending(AGV_FAULT_EPS_MODE_NOT_ANGLE));
    TEST_ASSERT_NULL(pending(AGV_FAULT_THROTTLE_IN_PARK));
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1612);
    TEST_ASSERT_EQUAL_STRING("THROTTLE_IN_PARK had begun at 1.603 s", pending(AGV_FAULT_THROTTLE_IN_PARK));
}

void test_the_limit_of_moving_while_safe_is_no_setting(void) {
    feed_trip(why, AGV_FAULT_EMERGENCY_STOP, 2000);
    feed_fault(why, AGV_FAULT_MOVING_WHILE_SAFE, AGV_CLASS_TRIP, true, 7000);
    TEST_ASSERT_EQUAL(WHY_VEHICLE, why_trip(why, 1)->kind);
    TEST_ASSERT_EQUAL_INT64(200, why_trip(why, 1)->limit);
    TEST_ASSERT_EQUAL_STRING("ms", why_trip(why, 1)->unit);
}

/* 363h and 0A3h every 10 ms, from a time on to before another. */
static void report(uint8_t mode, char gear, uint64_t from_ms, uint64_t to_ms) {
    const char bytes[8] = {gear};
    for (uint64_t t_ms = from_ms; t_ms < to_ms; t_ms += 10) {
        feed_mode(why, mode, t_ms);
        feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, bytes, t_ms);
    }
}

static void trip_and_park(uint64_t t_ms) {
    const hal_can_frame_t park = {.id = 0x168, .length = 8, .data = {0x08}};
    why_sent(why, HAL_CAN_VEHICLE, &park, t_ms * 1000);
    feed_trip(why, AGV_FAULT_EMERGENCY_STOP, t_ms);
}

static void check_unconfirmed(uint64_t t_ms, agv_message_t message, uint64_t cause_ms) {
    feed_fault(why, AGV_FAULT_SAFE_STATE_UNCONFIRMED, AGV_CLASS_TRIP, true, t_ms);
    const why_trip_t *trip = why_trip(why, why_trip_count(why) - 1);
    TEST_ASSERT_EQUAL(message, trip->message);
    TEST_ASSERT_EQUAL_UINT64(cause_ms * 1000, trip->cause_us);
    feed_fault(why, AGV_FAULT_SAFE_STATE_UNCONFIRMED, AGV_CLASS_TRIP, false, t_ms);
}

enum { MANUAL = 0x40, AUTOPILOT = 0x80, D = 1, P = 8 };

void test_the_autopilot_was_not_off_in_time(void) {
    report(AUTOPILOT, D, 1000, 2000);
    trip_and_park(2000);
    report(AUTOPILOT, D, 2010, 2100);
    report(AUTOPILOT, P, 2100, 2490);
    report(MANUAL, P, 2490, 2500); /* the first of three */
    check_unconfirmed(2500, AGV_MSG_VEHICLE_STATUS, 2000);
    TEST_ASSERT_EQUAL_STRING("autopilot off", why_unconfirmed(why_trip(why, 0)));
}

/* 400 ms and 100 ms. It is cleared by 5 s with both confirmed. */
void test_the_time_without_p_is_added_up(void) {
    report(MANUAL, D, 1000, 2000);
    trip_and_park(2000);
    report(MANUAL, D, 2010, 2400);
    report(MANUAL, P, 2400, 3000);
    report(MANUAL, D, 3000, 3110);
    check_unconfirmed(3100, AGV_MSG_GEAR_STATUS, 2000);
    report(MANUAL, P, 3110, 8120);
    report(MANUAL, D, 8120, 8630);
    check_unconfirmed(8620, AGV_MSG_GEAR_STATUS, 8120);
}

void test_p_is_expected_once_it_was_sent(void) {
    report(MANUAL, D, 1000, 2000);
    feed_trip(why, AGV_FAULT_EMERGENCY_STOP, 2000);
    report(MANUAL, D, 2010, 3000);
    const hal_can_frame_t park = {.id = 0x168, .length = 8, .data = {0x08}};
    why_sent(why, HAL_CAN_VEHICLE, &park, 3000000);
    report(MANUAL, D, 3000, 3510);
    check_unconfirmed(3500, AGV_MSG_GEAR_STATUS, 3000);
}

void test_a_silent_vcu_confirms_nothing(void) {
    report(MANUAL, P, 1000, 2010);
    for (uint64_t t_ms = 2010; t_ms <= 2050; t_ms += 20) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", t_ms);
    }
    trip_and_park(2051); /* 50 ms after the last 363h */
    for (uint64_t t_ms = 2060; t_ms <= 2540; t_ms += 20) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", t_ms);
    }
    check_unconfirmed(2551, AGV_MSG_VEHICLE_STATUS, 2051);
    TEST_ASSERT_EQUAL_STRING("autopilot off", why_unconfirmed(why_trip(why, 0)));
}

void test_both_were_confirmed_but_never_together(void) {
    report(AUTOPILOT, D, 1000, 2000);
    trip_and_park(2000);
    report(AUTOPILOT, P, 2010, 2030);
    report(MANUAL, D, 2030, 2060);
    TEST_ASSERT_EQUAL_STRING("P together with autopilot off", why_unconfirmed(why_trip(why, 0)));
}

/* 100 mm/s from 4010 on; one 101h at 4100 with 0. */
void test_a_slow_reading_does_not_begin_a_movement_anew(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x101, "\0\0\0\0\0\0\0", 1990);
    feed_trip(why, AGV_FAULT_EMERGENCY_STOP, 2000);
    for (uint64_t t_ms = 4010; t_ms < 4230; t_ms += 10) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x101, (t_ms == 4100) ? "\0\0\0\0\0\0\0" : "\x64\0\0\0\0\0\0", t_ms);
    }
    feed_fault(why, AGV_FAULT_MOVING_WHILE_SAFE, AGV_CLASS_TRIP, true, 4225);
    TEST_ASSERT_EQUAL_UINT64(4010000, why_trip(why, 1)->cause_us);
}

void test_more_trips_than_fit_are_left_out(void) {
    for (uint64_t i = 0; i < 1500; i++) {
        feed_trip(why, AGV_FAULT_EMERGENCY_STOP, i * 10);
        feed_state(why, AGV_STATE_SAFE, AGV_STATE_STANDBY, AGV_FAULT_NONE, (i * 10) + 5);
    }
    TEST_ASSERT_EQUAL_UINT(1000, why_trip_count(why));
}

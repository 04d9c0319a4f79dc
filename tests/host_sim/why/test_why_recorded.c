/* Causes of trips that a flight recorder kept: events with payloads, no frames. Expected values by hand. */
#include "agv/codec.h"
#include "one_why.h"

#define ALL 0x7FF /* every message came */
#define WITHOUT(message) (ALL & ~(1 << (message)))

static agv_event_t event;

enum { NOT_ACTIVE = 0 };

/* Record `event` with this kind and these fields, and begin the next one. */
static void record(agv_event_kind_t kind, uint8_t a, uint8_t b, uint8_t c, uint64_t t_ms) {
    event.kind = (uint8_t)kind;
    event.a = a;
    event.b = b;
    event.c = c;
    const session_event_t recorded = {.t_ms = t_ms, .recorded = event};
    why_event(why, &recorded);
    event = (agv_event_t){.kind = 0};
}

/* A recorder that was ACTIVE from some time on, or NOT_ACTIVE. */
static void start(uint64_t engaged_ms) {
    why_is_recorder(why);
    feed_state(why, 0, AGV_STATE_INIT, AGV_FAULT_NONE, 0);
    feed_state(why, AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_FAULT_NONE, 510);
    if (engaged_ms != NOT_ACTIVE) {
        feed_state(why, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_FAULT_NONE, engaged_ms);
    }
}

/* It tripped. @return its last trip */
static const why_trip_t *trip_from(uint8_t state, agv_fault_t reason, uint16_t seen, uint64_t trip_ms) {
    event.seen = seen;
    record(AGV_EVENT_STATE, state, AGV_STATE_TRIPPED, (uint8_t)reason, trip_ms);
    return why_trip(why, why_trip_count(why) - 1);
}

static const why_trip_t *trip_of(agv_fault_t reason, uint16_t seen, uint64_t engaged_ms, uint64_t trip_ms) {
    start(engaged_ms);
    return trip_from((engaged_ms != NOT_ACTIVE) ? AGV_STATE_ACTIVE : AGV_STATE_STANDBY, reason, seen, trip_ms);
}

static void check_times(const why_trip_t *trip, uint64_t cause_ms, uint64_t good_us) {
    TEST_ASSERT_EQUAL_UINT64(cause_ms * 1000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT64(good_us, trip->last_good_us);
}

void test_a_silence_after_the_engagement_is_as_long_as_its_deadline(void) {
    const why_trip_t *trip = trip_of(AGV_FAULT_STEERING_COMMAND_TIMEOUT, ALL, 1000, 3107);
    check_times(trip, 3006, 2981000); /* 3107 - 125 - 1, and a cycle of 25 ms later */
    check_words(trip, "065h steering_command was silent: last at 2.981 s, deadline 125 ms");
    TEST_ASSERT_EQUAL_UINT(1, trip->evidence_count);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->evidence[0].t_us);
}

void test_a_silence_that_counts_from_the_engagement_on(void) {
    const why_trip_t *trip = trip_of(AGV_FAULT_GEAR_COMMAND_TIMEOUT, ALL, 1000, 1351);
    check_times(trip, 1000, WHY_NEVER);
    check_words(trip, "168h gear_command was silent, engaged at 1.000 s, deadline 350 ms");
}

void test_a_heartbeat_that_was_lost_before_the_engagement(void) {
    start(NOT_ACTIVE);
    feed_fault(why, AGV_FAULT_AI_HEARTBEAT_LOST, AGV_CLASS_WARN, true, 700);
    const why_trip_t *trip = trip_from(AGV_STATE_STANDBY, AGV_FAULT_AI_HEARTBEAT_LOST, ALL, 1000);
    check_times(trip, 449, 349000); /* 700 - 350 - 1, and a cycle of 100 ms later */
    check_words(trip, "43Fh turn_signal_command was silent: last at 0.349 s, deadline 350 ms");
    TEST_ASSERT_EQUAL_INT64(350, trip->limit);
}

void test_a_heartbeat_that_trips_in_standby(void) {
    start(NOT_ACTIVE);
    feed_fault(why, AGV_FAULT_AI_HEARTBEAT_LOST, AGV_CLASS_TRIP, true, 2360);
    check_times(trip_from(AGV_STATE_STANDBY, AGV_FAULT_AI_HEARTBEAT_LOST, ALL, 2360), 2109, 2009000);
}

static void check_unknown(const why_trip_t *trip) {
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->last_good_us);
    check_words(trip, "43Fh turn_signal_command was silent, deadline 350 ms");
}

void test_a_heartbeat_whose_loss_is_not_recorded(void) {
    check_unknown(trip_of(AGV_FAULT_AI_HEARTBEAT_LOST, ALL, NOT_ACTIVE, 1000));
}

/* It may have been lost before the reset: its loss is raised when it is engaged. */
void test_a_heartbeat_that_is_missing_at_the_engagement_after_a_reset(void) {
    (void)trip_of(AGV_FAULT_EMERGENCY_STOP, ALL, 1000, 2000);
    feed_state(why, AGV_STATE_SAFE, AGV_STATE_STANDBY, AGV_FAULT_NONE, 5000);
    feed_fault(why, AGV_FAULT_AI_HEARTBEAT_LOST, AGV_CLASS_TRIP, true, 7000);
    check_unknown(trip_from(AGV_STATE_STANDBY, AGV_FAULT_AI_HEARTBEAT_LOST, ALL, 7000));
}

void test_a_command_that_a_reset_did_not_end(void) {
    start(NOT_ACTIVE);
    event.seen = ALL;
    event.frames[AGV_MSG_GEAR_COMMAND][0] = 3;
    record(AGV_EVENT_FAULT, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, AGV_CLASS_TRIP, 1, 2005);
    event.frames[AGV_MSG_GEAR_COMMAND][0] = AGV_GEAR_P;
    const why_trip_t *trip = trip_from(AGV_STATE_STANDBY, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, ALL, 5000);
    check_times(trip, 2005, WHY_NEVER);
    check_words(trip, "168h gear_command commanded an invalid value at 2.005 s [03 00 00 00 00 00 00 00]");
    TEST_ASSERT_EQUAL_UINT64(2005000, trip->evidence[0].t_us);
}

void test_a_budget_began_at_the_latest(void) {
    check_words(trip_of(AGV_FAULT_THROTTLE_IN_PARK, ALL, 1000, 3200),
                "050h throttle_status was above idle in gear P for 200 ms, from 3.000 s on at the latest");
}

void test_a_silence_that_began_before_it_was_active(void) {
    const why_trip_t *trip = trip_of(AGV_FAULT_GEAR_COMMAND_TIMEOUT, ALL, 1300, 1351);
    check_times(trip, 1000, WHY_NEVER); /* engaged then, or it came then */
    check_words(trip, "168h gear_command was silent, deadline 350 ms");
}

void test_an_ai_computer_that_was_never_seen(void) {
    const why_trip_t *trip =
        trip_of(AGV_FAULT_AI_HEARTBEAT_LOST, WITHOUT(AGV_MSG_TURN_SIGNAL_COMMAND), NOT_ACTIVE, 1501);
    check_times(trip, 1000, WHY_NEVER);
    TEST_ASSERT_EQUAL_INT64(500, trip->limit);
    TEST_ASSERT_EQUAL_UINT(0, trip->evidence_count);
    check_words(trip, "43Fh turn_signal_command was never received, engaged at 1.000 s, deadline 500 ms");
}

void test_a_short_interruption_is_the_same_engagement(void) {
    why_is_recorder(why);
    feed_state(why, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_FAULT_NONE, 600);
    feed_state(why, AGV_STATE_ACTIVE, AGV_STATE_STANDBY, AGV_FAULT_NONE, 2900);
    const why_trip_t *trip = trip_of(AGV_FAULT_STEERING_COMMAND_TIMEOUT, ALL, 3000, 3107);
    check_times(trip, 3006, 2981000);
}

void test_a_score_began_at_the_latest(void) {
    event.frames[AGV_MSG_EPS_STATUS][3] = 7;
    const why_trip_t *trip = trip_of(AGV_FAULT_EPS_MODE_INVALID, ALL, 1000, 3043);
    check_times(trip, 3003, WHY_NEVER); /* five frames, 10 ms apart */
    TEST_ASSERT_EQUAL_UINT64(3043000, trip->evidence[0].t_us);
    check_words(trip,
                "167h eps_status reported an EPS mode that does not exist in 5 frames, the first at 3.003 s at the "
                "latest");
}

/* Its last payload confirms that the autopilot is off. */
void test_a_silent_vcu_did_not_confirm(void) {
    (void)trip_of(AGV_FAULT_VCU_HEARTBEAT_LOST, ALL, NOT_ACTIVE, 2051);
    feed_fault(why, AGV_FAULT_VCU_HEARTBEAT_LOST, AGV_CLASS_TRIP, true, 2051);
    event.seen = ALL;
    event.frames[AGV_MSG_GEAR_STATUS][0] = AGV_GEAR_P;
    event.frames[AGV_MSG_VEHICLE_STATUS][6] = AGV_VCU_FLAG_MANUAL;
    record(AGV_EVENT_FAULT, AGV_FAULT_SAFE_STATE_UNCONFIRMED, AGV_CLASS_TRIP, 1, 2551);
    check_words(why_trip(why, 1),
                "363h vehicle_status did not confirm that the autopilot is off for 500 ms, from 2.051 s "
                "on at the latest");
}

/* With P, and the first of three 363h without autopilot. */
void test_an_engagement_that_has_not_ended_was_not_confirmed(void) {
    (void)trip_of(AGV_FAULT_EMERGENCY_STOP, ALL, 1000, 2000);
    event.seen = ALL;
    event.frames[AGV_MSG_GEAR_STATUS][0] = AGV_GEAR_P;
    event.frames[AGV_MSG_VEHICLE_STATUS][6] = AGV_VCU_FLAG_MANUAL;
    record(AGV_EVENT_FAULT, AGV_FAULT_SAFE_STATE_UNCONFIRMED, AGV_CLASS_TRIP, 1, 2500);
    TEST_ASSERT_EQUAL(AGV_MSG_VEHICLE_STATUS, why_trip(why, 1)->message);
}

void test_the_limit_of_a_command(void) {
    event.frames[AGV_MSG_STEERING_COMMAND][0] = 0x51; /* 18001 */
    event.frames[AGV_MSG_STEERING_COMMAND][1] = 0x46;
    event.frames[AGV_MSG_GEAR_COMMAND][0] = AGV_GEAR_D;
    const why_trip_t *trip = trip_of(AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, ALL, 1000, 3008);
    TEST_ASSERT_EQUAL_INT64(9000, trip->limit);
    TEST_ASSERT_EQUAL_STRING("ddeg", trip->unit);
    check_words(trip, "065h steering_command commanded an invalid value at 3.008 s [51 46 00 00 00 00 00 00]");
}

void test_a_sentence_has_a_subject_where_the_message_is_not_known(void) {
    event.frames[AGV_MSG_GEAR_COMMAND][0] = AGV_GEAR_D;
    check_words(trip_of(AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, ALL, 1000, 3008),
                "a command had an invalid value, a wrong length or a wrong format at 3.008 s");
    tearDown();
    setUp();
    check_words(trip_of(AGV_FAULT_FOREIGN_COMMAND_SENDER, ALL, 1000, 3008),
                "a command came from the vehicle side: at 3.008 s");
    tearDown();
    setUp();
    check_words(trip_of(AGV_FAULT_COMMAND_TOO_FAST, ALL, 1000, 3008),
                "a command came in less than half its cycle 10 times");
}

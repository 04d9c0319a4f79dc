/* The fault of each silence: of messages, of heartbeats, of the own identifiers. */
#include "observe/deadlines.h"

#include "causes.h"
#include "unity.h"

enum { NONE = AGV_FAULT_NONE };

static agv_fault_monitor_t faults;
static agv_timers_t timers;
static agv_liveness_t liveness;
static agv_config_t config;
static bool engaged;

/* The clock wraps in every test. */
static uint32_t at(uint32_t ms) {
    return 0xFFFFFFE0u + ms;
}

void setUp(void) {
    agv_config_defaults(&config);
    faults = (agv_fault_monitor_t){0};
    liveness = (agv_liveness_t){0};
    engaged = false;
    agv_timers_set_time(&timers, at(0));
    agv_timers_start(&timers);
    agv_liveness_start(&liveness, &timers);
}

static void tick(uint32_t ms) {
    agv_timers_advance(&timers, &config, at(ms), 0);
    agv_liveness_tick(&liveness, &timers, engaged);
    agv_deadlines_tick(&faults, &timers, &config, &liveness, engaged);
}

/* A frame with the alive counter in every byte. */
static void arrives(unsigned message, uint8_t counter, uint32_t ms) {
    hal_can_frame_t frame = {.time_ms = at(ms), .length = 8};
    for (unsigned i = 0; i < 8; i++) {
        frame.data[i] = counter;
    }
    (void)agv_liveness_arrived(&liveness, message, frame.time_ms);
    agv_timers_advance(&timers, &config, frame.time_ms, 0);
    agv_liveness_refresh(&liveness, &timers, &config, message, &frame);
}

/* All messages but one, at that time. */
static void others_arrive(unsigned silent, uint8_t counter, uint32_t ms) {
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        if (i != silent) {
            arrives(i, counter, ms);
        }
    }
}

static bool is_active(unsigned fault) {
    return agv_fault_monitor_is_active(&faults, fault);
}

static void expect_only(unsigned fault) {
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        TEST_ASSERT_EQUAL(i == fault, is_active(i));
    }
}

/* Two frames make the heartbeats alive. Then all messages but one come until its deadline has expired. */
static void be_silent(unsigned message, uint32_t timeout_ms) {
    others_arrive(NONE, 1, 0);
    others_arrive(NONE, 2, 0);
    others_arrive(message, 3, timeout_ms);
    tick(timeout_ms);
    expect_only(NONE);
    tick(timeout_ms + 1);
}

static bool is_heartbeat(const cause_t *cause) {
    return TRAFFIC[cause->message].counter_at >= 0;
}

/* With each silence of the table. In manual, that of the AI computer counts once it was alive. */
static void check_silence(const cause_t *cause) {
    const uint32_t deadline_ms = cause_deadline_ms(cause);
    setUp();
    be_silent(cause->message, deadline_ms);
    expect_only((cause->how == BY_SILENCE) || is_heartbeat(cause) ? cause->fault : (unsigned)NONE);
    setUp();
    engaged = true;
    be_silent(cause->message, deadline_ms);
    expect_only(cause->fault);
    arrives(cause->message, 4, deadline_ms + 2);
    tick(deadline_ms + 2);
    expect_only(NONE);
}

/* Shows: SUP-2, SUP-3 */
void test_the_fault_of_each_silence(void) {
    for (unsigned i = 0; i < CAUSES; i++) {
        if (cause_is_silence(&CAUSE[i])) {
            check_silence(&CAUSE[i]);
        }
    }
}

/* The last frame with the old counter came just before. */
static void check_freeze(const cause_t *cause) {
    const uint32_t deadline_ms = cause_deadline_ms(cause);
    setUp();
    others_arrive(NONE, 1, 0);
    others_arrive(NONE, 2, 0);
    others_arrive(cause->message, 3, deadline_ms);
    arrives(cause->message, 2, deadline_ms);
    tick(deadline_ms);
    expect_only(NONE);
    tick(deadline_ms + 1);
    expect_only(cause->fault);
    arrives(cause->message, 3, deadline_ms + 2);
    tick(deadline_ms + 2);
    expect_only(NONE);
}

/* Shows: SUP-2 */
void test_a_heartbeat_is_stuck(void) {
    for (unsigned i = 0; i < CAUSES; i++) {
        if ((CAUSE[i].how == BY_FREEZE) || (CAUSE[i].how == BY_FREEZE_ENGAGED)) {
            check_freeze(&CAUSE[i]);
        }
    }
}

/* Engaged, and no 43Fh was ever received. The time begins with the engagement, which mode.c starts; an interruption
 * does not end it. */
/* Shows: SUP-8, AI_HEARTBEAT_LOST */
void test_an_ai_computer_that_was_never_seen(void) {
    tick(10000);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_AI_HEARTBEAT_LOST));
    tick(10001);
    engaged = true;
    agv_timer_start(&timers, AGV_TIMER_AI_NEVER_SEEN);
    tick(10400);
    engaged = false; /* a short interruption; the engagement continues */
    tick(10401);
    engaged = true;
    tick(10501);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_AI_HEARTBEAT_LOST));
    tick(10502);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_AI_HEARTBEAT_LOST));
    engaged = false;
    tick(10503);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_AI_HEARTBEAT_LOST));
}

/* A reset takes effect at once, not only in the next tick. */
/* Shows: SUP-8 */
TEST_CASE(AGV_FAULT_AI_HEARTBEAT_LOST)
TEST_CASE(AGV_FAULT_AI_HEARTBEAT_STUCK)
void test_a_forgotten_ai_computer_is_not_lost(unsigned fault) {
    agv_fault_monitor_set(&faults, fault, true);
    agv_fault_monitor_set(&faults, AGV_FAULT_VCU_HEARTBEAT_LOST, true);
    agv_deadlines_forget_ai(&faults);
    expect_only(AGV_FAULT_VCU_HEARTBEAT_LOST);
}

/* Lost in manual: with the engagement it becomes a fault of an engaged vehicle, without waiting for a tick. */
/* Shows: SUP-8, FSM-11 */
void test_a_forgotten_ai_computer_is_lost_at_the_next_engagement(void) {
    arrives(AGV_MSG_TURN_SIGNAL_COMMAND, 1, 0);
    arrives(AGV_MSG_TURN_SIGNAL_COMMAND, 2, 0);
    agv_liveness_forget_ai(&liveness);
    agv_deadlines_forget_ai(&faults);
    tick(5000);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_AI_HEARTBEAT_LOST));
    engaged = true;
    agv_liveness_tick(&liveness, &timers, engaged);
    agv_deadlines_heartbeats(&faults, &timers, &liveness, engaged);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_AI_HEARTBEAT_LOST));
    arrives(AGV_MSG_TURN_SIGNAL_COMMAND, 3, 5001);
    agv_deadlines_heartbeats(&faults, &timers, &liveness, engaged);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_AI_HEARTBEAT_LOST));
}

/* Its deadline runs on from before the reset: 350 ms after its last changed counter. */
/* Shows: SUP-8, FSM-11 */
void test_the_deadline_of_a_forgotten_ai_computer_runs_on(void) {
    arrives(AGV_MSG_TURN_SIGNAL_COMMAND, 1, 0);
    arrives(AGV_MSG_TURN_SIGNAL_COMMAND, 2, 0);
    tick(200);
    agv_liveness_forget_ai(&liveness);
    engaged = true;
    tick(350);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_AI_HEARTBEAT_LOST));
    tick(351);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_AI_HEARTBEAT_LOST));
}

/* ---- The other set's identifiers ---- */

/* Shows: P1, WRONG_ID_SET */
TEST_CASE(AGV_MSG_TURN_SIGNAL_COMMAND)
TEST_CASE(AGV_MSG_VEHICLE_STATUS)
void test_the_other_identifier_while_the_own_one_is_silent(unsigned message) {
    arrives(message, 1, 0);
    tick(500);
    agv_deadlines_other_id_set(&timers, message);
    tick(500);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_WRONG_ID_SET));
    tick(501);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_WRONG_ID_SET));
    tick(1000);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_WRONG_ID_SET));
    tick(1001); /* the other one is silent, too */
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_WRONG_ID_SET));
}

/* Shows: P1, WRONG_ID_SET */
void test_the_own_identifier_ends_it_and_that_of_another_message_does_not(void) {
    tick(501);
    agv_deadlines_other_id_set(&timers, AGV_MSG_VEHICLE_STATUS);
    tick(502);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_WRONG_ID_SET));
    arrives(AGV_MSG_TURN_SIGNAL_COMMAND, 1, 503);
    tick(503);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_WRONG_ID_SET));
    arrives(AGV_MSG_VEHICLE_STATUS, 1, 504);
    tick(504);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_WRONG_ID_SET));
}

/* ---- Fresh messages ---- */

/* Not checked: 363h and 067h (heartbeats), the AI's commands, and 267h, which only warns. */
void test_the_messages_whose_silence_trips_have_to_be_fresh(void) {
    static const bool needed[AGV_MSG_COUNT] = {[AGV_MSG_GEAR_STATUS] = true,
                                               [AGV_MSG_THROTTLE_STATUS] = true,
                                               [AGV_MSG_EPS_STATUS] = true,
                                               [AGV_MSG_WHEEL_SPEED] = true};
    TEST_ASSERT_FALSE(agv_deadlines_messages_fresh(&liveness, &timers, &config));
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        setUp();
        others_arrive(i, 1, 0);
        TEST_ASSERT_EQUAL(!needed[i], agv_deadlines_messages_fresh(&liveness, &timers, &config));
        arrives(i, 1, 0);
        TEST_ASSERT_TRUE(agv_deadlines_messages_fresh(&liveness, &timers, &config));
    }
    setUp();
    agv_fault_set_put(&config.trips, AGV_FAULT_STEERING_POSITION_TIMEOUT, true);
    others_arrive(AGV_MSG_STEERING_POSITION, 1, 0);
    TEST_ASSERT_FALSE(agv_deadlines_messages_fresh(&liveness, &timers, &config));
}

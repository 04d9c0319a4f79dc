/* Senders, counters and deadlines of the messages, and which steps of a counter are a heartbeat (SUP-3). */
#include "common/message_facts.h"

#include "unity.h"

static agv_config_t config;
static message_beat_t beat;

void setUp(void) {
    agv_config_defaults(&config);
    beat = (message_beat_t){0};
}

void test_senders(void) {
    TEST_ASSERT_EQUAL(MESSAGE_FROM_AI, message_sender(AGV_MSG_STEERING_COMMAND));
    TEST_ASSERT_EQUAL(MESSAGE_FROM_VCU, message_sender(AGV_MSG_WHEEL_SPEED));
    TEST_ASSERT_EQUAL(MESSAGE_FROM_EPS, message_sender(AGV_MSG_STEERING_POSITION));
}

void test_identifiers_that_are_heard(void) {
    agv_ids_t ids;
    config.id_gear_command = 0x123;
    agv_config_ids(&config, &ids);
    TEST_ASSERT_TRUE_MESSAGE(message_id_is_heard(&ids, 0x123), "as configured");
    TEST_ASSERT_TRUE_MESSAGE(message_id_is_heard(&ids, 0x43F), "the heading");
    TEST_ASSERT_TRUE_MESSAGE(message_id_is_heard(&ids, 0x201), "the table");
    TEST_ASSERT_FALSE_MESSAGE(message_id_is_heard(&ids, 0x7F0), "the status frame");
    TEST_ASSERT_FALSE_MESSAGE(message_id_is_heard(&ids, 0x1FFFFFFF), "29 bits");
}

void test_counters_and_deadlines(void) {
    TEST_ASSERT_EQUAL_UINT8(7, message_counter_at(AGV_MSG_VEHICLE_STATUS));
    TEST_ASSERT_EQUAL_UINT8(0, message_counter_at(AGV_MSG_STEERING_STATUS));
    TEST_ASSERT_EQUAL_UINT8(MESSAGE_NO_COUNTER, message_counter_at(AGV_MSG_GEAR_STATUS));
    TEST_ASSERT_EQUAL_UINT16(AGV_SETTING_eps_heartbeat_timeout_ms, message_deadline_setting(AGV_MSG_STEERING_STATUS));
}

static bool beats(uint8_t value) {
    return message_beats(&beat, &config, AGV_MSG_VEHICLE_STATUS, value);
}

void test_any_change_is_a_beat(void) {
    TEST_ASSERT_TRUE(beats(0));
    TEST_ASSERT_FALSE(beats(0));
    TEST_ASSERT_TRUE(beats(200));
    TEST_ASSERT_TRUE(beats(199));
}

void test_a_counter_that_increments(void) {
    config.vcu_counter = AGV_COUNTER_INCREMENTS;
    TEST_ASSERT_TRUE(beats(254));
    TEST_ASSERT_TRUE_MESSAGE(beats(1), "by 3, over the end");
    TEST_ASSERT_FALSE_MESSAGE(beats(5), "by 4");
    TEST_ASSERT_FALSE_MESSAGE(beats(6), "the first right step after a wrong one");
    TEST_ASSERT_TRUE_MESSAGE(beats(7), "the second one");
    TEST_ASSERT_FALSE(beats(7));
}

void test_the_setting_is_that_of_the_sender(void) {
    config.eps_counter = AGV_COUNTER_INCREMENTS;
    TEST_ASSERT_TRUE(beats(10));
    TEST_ASSERT_TRUE(beats(20));
}

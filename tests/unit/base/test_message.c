/* The message table: identifiers in both sets, cycle times, and unknown messages. */
#include "agv/protocol.h"

#include <stdbool.h>

#include "unity.h"

typedef struct {
    agv_message_t message;
    uint16_t heading_id;
    uint16_t table_id;
    uint16_t cycle_ms;
} expected_t;

/* Written by hand from the protocol document. */
static const expected_t EXPECTED[] = {
    {AGV_MSG_TURN_SIGNAL_COMMAND, 0x43F, 0x201, 100}, {AGV_MSG_GEAR_COMMAND, 0x168, 0x168, 100},
    {AGV_MSG_THROTTLE_COMMAND, 0x075, 0x075, 100},    {AGV_MSG_STEERING_COMMAND, 0x065, 0x065, 25},
    {AGV_MSG_VEHICLE_STATUS, 0x363, 0x203, 10},       {AGV_MSG_GEAR_STATUS, 0x0A3, 0x0A3, 25},
    {AGV_MSG_THROTTLE_STATUS, 0x050, 0x050, 10},      {AGV_MSG_STEERING_STATUS, 0x067, 0x067, 10},
    {AGV_MSG_EPS_STATUS, 0x167, 0x167, 10},           {AGV_MSG_STEERING_POSITION, 0x267, 0x267, 10},
    {AGV_MSG_WHEEL_SPEED, 0x101, 0x101, 10},
};
#define EXPECTED_COUNT (sizeof EXPECTED / sizeof EXPECTED[0])

/* Shows: P1, P17 */
void test_every_message_has_its_identifier_in_both_sets(void) {
    TEST_ASSERT_EQUAL_UINT(AGV_MSG_COUNT, EXPECTED_COUNT);
    for (size_t i = 0; i < EXPECTED_COUNT; i++) {
        const expected_t *e = &EXPECTED[i];
        TEST_ASSERT_EQUAL_HEX16(e->heading_id, agv_message_id(e->message, AGV_ID_SET_HEADING));
        TEST_ASSERT_EQUAL_HEX16(e->table_id, agv_message_id(e->message, AGV_ID_SET_TABLE));
    }
}

/* Shows: P1 */
void test_every_identifier_names_its_message_in_both_sets(void) {
    for (size_t i = 0; i < EXPECTED_COUNT; i++) {
        const expected_t *e = &EXPECTED[i];
        TEST_ASSERT_EQUAL(e->message, agv_message_from_id(e->heading_id, AGV_ID_SET_HEADING));
        TEST_ASSERT_EQUAL(e->message, agv_message_from_id(e->table_id, AGV_ID_SET_TABLE));
    }
}

/* Shows: P1 */
void test_an_identifier_of_the_other_set_is_no_message(void) {
    TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x201, AGV_ID_SET_HEADING));
    TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x203, AGV_ID_SET_HEADING));
    TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x43F, AGV_ID_SET_TABLE));
    TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x363, AGV_ID_SET_TABLE));
}

/* Shows: P1 */
void test_of_all_identifiers_eleven_are_messages_in_each_set(void) {
    unsigned heading = 0;
    unsigned table = 0;

    for (uint32_t id = 0; id <= AGV_ID_MAX; id++) {
        heading += (agv_message_from_id(id, AGV_ID_SET_HEADING) != AGV_MSG_NONE) ? 1 : 0;
        table += (agv_message_from_id(id, AGV_ID_SET_TABLE) != AGV_MSG_NONE) ? 1 : 0;
    }
    TEST_ASSERT_EQUAL_UINT(11, heading);
    TEST_ASSERT_EQUAL_UINT(11, table);
}

/* Shows: P15 */
void test_an_identifier_beyond_eleven_bits_is_no_message(void) {
    TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x800u + 0x168u, AGV_ID_SET_HEADING));
    TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x10000u + 0x168u, AGV_ID_SET_HEADING));
    TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x80000168u, AGV_ID_SET_HEADING));
    TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(UINT32_MAX, AGV_ID_SET_TABLE));
}

/* Shows: P16 */
void test_every_message_has_its_cycle_time(void) {
    for (size_t i = 0; i < EXPECTED_COUNT; i++) {
        TEST_ASSERT_EQUAL_UINT16(EXPECTED[i].cycle_ms, agv_message_cycle_ms(EXPECTED[i].message));
    }
}

/* Shows: P17 */
void test_commands_come_first(void) {
    TEST_ASSERT_EQUAL_UINT(AGV_COMMAND_COUNT, AGV_MSG_VEHICLE_STATUS);
    TEST_ASSERT_EQUAL_UINT(AGV_COMMAND_COUNT - 1, AGV_MSG_STEERING_COMMAND);
}

/* An unknown message has no identifier that a frame could carry, and no cycle. */
static void assert_no_message(int message) {
    const agv_message_t value = (agv_message_t)message;

    TEST_ASSERT_GREATER_THAN_UINT16(AGV_ID_MAX, agv_message_id(value, AGV_ID_SET_HEADING));
    TEST_ASSERT_GREATER_THAN_UINT16(AGV_ID_MAX, agv_message_id(value, AGV_ID_SET_TABLE));
    TEST_ASSERT_EQUAL_UINT16(0, agv_message_cycle_ms(value));
}

/* Shows: P1, P16 */
void test_an_invalid_message_has_no_identifier_and_no_cycle(void) {
    assert_no_message(AGV_MSG_NONE);
}

/* Shows: P1 */
void test_a_set_that_does_not_exist_knows_neither_changed_identifier(void) {
    for (int set = -1; set <= 2; set += 3) {
        const agv_id_set_t none = (agv_id_set_t)set;
        TEST_ASSERT_GREATER_THAN_UINT16(AGV_ID_MAX, agv_message_id(AGV_MSG_TURN_SIGNAL_COMMAND, none));
        TEST_ASSERT_GREATER_THAN_UINT16(AGV_ID_MAX, agv_message_id(AGV_MSG_GEAR_COMMAND, none));
        TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x43F, none));
        TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x201, none));
        TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x363, none));
        TEST_ASSERT_EQUAL(AGV_MSG_NONE, agv_message_from_id(0x203, none));
    }
}

/* ---- Identifiers that a supervisor uses ---- */

/* Shows: P1 */
void test_a_message_is_found_by_the_identifier_that_it_has(void) {
    agv_ids_t ids;
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        ids.of[i] = (uint16_t)(0x400 + i);
    }
    for (uint32_t id = 0; id <= 0x800; id++) {
        const bool is_one = id >= 0x400 && id < 0x400 + AGV_MSG_COUNT;
        TEST_ASSERT_EQUAL_UINT32(is_one ? id - 0x400 : AGV_MSG_NONE, agv_ids_find(&ids, id));
    }
    TEST_ASSERT_EQUAL_UINT32(AGV_MSG_NONE, agv_ids_find(&ids, 0x10400u));
    TEST_ASSERT_EQUAL_UINT32(AGV_MSG_NONE, agv_ids_find(&ids, UINT32_MAX));
}

/* The first in the order of the document. */
void test_of_two_messages_with_one_identifier_the_first_is_found(void) {
    agv_ids_t ids;
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        ids.of[i] = 0x123;
    }
    TEST_ASSERT_EQUAL_UINT32(AGV_MSG_TURN_SIGNAL_COMMAND, agv_ids_find(&ids, 0x123));
}

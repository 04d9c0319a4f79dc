/* The message table: identifiers in both sets, cycle times, and what is no message. */
#include "agv/protocol.h"

#include "unity.h"

void setUp(void) {
}

void tearDown(void) {
}

/* Shows: P1 */
void test_every_message_is_found_by_its_identifier_in_both_sets(void) {
    for (int set = AGV_ID_SET_HEADING; set <= AGV_ID_SET_TABLE; set++) {
        for (int message = 0; message < AGV_MSG_COUNT; message++) {
            const uint16_t id = agv_message_id((agv_message_t)message, (agv_id_set_t)set);
            TEST_ASSERT_LESS_OR_EQUAL_UINT16(AGV_ID_MAX, id);
            TEST_ASSERT_EQUAL(message, agv_message_from_id(id, (agv_id_set_t)set));
        }
    }
}

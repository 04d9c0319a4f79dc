/* The traffic of the fixture is healthy. */
#include "one_fixture.h"

/* 700 frames a second but for the AI's 70: 7 messages each 10 ms or 25 ms, 4 commands. */
void test_a_second_of_healthy_traffic(void) {
    static const uint32_t EXPECTED[AGV_MSG_COUNT] = {10, 10, 10, 40, 100, 40, 100, 100, 100, 100, 100};
    fixture_start(&f);
    fixture_run(&f, 1000);
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        TEST_ASSERT_EQUAL_UINT32(EXPECTED[i], f.traffic[i].sent);
    }
    TEST_ASSERT_EQUAL_UINT32(710, agv_supervisor_counters(&f.supervisor)->received);
    TEST_ASSERT_EQUAL_UINT32(0, f.hal.bites);
}

/* Shows: SUP-1, SUP-2, SUP-3 */
void test_healthy_traffic_raises_nothing_and_nothing_is_sent(void) {
    fixture_active(&f);
    expect_state_after(&f, 5000, AGV_STATE_ACTIVE);
    expect_silence(&f);
    expect_output(&f, true);
    expect_led(&f, 0);
    TEST_ASSERT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_active(&f.supervisor));
}

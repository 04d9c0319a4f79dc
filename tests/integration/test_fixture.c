/* The fixture itself: healthy traffic is healthy, and what a test relies on is there. */
#include "fixture.h"
#include "unity.h"

static fixture_t f;

void setUp(void) {
    fixture_init(&f);
}

void tearDown(void) {
}

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
    fixture_run(&f, 5000);
    expect_state(&f, AGV_STATE_ACTIVE);
    expect_silence(&f);
    expect_output(&f, true);
    expect_led(&f, 0);
    TEST_ASSERT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_active(&f.supervisor));
}

void test_run_past_and_run_before(void) {
    fixture_start(&f);
    fixture_run_before(&f, AGV_MSG_GEAR_STATUS);
    TEST_ASSERT_EQUAL_UINT32(6, f.elapsed_ms);
    TEST_ASSERT_EQUAL_UINT32(0, f.traffic[AGV_MSG_GEAR_STATUS].sent);
    fixture_run_past(&f, AGV_MSG_GEAR_STATUS);
    TEST_ASSERT_EQUAL_UINT32(7, f.elapsed_ms);
    TEST_ASSERT_EQUAL_UINT32(1, f.traffic[AGV_MSG_GEAR_STATUS].sent);
    fixture_run_past(&f, AGV_MSG_GEAR_STATUS);
    TEST_ASSERT_EQUAL_UINT32(32, f.elapsed_ms);
}

/* Sending: the status frame. */
#include "mock_can.h"
#include "one_transmitter.h"

static void with_status_frame(void) {
    config.status_frame_id = 0x123;
    orders.state = AGV_STATE_STANDBY;
    orders.first_reason = AGV_FAULT_NONE;
}

/* State, rank of the reason or FFh, output, counter, checksum with the low byte first. The first one at the start. */
/* Shows: TOP-3 */
void test_the_status_frame(void) {
    const uint8_t first[8] = {0x33, 0xFF, 1, 0, 0x78, 0x56, 0x34, 0x12};
    const uint8_t second[8] = {0x55, AGV_FAULT_BUS_OFF, 0, 1, 0x78, 0x56, 0x34, 0x12};
    with_status_frame();
    orders.output_closed = true;
    agv_transmitter_status(&transmitter, &orders);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    expect_sent(0, HAL_CAN_VEHICLE, 0x123, first);
    TEST_ASSERT_EQUAL_UINT16(1, report().sent);
    orders.output_closed = false;
    EXPECT_COUNT_AFTER(99, 1);
    orders.state = AGV_STATE_TRIPPED;
    orders.first_reason = AGV_FAULT_BUS_OFF;
    orders.park_released = false;
    orders.holdable = false;
    tick(1);
    expect_sent(sent_count - 1, HAL_CAN_VEHICLE, 0x123, second);
}

/* 100 ms by default, and its counter wraps. */
/* Shows: TOP-3 */
void test_the_period_of_the_status_frame(void) {
    with_status_frame();
    for (unsigned i = 0; i < 300; i++) {
        sent_count = 0;
        EXPECT_COUNT_AFTER((i == 0) ? 1 : 100, 1);
        TEST_ASSERT_EQUAL_UINT8(i, sent[0].frame.data[3]);
    }
    config.status_frame_period_ms = 10;
    tick(100);
    sent_count = 0;
    EXPECT_COUNT_AFTER(100, 10);
}

/* Version 1.2.3 of the revision 89ABCDEFh, after the 256th frame. The bits 5 to 8 of byte 3 are the page. */
/* Shows: TOP-3, HW-6 */
void test_the_status_frame_reports_the_version_once_in_256_frames(void) {
    static const agv_version_t version = {.major = 1, .minor = 2, .patch = 3, .revision = 0x89ABCDEF};
    const uint8_t regular[8] = {0x33, 0xFF, 1, 255, 0x78, 0x56, 0x34, 0x12};
    const uint8_t first[8] = {0x33, 0xFF, 0x11, 255, 1, 2, 3, 0};
    const uint8_t second[8] = {0x33, 0xFF, 0x21, 255, 0xEF, 0xCD, 0xAB, 0x89};
    with_status_frame();
    orders.output_closed = true;
    orders.version = &version;
    config.status_version = AGV_STATUS_VERSION_ON;
    agv_transmitter_status(&transmitter, &orders);
    for (unsigned i = 1; i < 512; i++) {
        sent_count = 0;
        EXPECT_COUNT_AFTER(100, (i % 256 == 255) ? 3 : 1);
    }
    expect_sent(0, HAL_CAN_VEHICLE, 0x123, regular);
    expect_sent(1, HAL_CAN_VEHICLE, 0x123, first);
    expect_sent(2, HAL_CAN_VEHICLE, 0x123, second);
    TEST_ASSERT_EQUAL_UINT16(512 + 4, report().sent);
}

static void expect_one_frame_in_each_period(void) {
    with_status_frame();
    agv_transmitter_status(&transmitter, &orders);
    for (unsigned i = 1; i < 300; i++) {
        sent_count = 0;
        EXPECT_COUNT_AFTER(100, 1);
    }
}

/* Shows: TOP-3, HW-6 */
void test_the_version_is_reported_by_choice(void) {
    static const agv_version_t version = {.major = 1};
    orders.version = &version;
    expect_one_frame_in_each_period();
}

/* Shows: TOP-3, HW-6 */
void test_a_program_without_a_version_reports_none(void) {
    config.status_version = AGV_STATUS_VERSION_ON;
    expect_one_frame_in_each_period();
}

/* Of several missed frames one is sent, and the grid stays. */
/* Shows: TOP-3, TIM-1 */
void test_a_late_step_sends_one_status_frame(void) {
    with_status_frame();
    tick(1);
    agv_timers_advance(&timers, &config, 1430, 0);
    agv_transmitter_tick(&transmitter, &orders);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    EXPECT_COUNT_AFTER(69, 2);
    EXPECT_COUNT_AFTER(1, 3);
}

/* The status frame tests the transmit path: it is tried again at every tick, and counts as stalled after more than 100
 * ms. */
/* Shows: TOP-3, SUP-7, TX_STALLED */
void test_a_status_frame_that_is_not_taken_waits_and_stalls(void) {
    with_status_frame();
    hal_takes = false;
    agv_transmitter_status(&transmitter, &orders);
    EXPECT_STALLED_AFTER(100, false);
    EXPECT_STALLED_AFTER(1, true);
    hal_takes = true;
    EXPECT_COUNT_AFTER(1, 1);
    TEST_ASSERT_EQUAL_UINT8(0, sent[0].frame.data[3]);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    EXPECT_COUNT_AFTER(97, 1);
    EXPECT_COUNT_AFTER(1, 2); /* 200 ms after the start: on the grid */
}

/* Shows: TOP-3, TOP-4 */
void test_there_is_no_status_frame_in_shadow_or_when_it_is_off(void) {
    with_status_frame();
    config.shadow = AGV_SHADOW_ON;
    tick(250);
    TEST_ASSERT_EQUAL_UINT16(0, report().shadowed);
    config.shadow = AGV_SHADOW_OFF;
    config.status_frame_id = 0;
    EXPECT_COUNT_AFTER(250, 0);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
}

/* No status frame during bus-off, not even one that waits. Afterwards it is on its grid again. */
/* Shows: TOP-3, SUP-7 */
void test_there_is_no_status_frame_in_bus_off(void) {
    with_status_frame();
    hal_takes = false;
    tick(50);
    agv_timer_start(&timers, AGV_TIMER_BUS_OFF);
    hal_takes = true;
    EXPECT_COUNT_AFTER(100, 0);
    agv_timer_stop(&timers, AGV_TIMER_BUS_OFF);
    EXPECT_COUNT_AFTER(49, 0);
    EXPECT_COUNT_AFTER(1, 1);
}

/* A status frame that was passed to the HAL within the last 2 ms may have been withdrawn. An older one has left. */
/* Shows: TOP-3, SUP-7 */
void test_a_status_frame_that_may_have_been_withdrawn_is_sent_again(void) {
    for (unsigned age_ms = 2; age_ms <= 3; age_ms++) {
        setUp();
        with_status_frame();
        EXPECT_COUNT_AFTER(1, 1);
        tick(age_ms - 1);
        agv_timers_advance(&timers, &config, timers.now_ms + 1, 0);
        agv_transmitter_withdraw(&transmitter, &timers, true);
        EXPECT_COUNT_AFTER(1, (age_ms == 2) ? 2 : 1);
    }
}

/* At a start no status frame was passed to the HAL that could be discarded. */
/* Shows: TOP-3 */
void test_before_the_first_status_frame_none_is_sent_again(void) {
    with_status_frame();
    agv_timers_set_time(&timers, 0); /* the time in zeroed memory */
    agv_transmitter_start(&transmitter, 0);
    transmitter.status_due_ms = 50;
    discard(HAL_CAN_VEHICLE);
    EXPECT_COUNT_AFTER(49, 0);
}

/* Shows: TOP-3, FSM-2, SUP-7 */
void test_a_status_frame_that_waits_is_discarded(void) {
    with_status_frame();
    hal_takes = false;
    agv_transmitter_status(&transmitter, &orders);
    tick(60);
    discard(HAL_CAN_VEHICLE);
    hal_takes = true;
    EXPECT_COUNT_AFTER(39, 0);
    EXPECT_COUNT_AFTER(1, 1); /* on its grid */
}

/* 18 and 24.8 days without a step. */
/* Shows: TOP-3, TIM-1 */
TEST_CASE(0x60000000)
TEST_CASE(0x7FFFFFFF)
void test_a_status_frame_that_is_very_late_is_due(uint32_t late_ms) {
    with_status_frame();
    agv_timers_set_time(&timers, timers.now_ms + late_ms);
    agv_transmitter_status(&transmitter, &orders);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
}

/* A status frame passed to the HAL up to 2 ms before waiting frames are discarded may be lost, so it is sent again. */
/* Shows: TOP-3, FSM-2 */
TEST_CASE(0, 1)
TEST_CASE(2, 1)
TEST_CASE(3, 0)
void test_a_status_frame_that_may_have_been_discarded_is_sent_again(uint32_t before_ms, unsigned again) {
    with_status_frame();
    agv_transmitter_status(&transmitter, &orders);
    tick(before_ms);
    discard(HAL_CAN_VEHICLE);
    EXPECT_COUNT_AFTER(1, 1 + again);
    EXPECT_COUNT_AFTER(50, 1 + again);
}

/* The end of an engagement purges the controller, too. */
/* Shows: TOP-3, TOP-2 */
TEST_CASE(2, 1)
TEST_CASE(3, 0)
void test_a_status_frame_that_may_have_been_purged_is_sent_again(uint32_t before_ms, unsigned again) {
    with_status_frame();
    be_gateway();
    orders.state = AGV_STATE_STANDBY;
    agv_transmitter_status(&transmitter, &orders);
    tick(before_ms);
    hal_can_purge_Expect(&hal, HAL_CAN_VEHICLE);
    agv_transmitter_end_engagement(&transmitter, &orders); /* sends 075h */
    EXPECT_COUNT_AFTER(50, 2 + again);
}

/* Frames discarded on the AI side do not matter. */
void test_what_is_discarded_for_the_ai_side_is_no_status_frame(void) {
    with_status_frame();
    agv_transmitter_status(&transmitter, &orders);
    discard(HAL_CAN_AI);
    EXPECT_COUNT_AFTER(50, 1);
}

/* A start just before the wrap. */
/* Shows: TOP-3, TIM-2 */
void test_the_status_frame_across_the_wrap(void) {
    with_status_frame();
    agv_timers_set_time(&timers, 0xFFFFFFF0u);
    transmitter = (agv_transmitter_t){0};
    agv_transmitter_start(&transmitter, timers.now_ms);
    agv_transmitter_status(&transmitter, &orders);
    EXPECT_COUNT_AFTER(99, 1);
    EXPECT_COUNT_AFTER(201, 4);
}

static void status_at(uint32_t now_ms) {
    agv_timers_advance(&timers, &config, now_ms, 0);
    agv_transmitter_status(&transmitter, &orders);
}

/* Off the bus from the start at 1000 on: none was sent, so none is sent again, also after half of the clock's range. */
/* Shows: TOP-3, TIM-2 */
void test_a_status_frame_that_was_never_sent_is_not_sent_again(void) {
    with_status_frame();
    agv_timer_start(&timers, AGV_TIMER_BUS_OFF);
    status_at(1001);
    status_at(1001u + 0x40000000u);
    status_at(1000u + 0x7FFFFFFBu);
    agv_timers_advance(&timers, &config, 1000u + 0x7FFFFFFCu, 0);
    agv_timer_stop(&timers, AGV_TIMER_BUS_OFF);
    discard(HAL_CAN_VEHICLE);
    agv_transmitter_status(&transmitter, &orders);
    TEST_ASSERT_EQUAL_UINT(0, sent_count); /* it waits for its slot */
}

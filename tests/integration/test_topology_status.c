/* The supervisor's own status frame, and shadow mode. */
#include "fixture.h"
#include "unity.h"
#include "walk.h"

static fixture_t f;
static fixture_t real; /* the same in earnest */

enum { STATUS_ID = 0x6F0 };

void setUp(void) {
    fixture_init(&f);
}

void tearDown(void) {
}

static const fixture_sent_t *last_status(void) {
    return fixture_nth_sent(&f, STATUS_ID, fixture_count_sent(&f, STATUS_ID) - 1);
}

static void expect_status(agv_state_t state, agv_fault_t reason, uint8_t closed) {
    const uint32_t checksum = agv_config_checksum(&f.config);
    fixture_run(&f, 100);
    expect_state(&f, state);
    const fixture_sent_t *status = last_status();
    TEST_ASSERT_EQUAL_INT(HAL_CAN_VEHICLE, status->side);
    TEST_ASSERT_EQUAL_UINT8(8, status->length);
    TEST_ASSERT_EQUAL_HEX8(state, status->data[0]);
    TEST_ASSERT_EQUAL_UINT8(reason, status->data[1]);
    TEST_ASSERT_EQUAL_UINT8(closed, status->data[2]);
    TEST_ASSERT_EQUAL_HEX8(checksum, status->data[4]);
    TEST_ASSERT_EQUAL_HEX8(checksum >> 8, status->data[5]);
    TEST_ASSERT_EQUAL_HEX8(checksum >> 16, status->data[6]);
    TEST_ASSERT_EQUAL_HEX8(checksum >> 24, status->data[7]);
}

/* Shows: TOP-3 */
void test_no_status_frame_by_default(void) {
    fixture_active(&f);
    fixture_run(&f, 2000);
    expect_silence(&f);
}

/* Shows: TOP-3 */
void test_the_status_frame_says_state_first_reason_output_and_configuration(void) {
    f.config.status_frame_id = STATUS_ID;
    fixture_start(&f);
    expect_status(AGV_STATE_INIT, AGV_FAULT_NONE, 0);
    fixture_run(&f, 900);
    expect_status(AGV_STATE_STANDBY, AGV_FAULT_NONE, 1);
    fixture_mode(&f, MODE_ENGAGED);
    expect_status(AGV_STATE_ACTIVE, AGV_FAULT_NONE, 1);
    walk_trip(&f);
    expect_status(AGV_STATE_TRIPPED, AGV_FAULT_S_DRIVER_ALARM, 1);
    fixture_run(&f, 600);
    expect_status(AGV_STATE_TRIPPED, AGV_FAULT_S_DRIVER_ALARM, 0);
    fixture_vehicle_confirms(&f);
    fixture_run(&f, 100);
    expect_status(AGV_STATE_SAFE, AGV_FAULT_S_DRIVER_ALARM, 0);
}

/* Shows: TOP-3 */
void test_the_status_frame_says_it_in_the_gateway_too(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.config.status_frame_id = STATUS_ID;
    f.long_run = true;
    fixture_active(&f);
    expect_status(AGV_STATE_ACTIVE, AGV_FAULT_NONE, 1);
}

static void expect_period(uint16_t period_ms) {
    fixture_init(&f);
    f.config.status_frame_id = 0x001;
    f.config.status_frame_period_ms = period_ms;
    fixture_active(&f);
    const uint32_t times = 2000u / period_ms;
    fixture_run(&f, 2000);
    TEST_ASSERT_UINT32_WITHIN(1, times, fixture_count_sent(&f, 0x001));
    for (uint32_t n = 1; n < fixture_count_sent(&f, 0x001); n++) {
        const fixture_sent_t *before = fixture_nth_sent(&f, 0x001, n - 1);
        const fixture_sent_t *sent = fixture_nth_sent(&f, 0x001, n);
        TEST_ASSERT_EQUAL_UINT32(period_ms, sent->time_ms - before->time_ms);
        TEST_ASSERT_EQUAL_HEX8((uint8_t)(before->data[3] + 1), sent->data[3]); /* the alive counter */
    }
}

/* Shows: TOP-3 */
void test_the_status_frame_comes_in_its_period_and_counts(void) {
    expect_period(10);
    expect_period(100);
    expect_period(333);
    expect_period(1000);
}

/* Shows: TOP-3, TIM-1 */
void test_the_status_frame_does_not_burst_after_an_overrun(void) {
    f.config.status_frame_id = STATUS_ID;
    fixture_standby(&f);
    fixture_run(&f, 100);
    fixture_forget_sent(&f);
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF; /* it would have bitten */
    fixture_jump(&f, 750);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, STATUS_ID));
    fixture_run(&f, 500);
    TEST_ASSERT_EQUAL_UINT32(6, fixture_count_sent(&f, STATUS_ID));
}

/* Shows: TOP-3 */
void test_a_status_frame_that_does_not_leave_is_not_counted(void) {
    f.config.status_frame_id = STATUS_ID;
    fixture_standby(&f);
    fixture_run(&f, 200);
    const uint8_t before = last_status()->data[3];
    fixture_forget_sent(&f);
    sim_hal_fail_at(&f.hal, 1, UINT32_MAX, 1u << SIM_HAL_OP_CAN_SEND);
    fixture_run(&f, 200); /* two of them */
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, STATUS_ID));
    sim_hal_fail_at(&f.hal, 0, 0, 0);
    fixture_run(&f, 100);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, STATUS_ID));
    TEST_ASSERT_EQUAL_HEX8((uint8_t)(before + 1), last_status()->data[3]);
}

/* ---- Shadow ---- */

/* From the start through a trip, with an AI computer that is overridden, to SAFE and back. */
static void go_round(fixture_t *fixture) {
    fixture_active(fixture);
    walk_trip(fixture);
    fixture_run(fixture, 700);
    fixture_vehicle_confirms(fixture);
    fixture_run(fixture, 1000);
    fixture_button(fixture, true);
    fixture_run(fixture, 1100);
    fixture_button(fixture, false);
}

/* Shows: TOP-4 */
void test_in_shadow_no_frame_leaves_in_any_state(void) {
    f.config.shadow = AGV_SHADOW_ON;
    f.config.status_frame_id = STATUS_ID;
    fixture_start(&f);
    go_round(&f);
    TEST_ASSERT_EQUAL_UINT32(0, f.hal.op_calls[SIM_HAL_OP_CAN_SEND]);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->sent);
}

static void expect_the_same_decisions(void) {
    agv_event_t shadowed = {0};
    agv_event_t sent = {0};
    TEST_ASSERT_EQUAL_UINT32(agv_recorder_next_sequence(&real.recorder), agv_recorder_next_sequence(&f.recorder));
    for (uint32_t i = 0; i < agv_recorder_next_sequence(&f.recorder); i++) {
        TEST_ASSERT_TRUE(agv_recorder_get(&real.recorder, i, &sent) && agv_recorder_get(&f.recorder, i, &shadowed));
        TEST_ASSERT_EQUAL_MEMORY(&sent, &shadowed, sizeof sent);
    }
    TEST_ASSERT_EQUAL_INT(real.hal.safety_output.on, f.hal.safety_output.on);
    TEST_ASSERT_EQUAL_UINT32(real.hal.safety_output.changes, f.hal.safety_output.changes);
}

/* Shows: TOP-4 */
void test_in_shadow_it_decides_as_always_and_counts_what_it_would_have_sent(void) {
    for (uint16_t topology = AGV_TOPOLOGY_SHARED; topology <= AGV_TOPOLOGY_GATEWAY; topology++) {
        fixture_init(&real);
        real.config.topology = topology;
        real.config.status_frame_id = STATUS_ID;
        real.long_run = true;
        go_round(&real);
        fixture_init(&f);
        f.config = real.config;
        f.config.shadow = AGV_SHADOW_ON;
        go_round(&f);
        const uint32_t would_have = agv_supervisor_counters(&f.supervisor)->shadowed;
        TEST_ASSERT_TRUE(would_have > 100);
        TEST_ASSERT_EQUAL_UINT32(agv_supervisor_counters(&real.supervisor)->sent, would_have);
        expect_the_same_decisions();
    }
}

/* Without a shadow what leaves is counted as sent, and as nothing else. */
/* Shows: TOP-4 */
void test_what_is_sent_is_counted_once(void) {
    fixture_start(&f); /* INIT sends */
    fixture_run(&f, 100);
    TEST_ASSERT_EQUAL_UINT32(f.sent_count, agv_supervisor_counters(&f.supervisor)->sent);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->shadowed);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->gate_refused);
}

/* After an overrun the frames stand on their old grid again: every 50 ms from the start. */
/* Shows: TOP-3, TIM-1 */
void test_the_status_frame_keeps_its_grid(void) {
    f.config.status_frame_id = 0x123;
    f.config.status_frame_period_ms = 50;
    fixture_start(&f);
    fixture_run(&f, 101);
    fixture_forget_sent(&f);
    fixture_jump(&f, 74); /* 175 ms: the one of 150 ms is late */
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x123));
    fixture_run(&f, 24);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x123));
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(2, fixture_count_sent(&f, 0x123));
}

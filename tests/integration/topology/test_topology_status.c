/* The supervisor's own status frame, and shadow mode. */
#include "expect.h"
#include "fixture.h"
#include "unity.h"
#include "walk.h"

static fixture_t f;
static fixture_t real; /* the same without shadow mode */

enum { STATUS_ID = 0x6F0 };

void setUp(void) {
    fixture_init(&f);
    f.log_status = true;
}

static const fixture_sent_t *last_status(void) {
    return fixture_nth_sent(&f, STATUS_ID, fixture_count_sent(&f, STATUS_ID) - 1);
}

static void expect_status(agv_state_t state, agv_fault_t reason, uint8_t closed) {
    const uint32_t checksum = agv_config_checksum(&f.config);
    expect_state_after(&f, 100, state);
    const fixture_sent_t *status = last_status();
    TEST_ASSERT_EQUAL_INT(HAL_CAN_VEHICLE, status->side);
    TEST_ASSERT_EQUAL_UINT8(8, status->length);
    TEST_ASSERT_EQUAL_HEX8(state, status->data[0]);
    TEST_ASSERT_EQUAL_UINT8(reason == AGV_FAULT_NONE ? 0xFF : reason, status->data[1]);
    TEST_ASSERT_EQUAL_UINT8(closed, status->data[2]);
    TEST_ASSERT_EQUAL_HEX8(checksum, status->data[4]);
    TEST_ASSERT_EQUAL_HEX8(checksum >> 8, status->data[5]);
    TEST_ASSERT_EQUAL_HEX8(checksum >> 16, status->data[6]);
    TEST_ASSERT_EQUAL_HEX8(checksum >> 24, status->data[7]);
}

/* 7F0h each 100 ms, the first one at the start. */
/* Shows: TOP-3 */
void test_the_status_frame_is_on_by_default(void) {
    fixture_start(&f);
    const fixture_sent_t *first = fixture_nth_sent(&f, 0x7F0, 0);
    TEST_ASSERT_EQUAL_UINT32(f.now_ms, first->time_ms);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_VEHICLE, first->side);
    TEST_ASSERT_EQUAL_HEX8(AGV_STATE_INIT, first->data[0]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, first->data[1]); /* no reason */
    TEST_ASSERT_EQUAL_HEX8(0, first->data[2]);
    expect_count_after(&f, 99, 0x7F0, 1);
    expect_count_after(&f, 1, 0x7F0, 2);
    expect_count_after(&f, 1900, 0x7F0, 21);
}

/* Shows: TOP-3 */
void test_a_restart_begins_with_a_status_frame(void) {
    walk_to_safe(&f);
    fixture_forget_sent(&f);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x7F0));
    TEST_ASSERT_EQUAL_HEX8(AGV_STATE_TRIPPED, fixture_nth_sent(&f, 0x7F0, 0)->data[0]);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_S_DRIVER_ALARM, fixture_nth_sent(&f, 0x7F0, 0)->data[1]);
}

/* Shows: TOP-3 */
void test_the_status_frame_has_state_first_reason_output_and_configuration(void) {
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
void test_the_status_frame_of_a_gateway_has_them_too(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.config.status_frame_id = STATUS_ID;
    f.long_run = true;
    fixture_active(&f);
    expect_status(AGV_STATE_ACTIVE, AGV_FAULT_NONE, 1);
}

/* ---- Another sender of its identifier ---- */

static const agv_fault_t IN_USE = AGV_FAULT_STATUS_ID_IN_USE;

/* Any data frame of that identifier, of any length, FD too: a warning for a second after the last one. */
/* Shows: TOP-3, STATUS_ID_IN_USE */
void test_another_sender_of_the_status_frames_identifier_warns(void) {
    for (uint8_t i = 0; i < 18; i++) {
        setUp();
        fixture_active(&f);
        const uint8_t flags = i < 9 ? 0 : HAL_CAN_FD;
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x7F0, .length = i % 9, .flags = flags});
        expect_fault(&f, IN_USE, true);
        expect_state(&f, AGV_STATE_ACTIVE);
        TEST_ASSERT_EQUAL_UINT32(1, agv_supervisor_counters(&f.supervisor)->warnings);
        expect_fault_after(&f, 999, IN_USE, true);
        expect_led(&f, -1);
        expect_fault_after(&f, 1, IN_USE, false);
        expect_state(&f, AGV_STATE_ACTIVE);
    }
}

/* Shows: TOP-3, P15, STATUS_ID_IN_USE */
void test_frames_that_are_no_other_sender_of_the_status_frame(void) {
    static const uint8_t FLAGS[] = {HAL_CAN_REMOTE, HAL_CAN_EXTENDED, HAL_CAN_ERROR};
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.long_run = true;
    fixture_active(&f);
    for (unsigned i = 0; i < 3; i++) {
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x7F0, .length = 8, .flags = FLAGS[i]});
    }
    fixture_raw(&f, HAL_CAN_AI, (hal_can_frame_t){.id = 0x7F0, .length = 8});
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x7F1, .length = 8});
    expect_fault(&f, IN_USE, false);
    setUp();
    f.config.status_frame_id = 0; /* off: another node may use it, and 0 is not an identifier of the supervisor */
    fixture_active(&f);
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x7F0, .length = 8});
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0, .length = 8});
    expect_fault(&f, IN_USE, false);
}

/* ---- Shadow ---- */

/* From the start to ACTIVE, through a trip, with an AI computer that is overridden, to SAFE and back to STANDBY. */
static void go_round(fixture_t *fixture) {
    fixture_active(fixture);
    walk_trip(fixture);
    expect_state_after(fixture, 700, AGV_STATE_TRIPPED);
    fixture_vehicle_confirms(fixture);
    expect_state_after(fixture, 1000, AGV_STATE_SAFE);
    walk_reset(fixture, 1100);
    expect_state_after(fixture, 100, AGV_STATE_STANDBY);
}

/* Shows: TOP-4 */
void test_in_shadow_no_frame_is_sent_in_any_state(void) {
    f.config.shadow = AGV_SHADOW_ON;
    f.config.status_frame_id = STATUS_ID;
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

/* Without the status frame, which is not sent in shadow mode. */
/* Shows: TOP-3, TOP-4 */
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
        TEST_ASSERT_EQUAL_UINT32(agv_supervisor_counters(&real.supervisor)->sent - real.status_count, would_have);
        expect_the_same_decisions();
    }
}

/* Without shadow mode a sent frame is counted only as sent. */
/* Shows: TOP-4 */
void test_a_sent_frame_is_counted_once(void) {
    fixture_start(&f); /* INIT sends */
    fixture_run(&f, 100);
    TEST_ASSERT_EQUAL_UINT32(f.sent_count, agv_supervisor_counters(&f.supervisor)->sent);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->shadowed);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->gate_refused);
}

/* A trip discards what the controller has, perhaps a status frame that was just sent. Its age is a case of the transmitter's tests. */
/* Shows: TOP-3, FSM-2 */
void test_a_status_frame_just_before_a_trip_is_sent_again(void) {
    fixture_active(&f);
    while (fixture_count_sent(&f, 0x7F0) == 0) {
        fixture_run(&f, 1);
    }
    walk_trip(&f);
    expect_count_after(&f, 50, 0x7F0, 2);
}

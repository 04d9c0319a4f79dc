/* Malformed frames change only counters (except the two cases of SUP-5 and SUP-6). Two supervisors get the same
 * traffic, one of them also malformed frames. */
#include "expect.h"
#include "fixture.h"
#include "unity.h"
#include "walk.h"

static fixture_t f; /* also gets malformed frames */
static fixture_t calm;

static const uint32_t COMMAND_IDS[] = {0x43F, 0x168, 0x075, 0x065};
static const uint32_t STATUS_IDS[] = {0x363, 0x0A3, 0x050, 0x067, 0x167, 0x267, 0x101};

void setUp(void) {
    fixture_init(&f);
    fixture_init(&calm);
    f.long_run = true;
    calm.long_run = true;
}

/* All bits set would mean every alarm and fault, both modes, the button, an invalid gear, throttle and angle. */
static void pester(hal_can_side_t side, uint32_t id) {
    for (unsigned length = 0; length < 8; length++) {
        hal_can_frame_t frame = {.id = id, .length = (uint8_t)length};
        for (unsigned i = 0; i < length; i++) {
            frame.data[i] = 0xFF;
        }
        fixture_raw(&f, side, frame);
    }
    for (unsigned flags = 1; flags < 16; flags++) {
        fixture_raw(&f, side,
                    (hal_can_frame_t){.id = id,
                                      .flags = (uint8_t)flags,
                                      .length = 8,
                                      .data = {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}});
    }
}

static void pester_all(bool with_commands) {
    const bool gateway = f.config.topology == AGV_TOPOLOGY_GATEWAY;
    for (unsigned i = 0; i < 7; i++) {
        pester(HAL_CAN_VEHICLE, STATUS_IDS[i]);
    }
    for (unsigned i = 0; with_commands && i < 4; i++) {
        pester(gateway ? HAL_CAN_AI : HAL_CAN_VEHICLE, COMMAND_IDS[i]);
    }
}

static void expect_the_same(void) {
    agv_event_t a;
    agv_event_t b;
    TEST_ASSERT_EQUAL_HEX8(agv_supervisor_state(&calm.supervisor), agv_supervisor_state(&f.supervisor));
    TEST_ASSERT_EQUAL_UINT32(agv_recorder_next_sequence(&calm.recorder), agv_recorder_next_sequence(&f.recorder));
    for (uint32_t i = 0; i < agv_recorder_next_sequence(&f.recorder); i++) {
        TEST_ASSERT_TRUE(agv_recorder_get(&calm.recorder, i, &a) && agv_recorder_get(&f.recorder, i, &b));
        TEST_ASSERT_EQUAL_MEMORY(&a, &b, sizeof a);
    }
    TEST_ASSERT_EQUAL_UINT32(calm.sent_count, f.sent_count);
    for (uint32_t i = 0; i < f.sent_count; i++) {
        TEST_ASSERT_EQUAL_UINT32(calm.sent[i].time_ms, f.sent[i].time_ms);
        TEST_ASSERT_EQUAL_HEX32(calm.sent[i].id, f.sent[i].id);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(calm.sent[i].data, f.sent[i].data, 8);
    }
    TEST_ASSERT_EQUAL_UINT32(calm.hal.led.changes, f.hal.led.changes);
    TEST_ASSERT_EQUAL_UINT32(calm.hal.safety_output.changes, f.hal.safety_output.changes);
}

static void run_both(uint32_t ms, bool with_commands) {
    for (uint32_t i = 0; i < ms; i++) {
        pester_all(with_commands);
        fixture_run(&f, 1);
        fixture_run(&calm, 1);
    }
    expect_the_same();
}

static void go_through_the_states(uint16_t topology) {
    f.config.topology = topology;
    calm.config.topology = topology;
    fixture_start(&f);
    fixture_start(&calm);
    run_both(700, topology == AGV_TOPOLOGY_GATEWAY); /* INIT on the shared bus overrides commands of any length */
    expect_state(&f, AGV_STATE_STANDBY);
    run_both(200, true);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_mode(&calm, MODE_ENGAGED);
    run_both(700, false); /* engaged, commands of any length trip */
    expect_state(&f, AGV_STATE_ACTIVE);
    fixture_mute_vcu(&f, true); /* malformed frames do not replace the valid ones */
    fixture_mute_vcu(&calm, true);
    run_both(100, false);
    expect_state(&f, AGV_STATE_TRIPPED);
}

/* Shows: INT-2, P15 */
void test_malformed_frames_change_nothing_on_the_shared_bus(void) {
    go_through_the_states(AGV_TOPOLOGY_SHARED);
}

/* Shows: INT-2, P15, TOP-2 */
void test_malformed_frames_change_nothing_in_the_gateway(void) {
    go_through_the_states(AGV_TOPOLOGY_GATEWAY);
}

/* A frame with an unknown identifier is ignored, whatever its length. */
/* Shows: INT-2 */
void test_other_identifiers_are_received_and_nothing_else(void) {
    fixture_standby(&f);
    const agv_counters_t before = *agv_supervisor_counters(&f.supervisor);
    for (uint8_t length = 0; length <= 8; length++) {
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x7FF, .length = length});
    }
    const agv_counters_t *after = agv_supervisor_counters(&f.supervisor);
    TEST_ASSERT_EQUAL_UINT32(before.received + 9, after->received);
    TEST_ASSERT_EQUAL_UINT32(before.dropped, after->dropped);
    TEST_ASSERT_EQUAL_UINT32(before.rejected[AGV_REJECTED_LENGTH], after->rejected[AGV_REJECTED_LENGTH]);
    expect_state(&f, AGV_STATE_STANDBY);
}

/* ---- Any bytes in well-formed frames: no crash, no forbidden frame, and the latch is kept ---- */

/* Shows: INT-2, FSM-3 */
void test_any_bytes_in_each_position_keep_the_latch(void) {
    walk_to_tripped(&f);
    for (unsigned i = 0; i < 7; i++) {
        for (unsigned position = 0; position < 8; position++) {
            for (unsigned value = 0; value < 256; value++) {
                hal_can_frame_t frame = {.id = STATUS_IDS[i], .length = 8};
                frame.data[position] = (uint8_t)value;
                fixture_raw(&f, HAL_CAN_VEHICLE, frame);
            }
            fixture_run(&f, 1);
            const agv_state_t state = agv_supervisor_state(&f.supervisor);
            TEST_ASSERT_TRUE(state == AGV_STATE_TRIPPED || state == AGV_STATE_SAFE);
        }
    }
    expect_reason(&f, AGV_FAULT_S_DRIVER_ALARM);
}

/*
 * The gate: permitted frames by state, side, identifier and bytes. The oracle (oracle.h) is written by hand from FSM-6,
 * TOP-1 and TOP-2. The counts below are independent of it.
 */
#include "gate_oracle.h"

#include <stdio.h>
#include <string.h>

#include "agv/state.h"
#include "mock_can.h"
#include "unity.h"

/* The context of a port; the core never accesses its members. */
struct hal {
    int unused;
};
static hal_t hal;
static agv_config_t config;

/* Throttle ceiling 30 %: 75 counts. Held angle 9123 = 23A3h. */
enum { CEILING_PCT = 30, HELD_RAW = 0x23A3, STATUS_ID = 0x123 };
static agv_gate_t gate;
static agv_ids_t ids;

void setUp(void) {
    agv_config_defaults(&config);
    config.throttle_ceiling_pct = CEILING_PCT;
    config.status_frame_id = STATUS_ID;
    gate = (agv_gate_t){
        .config = &config, .ids = &ids, .hold_raw = HELD_RAW, .hold_check = 0xDC5C, .state = AGV_STATE_TRIPPED};
    agv_config_ids(&config, &ids);
}

/* Payloads about the limits of every command. */
static const uint8_t PAYLOADS[][8] = {
    {0}, /* throttle 0: at the end of an engagement */
    {1},
    {2},
    {3},
    {4},
    {8},
    {9},
    {16},
    {75},
    {76},
    {250},
    {255},
    {0, 1},
    {8, 1},
    {8, 0, 1},
    {8, 0, 0, 0, 0, 0, 0, 1},
    {0xA3, 0x23}, /* the held angle */
    {0xA2, 0x23},
    {0xA3, 0x22},
    {0xA3, 0x23, 1},
    {0xA3, 0x23, 0, 0, 0, 0, 0, 1},
    {0x50, 0x46}, /* 18000 = +900.0 degrees */
    {0x51, 0x46},
    {0xFF, 0xFF},
    {0, 0, 0, 0, 0x70, 0, 0, 0}, /* the safe lights, any counter */
    {0, 0, 0, 0, 0x70, 0, 0, 0xFF},
    {0, 0, 0, 0, 0x30, 0, 0, 9}, /* without autopilot off */
    {0, 0, 0, 0, 0x40, 0, 0, 9}, /* without hazard */
    {0, 0, 0, 0, 0x50, 0, 0, 9},
    {0, 0, 0, 0, 0x60, 0, 0, 9},
    {0, 0, 0, 0, 0xF0, 0, 0, 9}, /* headlight off */
    {0, 0, 0, 0, 0, 0, 0, 1},
    {0, 0, 0, 0, 0x71}, /* reserved bits */
    {0, 0, 0, 0, 0x78},
    {1, 0, 0, 0, 0x70},
    {0, 1, 0, 0, 0x70},
    {0, 0, 1, 0, 0x70},
    {0, 0, 0, 1, 0x70},
    {0, 0, 0, 0, 0x70, 1},
    {0, 0, 0, 0, 0x70, 0, 1},
    {0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF},
};

static const uint8_t STATES[] = {
    AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED, AGV_STATE_SAFE, 0x00, 0xFF, 0x3D};

static bool allows(hal_can_side_t side, uint32_t id, const uint8_t data[8]) {
    hal_can_frame_t frame = {.id = id, .length = 8};
    for (unsigned i = 0; i < 8; i++) {
        frame.data[i] = data[i];
    }
    return agv_gate_allows(&gate, side, &frame);
}

/* In the current state of the gate: all valid and invalid sides, all identifiers and some beyond 11 bits, all
 * payloads. */
static void expect_as_the_oracle(void) {
    const oracle_t oracle = gate_oracle(&gate);
    for (int side = 0; side <= HAL_CAN_SIDES; side++) {
        for (uint32_t id = 0; id <= 0x800; id++) {
            for (size_t i = 0; i < sizeof PAYLOADS / sizeof PAYLOADS[0]; i++) {
                hal_can_frame_t frame = {.id = id, .length = 8};
                memcpy(frame.data, PAYLOADS[i], sizeof frame.data);
                const bool expected =
                    side < HAL_CAN_SIDES && gate_oracle_allows(&oracle, &gate, (hal_can_side_t)side, &frame);
                if (agv_gate_allows(&gate, (hal_can_side_t)side, &frame) != expected) {
                    char text[100];
                    (void)snprintf(text, sizeof text, "state %02X side %d id %03X payload %u: expected %d",
                                   (unsigned)gate.state, side, (unsigned)id, (unsigned)i, expected);
                    TEST_FAIL_MESSAGE(text);
                }
            }
        }
    }
}

static void expect_as_the_oracle_in_every_state(void) {
    for (size_t i = 0; i < sizeof STATES; i++) {
        gate.state = STATES[i];
        expect_as_the_oracle();
    }
}

/* Shows: INT-4, FSM-6, TOP-1 */
void test_the_shared_bus(void) {
    expect_as_the_oracle_in_every_state();
}

/* Shows: INT-4, FSM-6, TOP-1 */
void test_the_shared_bus_with_the_other_id_set(void) {
    config.id_set = AGV_ID_SET_TABLE;
    agv_config_ids(&config, &ids);
    expect_as_the_oracle_in_every_state();
}

/* Shows: INT-4, FSM-6, TOP-2 */
void test_the_gateway(void) {
    config.topology = AGV_TOPOLOGY_GATEWAY;
    expect_as_the_oracle_in_every_state();
}

/* Shows: INT-4, FSM-6, TOP-2 */
void test_the_gateway_that_passes_all_in_manual(void) {
    config.topology = AGV_TOPOLOGY_GATEWAY;
    config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    config.id_set = AGV_ID_SET_TABLE;
    agv_config_ids(&config, &ids);
    expect_as_the_oracle_in_every_state();
}

/* One value of a setting opens the gate, whatever agv_config_check lets pass. */
/* Shows: INT-4, TOP-1, TOP-2 */
TEST_CASE(2)
TEST_CASE(0xFFFF)
void test_a_value_without_meaning_opens_nothing(unsigned value) {
    static const uint8_t drive[8] = {1};
    static const uint8_t any[8] = {0};
    gate.state = AGV_STATE_ACTIVE;
    config.topology = (uint16_t)value;
    TEST_ASSERT_FALSE(allows(HAL_CAN_VEHICLE, 0x168, drive));
    TEST_ASSERT_FALSE(allows(HAL_CAN_AI, 0x363, any));
    config.topology = AGV_TOPOLOGY_GATEWAY;
    TEST_ASSERT_TRUE(allows(HAL_CAN_VEHICLE, 0x168, drive));
    TEST_ASSERT_TRUE(allows(HAL_CAN_AI, 0x363, any));
    gate.state = AGV_STATE_STANDBY;
    config.gateway_in_manual = (uint16_t)value;
    TEST_ASSERT_FALSE(allows(HAL_CAN_VEHICLE, 0x168, drive));
}

/* Number of permitted values among the 65536 of the first two bytes (of 43Fh: bytes 5 and 8). */
static unsigned count_allowed(uint32_t id, unsigned first, unsigned second) {
    unsigned count = 0;
    for (unsigned value = 0; value < 65536; value++) {
        uint8_t data[8] = {0};
        data[first] = (uint8_t)(value & 0xFF);
        data[second] = (uint8_t)(value >> 8);
        count += allows(HAL_CAN_VEHICLE, id, data) ? 1u : 0u;
    }
    return count;
}

/* One gear, one throttle, one steering angle, and 43Fh with 256 counters; INIT holds no angle. */
/* Shows: FSM-6, FSM-10 */
void test_of_all_values_one_is_safe(void) {
    static const uint8_t safe[] = {AGV_STATE_INIT, AGV_STATE_TRIPPED, AGV_STATE_SAFE, 0x00};
    for (size_t i = 0; i < sizeof safe; i++) {
        gate.state = safe[i];
        TEST_ASSERT_EQUAL_UINT(1, count_allowed(0x168, 0, 1));
        TEST_ASSERT_EQUAL_UINT(1, count_allowed(0x075, 0, 1));
        TEST_ASSERT_EQUAL_UINT((safe[i] == AGV_STATE_INIT) ? 0 : 1, count_allowed(0x065, 0, 1));
        TEST_ASSERT_EQUAL_UINT(256, count_allowed(0x43F, 4, 7));
    }
}

/* 4 gears, throttle 0 to 75, angle 0 to 18000, and 16 combinations of lights with 256 counters. */
/* Shows: TOP-2 */
void test_of_all_values_those_in_range_pass(void) {
    config.topology = AGV_TOPOLOGY_GATEWAY;
    gate.state = AGV_STATE_ACTIVE;
    TEST_ASSERT_EQUAL_UINT(4, count_allowed(0x168, 0, 1));
    TEST_ASSERT_EQUAL_UINT(76, count_allowed(0x075, 0, 1));
    TEST_ASSERT_EQUAL_UINT(18001, count_allowed(0x065, 0, 1));
    TEST_ASSERT_EQUAL_UINT(16 * 256, count_allowed(0x43F, 4, 7));
}

/* Shows: FSM-10, INT-5 */
void test_an_angle_that_does_not_fit_its_complement_is_not_held(void) {
    for (unsigned bit = 0; bit < 16; bit++) {
        gate.hold_check = (uint16_t)(0xDC5C ^ (1u << bit));
        TEST_ASSERT_EQUAL_UINT(0, count_allowed(0x065, 0, 1));
    }
}

/* Shows: INT-4 */
void test_only_classic_data_frames_of_8_bytes_are_sent(void) {
    hal_can_frame_t frame = {.id = 0x168, .length = 8, .data = {8}};
    TEST_ASSERT_TRUE(agv_gate_allows(&gate, HAL_CAN_VEHICLE, &frame));
    for (unsigned flags = 1; flags < 256; flags++) {
        frame.flags = (uint8_t)flags;
        TEST_ASSERT_FALSE(agv_gate_allows(&gate, HAL_CAN_VEHICLE, &frame));
    }
    frame.flags = 0;
    for (unsigned length = 0; length < 256; length++) {
        frame.length = (uint8_t)length;
        TEST_ASSERT_EQUAL(length == 8, agv_gate_allows(&gate, HAL_CAN_VEHICLE, &frame));
    }
}

/* An identifier that is one of the protocol in its lower 11 bits only. */
/* Shows: INT-4 */
void test_no_identifier_beyond_11_bits_leaves(void) {
    static const uint8_t park[8] = {8};
    for (unsigned bit = 11; bit < 32; bit++) {
        TEST_ASSERT_FALSE(allows(HAL_CAN_VEHICLE, 0x168u | 1u << bit, park));
        TEST_ASSERT_FALSE(allows(HAL_CAN_VEHICLE, STATUS_ID | 1u << bit, park));
    }
}

/* Shows: TOP-3 */
void test_without_a_status_frame_identifier_0_does_not_leave(void) {
    static const uint8_t any[8] = {0};
    config.status_frame_id = 0;
    TEST_ASSERT_FALSE(allows(HAL_CAN_VEHICLE, 0, any));
    TEST_ASSERT_FALSE(allows(HAL_CAN_VEHICLE, STATUS_ID, any));
}

/* Of the 64 bits of each safe command only those of the alive counter are free. */
/* Shows: INT-4, FSM-6 */
void test_every_bit_of_a_safe_command_counts(void) {
    static const struct {
        uint32_t id;
        uint8_t data[8];
    } safe[] = {{0x43F, {0, 0, 0, 0, 0x70}}, {0x168, {8}}, {0x075, {0}}, {0x065, {0xA3, 0x23}}};
    for (size_t i = 0; i < sizeof safe / sizeof safe[0]; i++) {
        TEST_ASSERT_TRUE(allows(HAL_CAN_VEHICLE, safe[i].id, safe[i].data));
        for (unsigned bit = 0; bit < 64; bit++) {
            uint8_t data[8];
            memcpy(data, safe[i].data, sizeof data);
            data[bit / 8] = (uint8_t)(data[bit / 8] ^ (1u << (bit % 8)));
            TEST_ASSERT_EQUAL((safe[i].id == 0x43F) && (bit >= 56), allows(HAL_CAN_VEHICLE, safe[i].id, data));
        }
    }
}

/* In the gateway: one bit of a command at a time. Throttle 64 is under the ceiling of 75 counts, angle 16384 under 18000. */
/* Shows: INT-4, TOP-2 */
void test_every_reserved_bit_of_a_passed_command_counts(void) {
    static const uint8_t free_bits[4][8] = {{0, 0, 0, 0, 0xF0, 0, 0, 0xFF}, {0x0F}, {0x7F}, {0xFF, 0x7F}};
    static const uint32_t commands[4] = {0x43F, 0x168, 0x075, 0x065};
    config.topology = AGV_TOPOLOGY_GATEWAY;
    gate.state = AGV_STATE_ACTIVE;
    for (unsigned i = 0; i < 4; i++) {
        for (unsigned bit = 0; bit < 64; bit++) {
            const uint8_t byte = (uint8_t)(1u << (bit % 8));
            uint8_t data[8] = {0};
            data[0] = (commands[i] == 0x168) ? 8 : 0;
            data[bit / 8] = byte;
            TEST_ASSERT_EQUAL((free_bits[i][bit / 8] & byte) != 0, allows(HAL_CAN_VEHICLE, commands[i], data));
        }
    }
}

/* A configuration with such a status frame is refused. The gate refuses the frame, too. */
/* Shows: INT-4, TOP-3 */
void test_an_identifier_of_the_protocol_is_no_status_frame(void) {
    static const uint8_t any[8] = {0};
    config.status_frame_id = 0x101;
    TEST_ASSERT_FALSE(allows(HAL_CAN_VEHICLE, 0x101, any));
    config.status_frame_id = 0x363;
    TEST_ASSERT_FALSE(allows(HAL_CAN_VEHICLE, 0x363, any));
}

/* Shows: INT-4 */
void test_an_allowed_frame_is_passed_to_the_hal_unchanged(void) {
    const hal_can_frame_t frame = {.id = 0x168, .time_ms = 77, .length = 8, .data = {8}};
    hal_can_send_ExpectAndReturn(&hal, HAL_CAN_VEHICLE, &frame, true);
    TEST_ASSERT_EQUAL(AGV_GATE_SENT, agv_gate_send(&gate, &hal, HAL_CAN_VEHICLE, &frame));
    hal_can_send_ExpectAndReturn(&hal, HAL_CAN_VEHICLE, &frame, false);
    TEST_ASSERT_EQUAL(AGV_GATE_BUSY, agv_gate_send(&gate, &hal, HAL_CAN_VEHICLE, &frame));
}

/* The mock fails the test when the HAL is called. */
/* Shows: INT-4, FSM-6 */
void test_a_refused_frame_never_reaches_the_hal(void) {
    const hal_can_frame_t drive = {.id = 0x168, .length = 8, .data = {1}};
    for (size_t i = 0; i < sizeof STATES; i++) {
        gate.state = STATES[i];
        TEST_ASSERT_EQUAL(AGV_GATE_REFUSED, agv_gate_send(&gate, &hal, HAL_CAN_VEHICLE, &drive));
        TEST_ASSERT_EQUAL(AGV_GATE_REFUSED, agv_gate_send(&gate, &hal, HAL_CAN_AI, &drive));
    }
}

/* Shows: TOP-4 */
void test_in_shadow_mode_nothing_reaches_the_hal(void) {
    hal_can_frame_t frame = {.id = 0x168, .length = 8, .data = {8}};
    config.shadow = AGV_SHADOW_ON;
    TEST_ASSERT_EQUAL(AGV_GATE_SHADOWED, agv_gate_send(&gate, &hal, HAL_CAN_VEHICLE, &frame));
    frame.data[0] = 1;
    TEST_ASSERT_EQUAL(AGV_GATE_REFUSED, agv_gate_send(&gate, &hal, HAL_CAN_VEHICLE, &frame));
}

/* Only the value `on` keeps a safe command back. */
/* Shows: FSM-6, TOP-4 */
TEST_CASE(2)
TEST_CASE(0xFFFF)
void test_a_safe_command_leaves_with_a_value_of_shadow_without_meaning(unsigned value) {
    const hal_can_frame_t frame = {.id = 0x168, .length = 8, .data = {8}};
    config.shadow = (uint16_t)value;
    hal_can_send_ExpectAndReturn(&hal, HAL_CAN_VEHICLE, &frame, true);
    TEST_ASSERT_EQUAL(AGV_GATE_SENT, agv_gate_send(&gate, &hal, HAL_CAN_VEHICLE, &frame));
}

/* The gate uses the configured identifiers, not those of the protocol. */
/* Shows: INT-4, P1 */
void test_the_gate_uses_the_identifiers_of_this_vehicle(void) {
    static const uint8_t park[8] = {8};
    static const uint8_t any[8] = {0};
    config.id_gear_command = 0x169;
    config.id_wheel_speed = 0x102;
    config.topology = AGV_TOPOLOGY_GATEWAY;
    agv_config_ids(&config, &ids);
    for (uint32_t id = 0; id <= 0x800; id++) {
        TEST_ASSERT_EQUAL(id == 0x169 || id == STATUS_ID, allows(HAL_CAN_VEHICLE, id, park));
    }
    TEST_ASSERT_TRUE(allows(HAL_CAN_AI, 0x102, any));
    TEST_ASSERT_FALSE(allows(HAL_CAN_AI, 0x101, any));
}

/* Such a configuration is refused. The gate also refuses the command whose identifier belongs to an earlier message. */
/* Shows: INT-4, P1 */
void test_an_identifier_twice_is_that_of_the_first_message(void) {
    static const uint8_t zeros[8] = {0};
    static const uint8_t park[8] = {8};
    ids.of[AGV_MSG_WHEEL_SPEED] = 0x168;
    TEST_ASSERT_TRUE(allows(HAL_CAN_VEHICLE, 0x168, park));
    TEST_ASSERT_FALSE(allows(HAL_CAN_VEHICLE, 0x168, zeros));
}

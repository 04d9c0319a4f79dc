/*
 * Pack and unpack of every message. All payloads are written by hand from the protocol document.
 *
 * The payload under test is at an odd address between two guard bytes: no function may need alignment or write beyond
 * its payload.
 */
#include "agv/codec.h"

#include "unity.h"

#include <string.h>

#define GUARD 0xA5u

static uint8_t memory[AGV_DLC + 2u] __attribute__((aligned(8)));
static uint8_t *const data = &memory[1];

void setUp(void) {
    memset(memory, GUARD, sizeof memory);
}

void tearDown(void) {
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(GUARD, memory[0], "wrote in front of the payload");
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(GUARD, memory[AGV_DLC + 1u], "wrote behind the payload");
}

#define ASSERT_PAYLOAD(...) assert_payload((const uint8_t[AGV_DLC]){__VA_ARGS__}, __LINE__)
#define ASSERT_UNTOUCHED() ASSERT_PAYLOAD(GUARD, GUARD, GUARD, GUARD, GUARD, GUARD, GUARD, GUARD)
#define RECEIVE(...) memcpy(data, ((const uint8_t[AGV_DLC]){__VA_ARGS__}), AGV_DLC)

static void assert_payload(const uint8_t *expected, UNITY_LINE_TYPE line) {
    UNITY_TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, data, AGV_DLC, line, "payload");
}

/* ---- 43Fh / 201h: turn signal command -------------------------------------------------------------------------- */

/* Shows: P3, P11, P14 */
void test_turn_signal_command_each_bit_has_its_place(void) {
    agv_turn_signal_command_t in = {.headlight_on = true};

    TEST_ASSERT_TRUE(agv_pack_turn_signal_command(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0, 0x00, 0, 0, 0);
    in = (agv_turn_signal_command_t){.headlight_on = true, .turn_left_on = true};
    TEST_ASSERT_TRUE(agv_pack_turn_signal_command(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0, 0x10, 0, 0, 0);
    in = (agv_turn_signal_command_t){.headlight_on = true, .turn_right_on = true};
    TEST_ASSERT_TRUE(agv_pack_turn_signal_command(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0, 0x20, 0, 0, 0);
    in = (agv_turn_signal_command_t){.headlight_on = true, .autopilot_off = true};
    TEST_ASSERT_TRUE(agv_pack_turn_signal_command(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0, 0x40, 0, 0, 0);
}

/* Shows: P11 */
void test_turn_signal_command_headlight_is_inverted_on_the_wire(void) {
    const agv_turn_signal_command_t off = {.headlight_on = false};
    agv_turn_signal_command_t out = {.headlight_on = true};

    TEST_ASSERT_TRUE(agv_pack_turn_signal_command(data, &off));
    ASSERT_PAYLOAD(0, 0, 0, 0, 0x80, 0, 0, 0);
    TEST_ASSERT_TRUE(agv_unpack_turn_signal_command(&out, data));
    TEST_ASSERT_FALSE(out.headlight_on);
    RECEIVE(0, 0, 0, 0, 0x00, 0, 0, 0);
    TEST_ASSERT_TRUE(agv_unpack_turn_signal_command(&out, data));
    TEST_ASSERT_TRUE(out.headlight_on);
}

/* Shows: P12, P13 */
void test_turn_signal_command_of_the_safe_state(void) {
    const agv_turn_signal_command_t in = {.turn_left_on = true,
                                          .turn_right_on = true,
                                          .autopilot_off = true,
                                          .headlight_on = true,
                                          .alive_counter = 0xFF};

    TEST_ASSERT_TRUE(agv_pack_turn_signal_command(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0, 0x70, 0, 0, 0xFF);
}

/* Shows: P3, P12, P13 */
void test_turn_signal_command_unpack_reads_each_bit(void) {
    agv_turn_signal_command_t out;

    memset(&out, 0, sizeof out);
    RECEIVE(0, 0, 0, 0, 0x90, 0, 0, 0x01);
    TEST_ASSERT_TRUE(agv_unpack_turn_signal_command(&out, data));
    TEST_ASSERT_TRUE(out.turn_left_on);
    TEST_ASSERT_FALSE(out.turn_right_on);
    TEST_ASSERT_FALSE(out.autopilot_off);
    TEST_ASSERT_FALSE(out.headlight_on);
    TEST_ASSERT_EQUAL_UINT8(0x01, out.alive_counter);

    RECEIVE(0, 0, 0, 0, 0x60, 0, 0, 0xFF);
    TEST_ASSERT_TRUE(agv_unpack_turn_signal_command(&out, data));
    TEST_ASSERT_FALSE(out.turn_left_on);
    TEST_ASSERT_TRUE(out.turn_right_on);
    TEST_ASSERT_TRUE(out.autopilot_off);
    TEST_ASSERT_TRUE(out.headlight_on);
    TEST_ASSERT_EQUAL_UINT8(0xFF, out.alive_counter);
}

/* Shows: P14 */
void test_turn_signal_command_unpack_ignores_reserved_bits(void) {
    agv_turn_signal_command_t out = {.turn_left_on = true, .turn_right_on = true, .autopilot_off = true};

    RECEIVE(0xFF, 0xFF, 0xFF, 0xFF, 0x0F, 0xFF, 0xFF, 0x7E);
    TEST_ASSERT_TRUE(agv_unpack_turn_signal_command(&out, data));
    TEST_ASSERT_FALSE(out.turn_left_on);
    TEST_ASSERT_FALSE(out.turn_right_on);
    TEST_ASSERT_FALSE(out.autopilot_off);
    TEST_ASSERT_TRUE(out.headlight_on);
    TEST_ASSERT_EQUAL_HEX8(0x7E, out.alive_counter);
}

/* ---- 168h and 0A3h: gear command and gear status --------------------------------------------------------------- */

/* Shows: P2, P14 */
void test_gear_each_code_is_sent(void) {
    agv_gear_command_t command = {.gear = AGV_GEAR_P};
    agv_gear_status_t status = {.gear = AGV_GEAR_D};

    TEST_ASSERT_TRUE(agv_pack_gear_command(data, &command));
    ASSERT_PAYLOAD(8, 0, 0, 0, 0, 0, 0, 0);
    command.gear = AGV_GEAR_N;
    TEST_ASSERT_TRUE(agv_pack_gear_command(data, &command));
    ASSERT_PAYLOAD(4, 0, 0, 0, 0, 0, 0, 0);
    command.gear = AGV_GEAR_R;
    TEST_ASSERT_TRUE(agv_pack_gear_command(data, &command));
    ASSERT_PAYLOAD(2, 0, 0, 0, 0, 0, 0, 0);
    command.gear = AGV_GEAR_D;
    TEST_ASSERT_TRUE(agv_pack_gear_command(data, &command));
    ASSERT_PAYLOAD(1, 0, 0, 0, 0, 0, 0, 0);

    TEST_ASSERT_TRUE(agv_pack_gear_status(data, &status));
    ASSERT_PAYLOAD(1, 0, 0, 0, 0, 0, 0, 0);
    status.gear = AGV_GEAR_P;
    TEST_ASSERT_TRUE(agv_pack_gear_status(data, &status));
    ASSERT_PAYLOAD(8, 0, 0, 0, 0, 0, 0, 0);
}

/* Shows: P2 */
void test_gear_of_all_byte_values_four_are_gears(void) {
    for (unsigned code = 0; code <= 0xFFu; code++) {
        const bool valid = (code == 1u) || (code == 2u) || (code == 4u) || (code == 8u);
        const agv_gear_command_t command = {.gear = (uint8_t)code};
        const agv_gear_status_t status = {.gear = (uint8_t)code};
        agv_gear_command_t command_out = {.gear = 0x55};
        agv_gear_status_t status_out = {.gear = 0x55};

        memset(data, GUARD, AGV_DLC);
        TEST_ASSERT_EQUAL(valid, agv_pack_gear_command(data, &command));
        TEST_ASSERT_EQUAL_HEX8(valid ? code : GUARD, data[0]);
        memset(data, GUARD, AGV_DLC);
        TEST_ASSERT_EQUAL(valid, agv_pack_gear_status(data, &status));
        TEST_ASSERT_EQUAL_HEX8(valid ? code : GUARD, data[0]);

        data[0] = (uint8_t)code;
        TEST_ASSERT_EQUAL(valid, agv_unpack_gear_command(&command_out, data));
        TEST_ASSERT_EQUAL_HEX8(code, command_out.gear);
        TEST_ASSERT_EQUAL(valid, agv_unpack_gear_status(&status_out, data));
        TEST_ASSERT_EQUAL_HEX8(code, status_out.gear);
    }
}

/* Shows: P2 */
void test_gear_refused_pack_leaves_the_payload_untouched(void) {
    const agv_gear_command_t command = {.gear = 0};
    const agv_gear_status_t status = {.gear = 3};

    TEST_ASSERT_FALSE(agv_pack_gear_command(data, &command));
    ASSERT_UNTOUCHED();
    TEST_ASSERT_FALSE(agv_pack_gear_status(data, &status));
    ASSERT_UNTOUCHED();
}

/* Shows: P14 */
void test_gear_unpack_ignores_reserved_bytes(void) {
    agv_gear_command_t command = {.gear = 0};
    agv_gear_status_t status = {.gear = 0};

    RECEIVE(0x08, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF);
    TEST_ASSERT_TRUE(agv_unpack_gear_command(&command, data));
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_P, command.gear);
    TEST_ASSERT_TRUE(agv_unpack_gear_status(&status, data));
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_P, status.gear);
}

/* ---- 075h and 050h: throttle command and throttle status ------------------------------------------------------- */

static void assert_throttle_packs(uint16_t permille, uint8_t counts) {
    const agv_throttle_command_t command = {.throttle_permille = permille};
    const agv_throttle_status_t status = {.throttle_permille = permille};

    memset(data, GUARD, AGV_DLC);
    TEST_ASSERT_TRUE(agv_pack_throttle_command(data, &command));
    ASSERT_PAYLOAD(counts, 0, 0, 0, 0, 0, 0, 0);
    memset(data, GUARD, AGV_DLC);
    TEST_ASSERT_TRUE(agv_pack_throttle_status(data, &status));
    ASSERT_PAYLOAD(counts, 0, 0, 0, 0, 0, 0, 0);
}

static void assert_throttle_is_refused(uint16_t permille) {
    const agv_throttle_command_t command = {.throttle_permille = permille};
    const agv_throttle_status_t status = {.throttle_permille = permille};

    TEST_ASSERT_FALSE(agv_pack_throttle_command(data, &command));
    ASSERT_UNTOUCHED();
    TEST_ASSERT_FALSE(agv_pack_throttle_status(data, &status));
    ASSERT_UNTOUCHED();
}

static void assert_throttle_unpacks(uint8_t counts, uint16_t permille, bool valid) {
    agv_throttle_command_t command = {.throttle_permille = 0x5555};
    agv_throttle_status_t status = {.throttle_permille = 0x5555};

    RECEIVE(counts, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF);
    TEST_ASSERT_EQUAL(valid, agv_unpack_throttle_command(&command, data));
    TEST_ASSERT_EQUAL_UINT16(permille, command.throttle_permille);
    TEST_ASSERT_EQUAL(valid, agv_unpack_throttle_status(&status, data));
    TEST_ASSERT_EQUAL_UINT16(permille, status.throttle_permille);
}

/* Shows: P6, P14 */
void test_throttle_is_sent_in_steps_of_4_permille(void) {
    assert_throttle_packs(0, 0);
    assert_throttle_packs(4, 1);
    assert_throttle_packs(500, 125);
    assert_throttle_packs(996, 249);
    assert_throttle_packs(1000, 250);
}

/* Shows: P6 */
void test_throttle_between_two_steps_is_rounded_down(void) {
    assert_throttle_packs(3, 0);
    assert_throttle_packs(7, 1);
    assert_throttle_packs(999, 249);
}

/* Shows: P6 */
void test_throttle_above_100_percent_is_refused(void) {
    assert_throttle_is_refused(1001);
    assert_throttle_is_refused(1004);
    assert_throttle_is_refused(1024);
    assert_throttle_is_refused(UINT16_MAX);
}

/* Shows: P6, P14 */
void test_throttle_is_read_up_to_250_counts(void) {
    assert_throttle_unpacks(0, 0, true);
    assert_throttle_unpacks(1, 4, true);
    assert_throttle_unpacks(250, 1000, true);
    assert_throttle_unpacks(251, 1004, false);
    assert_throttle_unpacks(255, 1020, false);
}

/* ---- 065h: steering command ------------------------------------------------------------------------------------ */

static void assert_steering_command_packs(int32_t angle_ddeg, uint8_t low, uint8_t high) {
    const agv_steering_command_t in = {.angle_ddeg = angle_ddeg};

    memset(data, GUARD, AGV_DLC);
    TEST_ASSERT_TRUE(agv_pack_steering_command(data, &in));
    ASSERT_PAYLOAD(low, high, 0, 0, 0, 0, 0, 0);
}

static void assert_steering_command_is_refused(int32_t angle_ddeg) {
    const agv_steering_command_t in = {.angle_ddeg = angle_ddeg};

    TEST_ASSERT_FALSE(agv_pack_steering_command(data, &in));
    ASSERT_UNTOUCHED();
}

static void assert_steering_command_unpacks(uint8_t low, uint8_t high, int32_t angle_ddeg, bool valid) {
    agv_steering_command_t out = {.angle_ddeg = 0x55555555};

    RECEIVE(low, high, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF);
    TEST_ASSERT_EQUAL(valid, agv_unpack_steering_command(&out, data));
    TEST_ASSERT_EQUAL_INT32(angle_ddeg, out.angle_ddeg);
}

/* Shows: P4, P5, P14 */
void test_steering_command_counts_from_the_centre_low_byte_first(void) {
    assert_steering_command_packs(0, 0x28, 0x23);     /* 9000 */
    assert_steering_command_packs(1, 0x29, 0x23);     /* 9001 */
    assert_steering_command_packs(-1, 0x27, 0x23);    /* 8999 */
    assert_steering_command_packs(500, 0x1C, 0x25);   /* 50.0 degrees: 9500 */
    assert_steering_command_packs(-9000, 0x00, 0x00); /* 0 */
    assert_steering_command_packs(9000, 0x50, 0x46);  /* 18000 */
}

/* Shows: P5 */
void test_steering_command_beyond_900_degrees_is_refused(void) {
    assert_steering_command_is_refused(9001);
    assert_steering_command_is_refused(-9001);
    assert_steering_command_is_refused(0x10000); /* would pass if only 16 bits were checked */
    assert_steering_command_is_refused(INT32_MAX);
    assert_steering_command_is_refused(INT32_MIN);
}

/* Shows: P4, P5, P14 */
void test_steering_command_is_read_up_to_18000(void) {
    assert_steering_command_unpacks(0x28, 0x23, 0, true);
    assert_steering_command_unpacks(0x1C, 0x25, 500, true);
    assert_steering_command_unpacks(0x00, 0x00, -9000, true);
    assert_steering_command_unpacks(0x50, 0x46, 9000, true);
    assert_steering_command_unpacks(0x51, 0x46, 9001, false);
    assert_steering_command_unpacks(0xFF, 0xFF, 56535, false);
}

/* ---- 363h / 203h: vehicle status ------------------------------------------------------------------------------- */

static void assert_vehicle_status(const agv_vehicle_status_t *expected, const agv_vehicle_status_t *actual) {
    TEST_ASSERT_EQUAL_UINT16(expected->speed_m_per_h, actual->speed_m_per_h);
    TEST_ASSERT_EQUAL_HEX8(expected->level1_alarms, actual->level1_alarms);
    TEST_ASSERT_EQUAL_HEX8(expected->level2_alarms, actual->level2_alarms);
    TEST_ASSERT_EQUAL(expected->button_1, actual->button_1);
    TEST_ASSERT_EQUAL(expected->button_2, actual->button_2);
    TEST_ASSERT_EQUAL(expected->turn_left_on, actual->turn_left_on);
    TEST_ASSERT_EQUAL(expected->turn_right_on, actual->turn_right_on);
    TEST_ASSERT_EQUAL(expected->manual_mode, actual->manual_mode);
    TEST_ASSERT_EQUAL(expected->autopilot_mode, actual->autopilot_mode);
    TEST_ASSERT_EQUAL_UINT8(expected->alive_counter, actual->alive_counter);
}

/* Packs to the payload, and the payload unpacks to the same. */
static void assert_vehicle_status_is(const agv_vehicle_status_t *status, const uint8_t *payload) {
    agv_vehicle_status_t out;

    memset(&out, 0, sizeof out);
    memset(data, GUARD, AGV_DLC);
    TEST_ASSERT_TRUE(agv_pack_vehicle_status(data, status));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(payload, data, AGV_DLC);
    memcpy(data, payload, AGV_DLC);
    TEST_ASSERT_TRUE(agv_unpack_vehicle_status(&out, data));
    assert_vehicle_status(status, &out);
}

#define ASSERT_VEHICLE_STATUS(status, ...) assert_vehicle_status_is(&(status), (const uint8_t[AGV_DLC]){__VA_ARGS__})

/* Shows: P4, P7 */
void test_vehicle_status_speed_is_unsigned_metres_per_hour_low_byte_first(void) {
    agv_vehicle_status_t s = {.speed_m_per_h = 0};

    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0, 0, 0, 0);
    s.speed_m_per_h = 5000; /* 5 km/h = 1388h */
    ASSERT_VEHICLE_STATUS(s, 0x88, 0x13, 0, 0, 0, 0, 0, 0);
    s.speed_m_per_h = 65535;
    ASSERT_VEHICLE_STATUS(s, 0xFF, 0xFF, 0, 0, 0, 0, 0, 0);
}

/* Shows: P3 */
void test_vehicle_status_each_alarm_has_its_bit(void) {
    agv_vehicle_status_t s = {.level1_alarms = AGV_VCU_ALARM_REMOTE_SIGNAL_LOST};

    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0x01, 0, 0, 0);
    s.level1_alarms = AGV_VCU_ALARM_REMOTE_POWER_LOST;
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0x02, 0, 0, 0);
    s.level1_alarms = AGV_VCU_ALARM_AI_CAN_LOST;
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0x08, 0, 0, 0);
    s.level1_alarms = AGV_VCU_ALARM_EPS_HARDWARE;
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0x10, 0, 0, 0);
    s.level1_alarms = AGV_VCU_ALARM_EPS_CAN_BUS;
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0x20, 0, 0, 0);
    s.level1_alarms = AGV_VCU_ALARM_S_DRIVER;
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0x80, 0, 0, 0);
    s = (agv_vehicle_status_t){.level2_alarms = 0xC3};
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0, 0xC3, 0, 0);
}

/* Shows: P3 */
void test_vehicle_status_each_flag_of_byte_7_has_its_bit(void) {
    agv_vehicle_status_t s = {.button_1 = true};

    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0, 0, 0x01, 0);
    s = (agv_vehicle_status_t){.button_2 = true};
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0, 0, 0x02, 0);
    s = (agv_vehicle_status_t){.turn_left_on = true};
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0, 0, 0x10, 0);
    s = (agv_vehicle_status_t){.turn_right_on = true};
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0, 0, 0x20, 0);
    s = (agv_vehicle_status_t){.manual_mode = true};
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0, 0, 0x40, 0);
    s = (agv_vehicle_status_t){.autopilot_mode = true};
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0, 0, 0x80, 0);
}

/* Shows: P13 */
void test_vehicle_status_alive_counter_is_byte_8(void) {
    agv_vehicle_status_t s = {.alive_counter = 1};

    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0, 0, 0, 0x01);
    s.alive_counter = 0xFF;
    ASSERT_VEHICLE_STATUS(s, 0, 0, 0, 0, 0, 0, 0, 0xFF);
}

/* Shows: P14 */
void test_vehicle_status_sends_reserved_alarm_bits_as_0(void) {
    const agv_vehicle_status_t all = {.speed_m_per_h = 0xFFFF,
                                      .level1_alarms = 0xFF,
                                      .level2_alarms = 0xFF,
                                      .button_1 = true,
                                      .button_2 = true,
                                      .turn_left_on = true,
                                      .turn_right_on = true,
                                      .manual_mode = true,
                                      .autopilot_mode = true,
                                      .alive_counter = 0xFF};

    TEST_ASSERT_TRUE(agv_pack_vehicle_status(data, &all));
    ASSERT_PAYLOAD(0xFF, 0xFF, 0, 0, 0xBB, 0xFF, 0xF3, 0xFF);
}

/* Shows: P14 */
void test_vehicle_status_unpack_ignores_reserved_bits(void) {
    const agv_vehicle_status_t nothing = {.speed_m_per_h = 0};
    agv_vehicle_status_t out;

    memset(&out, 1, sizeof out);
    RECEIVE(0, 0, 0xFF, 0xFF, 0x44, 0, 0x0C, 0);
    TEST_ASSERT_TRUE(agv_unpack_vehicle_status(&out, data));
    assert_vehicle_status(&nothing, &out);
}

/* ---- 067h: steering status ------------------------------------------------------------------------------------- */

/* Shows: P3, P4, P5, P8, P9, P13 */
void test_steering_status_each_field_has_its_place(void) {
    const agv_steering_status_t in = {
        .alive_counter = 0x12, .supply_pct_of_12v = 100, .angle_ddeg = 500, .torque_raw = 0x3456, .speed_raw = 0x789A};
    agv_steering_status_t out = {.alive_counter = 0};

    TEST_ASSERT_TRUE(agv_pack_steering_status(data, &in));
    ASSERT_PAYLOAD(0x12, 0x64, 0x1C, 0x25, 0x56, 0x34, 0x9A, 0x78);
    RECEIVE(0x12, 0x64, 0x1C, 0x25, 0x56, 0x34, 0x9A, 0x78);
    TEST_ASSERT_TRUE(agv_unpack_steering_status(&out, data));
    TEST_ASSERT_EQUAL_HEX8(0x12, out.alive_counter);
    TEST_ASSERT_EQUAL_UINT8(100, out.supply_pct_of_12v);
    TEST_ASSERT_EQUAL_INT32(500, out.angle_ddeg);
    TEST_ASSERT_EQUAL_HEX16(0x3456, out.torque_raw);
    TEST_ASSERT_EQUAL_HEX16(0x789A, out.speed_raw);
}

/* Shows: P8, P9, P13 */
void test_steering_status_raw_fields_take_their_whole_range(void) {
    const agv_steering_status_t in = {.alive_counter = 0xFF,
                                      .supply_pct_of_12v = 0xFF,
                                      .angle_ddeg = 9000,
                                      .torque_raw = 0xFFFF,
                                      .speed_raw = 0xFFFF};
    agv_steering_status_t out = {.alive_counter = 0};

    TEST_ASSERT_TRUE(agv_pack_steering_status(data, &in));
    ASSERT_PAYLOAD(0xFF, 0xFF, 0x50, 0x46, 0xFF, 0xFF, 0xFF, 0xFF);
    TEST_ASSERT_TRUE(agv_unpack_steering_status(&out, data));
    TEST_ASSERT_EQUAL_UINT8(0xFF, out.alive_counter);
    TEST_ASSERT_EQUAL_UINT8(0xFF, out.supply_pct_of_12v);
    TEST_ASSERT_EQUAL_UINT16(0xFFFF, out.torque_raw);
    TEST_ASSERT_EQUAL_UINT16(0xFFFF, out.speed_raw);
}

static void assert_steering_status_is_refused(int32_t angle_ddeg) {
    const agv_steering_status_t in = {.alive_counter = 1, .angle_ddeg = angle_ddeg};

    TEST_ASSERT_FALSE(agv_pack_steering_status(data, &in));
    ASSERT_UNTOUCHED();
}

/* Shows: P5 */
void test_steering_status_angle_beyond_900_degrees_is_refused(void) {
    agv_steering_status_t in = {.angle_ddeg = -9000};

    assert_steering_status_is_refused(9001);
    assert_steering_status_is_refused(-9001);
    assert_steering_status_is_refused(INT32_MAX);
    assert_steering_status_is_refused(INT32_MIN);
    TEST_ASSERT_TRUE(agv_pack_steering_status(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0, 0, 0, 0, 0);
}

/* Shows: P5, P13 */
void test_steering_status_with_an_invalid_angle_still_has_its_other_fields(void) {
    agv_steering_status_t out = {.alive_counter = 0};

    RECEIVE(0x34, 0x5F, 0x51, 0x46, 0x01, 0x02, 0x03, 0x04);
    TEST_ASSERT_FALSE(agv_unpack_steering_status(&out, data));
    TEST_ASSERT_EQUAL_HEX8(0x34, out.alive_counter);
    TEST_ASSERT_EQUAL_HEX8(0x5F, out.supply_pct_of_12v);
    TEST_ASSERT_EQUAL_INT32(9001, out.angle_ddeg);
    TEST_ASSERT_EQUAL_HEX16(0x0201, out.torque_raw);
    TEST_ASSERT_EQUAL_HEX16(0x0403, out.speed_raw);
    RECEIVE(0, 0, 0x50, 0x46, 0, 0, 0, 0);
    TEST_ASSERT_TRUE(agv_unpack_steering_status(&out, data));
    TEST_ASSERT_EQUAL_INT32(9000, out.angle_ddeg);
    RECEIVE(0, 0, 0, 0, 0, 0, 0, 0);
    TEST_ASSERT_TRUE(agv_unpack_steering_status(&out, data));
    TEST_ASSERT_EQUAL_INT32(-9000, out.angle_ddeg);
}

/* ---- 167h: EPS status ------------------------------------------------------------------------------------------ */

/* Shows: P14, P18 */
void test_eps_status_each_mode_is_sent_in_byte_4(void) {
    agv_eps_status_t in = {.mode = AGV_EPS_MODE_ASSIST};

    TEST_ASSERT_TRUE(agv_pack_eps_status(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0x00, 0, 0, 0, 0);
    in.mode = AGV_EPS_MODE_ANGLE;
    TEST_ASSERT_TRUE(agv_pack_eps_status(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0x01, 0, 0, 0, 0);
    in.mode = AGV_EPS_MODE_SPEED;
    TEST_ASSERT_TRUE(agv_pack_eps_status(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0x02, 0, 0, 0, 0);
    in.mode = AGV_EPS_MODE_TORQUE;
    TEST_ASSERT_TRUE(agv_pack_eps_status(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0x03, 0, 0, 0, 0);
    in.mode = AGV_EPS_MODE_OFF;
    TEST_ASSERT_TRUE(agv_pack_eps_status(data, &in));
    ASSERT_PAYLOAD(0, 0, 0, 0xFF, 0, 0, 0, 0);
}

/* Shows: P18 */
void test_eps_status_of_all_byte_values_five_are_modes(void) {
    for (unsigned code = 0; code <= 0xFFu; code++) {
        const bool valid = (code <= 3u) || (code == 0xFFu);
        const agv_eps_status_t in = {.mode = (uint8_t)code, .faults = 0x11};
        agv_eps_status_t out = {.mode = 0x55, .faults = 0};

        memset(data, GUARD, AGV_DLC);
        TEST_ASSERT_EQUAL(valid, agv_pack_eps_status(data, &in));
        if (!valid) {
            ASSERT_UNTOUCHED();
        }
        RECEIVE(0, 0, 0, (uint8_t)code, 0, 0, 0, 0x81);
        TEST_ASSERT_EQUAL(valid, agv_unpack_eps_status(&out, data));
        TEST_ASSERT_EQUAL_HEX8(code, out.mode);
        TEST_ASSERT_EQUAL_HEX8(0x81, out.faults); /* valid in every mode */
    }
}

/* Shows: P3 */
void test_eps_status_each_fault_has_its_bit(void) {
    static const uint8_t FAULTS[] = {
        AGV_EPS_FAULT_UNDER_VOLTAGE,         /* bit 1 */
        AGV_EPS_FAULT_OVER_VOLTAGE,          /* bit 2 */
        AGV_EPS_FAULT_EXCESSIVE_CURRENT,     /* bit 3 */
        AGV_EPS_FAULT_OVER_CURRENT_SHUTDOWN, /* bit 4 */
        AGV_EPS_FAULT_TEMP_ABOVE_110,        /* bit 5 */
        AGV_EPS_FAULT_TEMP_ABOVE_120,        /* bit 6 */
        AGV_EPS_FAULT_MOTOR_ENCODER,         /* bit 7 */
        AGV_EPS_FAULT_POSITION_ENCODER,      /* bit 8 */
    };
    static const uint8_t BITS[] = {0x01, 0x02, 0x04, 0x08, 0x10, 0x20, 0x40, 0x80};

    for (size_t i = 0; i < sizeof BITS; i++) {
        const agv_eps_status_t in = {.mode = AGV_EPS_MODE_ANGLE, .faults = FAULTS[i]};
        agv_eps_status_t out = {.mode = 0, .faults = 0};

        TEST_ASSERT_TRUE(agv_pack_eps_status(data, &in));
        ASSERT_PAYLOAD(0, 0, 0, 0x01, 0, 0, 0, BITS[i]);
        TEST_ASSERT_TRUE(agv_unpack_eps_status(&out, data));
        TEST_ASSERT_EQUAL_HEX8(FAULTS[i], out.faults);
    }
}

/* Shows: P14 */
void test_eps_status_unpack_ignores_reserved_bytes(void) {
    agv_eps_status_t out = {.mode = 0x55, .faults = 0x55};

    RECEIVE(0xFF, 0xFF, 0xFF, 0x01, 0xFF, 0xFF, 0xFF, 0x00);
    TEST_ASSERT_TRUE(agv_unpack_eps_status(&out, data));
    TEST_ASSERT_EQUAL_HEX8(AGV_EPS_MODE_ANGLE, out.mode);
    TEST_ASSERT_EQUAL_HEX8(0, out.faults);
}

/* ---- 267h: steering position ----------------------------------------------------------------------------------- */

/* Shows: P4, P14 */
void test_steering_position_is_sent_high_byte_first(void) {
    const agv_steering_position_t in = {.centre_raw = 0x1234, .left_raw = 0x5678, .right_raw = 0x9ABC};
    const agv_steering_position_t all = {.centre_raw = 0xFFFF, .left_raw = 0xFFFF, .right_raw = 0xFFFF};

    TEST_ASSERT_TRUE(agv_pack_steering_position(data, &in));
    ASSERT_PAYLOAD(0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC, 0, 0);
    TEST_ASSERT_TRUE(agv_pack_steering_position(data, &all));
    ASSERT_PAYLOAD(0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0);
}

/* Shows: P4, P14 */
void test_steering_position_is_read_high_byte_first(void) {
    agv_steering_position_t out = {.centre_raw = 0};

    RECEIVE(0x00, 0x01, 0x80, 0x00, 0x23, 0x28, 0xFF, 0xFF);
    TEST_ASSERT_TRUE(agv_unpack_steering_position(&out, data));
    TEST_ASSERT_EQUAL_HEX16(0x0001, out.centre_raw);
    TEST_ASSERT_EQUAL_HEX16(0x8000, out.left_raw);
    TEST_ASSERT_EQUAL_HEX16(0x2328, out.right_raw);
}

/* ---- 101h: wheel speed ----------------------------------------------------------------------------------------- */

/* Packs to the payload, and the payload unpacks to the same. */
static void assert_wheel_speed_is(int32_t left, int32_t right, const uint8_t *payload) {
    const agv_wheel_speed_t in = {.left_mm_s = left, .right_mm_s = right};
    agv_wheel_speed_t out = {.left_mm_s = 0x55555555, .right_mm_s = 0x55555555};

    TEST_ASSERT_TRUE(agv_pack_wheel_speed(data, &in));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(payload, data, AGV_DLC);
    memcpy(data, payload, AGV_DLC);
    TEST_ASSERT_TRUE(agv_unpack_wheel_speed(&out, data));
    TEST_ASSERT_EQUAL_INT32(left, out.left_mm_s);
    TEST_ASSERT_EQUAL_INT32(right, out.right_mm_s);
}

#define ASSERT_WHEEL_SPEED(left, right, ...) assert_wheel_speed_is(left, right, (const uint8_t[AGV_DLC]){__VA_ARGS__})

/* Shows: P4, P10 */
void test_wheel_speed_is_signed_low_byte_first(void) {
    ASSERT_WHEEL_SPEED(0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
    ASSERT_WHEEL_SPEED(1500, -1000, 0xDC, 0x05, 0x00, 0x00, 0x18, 0xFC, 0xFF, 0xFF);
    ASSERT_WHEEL_SPEED(-1, 1, 0xFF, 0xFF, 0xFF, 0xFF, 0x01, 0x00, 0x00, 0x00);
    ASSERT_WHEEL_SPEED(0x12345678, -0x12345678, 0x78, 0x56, 0x34, 0x12, 0x88, 0xA9, 0xCB, 0xED);
}

/* Shows: P10 */
void test_wheel_speed_takes_the_whole_range(void) {
    ASSERT_WHEEL_SPEED(INT32_MIN, INT32_MAX, 0x00, 0x00, 0x00, 0x80, 0xFF, 0xFF, 0xFF, 0x7F);
    ASSERT_WHEEL_SPEED(INT32_MAX, INT32_MIN, 0xFF, 0xFF, 0xFF, 0x7F, 0x00, 0x00, 0x00, 0x80);
    ASSERT_WHEEL_SPEED(INT32_MIN + 1, INT32_MAX - 1, 0x01, 0x00, 0x00, 0x80, 0xFE, 0xFF, 0xFF, 0x7F);
}

/* Return value of agv_unpack_X for every value of the bytes that it checks. */
void test_value_is_valid_agrees_with_unpack(void) {
    agv_gear_command_t gear;
    agv_throttle_command_t throttle;
    agv_steering_command_t steering;
    agv_steering_status_t measured;
    agv_eps_status_t eps;
    uint8_t bytes[AGV_DLC] = {0};
    for (unsigned value = 0; value < 0x10000u; value++) {
        bytes[0] = (uint8_t)value;
        bytes[1] = (uint8_t)(value >> 8);
        bytes[2] = bytes[0];
        bytes[3] = bytes[1];
        const bool gear_is_known = agv_unpack_gear_command(&gear, bytes);
        const bool throttle_is_known = agv_unpack_throttle_command(&throttle, bytes);
        TEST_ASSERT_EQUAL(gear_is_known, agv_value_is_valid(AGV_MSG_GEAR_COMMAND, bytes));
        TEST_ASSERT_EQUAL(gear_is_known, agv_value_is_valid(AGV_MSG_GEAR_STATUS, bytes));
        TEST_ASSERT_EQUAL(throttle_is_known, agv_value_is_valid(AGV_MSG_THROTTLE_COMMAND, bytes));
        TEST_ASSERT_EQUAL(throttle_is_known, agv_value_is_valid(AGV_MSG_THROTTLE_STATUS, bytes));
        TEST_ASSERT_EQUAL(agv_unpack_steering_command(&steering, bytes),
                          agv_value_is_valid(AGV_MSG_STEERING_COMMAND, bytes));
        TEST_ASSERT_EQUAL(agv_unpack_steering_status(&measured, bytes),
                          agv_value_is_valid(AGV_MSG_STEERING_STATUS, bytes));
        TEST_ASSERT_EQUAL(agv_unpack_eps_status(&eps, bytes), agv_value_is_valid(AGV_MSG_EPS_STATUS, bytes));
        TEST_ASSERT_TRUE(agv_value_is_valid(AGV_MSG_TURN_SIGNAL_COMMAND, bytes));
        TEST_ASSERT_TRUE(agv_value_is_valid(AGV_MSG_VEHICLE_STATUS, bytes));
        TEST_ASSERT_TRUE(agv_value_is_valid(AGV_MSG_STEERING_POSITION, bytes));
        TEST_ASSERT_TRUE(agv_value_is_valid(AGV_MSG_WHEEL_SPEED, bytes));
    }
}

void test_an_angle_is_written_as_it_is_read(void) {
    uint8_t bytes[2];
    for (uint32_t raw = 0; raw <= UINT16_MAX; raw++) {
        agv_angle_write(bytes, raw);
        TEST_ASSERT_EQUAL_UINT32(raw, agv_angle_read(bytes));
        TEST_ASSERT_EQUAL_UINT32(raw, bytes[0] | bytes[1] << 8);
    }
}

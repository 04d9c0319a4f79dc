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

static uint8_t memory[AGV_DLC + 2] __attribute__((aligned(8)));
static uint8_t *const data = &memory[1];

void setUp(void) {
    memset(memory, GUARD, sizeof memory);
}

void tearDown(void) {
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(GUARD, memory[0], "wrote in front of the payload");
    TEST_ASSERT_EQUAL_HEX8_MESSAGE(GUARD, memory[AGV_DLC + 1], "wrote behind the payload");
}

static void assert_payload(const uint8_t *expected, UNITY_LINE_TYPE line) {
    UNITY_TEST_ASSERT_EQUAL_HEX8_ARRAY(expected, data, AGV_DLC, line, "payload");
}

/* ---- One line a case: the fields of a message, and its bytes. Fields and bytes that are not written are 0. ---- */

#define BYTES(...) ((const uint8_t[AGV_DLC]){__VA_ARGS__})

#define PACKS(message, bytes, ...)                                                                                     \
    do {                                                                                                               \
        const agv_##message##_t in = {__VA_ARGS__};                                                                    \
        memset(data, GUARD, AGV_DLC);                                                                                  \
        TEST_ASSERT_TRUE(agv_pack_##message(data, &in));                                                               \
        assert_payload(bytes, __LINE__);                                                                               \
    } while (0)

/* Does not pack; the payload is unchanged. */
#define REFUSES(message, ...)                                                                                          \
    do {                                                                                                               \
        const agv_##message##_t in = {__VA_ARGS__};                                                                    \
        memset(data, GUARD, AGV_DLC);                                                                                  \
        TEST_ASSERT_FALSE(agv_pack_##message(data, &in));                                                              \
        assert_payload(BYTES(GUARD, GUARD, GUARD, GUARD, GUARD, GUARD, GUARD, GUARD), __LINE__);                       \
    } while (0)

/* Returns `valid`, and writes all fields, whatever they were. */
#define UNPACKS(valid, message, bytes, ...)                                                                            \
    do {                                                                                                               \
        const agv_##message##_t expected = {__VA_ARGS__};                                                              \
        memcpy(data, bytes, AGV_DLC);                                                                                  \
        for (int fill = 0; fill <= 1; fill++) {                                                                        \
            agv_##message##_t out;                                                                                     \
            memset(&out, fill, sizeof out);                                                                            \
            UNITY_TEST_ASSERT_EQUAL_INT(valid, agv_unpack_##message(&out, data), __LINE__, "valid");                   \
            same_##message(&expected, &out, __LINE__);                                                                 \
        }                                                                                                              \
    } while (0)

#define PACKS_AND_UNPACKS(message, bytes, ...)                                                                         \
    do {                                                                                                               \
        PACKS(message, bytes, __VA_ARGS__);                                                                            \
        UNPACKS(true, message, bytes, __VA_ARGS__);                                                                    \
    } while (0)

#define SAME(message) static void same_##message(const agv_##message##_t *a, const agv_##message##_t *b, unsigned line)
#define FIELD(name) UNITY_TEST_ASSERT_EQUAL_INT(a->name, b->name, line, #name)

SAME(turn_signal_command) {
    FIELD(turn_left_on);
    FIELD(turn_right_on);
    FIELD(autopilot_off);
    FIELD(headlight_on);
    FIELD(alive_counter);
}

SAME(gear_command) {
    FIELD(gear);
}

SAME(gear_status) {
    FIELD(gear);
}

SAME(throttle_command) {
    FIELD(throttle_permille);
}

SAME(throttle_status) {
    FIELD(throttle_permille);
}

SAME(steering_command) {
    FIELD(angle_ddeg);
}

SAME(vehicle_status) {
    FIELD(speed_m_per_h);
    FIELD(level1_alarms);
    FIELD(level2_alarms);
    FIELD(button_1);
    FIELD(button_2);
    FIELD(turn_left_on);
    FIELD(turn_right_on);
    FIELD(manual_mode);
    FIELD(autopilot_mode);
    FIELD(alive_counter);
}

SAME(steering_status) {
    FIELD(alive_counter);
    FIELD(supply_pct_of_12v);
    FIELD(angle_ddeg);
    FIELD(torque_raw);
    FIELD(speed_raw);
}

SAME(eps_status) {
    FIELD(mode);
    FIELD(faults);
}

SAME(steering_position) {
    FIELD(centre_raw);
    FIELD(left_raw);
    FIELD(right_raw);
}

SAME(wheel_speed) {
    FIELD(left_mm_s);
    FIELD(right_mm_s);
}

/* ---- 43Fh / 201h: turn signal command; headlight is inverted on the wire ---- */

/* Shows: P3, P11, P12, P13, P14 */
void test_turn_signal_command_is_sent(void) {
    PACKS(turn_signal_command, BYTES(0, 0, 0, 0, 0x00), .headlight_on = true);
    PACKS(turn_signal_command, BYTES(0, 0, 0, 0, 0x10), .headlight_on = true, .turn_left_on = true);
    PACKS(turn_signal_command, BYTES(0, 0, 0, 0, 0x20), .headlight_on = true, .turn_right_on = true);
    PACKS(turn_signal_command, BYTES(0, 0, 0, 0, 0x40), .headlight_on = true, .autopilot_off = true);
    PACKS(turn_signal_command, BYTES(0, 0, 0, 0, 0x80), .headlight_on = false);
    PACKS(turn_signal_command, BYTES(0, 0, 0, 0, 0x70, 0, 0, 0xFF), .turn_left_on = true, .turn_right_on = true,
          .autopilot_off = true, .headlight_on = true, .alive_counter = 0xFF); /* in the safe state */
}

/* Shows: P3, P11, P12, P13, P14 */
void test_turn_signal_command_is_read(void) {
    UNPACKS(true, turn_signal_command, BYTES(0, 0, 0, 0, 0x80), .headlight_on = false);
    UNPACKS(true, turn_signal_command, BYTES(0, 0, 0, 0, 0x00), .headlight_on = true);
    UNPACKS(true, turn_signal_command, BYTES(0, 0, 0, 0, 0x90, 0, 0, 0x01), .turn_left_on = true, .alive_counter = 1);
    UNPACKS(true, turn_signal_command, BYTES(0, 0, 0, 0, 0x60, 0, 0, 0xFF), .turn_right_on = true,
            .autopilot_off = true, .headlight_on = true, .alive_counter = 0xFF);
    UNPACKS(true, turn_signal_command, BYTES(0xFF, 0xFF, 0xFF, 0xFF, 0x0F, 0xFF, 0xFF, 0x7E), .headlight_on = true,
            .alive_counter = 0x7E); /* reserved bits are ignored */
}

/* ---- 168h and 0A3h: gear command and gear status ---- */

/* Shows: P2, P14 */
void test_each_gear_has_its_code(void) {
    PACKS(gear_command, BYTES(8), .gear = AGV_GEAR_P);
    PACKS(gear_command, BYTES(4), .gear = AGV_GEAR_N);
    PACKS(gear_command, BYTES(2), .gear = AGV_GEAR_R);
    PACKS(gear_command, BYTES(1), .gear = AGV_GEAR_D);
    PACKS(gear_status, BYTES(1), .gear = AGV_GEAR_D);
    PACKS(gear_status, BYTES(8), .gear = AGV_GEAR_P);
    UNPACKS(true, gear_command, BYTES(0x08, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF), .gear = AGV_GEAR_P);
    UNPACKS(true, gear_status, BYTES(0x08, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF), .gear = AGV_GEAR_P);
}

/* Shows: P2 */
void test_of_all_byte_values_four_are_gears(void) {
    for (unsigned code = 0; code <= 0xFFu; code++) {
        const bool valid = (code == 1) || (code == 2) || (code == 4) || (code == 8);
        const uint8_t gear = (uint8_t)code;
        if (valid) {
            PACKS(gear_command, BYTES(gear), .gear = gear);
            PACKS(gear_status, BYTES(gear), .gear = gear);
        } else {
            REFUSES(gear_command, .gear = gear);
            REFUSES(gear_status, .gear = gear);
        }
        UNPACKS(valid, gear_command, BYTES(gear), .gear = gear);
        UNPACKS(valid, gear_status, BYTES(gear), .gear = gear);
    }
}

/* ---- 075h and 050h: throttle command and throttle status; one count is 4 permille, rounded down ---- */

/* Shows: P6, P14 */
void test_throttle_is_sent_in_steps_of_4_permille(void) {
    static const struct {
        uint16_t permille;
        uint8_t counts;
    } ROWS[] = {{0, 0}, {3, 0}, {4, 1}, {7, 1}, {500, 125}, {996, 249}, {999, 249}, {1000, 250}};
    for (size_t i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        PACKS(throttle_command, BYTES(ROWS[i].counts), .throttle_permille = ROWS[i].permille);
        PACKS(throttle_status, BYTES(ROWS[i].counts), .throttle_permille = ROWS[i].permille);
    }
}

/* Shows: P6 */
void test_throttle_above_100_percent_is_refused(void) {
    static const uint16_t ROWS[] = {1001, 1004, 1024, UINT16_MAX};
    for (size_t i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        REFUSES(throttle_command, .throttle_permille = ROWS[i]);
        REFUSES(throttle_status, .throttle_permille = ROWS[i]);
    }
}

/* Shows: P6, P14 */
void test_throttle_is_read_up_to_250_counts(void) {
    static const struct {
        uint8_t counts;
        uint16_t permille;
        bool valid;
    } ROWS[] = {{0, 0, true}, {1, 4, true}, {250, 1000, true}, {251, 1004, false}, {255, 1020, false}};
    for (size_t i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        const uint8_t bytes[AGV_DLC] = {ROWS[i].counts, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
        UNPACKS(ROWS[i].valid, throttle_command, bytes, .throttle_permille = ROWS[i].permille);
        UNPACKS(ROWS[i].valid, throttle_status, bytes, .throttle_permille = ROWS[i].permille);
    }
}

/* ---- 065h: steering command; counts from the centre, low byte first ---- */

/* Shows: P4, P5, P14 */
void test_steering_command_is_sent(void) {
    PACKS(steering_command, BYTES(0x28, 0x23), .angle_ddeg = 0);   /* 9000 */
    PACKS(steering_command, BYTES(0x29, 0x23), .angle_ddeg = 1);   /* 9001 */
    PACKS(steering_command, BYTES(0x27, 0x23), .angle_ddeg = -1);  /* 8999 */
    PACKS(steering_command, BYTES(0x1C, 0x25), .angle_ddeg = 500); /* 50.0 degrees: 9500 */
    PACKS(steering_command, BYTES(0x00, 0x00), .angle_ddeg = -9000);
    PACKS(steering_command, BYTES(0x50, 0x46), .angle_ddeg = 9000); /* 18000 */
}

/* Shows: P5 */
void test_steering_command_beyond_900_degrees_is_refused(void) {
    REFUSES(steering_command, .angle_ddeg = 9001);
    REFUSES(steering_command, .angle_ddeg = -9001);
    REFUSES(steering_command, .angle_ddeg = 0x10000); /* would pass if only 16 bits were checked */
    REFUSES(steering_command, .angle_ddeg = INT32_MAX);
    REFUSES(steering_command, .angle_ddeg = INT32_MIN);
}

/* Shows: P4, P5, P14 */
void test_steering_command_is_read_up_to_18000(void) {
    UNPACKS(true, steering_command, BYTES(0x28, 0x23, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF), .angle_ddeg = 0);
    UNPACKS(true, steering_command, BYTES(0x1C, 0x25, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF), .angle_ddeg = 500);
    UNPACKS(true, steering_command, BYTES(0x00, 0x00, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF), .angle_ddeg = -9000);
    UNPACKS(true, steering_command, BYTES(0x50, 0x46, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF), .angle_ddeg = 9000);
    UNPACKS(false, steering_command, BYTES(0x51, 0x46, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF), .angle_ddeg = 9001);
    UNPACKS(false, steering_command, BYTES(0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF), .angle_ddeg = 56535);
}

/* ---- 363h / 203h: vehicle status ---- */

/* Unsigned metres per hour, low byte first. */
/* Shows: P4, P7 */
void test_speed_of_the_vehicle_status(void) {
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0), .speed_m_per_h = 0);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0x88, 0x13), .speed_m_per_h = 5000); /* 5 km/h */
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0xFF, 0xFF), .speed_m_per_h = 65535);
}

/* Shows: P3 */
void test_each_alarm_of_the_vehicle_status_has_its_bit(void) {
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0x01), .level1_alarms = AGV_VCU_ALARM_REMOTE_SIGNAL_LOST);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0x02), .level1_alarms = AGV_VCU_ALARM_REMOTE_POWER_LOST);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0x08), .level1_alarms = AGV_VCU_ALARM_AI_CAN_LOST);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0x10), .level1_alarms = AGV_VCU_ALARM_EPS_HARDWARE);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0x20), .level1_alarms = AGV_VCU_ALARM_EPS_CAN_BUS);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0x80), .level1_alarms = AGV_VCU_ALARM_S_DRIVER);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0, 0xC3), .level2_alarms = 0xC3);
}

/* Shows: P3, P13 */
void test_each_flag_of_the_vehicle_status_has_its_bit(void) {
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0, 0, 0x01), .button_1 = true);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0, 0, 0x02), .button_2 = true);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0, 0, 0x10), .turn_left_on = true);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0, 0, 0x20), .turn_right_on = true);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0, 0, 0x40), .manual_mode = true);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0, 0, 0x80), .autopilot_mode = true);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0, 0, 0, 0x01), .alive_counter = 1);
    PACKS_AND_UNPACKS(vehicle_status, BYTES(0, 0, 0, 0, 0, 0, 0, 0xFF), .alive_counter = 0xFF);
}

/* Shows: P14 */
void test_reserved_bits_of_the_vehicle_status(void) {
    PACKS(vehicle_status, BYTES(0xFF, 0xFF, 0, 0, 0xBB, 0xFF, 0xF3, 0xFF), .speed_m_per_h = 0xFFFF,
          .level1_alarms = 0xFF, .level2_alarms = 0xFF, .button_1 = true, .button_2 = true, .turn_left_on = true,
          .turn_right_on = true, .manual_mode = true, .autopilot_mode = true, .alive_counter = 0xFF);
    UNPACKS(true, vehicle_status, BYTES(0, 0, 0xFF, 0xFF, 0x44, 0, 0x0C, 0), .speed_m_per_h = 0);
}

/* ---- 067h: steering status ---- */

/* Shows: P3, P4, P5, P8, P9, P13 */
void test_each_field_of_the_steering_status_has_its_place(void) {
    PACKS_AND_UNPACKS(steering_status, BYTES(0x12, 0x64, 0x1C, 0x25, 0x56, 0x34, 0x9A, 0x78), .alive_counter = 0x12,
                      .supply_pct_of_12v = 100, .angle_ddeg = 500, .torque_raw = 0x3456, .speed_raw = 0x789A);
    PACKS_AND_UNPACKS(steering_status, BYTES(0xFF, 0xFF, 0x50, 0x46, 0xFF, 0xFF, 0xFF, 0xFF), .alive_counter = 0xFF,
                      .supply_pct_of_12v = 0xFF, .angle_ddeg = 9000, .torque_raw = 0xFFFF, .speed_raw = 0xFFFF);
    PACKS_AND_UNPACKS(steering_status, BYTES(0), .angle_ddeg = -9000);
}

/* Shows: P5 */
void test_steering_status_beyond_900_degrees_is_refused(void) {
    REFUSES(steering_status, .alive_counter = 1, .angle_ddeg = 9001);
    REFUSES(steering_status, .alive_counter = 1, .angle_ddeg = -9001);
    REFUSES(steering_status, .alive_counter = 1, .angle_ddeg = INT32_MAX);
    REFUSES(steering_status, .alive_counter = 1, .angle_ddeg = INT32_MIN);
}

/* Shows: P5, P13 */
void test_steering_status_with_an_invalid_angle_still_has_its_other_fields(void) {
    UNPACKS(false, steering_status, BYTES(0x34, 0x5F, 0x51, 0x46, 0x01, 0x02, 0x03, 0x04), .alive_counter = 0x34,
            .supply_pct_of_12v = 0x5F, .angle_ddeg = 9001, .torque_raw = 0x0201, .speed_raw = 0x0403);
    UNPACKS(true, steering_status, BYTES(0, 0, 0x50, 0x46), .angle_ddeg = 9000);
}

/* ---- 167h: EPS status ---- */

/* Shows: P14, P18 */
void test_each_mode_of_the_eps_has_its_code(void) {
    PACKS(eps_status, BYTES(0, 0, 0, 0x00), .mode = AGV_EPS_MODE_ASSIST);
    PACKS(eps_status, BYTES(0, 0, 0, 0x01), .mode = AGV_EPS_MODE_ANGLE);
    PACKS(eps_status, BYTES(0, 0, 0, 0x02), .mode = AGV_EPS_MODE_SPEED);
    PACKS(eps_status, BYTES(0, 0, 0, 0x03), .mode = AGV_EPS_MODE_TORQUE);
    PACKS(eps_status, BYTES(0, 0, 0, 0xFF), .mode = AGV_EPS_MODE_OFF);
    UNPACKS(true, eps_status, BYTES(0xFF, 0xFF, 0xFF, 0x01, 0xFF, 0xFF, 0xFF, 0x00), .mode = AGV_EPS_MODE_ANGLE);
}

/* The faults are read in every mode. */
/* Shows: P18 */
void test_of_all_byte_values_five_are_modes_of_the_eps(void) {
    for (unsigned code = 0; code <= 0xFFu; code++) {
        const bool valid = (code <= 3) || (code == 0xFFu);
        const uint8_t mode = (uint8_t)code;
        if (valid) {
            PACKS(eps_status, BYTES(0, 0, 0, mode, 0, 0, 0, 0x11), .mode = mode, .faults = 0x11);
        } else {
            REFUSES(eps_status, .mode = mode, .faults = 0x11);
        }
        UNPACKS(valid, eps_status, BYTES(0, 0, 0, mode, 0, 0, 0, 0x81), .mode = mode, .faults = 0x81);
    }
}

/* Shows: P3 */
void test_each_fault_of_the_eps_has_its_bit(void) {
    static const struct {
        uint8_t fault;
        uint8_t byte_8;
    } ROWS[] = {{AGV_EPS_FAULT_UNDER_VOLTAGE, 0x01},     {AGV_EPS_FAULT_OVER_VOLTAGE, 0x02},
                {AGV_EPS_FAULT_EXCESSIVE_CURRENT, 0x04}, {AGV_EPS_FAULT_OVER_CURRENT_SHUTDOWN, 0x08},
                {AGV_EPS_FAULT_TEMP_ABOVE_110, 0x10},    {AGV_EPS_FAULT_TEMP_ABOVE_120, 0x20},
                {AGV_EPS_FAULT_MOTOR_ENCODER, 0x40},     {AGV_EPS_FAULT_POSITION_ENCODER, 0x80}};
    for (size_t i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        PACKS_AND_UNPACKS(eps_status, BYTES(0, 0, 0, 0x01, 0, 0, 0, ROWS[i].byte_8), .mode = AGV_EPS_MODE_ANGLE,
                          .faults = ROWS[i].fault);
    }
}

/* ---- 267h: steering position; high byte first ---- */

/* Shows: P4, P14 */
void test_steering_position(void) {
    PACKS(steering_position, BYTES(0x12, 0x34, 0x56, 0x78, 0x9A, 0xBC, 0, 0), .centre_raw = 0x1234, .left_raw = 0x5678,
          .right_raw = 0x9ABC);
    PACKS(steering_position, BYTES(0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0, 0), .centre_raw = 0xFFFF, .left_raw = 0xFFFF,
          .right_raw = 0xFFFF);
    UNPACKS(true, steering_position, BYTES(0x00, 0x01, 0x80, 0x00, 0x23, 0x28, 0xFF, 0xFF), .centre_raw = 0x0001,
            .left_raw = 0x8000, .right_raw = 0x2328);
}

/* ---- 101h: wheel speed; signed, low byte first ---- */

/* Shows: P4, P10 */
void test_wheel_speed(void) {
    PACKS_AND_UNPACKS(wheel_speed, BYTES(0), .left_mm_s = 0);
    PACKS_AND_UNPACKS(wheel_speed, BYTES(0xDC, 0x05, 0x00, 0x00, 0x18, 0xFC, 0xFF, 0xFF), .left_mm_s = 1500,
                      .right_mm_s = -1000);
    PACKS_AND_UNPACKS(wheel_speed, BYTES(0xFF, 0xFF, 0xFF, 0xFF, 0x01, 0x00, 0x00, 0x00), .left_mm_s = -1,
                      .right_mm_s = 1);
    PACKS_AND_UNPACKS(wheel_speed, BYTES(0x78, 0x56, 0x34, 0x12, 0x88, 0xA9, 0xCB, 0xED), .left_mm_s = 0x12345678,
                      .right_mm_s = -0x12345678);
    PACKS_AND_UNPACKS(wheel_speed, BYTES(0x00, 0x00, 0x00, 0x80, 0xFF, 0xFF, 0xFF, 0x7F), .left_mm_s = INT32_MIN,
                      .right_mm_s = INT32_MAX);
    PACKS_AND_UNPACKS(wheel_speed, BYTES(0xFF, 0xFF, 0xFF, 0x7F, 0x00, 0x00, 0x00, 0x80), .left_mm_s = INT32_MAX,
                      .right_mm_s = INT32_MIN);
    PACKS_AND_UNPACKS(wheel_speed, BYTES(0x01, 0x00, 0x00, 0x80, 0xFE, 0xFF, 0xFF, 0x7F), .left_mm_s = INT32_MIN + 1,
                      .right_mm_s = INT32_MAX - 1);
}

/* ---- Single values ---- */

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

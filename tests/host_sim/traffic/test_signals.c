/* Signals with names and units, compared with the codec and with texts written by hand. */
#include "traffic/signals.h"

#include <string.h>

#include "agv/codec.h"
#include "agv/names.h"
#include "unity.h"

static uint8_t data[AGV_DLC];
static char text[SIGNALS_TEXT_SIZE];

void setUp(void) {
    memset(data, 0, sizeof data);
}

static const char *print(uint32_t message) {
    return signals_print(text, sizeof text, message, data);
}

/* A signal by its name, as a number in its unit. */
static double number(uint32_t message, const char *name) {
    signal_value_t value;
    for (size_t i = 0; signals_read(message, i, data, &value); i++) {
        if (strcmp(signals_info(message, i)->name, name) == 0) {
            return signals_number(signals_info(message, i), &value);
        }
    }
    TEST_FAIL_MESSAGE(name);
    return 0.0;
}

void test_every_message_has_a_name_and_signals(void) {
    for (uint32_t message = 0; message < SIGNALS_MESSAGES; message++) {
        TEST_ASSERT_NOT_NULL(signals_message_name(message));
        TEST_ASSERT_GREATER_THAN_UINT(0, signals_count(message));
        TEST_ASSERT_LESS_OR_EQUAL_UINT(SIGNALS_MAX, signals_count(message));
    }
    TEST_ASSERT_EQUAL_STRING("supervisor_status", signals_message_name(SIGNALS_STATUS_FRAME));
    TEST_ASSERT_NULL(signals_message_name(SIGNALS_STATUS_FRAME + 1));
    TEST_ASSERT_EQUAL_UINT(0, signals_count(SIGNALS_STATUS_FRAME + 1));
    TEST_ASSERT_NULL(signals_info(AGV_MSG_GEAR_STATUS, 1));
}

/* All bits of one message belong to signals, or are reserved: what a command may send is exactly its signals. */
void test_the_bits_of_commands_are_those_of_the_codec(void) {
    for (uint32_t message = 0; message < AGV_COMMAND_COUNT; message++) {
        uint8_t mask[AGV_DLC];
        signals_mask(message, mask);
        TEST_ASSERT_EQUAL_HEX8_ARRAY(agv_command_bits[message], mask, AGV_DLC);
    }
}

void test_numbers_are_those_of_the_codec(void) {
    static const int32_t angles[] = {-9000, -125, 0, 1, 9000};
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; i++) {
        const agv_steering_command_t command = {.angle_ddeg = angles[i]};
        TEST_ASSERT_TRUE(agv_pack_steering_command(data, &command));
        TEST_ASSERT_EQUAL_INT32(angles[i], (int32_t)(number(AGV_MSG_STEERING_COMMAND, "angle") * 10.0));
    }
    const agv_wheel_speed_t wheels = {.left_mm_s = -1234567, .right_mm_s = 2147483647};
    TEST_ASSERT_TRUE(agv_pack_wheel_speed(data, &wheels));
    TEST_ASSERT_EQUAL_INT32(-1234567, (int32_t)number(AGV_MSG_WHEEL_SPEED, "left"));
    TEST_ASSERT_EQUAL_INT32(2147483647, (int32_t)number(AGV_MSG_WHEEL_SPEED, "right"));
    const agv_steering_position_t position = {.centre_raw = 0x1234, .left_raw = 0xFFEE, .right_raw = 0x0001};
    TEST_ASSERT_TRUE(agv_pack_steering_position(data, &position));
    TEST_ASSERT_EQUAL_INT32(0x1234, (int32_t)number(AGV_MSG_STEERING_POSITION, "centre_raw"));
    TEST_ASSERT_EQUAL_INT32(0xFFEE, (int32_t)number(AGV_MSG_STEERING_POSITION, "left_raw"));
    TEST_ASSERT_EQUAL_INT32(1, (int32_t)number(AGV_MSG_STEERING_POSITION, "right_raw"));
    const agv_steering_status_t steering = {
        .alive_counter = 200, .supply_pct_of_12v = 95, .angle_ddeg = -1, .torque_raw = 0x1234, .speed_raw = 0x5678};
    TEST_ASSERT_TRUE(agv_pack_steering_status(data, &steering));
    TEST_ASSERT_EQUAL_STRING("alive_counter 200, supply 11.40 V, angle -0.1 deg, torque_raw 4660, speed_raw 22136",
                             print(AGV_MSG_STEERING_STATUS));
}

void test_texts(void) {
    data[0] = 8;
    TEST_ASSERT_EQUAL_STRING("gear P", print(AGV_MSG_GEAR_COMMAND));
    data[0] = 5;
    TEST_ASSERT_EQUAL_STRING("gear 5 (invalid)", print(AGV_MSG_GEAR_STATUS));
    data[0] = 3;
    TEST_ASSERT_EQUAL_STRING("throttle 1.2 %", print(AGV_MSG_THROTTLE_COMMAND));
    data[0] = 251;
    TEST_ASSERT_EQUAL_STRING("throttle 100.4 % (invalid)", print(AGV_MSG_THROTTLE_STATUS));
    data[0] = 0x51;
    data[1] = 0x46;
    TEST_ASSERT_EQUAL_STRING("angle 900.1 deg (invalid)", print(AGV_MSG_STEERING_COMMAND));
}

void test_flags_and_alarms_are_named_while_they_are_set(void) {
    data[4] = 0x70;
    data[7] = 9;
    TEST_ASSERT_EQUAL_STRING("turn_left, turn_right, autopilot_off, headlight, alive_counter 9",
                             print(AGV_MSG_TURN_SIGNAL_COMMAND));
    data[4] = 0x80;
    TEST_ASSERT_EQUAL_STRING("alive_counter 9", print(AGV_MSG_TURN_SIGNAL_COMMAND));
    const uint8_t status[AGV_DLC] = {0xB0, 0x04, 0, 0, 0x81, 3, 0x41, 17};
    TEST_ASSERT_EQUAL_STRING("speed 1200 m/h, REMOTE_SIGNAL_LOST, S_DRIVER_ALARM, VCU_LEVEL2_ALARM 3, button_1, "
                             "mode manual, alive_counter 17",
                             signals_print(text, sizeof text, AGV_MSG_VEHICLE_STATUS, status));
    const uint8_t both[AGV_DLC] = {0, 0, 0, 0, 0, 0, 0xC0, 0};
    TEST_ASSERT_EQUAL_STRING("speed 0 m/h, mode both (invalid), alive_counter 0",
                             signals_print(text, sizeof text, AGV_MSG_VEHICLE_STATUS, both));
    const uint8_t eps[AGV_DLC] = {0, 0, 0, 0xFF, 0, 0, 0, 0x41};
    TEST_ASSERT_EQUAL_STRING("mode off, EPS_UNDER_VOLTAGE, EPS_MOTOR_ENCODER",
                             signals_print(text, sizeof text, AGV_MSG_EPS_STATUS, eps));
}

void test_the_status_frame(void) {
    const uint8_t status[AGV_DLC] = {0x55, (uint8_t)AGV_FAULT_BUS_OFF, 0, 7, 0x78, 0x56, 0x34, 0x12};
    TEST_ASSERT_EQUAL_STRING("state TRIPPED, first_reason BUS_OFF, safety_output open, page 0, alive_counter 7, "
                             "config_checksum 12345678",
                             signals_print(text, sizeof text, SIGNALS_STATUS_FRAME, status));
}

void test_the_pages_of_the_status_frame(void) {
    const uint8_t version[AGV_DLC] = {0x33, 0xFF, 0x11, 8, 1, 2, 30, 0};
    TEST_ASSERT_EQUAL_STRING("state STANDBY, first_reason none, safety_output closed, page 1, alive_counter 8, "
                             "version_major 1, version_minor 2, version_patch 30",
                             signals_print(text, sizeof text, SIGNALS_STATUS_FRAME, version));
    const uint8_t revision[AGV_DLC] = {0x33, 0xFF, 0x21, 8, 0x0D, 0xF0, 0xFE, 0xCA};
    TEST_ASSERT_EQUAL_STRING("state STANDBY, first_reason none, safety_output closed, page 2, alive_counter 8, "
                             "revision CAFEF00D",
                             signals_print(text, sizeof text, SIGNALS_STATUS_FRAME, revision));
}

void test_every_alarm_is_a_fault(void) {
    for (uint32_t message = 0; message < SIGNALS_MESSAGES; message++) {
        for (size_t i = 0; i < signals_count(message); i++) {
            const signal_info_t *info = signals_info(message, i);
            if (info->kind == SIGNAL_ALARM) {
                TEST_ASSERT_EQUAL_STRING(info->name, agv_fault_name(info->fault));
            } else {
                TEST_ASSERT_EQUAL_INT(AGV_FAULT_NONE, info->fault);
            }
        }
    }
}

void test_a_text_without_room(void) {
    char small[16];
    data[1] = 100;
    TEST_ASSERT_EQUAL_STRING("alive_counter 0", signals_print(small, sizeof small, AGV_MSG_STEERING_STATUS, data));
}

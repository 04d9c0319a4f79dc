/* The last valid commands of an engagement. */
#include "observe/commands.h"

#include "unity.h"

static agv_commands_t commands;

void setUp(void) {
    commands = (agv_commands_t){0};
}

static void expect_known(unsigned set) {
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL((set >> i) & 1, agv_commands_has(&commands, i));
    }
}

/* Each command is read from its own bytes, and known independently of the others. */
/* Shows: SUP-5, SUP-11 */
void test_each_command_is_taken_by_itself(void) {
    static const uint8_t ones[8] = {1, 1, 1, 1, 1, 1, 1, 1};
    expect_known(0);
    agv_commands_take(&commands, AGV_MSG_STEERING_COMMAND, (const uint8_t[8]){0xA3, 0x23, 9, 9, 0xFF});
    expect_known(8);
    TEST_ASSERT_EQUAL_UINT16(9123, commands.angle_raw);
    agv_commands_take(&commands, AGV_MSG_THROTTLE_COMMAND, (const uint8_t[8]){250, 1, 1, 1, 0xFF});
    expect_known(8 | 4);
    TEST_ASSERT_EQUAL_UINT8(250, commands.throttle);
    agv_commands_take(&commands, AGV_MSG_GEAR_COMMAND, (const uint8_t[8]){2, 1, 1, 1, 0xFF});
    expect_known(8 | 4 | 2);
    TEST_ASSERT_EQUAL_UINT8(2, commands.gear);
    TEST_ASSERT_FALSE(commands.autopilot_off);
    agv_commands_take(&commands, AGV_MSG_TURN_SIGNAL_COMMAND, ones);
    expect_known(15);
    TEST_ASSERT_EQUAL_UINT16(9123, commands.angle_raw);
    TEST_ASSERT_EQUAL_UINT8(250, commands.throttle);
    TEST_ASSERT_EQUAL_UINT8(2, commands.gear);
}

/* 43Fh byte 5, bit 7 of the document. */
/* Shows: SUP-11 */
void test_autopilot_off_is_one_bit_of_43f(void) {
    for (unsigned bits = 0; bits < 256; bits++) {
        agv_commands_take(&commands, AGV_MSG_TURN_SIGNAL_COMMAND, (const uint8_t[8]){0, 0, 0, 0, (uint8_t)bits});
        TEST_ASSERT_EQUAL((bits & 0x40u) != 0, commands.autopilot_off);
    }
}

/* Shows: SUP-11 */
void test_an_engagement_begins_without_known_commands(void) {
    for (unsigned i = 0; i < 4; i++) {
        agv_commands_take(&commands, i, (const uint8_t[8]){1});
    }
    agv_commands_forget(&commands);
    expect_known(0);
    agv_commands_take(&commands, AGV_MSG_GEAR_COMMAND, (const uint8_t[8]){1});
    expect_known(2);
}

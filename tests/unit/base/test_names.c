/* The public names. Invalid values have none. */
#include "agv/names.h"

#include <stddef.h>
#include <string.h>

#include "settings_expected.h"
#include "unity.h"

void test_an_invalid_fault_has_no_name(void) {
    TEST_ASSERT_NULL(agv_fault_name(AGV_FAULT_NONE));
    TEST_ASSERT_NULL(agv_fault_name((agv_fault_t)255));
    TEST_ASSERT_EQUAL_UINT(AGV_FAULT_NONE, agv_fault_from_name(""));
    TEST_ASSERT_EQUAL_UINT(AGV_FAULT_NONE, agv_fault_from_name("BUS_OF"));
    TEST_ASSERT_EQUAL_UINT(AGV_FAULT_NONE, agv_fault_from_name("bus_off"));
}

void test_classes(void) {
    TEST_ASSERT_EQUAL_STRING("trip", agv_class_name(AGV_CLASS_TRIP));
    TEST_ASSERT_EQUAL_STRING("warn", agv_class_name(AGV_CLASS_WARN));
    TEST_ASSERT_EQUAL_STRING("warn", agv_class_name((agv_fault_class_t)255)); /* only a trip is called so */
}

void test_states(void) {
    unsigned named = 0;
    TEST_ASSERT_EQUAL_STRING("INIT", agv_state_name(AGV_STATE_INIT));
    TEST_ASSERT_EQUAL_STRING("STANDBY", agv_state_name(AGV_STATE_STANDBY));
    TEST_ASSERT_EQUAL_STRING("ACTIVE", agv_state_name(AGV_STATE_ACTIVE));
    TEST_ASSERT_EQUAL_STRING("TRIPPED", agv_state_name(AGV_STATE_TRIPPED));
    TEST_ASSERT_EQUAL_STRING("SAFE", agv_state_name(AGV_STATE_SAFE));
    for (unsigned value = 0; value < 256; value++) {
        named += (agv_state_name((agv_state_t)value) != NULL) ? 1 : 0;
    }
    TEST_ASSERT_EQUAL_UINT(5, named);
}

void test_messages_in_the_order_of_the_document(void) {
    static const char *const expected[] = {"turn_signal_command", "gear_command",    "throttle_command",
                                           "steering_command",    "vehicle_status",  "gear_status",
                                           "throttle_status",     "steering_status", "eps_status",
                                           "steering_position",   "wheel_speed"};
    for (unsigned i = 0; i < 11; i++) {
        TEST_ASSERT_EQUAL_STRING(expected[i], agv_message_name((agv_message_t)i));
    }
    TEST_ASSERT_NULL(agv_message_name(AGV_MSG_NONE));
    TEST_ASSERT_NULL(agv_message_name((agv_message_t)255));
}

static void assert_no_name_from(uint8_t first, const char *(*name)(uint8_t index)) {
    for (uint16_t i = first; i <= UINT8_MAX; i++) {
        TEST_ASSERT_NULL(name((uint8_t)i));
    }
}

/* By bit of AGV_MISSING_*. */
void test_what_is_missing(void) {
    static const char *const expected[] = {"state",      "vcu_heartbeat", "eps_heartbeat",  "trip_cause",
                                           "standstill", "manual",        "button",         "messages",
                                           "throttle",   "released",      "output_feedback"};
    for (uint8_t i = 0; i < 11; i++) {
        TEST_ASSERT_EQUAL_STRING(expected[i], agv_missing_name(i));
    }
    assert_no_name_from(11, agv_missing_name);
}

/* By bit of HAL_SELF_TEST_*. */
/* Shows: HW-4 */
void test_parts_of_the_self_test(void) {
    static const char *const expected[] = {"flash", "ram", "processor", "watchdog", "devices", "core", "supply"};
    for (uint8_t i = 0; i < 7; i++) {
        TEST_ASSERT_EQUAL_STRING(expected[i], agv_self_test_part_name(i));
    }
    assert_no_name_from(7, agv_self_test_part_name);
}

/* By hal_reset_cause_t and hal_end_t: the numbers are stored in the flight recorder. */
/* Shows: INT-3 */
void test_how_a_run_ended(void) {
    static const char *const causes[] = {"power-on", "watchdog", "brown-out", "lock-up", "software", "unknown"};
    static const char *const ends[] = {"task watchdog",
                                       "processor fault",
                                       "spurious interrupt",
                                       "stack overflow",
                                       "failed assertion",
                                       "kernel panic",
                                       "NMI",
                                       "clock failure",
                                       "flash ECC error",
                                       "RAM parity error",
                                       "window watchdog"};
    for (uint8_t i = 0; i < 6; i++) {
        TEST_ASSERT_EQUAL_STRING(causes[i], agv_reset_cause_name(i));
    }
    assert_no_name_from(6, agv_reset_cause_name);
    TEST_ASSERT_NULL(agv_end_name(0));
    for (uint8_t i = 0; i < 11; i++) {
        TEST_ASSERT_EQUAL_STRING(ends[i], agv_end_name((uint8_t)(i + 1)));
    }
    assert_no_name_from(12, agv_end_name);
}

/* Shows: INT-2 */
void test_every_setting_is_described(void) {
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        TEST_ASSERT_TRUE(strlen(info->name) > 0 && strlen(info->meaning) > 0);
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(SETTING_EXPECTED[i].preset, info->preset, info->name);
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(SETTING_EXPECTED[i].lowest, info->lowest, info->name);
        TEST_ASSERT_EQUAL_UINT16_MESSAGE(SETTING_EXPECTED[i].highest, info->highest, info->name);
        TEST_ASSERT_EQUAL_MESSAGE(SETTING_EXPECTED[i].scope == GATEWAY_ONLY, info->gateway_only, info->name);
        TEST_ASSERT_EQUAL_MESSAGE(i < SETTINGS_EXPECTED_CHOICES, info->words != NULL, info->name);
        if (info->words != NULL) {
            TEST_ASSERT_NOT_NULL(strchr(info->words, '|'));
            unsigned last = 0;
            for (const char *at = info->words; *at != '\0'; at++) {
                last += (*at == '|') ? 1 : 0;
            }
            TEST_ASSERT_EQUAL_UINT16(last, info->highest);
        }
    }
    TEST_ASSERT_NULL(agv_setting_info(AGV_SETTING_COUNT));
    TEST_ASSERT_NULL(agv_setting_info(UINT16_MAX));
}

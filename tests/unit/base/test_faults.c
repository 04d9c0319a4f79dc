/* The table of faults, and sets of faults. An invalid fault is in no set and has no properties. */
#include "agv/faults.h"

#include <string.h>

#include "unity.h"

enum { BITS = 32 * AGV_FAULT_WORDS };

static agv_fault_set_t set;

void setUp(void) {
    set = (agv_fault_set_t){0};
}

/* Whether a bit of the set is on, by hand. */
static bool bit(unsigned n) {
    return ((set.words[n / 32] >> (n % 32)) & 1) != 0;
}

void test_a_fault_is_the_bit_of_its_rank(void) {
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        setUp();
        agv_fault_set_put(&set, i, true);
        for (unsigned n = 0; n < BITS; n++) {
            TEST_ASSERT_EQUAL(n == i, bit(n));
            TEST_ASSERT_EQUAL(n == i, agv_fault_is_in(&set, n));
        }
        TEST_ASSERT_EQUAL_UINT32(i, agv_fault_first(&set));
        agv_fault_set_put(&set, i, true);
        TEST_ASSERT_TRUE(bit(i));
        agv_fault_set_put(&set, i, false);
        TEST_ASSERT_FALSE(bit(i));
    }
}

void test_a_fault_that_is_taken_out_leaves_the_others(void) {
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        memset(&set, 0xFF, sizeof set);
        agv_fault_set_put(&set, i, false);
        for (unsigned n = 0; n < BITS; n++) {
            TEST_ASSERT_EQUAL(n != i, bit(n));
        }
    }
}

/* Across the words; the upper row is the first. */
void test_the_first_of_a_set_is_the_highest_ranking_one(void) {
    TEST_ASSERT_EQUAL_UINT32(AGV_FAULT_NONE, agv_fault_first(&set));
    for (unsigned i = AGV_FAULT_COUNT; i-- > 0;) {
        agv_fault_set_put(&set, i, true);
        TEST_ASSERT_EQUAL_UINT32(i, agv_fault_first(&set));
    }
    agv_fault_set_put(&set, 0, false);
    TEST_ASSERT_EQUAL_UINT32(1, agv_fault_first(&set));
    setUp();
    agv_fault_set_put(&set, 31, true);
    agv_fault_set_put(&set, 32, true);
    TEST_ASSERT_EQUAL_UINT32(31, agv_fault_first(&set));
}

/* Bits beyond the last fault. */
void test_an_invalid_fault_is_in_no_set(void) {
    memset(&set, 0xFF, sizeof set);
    TEST_ASSERT_TRUE(agv_fault_is_in(&set, AGV_FAULT_COUNT - 1));
    TEST_ASSERT_FALSE(agv_fault_is_in(&set, AGV_FAULT_NONE));
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        agv_fault_set_put(&set, i, false);
    }
    TEST_ASSERT_EQUAL_UINT32(AGV_FAULT_NONE, agv_fault_first(&set));
}

void test_an_invalid_fault_changes_nothing(void) {
    static const unsigned none[] = {AGV_FAULT_NONE, 32 * AGV_FAULT_WORDS - 1, 32 * AGV_FAULT_WORDS, 255, UINT32_MAX};
    for (unsigned i = 0; i < sizeof none / sizeof none[0]; i++) {
        agv_fault_set_put(&set, none[i], true);
        TEST_ASSERT_FALSE(agv_fault_is_in(&set, none[i]));
        TEST_ASSERT_EACH_EQUAL_HEX32(0, set.words, AGV_FAULT_WORDS);
        TEST_ASSERT_EQUAL_HEX8(0, agv_fault_flags(none[i]));
        TEST_ASSERT_EQUAL_UINT8(0, agv_fault_led_code(none[i]));
        TEST_ASSERT_EQUAL(AGV_CLASS_WARN, agv_fault_default_class(none[i]));
    }
}

/* Shows: FSM-9, HW-1 */
void test_four_faults_are_unresettable(void) {
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        const bool unresettable = i == AGV_FAULT_SELF_TEST_FAILED || i == AGV_FAULT_MEMORY_CORRUPTED ||
                                  i == AGV_FAULT_CONFIG_INVALID || i == AGV_FAULT_OUTPUT_FEEDBACK;
        TEST_ASSERT_EQUAL(unresettable, (agv_fault_flags(i) & AGV_FAULT_FLAG_UNRESETTABLE) != 0);
    }
}

/* Mandatory faults are trips by default. STARTUP_TIMEOUT must stay a warning. */
void test_mandatory_faults_are_trips(void) {
    TEST_ASSERT_EQUAL_HEX8(AGV_FAULT_FLAG_FIXED, agv_fault_flags(AGV_FAULT_STARTUP_TIMEOUT));
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        if ((i != AGV_FAULT_STARTUP_TIMEOUT) && ((agv_fault_flags(i) & AGV_FAULT_FLAG_FIXED) != 0)) {
            TEST_ASSERT_EQUAL(AGV_CLASS_TRIP, agv_fault_default_class(i));
        }
    }
    TEST_ASSERT_TRUE((agv_fault_flags(AGV_FAULT_BUS_OFF) & AGV_FAULT_FLAG_FIXED) != 0);
    TEST_ASSERT_EQUAL(AGV_CLASS_WARN, agv_fault_default_class(AGV_FAULT_RX_OVERRUN));
}

/* By hand from the rows of the AI computer and of the EPS. */
/* Shows: FSM-3, FSM-10 */
void test_the_other_properties_of_some_faults(void) {
    TEST_ASSERT_EQUAL_HEX8(AGV_FAULT_FLAG_FIXED | AGV_FAULT_FLAG_FROM_AI, agv_fault_flags(AGV_FAULT_AI_HEARTBEAT_LOST));
    TEST_ASSERT_EQUAL_HEX8(AGV_FAULT_FLAG_FROM_AI, agv_fault_flags(AGV_FAULT_COMMAND_TOO_FAST));
    TEST_ASSERT_EQUAL_HEX8(AGV_FAULT_FLAG_FIXED | AGV_FAULT_FLAG_OF_EPS, agv_fault_flags(AGV_FAULT_EPS_STATUS_TIMEOUT));
    TEST_ASSERT_EQUAL_HEX8(AGV_FAULT_FLAG_FIXED, agv_fault_flags(AGV_FAULT_EPS_MODE_OFF));
    TEST_ASSERT_EQUAL_HEX8(AGV_FAULT_FLAG_FROM_AI | AGV_FAULT_FLAG_GATEWAY, agv_fault_flags(AGV_FAULT_AI_BUS_OFF));
    TEST_ASSERT_EQUAL_HEX8(AGV_FAULT_FLAG_FIXED | AGV_FAULT_FLAG_FROM_AI, agv_fault_flags(AGV_FAULT_VCU_AI_CAN_LOST));
    TEST_ASSERT_EQUAL_HEX8(AGV_FAULT_FLAG_FIXED, agv_fault_flags(AGV_FAULT_FOREIGN_COMMAND_SENDER));
    TEST_ASSERT_EQUAL_HEX8(0, agv_fault_flags(AGV_FAULT_S_DRIVER_ALARM));
}

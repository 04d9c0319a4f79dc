/* Sets of faults, and the properties of each (causes.c). An invalid fault is in no set and has no properties. */
#include "agv/faults.h"

#include <string.h>

#include "causes.h"
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

/* Which ones come from the AI computer, which are of the EPS, which are unresettable, which classes are mandatory. */
/* Shows: FSM-3, FSM-9, FSM-10, FSM-11, HW-1, INT-2 */
void test_the_properties_of_every_fault(void) {
    TEST_ASSERT_EQUAL_UINT(FAULT_ROWS, AGV_FAULT_COUNT);
    for (unsigned i = 0; i < FAULT_ROWS; i++) {
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(FAULT_ROW[i].flags, agv_fault_flags(i), FAULT_ROW[i].name);
        TEST_ASSERT_EQUAL_MESSAGE(FAULT_ROW[i].trip ? AGV_CLASS_TRIP : AGV_CLASS_WARN, agv_fault_default_class(i),
                                  FAULT_ROW[i].name);
    }
}

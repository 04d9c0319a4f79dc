/* The faults of one supervisor: levels, events, sets; and that what is no fault changes nothing. */
#include "agv/faults.h"

#include <string.h>

#include "agv/core.h"
#include "unity.h"

static agv_core_t core;

void setUp(void) {
    core = (agv_core_t){0};
}

void tearDown(void) {
}

static void event(agv_fault_t fault, uint32_t now_ms) {
    core.now_ms = now_ms;
    agv_faults_event(&core, fault);
}

static void tick(uint32_t now_ms, uint16_t hold_ms) {
    core.now_ms = now_ms;
    core.config.event_hold_ms = hold_ms;
    agv_faults_tick(&core);
}

static bool is_active(agv_fault_t fault) {
    return agv_faults_is_active(&core, fault);
}

void test_a_level_is_active_while_its_cause_is(void) {
    agv_faults_level(&core, AGV_FAULT_MODE_INVALID, true);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_MODE_INVALID));
    TEST_ASSERT_TRUE(core.summary.changed);
    TEST_ASSERT_EQUAL_HEX64(agv_fault_bit(AGV_FAULT_MODE_INVALID), agv_faults_marked(&core.faults, AGV_MARK_ACTIVE));
    core.summary.changed = false;
    agv_faults_level(&core, AGV_FAULT_MODE_INVALID, true);
    TEST_ASSERT_FALSE(core.summary.changed);
    agv_faults_level(&core, AGV_FAULT_MODE_INVALID, false);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_MODE_INVALID));
    TEST_ASSERT_TRUE(core.summary.changed);
    TEST_ASSERT_EQUAL_HEX64(0, agv_faults_marked(&core.faults, AGV_MARK_ACTIVE));
}

void test_a_level_leaves_other_marks_alone(void) {
    core.faults.marks[AGV_FAULT_BUS_OFF] = AGV_MARK_LATCHED;
    agv_faults_level(&core, AGV_FAULT_BUS_OFF, true);
    agv_faults_level(&core, AGV_FAULT_BUS_OFF, false);
    TEST_ASSERT_EQUAL_HEX8(AGV_MARK_LATCHED, core.faults.marks[AGV_FAULT_BUS_OFF]);
}

void test_a_set_has_the_faults_with_all_of_the_marks(void) {
    core.faults.marks[0] = AGV_MARK_ACTIVE;
    core.faults.marks[1] = AGV_MARK_ACTIVE | AGV_MARK_TRIPPING;
    core.faults.marks[AGV_FAULT_COUNT - 1] = AGV_MARK_ACTIVE | AGV_MARK_TRIPPING | AGV_MARK_LATCHED;
    const agv_fault_set_t last = (agv_fault_set_t)1 << (AGV_FAULT_COUNT - 1);
    TEST_ASSERT_EQUAL_HEX64(3u | last, agv_faults_marked(&core.faults, AGV_MARK_ACTIVE));
    TEST_ASSERT_EQUAL_HEX64(2u | last, agv_faults_marked(&core.faults, AGV_MARK_ACTIVE | AGV_MARK_TRIPPING));
    TEST_ASSERT_EQUAL_HEX64(last, agv_faults_marked(&core.faults, AGV_MARK_LATCHED));
}

/* Shows: TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFE0C)
void test_an_event_ends_when_its_time_after_the_last_one_is_over(uint32_t start_ms) {
    event(AGV_FAULT_STEP_OVERRUN, start_ms);
    tick(start_ms + 600, 1000);
    event(AGV_FAULT_STEP_OVERRUN, start_ms + 600);
    event(AGV_FAULT_RX_OVERRUN, start_ms + 601);
    tick(start_ms + 1599, 1000);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_STEP_OVERRUN));
    tick(start_ms + 1600, 1000);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_STEP_OVERRUN));
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_RX_OVERRUN));
    tick(start_ms + 1601, 1000);
    TEST_ASSERT_EQUAL_HEX64(0, agv_faults_marked(&core.faults, AGV_MARK_ACTIVE));
}

/* The eight rows that the table calls events, by hand. */
void test_eight_faults_are_events_and_the_others_are_not(void) {
    const agv_fault_set_t events =
        agv_fault_bit(AGV_FAULT_SUPERVISOR_RESET) | agv_fault_bit(AGV_FAULT_TX_GATE_REFUSED) |
        agv_fault_bit(AGV_FAULT_STEP_OVERRUN) | agv_fault_bit(AGV_FAULT_AI_COMMAND_OUT_OF_RANGE) |
        agv_fault_bit(AGV_FAULT_FOREIGN_COMMAND_SENDER) | agv_fault_bit(AGV_FAULT_COMMAND_TOO_FAST) |
        agv_fault_bit(AGV_FAULT_RX_OVERRUN) | agv_fault_bit(AGV_FAULT_STORE_INVALID);
    TEST_ASSERT_EQUAL_HEX64(events, agv_faults_events);
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        const bool is_event = ((events >> i) & 1u) != 0;
        setUp();
        event((agv_fault_t)i, 0);
        TEST_ASSERT_EQUAL(is_event, is_active((agv_fault_t)i));
        tick(1000, 1000);
        TEST_ASSERT_EQUAL_HEX64(0, agv_faults_marked(&core.faults, AGV_MARK_ACTIVE));
    }
}

/* Of 64 bits, one a fault. */
void test_a_fault_is_in_the_sets_that_have_its_bit(void) {
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        for (unsigned bit = 0; bit < 64; bit++) {
            TEST_ASSERT_EQUAL(i == bit, agv_fault_is_in((agv_fault_set_t)1 << bit, i));
        }
        TEST_ASSERT_EQUAL_HEX64((agv_fault_set_t)1 << i, agv_fault_bit(i));
    }
    TEST_ASSERT_FALSE(agv_fault_is_in(UINT64_MAX, AGV_FAULT_NONE));
    TEST_ASSERT_FALSE(agv_fault_is_in(UINT64_MAX, 63));
}

/* Whatever stands behind the marks. */
void test_what_is_no_fault_is_never_active(void) {
    memset(&core, 0xFF, sizeof core);
    TEST_ASSERT_TRUE(is_active((agv_fault_t)(AGV_FAULT_COUNT - 1)));
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_NONE));
}

void test_what_is_no_fault_changes_nothing(void) {
    const agv_fault_t none[] = {AGV_FAULT_NONE, (agv_fault_t)63, (agv_fault_t)64, (agv_fault_t)255};
    for (unsigned i = 0; i < 4; i++) {
        agv_faults_level(&core, none[i], true);
        event(none[i], 0);
        TEST_ASSERT_FALSE(is_active(none[i]));
        TEST_ASSERT_EQUAL_HEX64(0, agv_fault_bit(none[i]));
        TEST_ASSERT_EQUAL_HEX8(0, agv_fault_flags(none[i]));
        TEST_ASSERT_EQUAL_UINT8(0, agv_fault_led_code(none[i]));
    }
    TEST_ASSERT_FALSE(core.summary.changed);
    TEST_ASSERT_EQUAL_HEX64(0, agv_faults_marked(&core.faults, AGV_MARK_ACTIVE));
}

/* Shows: FSM-9 */
void test_three_faults_are_unresettable(void) {
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        const bool unresettable =
            i == AGV_FAULT_SELF_TEST_FAILED || i == AGV_FAULT_MEMORY_CORRUPTED || i == AGV_FAULT_CONFIG_INVALID;
        TEST_ASSERT_EQUAL(unresettable, (agv_fault_flags((agv_fault_t)i) & AGV_FAULT_FLAG_UNRESETTABLE) != 0);
    }
}

/* What must not be made weaker is a trip to begin with. */
void test_fixed_faults_are_trips(void) {
    TEST_ASSERT_EQUAL_HEX64(0, agv_faults_fixed & ~agv_faults_default_trips);
    TEST_ASSERT_TRUE((agv_faults_fixed & agv_fault_bit(AGV_FAULT_BUS_OFF)) != 0);
    TEST_ASSERT_TRUE((agv_faults_default_trips & agv_fault_bit(AGV_FAULT_RX_OVERRUN)) == 0);
}

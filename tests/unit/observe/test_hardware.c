/*
 * The hardware that answers: contact of the safety output, emergency stop, push button, second clock, self-test. Each tick
 * reads inputs, second clock and self-test once each.
 */
#include "observe/hardware.h"

#include "mock_clock.h"
#include "mock_inputs.h"
#include "mock_self_test.h"
#include "unity.h"

enum { NONE = HAL_CONTACT_NONE, OPEN = HAL_CONTACT_OPEN, CLOSED = HAL_CONTACT_CLOSED };

struct hal {
    int unused;
};
static hal_t hal;
static agv_hardware_t hardware;
static agv_fault_monitor_t faults;
static agv_timers_t timers;
static agv_config_t config;
static hal_inputs_t inputs;
static bool output_closed;
static bool has_second;
static uint32_t second_ms;
static uint32_t failed;
static uint32_t reads; /* calls of the HAL */

static void inputs_stub(hal_t *port, hal_inputs_t *read, int calls) {
    (void)port, (void)calls;
    *read = inputs;
    reads++;
}

static bool second_stub(hal_t *port, uint32_t *time_ms, int calls) {
    (void)port, (void)calls;
    *time_ms = second_ms;
    reads++;
    return has_second;
}

static uint32_t self_test_stub(hal_t *port, int calls) {
    (void)port, (void)calls;
    reads++;
    return failed;
}

void setUp(void) {
    hardware = (agv_hardware_t){0};
    faults = (agv_fault_monitor_t){0};
    agv_config_defaults(&config);
    agv_timers_set_time(&timers, 0);
    inputs = (hal_inputs_t){0};
    output_closed = false;
    has_second = false;
    second_ms = 0;
    failed = 0;
    hal_inputs_read_Stub(inputs_stub);
    hal_clock_second_ms_Stub(second_stub);
    hal_self_test_Stub(self_test_stub);
}

/* A tick this long after the one before. */
static void tick_after(uint32_t elapsed_ms) {
    const uint32_t before = reads;
    agv_timers_set_time(&timers, timers.now_ms + elapsed_ms);
    agv_hardware_tick(&hardware, &faults, &timers, &config, &hal, elapsed_ms, output_closed);
    TEST_ASSERT_EQUAL_UINT32(3, reads - before);
}

static void ticks(uint32_t count) {
    for (uint32_t i = 0; i < count; i++) {
        tick_after(1);
    }
}

static bool is_active(unsigned fault) {
    return agv_fault_monitor_is_active(&faults, fault);
}

static void expect_no_fault(void) {
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        TEST_ASSERT_FALSE(is_active(i));
    }
}

/* Shows: HW-1, HW-4 */
void test_the_calls_of_a_tick(void) {
    hal_inputs_read_Stub(NULL);
    hal_clock_second_ms_Stub(NULL);
    hal_self_test_Stub(NULL);
    hal_inputs_read_Expect(&hal, NULL);
    hal_inputs_read_IgnoreArg_inputs();
    hal_clock_second_ms_ExpectAndReturn(&hal, NULL, false);
    hal_clock_second_ms_IgnoreArg_time_ms();
    hal_self_test_ExpectAndReturn(&hal, 0);
    agv_hardware_tick(&hardware, &faults, &timers, &config, &hal, 1, false);
    expect_no_fault();
}

void test_a_board_without_any_part_raises_nothing(void) {
    ticks(3000);
    output_closed = true;
    ticks(3000);
    expect_no_fault();
    TEST_ASSERT_TRUE(agv_hardware_output_reads_open(&hardware));
    TEST_ASSERT_EQUAL_UINT8(AGV_BUTTON_UNHEARD, hardware.button);
}

/* --- the contact of the safety output --- */

/* A tick that reads another contact. The ms before it counts by the last one: a wrong contact has lasted for 0 ms. */
static void begin(void) {
    ticks(1);
}

/* Open but reads closed, closed but reads open, and values that the contract does not have, in both positions. */
/* Shows: HW-1, OUTPUT_FEEDBACK */
TEST_CASE(false, 2)
TEST_CASE(true, 1)
TEST_CASE(false, 3)
TEST_CASE(true, 3)
TEST_CASE(false, 255)
void test_a_wrong_contact_is_a_fault_after_100_ms(bool closed, int contact) {
    output_closed = closed;
    inputs.output_feedback = (uint8_t)contact;
    begin();
    ticks(99);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
    ticks(1);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
}

/* Shows: HW-1 */
TEST_CASE(false, 1)
TEST_CASE(true, 2)
void test_a_contact_that_follows_is_no_fault(bool closed, int contact) {
    output_closed = closed;
    inputs.output_feedback = (uint8_t)contact;
    ticks(1000);
    expect_no_fault();
}

/* Shows: HW-1, INT-2 */
TEST_CASE(20)
TEST_CASE(1000)
void test_the_time_is_a_setting(unsigned setting_ms) {
    config.output_feedback_ms = (uint16_t)setting_ms;
    inputs.output_feedback = CLOSED;
    begin();
    ticks(setting_ms - 1);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
    ticks(1);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
}

/* Shows: HW-1 */
void test_the_fault_ends_when_the_time_is_used_up(void) {
    inputs.output_feedback = CLOSED;
    ticks(5000); /* no more than 100 */
    inputs.output_feedback = OPEN;
    begin();
    ticks(199);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
    ticks(1);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
}

/* Shows: HW-1 */
void test_a_relay_that_takes_10_ms_each_time_is_no_fault(void) {
    for (unsigned i = 0; i < 100; i++) {
        output_closed = !output_closed;
        ticks(10);
        inputs.output_feedback = output_closed ? CLOSED : OPEN;
        ticks(20);
    }
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
}

/* All of the time before a late tick counts, and no more than that. */
/* Shows: HW-1 */
TEST_CASE(99, false)
TEST_CASE(100, true)
TEST_CASE(0x7FFFFFFF, true)
TEST_CASE(0xFFFFFFFF, true)
void test_a_late_tick_counts_in_full(uint32_t elapsed_ms, bool is_fault) {
    inputs.output_feedback = CLOSED;
    begin();
    tick_after(elapsed_ms);
    TEST_ASSERT_EQUAL(is_fault, is_active(AGV_FAULT_OUTPUT_FEEDBACK));
}

/*
 * A late tick of 10 ms, after 60 ms of a wrong contact; with a right one before it: after 61, and half of 1 ms less. It counts
 * by what it sees: up if the contact is wrong, down by half if not. If the output has changed, it counts as a tick of 1 ms,
 * which counts by what the last one saw.
 */
/* Shows: HW-1, TIM-4 */
TEST_CASE(2, false, 2, 70)
TEST_CASE(2, false, 1, 55)
TEST_CASE(2, true, 1, 61)
TEST_CASE(2, true, 2, 61)
TEST_CASE(1, false, 2, 71)
TEST_CASE(1, false, 1, 56)
TEST_CASE(1, true, 1, 60)
TEST_CASE(1, true, 2, 60)
void test_how_much_of_a_late_tick_counts(int before, bool closes, int at_its_end, unsigned value_ms) {
    inputs.output_feedback = CLOSED;
    begin();
    ticks(60);
    if (before == OPEN) {
        inputs.output_feedback = OPEN;
        begin();
        ticks(1);
    }
    output_closed = closes;
    inputs.output_feedback = (uint8_t)at_its_end;
    tick_after(10);
    TEST_ASSERT_EQUAL_UINT16(value_ms, hardware.mismatch.value_ms);
    const bool wrong = closes != (at_its_end == CLOSED);
    tick_after(10); /* the output has not changed again */
    TEST_ASSERT_EQUAL_UINT16(wrong ? value_ms + 10 : value_ms - 5, hardware.mismatch.value_ms);
}

/* The same when the output opens: the contact was right until then. */
/* Shows: HW-1, TIM-4 */
void test_a_late_tick_after_the_output_opened_counts_1_ms(void) {
    output_closed = true;
    inputs.output_feedback = CLOSED;
    ticks(60);
    output_closed = false;
    tick_after(10);
    TEST_ASSERT_EQUAL_UINT16(0, hardware.mismatch.value_ms);
    tick_after(10);
    TEST_ASSERT_EQUAL_UINT16(10, hardware.mismatch.value_ms);
}

/* A board has its feedback always. One that is gone is a wrong contact in both positions. */
/* Shows: HW-1 */
TEST_CASE(false)
TEST_CASE(true)
void test_a_feedback_that_falls_silent_is_a_fault(bool closed) {
    output_closed = closed;
    inputs.output_feedback = closed ? CLOSED : OPEN;
    ticks(1);
    inputs.output_feedback = NONE;
    begin();
    ticks(99);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
    TEST_ASSERT_FALSE(agv_hardware_output_reads_open(&hardware));
    ticks(1);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
}

/* Shows: HW-1, FSM-4 */
TEST_CASE(0, true)
TEST_CASE(1, true)
TEST_CASE(2, false)
TEST_CASE(3, false)
TEST_CASE(255, false)
void test_only_open_or_no_feedback_lets_the_output_close(int contact, bool reads_open) {
    inputs.output_feedback = (uint8_t)contact;
    ticks(1);
    TEST_ASSERT_EQUAL(reads_open, agv_hardware_output_reads_open(&hardware));
}

/* --- the emergency stop --- */

/* Shows: HW-2, EMERGENCY_STOP */
TEST_CASE(1)
TEST_CASE(3)
TEST_CASE(255)
void test_an_open_circuit_stops_at_once_and_for_as_long_as_it_is_open(int contact) {
    inputs.emergency_stop = CLOSED;
    ticks(1);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_EMERGENCY_STOP));
    inputs.emergency_stop = (uint8_t)contact;
    tick_after(0);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_EMERGENCY_STOP));
    ticks(100000);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_EMERGENCY_STOP));
    inputs.emergency_stop = CLOSED;
    ticks(1);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_EMERGENCY_STOP));
}

/* Shows: HW-2 */
void test_a_circuit_that_is_open_at_the_first_tick_stops(void) {
    inputs.emergency_stop = OPEN;
    tick_after(0);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_EMERGENCY_STOP));
}

/* Shows: HW-2 */
void test_an_emergency_stop_that_falls_silent_stops(void) {
    inputs.emergency_stop = CLOSED;
    ticks(1);
    inputs.emergency_stop = NONE;
    ticks(1);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_EMERGENCY_STOP));
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
}

/* --- the push button --- */

static void button(uint8_t contact, uint32_t ms) {
    inputs.reset_button = contact;
    ticks(ms);
}

/* Read as pressed for the first time, and 20 ms later. */
/* Shows: HW-3 */
void test_a_press_counts_when_it_was_read_for_20_ms(void) {
    button(OPEN, 100);
    button(CLOSED, 20);
    TEST_ASSERT_EQUAL_UINT8(AGV_BUTTON_UP, hardware.button);
    ticks(1);
    TEST_ASSERT_EQUAL_UINT8(AGV_BUTTON_DOWN, hardware.button);
    button(OPEN, 20);
    TEST_ASSERT_EQUAL_UINT8(AGV_BUTTON_DOWN, hardware.button);
    ticks(1);
    TEST_ASSERT_EQUAL_UINT8(AGV_BUTTON_UP, hardware.button);
}

/* Shows: HW-3 */
void test_each_bounce_begins_the_20_ms_again(void) {
    button(OPEN, 100);
    for (unsigned i = 0; i < 50; i++) {
        button(CLOSED, 20);
        button(OPEN, 1);
        TEST_ASSERT_EQUAL_UINT8(AGV_BUTTON_UP, hardware.button);
    }
    button(CLOSED, 21);
    TEST_ASSERT_EQUAL_UINT8(AGV_BUTTON_DOWN, hardware.button);
}

/* So that it has no rising edge. */
/* Shows: HW-3 */
void test_before_its_first_20_ms_the_button_is_unknown(void) {
    button(CLOSED, 20);
    TEST_ASSERT_EQUAL_UINT8(AGV_BUTTON_UNKNOWN, hardware.button);
    ticks(1);
    TEST_ASSERT_EQUAL_UINT8(AGV_BUTTON_DOWN, hardware.button);
}

/* An input that falls silent, and a value that the contract does not have, are no release. */
/* Shows: HW-3 */
TEST_CASE(1, 2)
TEST_CASE(0, 3)
TEST_CASE(3, 3)
TEST_CASE(255, 3)
void test_only_a_closed_contact_is_a_press_and_an_open_one_a_release(int contact, int is) {
    button(CLOSED, 100);
    button((uint8_t)contact, 21);
    TEST_ASSERT_EQUAL_UINT8(is, hardware.button);
}

/* Shows: HW-3 */
TEST_CASE(19, 0)
TEST_CASE(20, 1)
TEST_CASE(0xFFFFFFFF, 1)
void test_the_time_to_a_late_tick_counts(uint32_t elapsed_ms, int down) {
    button(OPEN, 100);
    button(CLOSED, 1);
    tick_after(elapsed_ms);
    TEST_ASSERT_EQUAL_UINT8(down ? AGV_BUTTON_DOWN : AGV_BUTTON_UP, hardware.button);
}

/* --- the clocks --- */

static void start_clocks(uint32_t first, uint32_t second) {
    has_second = true;
    agv_timers_set_time(&timers, first);
    second_ms = second;
    tick_after(0);
}

static void clocks(uint32_t first_passed_ms, uint32_t second_passed_ms) {
    second_ms += second_passed_ms;
    tick_after(first_passed_ms);
}

/*
 * 5 % of a second are 50 ms; above a second, a 20th of the longer time, rounded down. The last rows: a second clock that
 * stands still, one that is not compared yet, ticks that come far too seldom, a clock that jumps, a late tick.
 */
/* Shows: HW-4, CLOCK_DEVIATION */
TEST_CASE(1000, 1000, false)
TEST_CASE(1000, 950, false)
TEST_CASE(1000, 949, true)
TEST_CASE(950, 1000, false)
TEST_CASE(949, 1000, true)
TEST_CASE(1000, 0, true)
TEST_CASE(999, 0, false)
TEST_CASE(1, 1000, true)
TEST_CASE(1000, 60000, true)
TEST_CASE(5000, 4750, false)
TEST_CASE(5000, 4749, true)
void test_5_percent_of_a_second_are_allowed(uint32_t first_ms, uint32_t passed_ms, bool is_fault) {
    start_clocks(12345, 777);
    clocks(first_ms, passed_ms);
    TEST_ASSERT_EQUAL(is_fault, is_active(AGV_FAULT_CLOCK_DEVIATION));
}

/* Shows: HW-4, TIM-2 */
TEST_CASE(0xFFFFFE00, 0)
TEST_CASE(0, 0xFFFFFE00)
TEST_CASE(0xFFFFFFFF, 0xFFFFFFFF)
void test_both_clocks_may_wrap(uint32_t first, uint32_t second) {
    start_clocks(first, second);
    for (unsigned i = 0; i < 5; i++) {
        clocks(1000, 1000);
        TEST_ASSERT_FALSE(is_active(AGV_FAULT_CLOCK_DEVIATION));
    }
    clocks(1000, 900);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_CLOCK_DEVIATION));
}

/* Ticks of 1 ms. A first clock that runs at half its speed is found after a second of the other one. */
/* Shows: HW-4 */
void test_a_slow_first_clock_is_found_in_a_second_of_the_other_one(void) {
    start_clocks(0, 0);
    for (unsigned i = 0; i < 499; i++) {
        clocks(1, 2);
    }
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_CLOCK_DEVIATION));
    clocks(1, 2);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_CLOCK_DEVIATION));
}

/* A board with a second clock may have no inputs. */
/* Shows: HW-1, HW-2, HW-4 */
void test_a_second_clock_makes_no_input(void) {
    start_clocks(0, 0);
    for (unsigned i = 0; i < 200; i++) {
        clocks(1, 1);
    }
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_OUTPUT_FEEDBACK));
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_EMERGENCY_STOP));
}

/* The deviation of a second does not spoil the next one. */
/* Shows: HW-4 */
void test_the_fault_ends_with_a_good_second(void) {
    start_clocks(0, 0);
    clocks(1000, 900);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_CLOCK_DEVIATION));
    clocks(999, 999);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_CLOCK_DEVIATION));
    clocks(1, 1);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_CLOCK_DEVIATION));
}

/* Shows: HW-4 */
void test_a_second_clock_that_falls_silent_stands_still(void) {
    start_clocks(0, 500);
    clocks(1000, 1000);
    has_second = false;
    second_ms = 123456; /* what it returns with false does not count */
    ticks(999);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_CLOCK_DEVIATION));
    ticks(1);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_CLOCK_DEVIATION));
}

/* The first reading is the baseline, whatever it is and whenever it comes. */
/* Shows: HW-4 */
void test_a_second_clock_that_begins_late_is_no_fault(void) {
    ticks(10000);
    start_clocks(timers.now_ms, 0x80000000);
    clocks(1000, 1000);
    expect_no_fault();
}

/* --- the self-test --- */

/* Shows: HW-4, SELF_TEST_FAILED */
void test_a_part_that_fails_later_is_a_fault_for_good(void) {
    ticks(1000);
    expect_no_fault();
    failed = HAL_SELF_TEST_FLASH;
    ticks(1);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_SELF_TEST_FAILED));
    failed = HAL_SELF_TEST_RAM; /* a port that forgets */
    ticks(1);
    failed = 0;
    ticks(1000);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_SELF_TEST_FAILED));
    TEST_ASSERT_EQUAL_HEX8(HAL_SELF_TEST_FLASH | HAL_SELF_TEST_RAM, hardware.failed);
}

/* Shows: HW-4, SELF_TEST_FAILED */
TEST_CASE(0, 0)
TEST_CASE(0x04, 0)
TEST_CASE(0, 0x20)
TEST_CASE(0x04, 0x20)
void test_parts_found_by_the_port_and_elsewhere(uint32_t of_port, uint32_t elsewhere) {
    failed = of_port;
    agv_hardware_self_test(&hardware, &faults, &hal, elsewhere);
    TEST_ASSERT_EQUAL_HEX8(of_port | elsewhere, hardware.failed);
    TEST_ASSERT_EQUAL((of_port | elsewhere) != 0, is_active(AGV_FAULT_SELF_TEST_FAILED));
}

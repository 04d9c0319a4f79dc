/* The hard-wired parts of a simulated board: contact with its relay, inputs, second clock. */
#include <string.h>

#include "hal_sim/sim_hal.h"
#include "unity.h"

enum { NONE = HAL_CONTACT_NONE, OPEN = HAL_CONTACT_OPEN, CLOSED = HAL_CONTACT_CLOSED };

static struct hal hal;

void setUp(void) {
    memset(&hal, 0xA5, sizeof hal);
    sim_hal_init_direct(&hal, NULL, 1, NULL, NULL);
    hal.board.has_feedback = true;
}

static hal_inputs_t read_at(uint32_t time_ms) {
    hal_inputs_t inputs;
    sim_hal_set_now_ms(&hal, time_ms);
    hal_inputs_read(&hal, &inputs);
    return inputs;
}

static uint8_t contact_at(uint32_t time_ms) {
    return read_at(time_ms).output_feedback;
}

static uint32_t second_at(uint32_t time_ms) {
    uint32_t second_ms = 0;
    sim_hal_set_now_ms(&hal, time_ms);
    TEST_ASSERT_TRUE(hal_clock_second_ms(&hal, &second_ms));
    return second_ms;
}

void test_a_board_without_parts(void) {
    uint32_t second_ms = 0;
    hal.board = (sim_board_t){.stop_is_open = true, .button_is_down = true};
    const hal_inputs_t inputs = read_at(5);
    TEST_ASSERT_EQUAL_UINT8(NONE, inputs.output_feedback);
    TEST_ASSERT_EQUAL_UINT8(NONE, inputs.emergency_stop);
    TEST_ASSERT_EQUAL_UINT8(NONE, inputs.reset_button);
    TEST_ASSERT_FALSE(hal_clock_second_ms(&hal, &second_ms));
    TEST_ASSERT_EQUAL_HEX32(0, hal_self_test(&hal));
}

/* Shows: HW-1 */
void test_the_contact_follows_after_10_ms(void) {
    TEST_ASSERT_EQUAL_UINT8(OPEN, contact_at(100));
    hal_safety_output_set(&hal, true);
    TEST_ASSERT_EQUAL_UINT8(OPEN, contact_at(109));
    TEST_ASSERT_EQUAL_UINT8(CLOSED, contact_at(110));
    hal_safety_output_set(&hal, false);
    TEST_ASSERT_EQUAL_UINT8(CLOSED, contact_at(119));
    TEST_ASSERT_EQUAL_UINT8(OPEN, contact_at(120));
}

/* Shows: HW-1 */
void test_a_welded_contact_stays_closed_until_it_is_repaired(void) {
    hal_safety_output_set(&hal, true);
    (void)contact_at(10);
    hal.board.contact = SIM_CONTACT_WELDED;
    hal_safety_output_set(&hal, false);
    TEST_ASSERT_EQUAL_UINT8(CLOSED, contact_at(100000));
    sim_hal_reset(&hal, HAL_RESET_POWER_ON);
    TEST_ASSERT_EQUAL_UINT8(CLOSED, contact_at(200000));
    hal.board.contact = SIM_CONTACT_WORKS;
    TEST_ASSERT_EQUAL_UINT8(OPEN, contact_at(200001));
}

/* Shows: HW-1 */
void test_a_contact_that_is_stuck_open(void) {
    hal_safety_output_set(&hal, true);
    TEST_ASSERT_EQUAL_UINT8(CLOSED, contact_at(10));
    hal.board.contact = SIM_CONTACT_STUCK_OPEN;
    TEST_ASSERT_EQUAL_UINT8(OPEN, contact_at(11));
    hal.board.contact = SIM_CONTACT_WORKS;
    TEST_ASSERT_EQUAL_UINT8(CLOSED, contact_at(12));
}

/* Shows: HW-1 */
void test_an_inverted_feedback(void) {
    hal.board.feedback_is_inverted = true;
    TEST_ASSERT_EQUAL_UINT8(CLOSED, contact_at(0));
    hal_safety_output_set(&hal, true);
    TEST_ASSERT_EQUAL_UINT8(OPEN, contact_at(10));
}

/* Shows: HW-2, HW-3 */
void test_emergency_stop_and_reset_button(void) {
    hal.board = (sim_board_t){.has_emergency_stop = true, .has_reset_button = true};
    TEST_ASSERT_EQUAL_UINT8(CLOSED, read_at(0).emergency_stop);
    TEST_ASSERT_EQUAL_UINT8(OPEN, read_at(0).reset_button);
    hal.board.stop_is_open = true;
    hal.board.button_is_down = true;
    TEST_ASSERT_EQUAL_UINT8(OPEN, read_at(0).emergency_stop);
    TEST_ASSERT_EQUAL_UINT8(CLOSED, read_at(0).reset_button);
}

/* Shows: HW-4 */
void test_the_second_clock_deviates_from_the_moment_of_the_change_on(void) {
    hal.board.has_second_clock = true;
    const uint32_t start_ms = second_at(1000);
    TEST_ASSERT_EQUAL_UINT32(start_ms + 1000, second_at(2000));
    hal.board.clock_permille = 60; /* the first clock is slow */
    TEST_ASSERT_EQUAL_UINT32(start_ms + 2060, second_at(3000));
    hal.board.clock_permille = -60;
    TEST_ASSERT_EQUAL_UINT32(start_ms + 3000, second_at(4000));
    hal.board.clock_permille = 0;
    TEST_ASSERT_EQUAL_UINT32(start_ms + 4000, second_at(5000));
}

/* No thousandth is lost between readings. */
/* Shows: HW-4 */
void test_the_second_clock_read_at_every_tick(void) {
    hal.board.has_second_clock = true;
    hal.board.clock_permille = 1;
    const uint32_t start_ms = second_at(0);
    for (uint32_t ms = 1; ms < 10000; ms++) {
        (void)second_at(ms);
    }
    TEST_ASSERT_EQUAL_UINT32(start_ms + 10010, second_at(10000));
}

/* Shows: HW-4, TIM-2 */
void test_the_second_clock_runs_on_when_the_first_one_wraps(void) {
    hal.board.has_second_clock = true;
    const uint32_t start_ms = second_at(0xFFFFFF00);
    TEST_ASSERT_EQUAL_UINT32(start_ms + 0x200u, second_at(0x100));
}

/* Shows: HW-4 */
void test_parts_that_fail_their_test(void) {
    hal.board.failed = HAL_SELF_TEST_FLASH | HAL_SELF_TEST_PROCESSOR;
    TEST_ASSERT_EQUAL_HEX32(0x05, hal_self_test(&hal));
}

/* The simulated port: every operation can be made to fail, by the number of its call. */
#include <string.h>

#include "hal_sim/sim_hal.h"
#include "unity.h"

static sim_store_t store;
static struct hal hal;

static const hal_can_frame_t FRAME = {.id = 0x168, .length = 8};

/* A board with a second clock, whose RAM fails its test. */
static void start(void) {
    sim_hal_init_direct(&hal, &(sim_hal_config_t){.store = &store}, 1, NULL, NULL);
    hal.board = (sim_board_t){.has_second_clock = true, .failed = HAL_SELF_TEST_RAM};
}

void setUp(void) {
    memset(&hal, 0xA5, sizeof hal);
    sim_store_init(&store);
    start();
}

static void fail_next(void) {
    sim_hal_fail_at(&hal, hal.calls + 1, 1, SIM_HAL_OP_ALL);
}

static void assert_failed(sim_hal_op_t op, uint32_t failures) {
    TEST_ASSERT_EQUAL_UINT32(failures, hal.failures);
    TEST_ASSERT_EQUAL_INT(op, hal.last_failed);
}

/* Call every operation once, in the order of sim_hal_op_t. @return number of successful ones among those that report
 * success */
static unsigned call_all(void) {
    uint8_t bytes[4] = {1, 2, 3, 4};
    hal_can_status_t status;
    unsigned worked = 0;
    worked += hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME);
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    hal_can_status(&hal, HAL_CAN_VEHICLE, &status);
    (void)hal_clock_now_ms(&hal);
    hal_led_set(&hal, true);
    worked += hal_reset_cause(&hal) == HAL_RESET_POWER_ON;
    hal_safety_output_set(&hal, true);
    (void)hal_store_read_latch(&hal, bytes, sizeof bytes);
    worked += hal_store_write_latch(&hal, bytes, sizeof bytes);
    worked += hal_store_append(&hal, bytes, sizeof bytes);
    worked += hal_store_read_record(&hal, 0, bytes, sizeof bytes) == 4;
    hal_watchdog_feed(&hal);
    hal_inputs_t inputs;
    uint32_t second_ms = 0;
    hal_inputs_read(&hal, &inputs);
    worked += hal_clock_second_ms(&hal, &second_ms);
    worked += hal_self_test(&hal) == HAL_SELF_TEST_RAM;
    return worked;
}

void test_no_call_fails_by_default_and_every_call_is_counted(void) {
    TEST_ASSERT_EQUAL_UINT(7, call_all());
    TEST_ASSERT_EQUAL_UINT32(SIM_HAL_OP_COUNT, hal.calls);
    TEST_ASSERT_EQUAL_UINT32(0, hal.failures);
    for (unsigned op = 0; op < SIM_HAL_OP_COUNT; op++) {
        TEST_ASSERT_EQUAL_UINT32(1, hal.op_calls[op]);
    }
}

void test_each_index_hits_its_operation_and_no_other(void) {
    for (unsigned index = 1; index <= SIM_HAL_OP_COUNT; index++) {
        sim_store_init(&store);
        start();
        sim_hal_fail_at(&hal, index, 1, SIM_HAL_OP_ALL);
        (void)call_all();
        assert_failed((sim_hal_op_t)(index - 1), 1);
    }
}

void test_a_range_of_calls_or_all_from_one_on_can_fail(void) {
    sim_hal_fail_at(&hal, 5, 3, SIM_HAL_OP_ALL);
    (void)call_all();
    assert_failed(SIM_HAL_OP_RESET_CAUSE, 3);
    sim_hal_fail_at(&hal, 5 + hal.calls, UINT32_MAX, SIM_HAL_OP_ALL);
    (void)call_all();
    assert_failed(SIM_HAL_OP_SELF_TEST, 3 + 12);
    sim_hal_fail_at(&hal, 0, UINT32_MAX, SIM_HAL_OP_ALL);
    (void)call_all();
    TEST_ASSERT_EQUAL_UINT32(15, hal.failures);
}

void test_failing_can_be_limited_to_operations(void) {
    sim_hal_fail_at(&hal, 1, UINT32_MAX, 1u << SIM_HAL_OP_LED_SET | 1u << SIM_HAL_OP_STORE_APPEND);
    TEST_ASSERT_EQUAL_UINT(5, call_all()); /* no append, and no record to read */
    assert_failed(SIM_HAL_OP_STORE_APPEND, 2);
    TEST_ASSERT_FALSE(hal.led.on);
}

void test_what_a_failing_controller_operation_does(void) {
    hal_can_status_t status;
    sim_hal_set_tx_pending_ms(&hal, HAL_CAN_VEHICLE, 7);
    fail_next();
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    TEST_ASSERT_EQUAL_UINT32(1, hal.can[HAL_CAN_VEHICLE].refused);
    fail_next();
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    hal_can_status(&hal, HAL_CAN_VEHICLE, &status);
    TEST_ASSERT_EQUAL_UINT32(7, status.tx_pending_ms);
    sim_hal_set_can_state(&hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    fail_next();
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT32(0, hal.can[HAL_CAN_VEHICLE].recover_requests);
}

/* The last report again, so that no counter goes down. */
void test_a_failing_status_repeats_the_last_report(void) {
    static sim_bus_t bus;
    hal_can_status_t status;
    sim_bus_init(&bus, 500000);
    sim_hal_init(&hal, NULL);
    sim_hal_attach(&hal, HAL_CAN_VEHICLE, &bus, NULL);
    sim_hal_add_overrun(&hal, HAL_CAN_VEHICLE);
    hal_can_status(&hal, HAL_CAN_VEHICLE, &status);
    sim_hal_add_overrun(&hal, HAL_CAN_VEHICLE);
    fail_next();
    hal_can_status(&hal, HAL_CAN_VEHICLE, &status);
    TEST_ASSERT_EQUAL_UINT16(1, status.overrun_count);
    hal_can_status(&hal, HAL_CAN_VEHICLE, &status);
    TEST_ASSERT_EQUAL_UINT16(2, status.overrun_count);
}

/* The last value that could be read; before the first reading the start value. */
void test_a_clock_that_fails_from_the_first_call_on_stands_at_the_start(void) {
    sim_hal_init_direct(&hal, &(sim_hal_config_t){.clock_start_ms = 77}, 1, NULL, NULL);
    sim_hal_set_now_ms(&hal, 90);
    sim_hal_fail_at(&hal, 1, UINT32_MAX, SIM_HAL_OP_ALL);
    TEST_ASSERT_EQUAL_UINT32(77, hal_clock_now_ms(&hal));
}

void test_what_the_other_failing_operations_do(void) {
    sim_hal_set_now_ms(&hal, 5);
    TEST_ASSERT_EQUAL_UINT32(5, hal_clock_now_ms(&hal));
    sim_hal_set_now_ms(&hal, 6);
    fail_next();
    TEST_ASSERT_EQUAL_UINT32(5, hal_clock_now_ms(&hal));
    fail_next();
    TEST_ASSERT_EQUAL_INT(HAL_RESET_UNKNOWN, hal_reset_cause(&hal));
    hal_safety_output_set(&hal, true);
    fail_next();
    hal_safety_output_set(&hal, false);
    TEST_ASSERT_TRUE(hal.safety_output.on);
    fail_next();
    hal_watchdog_feed(&hal);
    TEST_ASSERT_EQUAL_UINT32(0, hal.feeds);
    sim_hal_set_now_ms(&hal, 101);
    TEST_ASSERT_TRUE(sim_hal_poll(&hal));
}

void test_what_a_failing_store_does(void) {
    uint8_t bytes[4] = {1, 2, 3, 4};
    TEST_ASSERT_TRUE(hal_store_write_latch(&hal, bytes, 4));
    TEST_ASSERT_TRUE(hal_store_append(&hal, bytes, 4));
    fail_next();
    TEST_ASSERT_FALSE(hal_store_write_latch(&hal, bytes, 2));
    fail_next();
    TEST_ASSERT_FALSE(hal_store_append(&hal, bytes, 2));
    fail_next();
    TEST_ASSERT_EQUAL_size_t(0, hal_store_read_latch(&hal, bytes, 4));
    fail_next();
    TEST_ASSERT_EQUAL_size_t(0, hal_store_read_record(&hal, 0, bytes, 4));
    TEST_ASSERT_EQUAL_size_t(4, hal_store_read_latch(&hal, bytes, 4));
    TEST_ASSERT_EQUAL_size_t(0, hal_store_read_record(&hal, 1, bytes, 4));
}

/* Failures of the store are reported by the port. */
void test_a_store_that_fails_is_reported(void) {
    sim_store_fail_writes(&store, 2);
    TEST_ASSERT_FALSE(hal_store_write_latch(&hal, "abcd", 4));
    TEST_ASSERT_FALSE(hal_store_append(&hal, "abcd", 4));
    TEST_ASSERT_EQUAL_UINT32(0, hal.failures);
}

void test_a_port_without_a_store_stores_nothing(void) {
    uint8_t bytes[4] = {0};
    sim_hal_init_direct(&hal, NULL, 1, NULL, NULL);
    TEST_ASSERT_FALSE(hal_store_write_latch(&hal, bytes, 4));
    TEST_ASSERT_FALSE(hal_store_append(&hal, bytes, 4));
    TEST_ASSERT_EQUAL_size_t(0, hal_store_read_latch(&hal, bytes, 4));
    TEST_ASSERT_EQUAL_size_t(0, hal_store_read_record(&hal, 0, bytes, 4));
}

/* The template port: it has every function of the contract, and none has an effect. */
#include "hal/clock.h"
#include "hal/led.h"
#include "hal/safety_output.h"
#include "hal/store.h"
#include "hal/watchdog.h"
#include "hal_template/hal_template.h"
#include "unity.h"

static struct hal hal;

void setUp(void) {
    hal_template_init(&hal);
}

void test_no_frame_comes_or_goes(void) {
    hal_can_frame_t frame = {.id = 0x168};
    hal_can_status_t status = {HAL_CAN_BUS_OFF, 1, 2, 3};
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_VEHICLE, &frame));
    TEST_ASSERT_FALSE(hal_template_receive(&hal, HAL_CAN_VEHICLE, &frame));
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    hal_can_status(&hal, HAL_CAN_VEHICLE, &status);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_ERROR_ACTIVE, status.state);
    TEST_ASSERT_EQUAL_UINT32(0, status.tx_pending_ms);
    status.state = HAL_CAN_BUS_OFF;
    hal_can_status(&hal, HAL_CAN_SIDES, &status);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_ERROR_ACTIVE, status.state);
}

/* An unknown reset cause is never reported as a power-on. */
/* Shows: FSM-7 */
void test_an_unwritten_port_does_not_claim_a_power_on(void) {
    TEST_ASSERT_EQUAL_INT(HAL_RESET_UNKNOWN, hal_reset_cause(&hal));
}

void test_nothing_is_stored(void) {
    uint8_t byte = 0x55;
    TEST_ASSERT_FALSE(hal_store_write_latch(&hal, &byte, 1));
    TEST_ASSERT_FALSE(hal_store_append(&hal, &byte, 1));
    TEST_ASSERT_EQUAL_size_t(0, hal_store_read_latch(&hal, &byte, 1));
    TEST_ASSERT_EQUAL_size_t(0, hal_store_read_record(&hal, 0, &byte, 1));
    TEST_ASSERT_EQUAL_HEX8(0x55, byte);
}

void test_the_rest_can_be_called(void) {
    hal_led_set(&hal, true);
    hal_safety_output_set(&hal, true);
    hal_watchdog_feed(&hal);
    TEST_ASSERT_EQUAL_UINT32(0, hal_clock_now_ms(&hal));
}

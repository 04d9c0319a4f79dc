/* The HAL contract can be mocked, and the mocks see the order of calls across headers. */
#include "mock_can.h"
#include "mock_clock.h"
#include "mock_led.h"
#include "mock_reset.h"
#include "mock_safety_output.h"
#include "mock_store.h"
#include "mock_watchdog.h"

#include "unity.h"

/* A port's context: the core never looks inside. */
struct hal {
    int unused;
};
static hal_t hal;

void test_a_mock_compares_the_whole_frame(void) {
    const hal_can_frame_t frame = {.id = 0x168, .length = 8, .data = {8}};
    const hal_can_frame_t same = frame;
    hal_can_send_ExpectAndReturn(&hal, HAL_CAN_VEHICLE, &frame, true);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &same));
}

void test_a_mock_fills_what_the_caller_points_to(void) {
    hal_can_status_t reported = {.state = HAL_CAN_BUS_OFF, .bus_off_count = 3};
    hal_can_status_t status;
    hal_can_status_Expect(&hal, HAL_CAN_VEHICLE, NULL);
    hal_can_status_IgnoreArg_status();
    hal_can_status_ReturnThruPtr_status(&reported);
    hal_can_status(&hal, HAL_CAN_VEHICLE, &status);
    TEST_ASSERT_EQUAL(HAL_CAN_BUS_OFF, status.state);
    TEST_ASSERT_EQUAL_UINT16(3, status.bus_off_count);
}

void test_calls_to_several_parts_of_the_hal_come_in_one_order(void) {
    hal_safety_output_set_Expect(&hal, false);
    hal_led_set_Expect(&hal, true);
    hal_watchdog_feed_Expect(&hal);
    hal_safety_output_set(&hal, false);
    hal_led_set(&hal, true);
    hal_watchdog_feed(&hal);
}

/* Planted: the right calls in the wrong order, across two mocks. */
#include "mock_led.h"
#include "mock_watchdog.h"

#include "unity.h"

void setUp(void) {
}

void tearDown(void) {
}

void test_calls_out_of_order(void) {
    hal_led_set_Expect(NULL, true);
    hal_watchdog_feed_Expect(NULL);
    hal_watchdog_feed(NULL);
    hal_led_set(NULL, true);
}

/* Planted: a call that is expected and does not come. */
#include "mock_watchdog.h"

#include "unity.h"

void setUp(void) {
}

void tearDown(void) {
}

void test_call_that_does_not_come(void) {
    hal_watchdog_feed_Expect(NULL);
}

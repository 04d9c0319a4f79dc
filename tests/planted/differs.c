/* Planted: what holds on a computer and not on a microcontroller. */
#include "unity.h"

void setUp(void) {
}

void tearDown(void) {
}

void test_that_differs(void) {
    TEST_ASSERT_EQUAL(8, sizeof(void *));
}

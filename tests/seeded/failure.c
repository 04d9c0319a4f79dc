/* Seeded fault: an expectation that does not hold. */
#include "unity.h"

void setUp(void) {
}

void tearDown(void) {
}

void test_that_fails(void) {
    TEST_ASSERT_EQUAL(1, 2);
}

/* Seeded fault: an expectation that does not hold. */
#include "unity.h"

void test_that_fails(void) {
    TEST_ASSERT_EQUAL(1, 2);
}

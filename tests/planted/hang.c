/* Planted: a test that never ends. */
#include "unity.h"

static volatile int forever = 1;

void setUp(void) {
}

void tearDown(void) {
}

void test_that_never_ends(void) {
    while (forever) {
    }
}

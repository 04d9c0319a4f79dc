/* Planted: a test program without a test. */
#include "unity.h"

void setUp(void) {
}

void tearDown(void) {
}

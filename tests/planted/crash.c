/* Planted: a call to where nothing is. */
#include <stdint.h>

#include "unity.h"

static volatile uintptr_t nowhere = 0xF0000001u;

void setUp(void) {
}

void tearDown(void) {
}

void test_that_crashes(void) {
    ((void (*)(void))nowhere)();
}

/** @file one_why.h Common start of the tests of why/: one object with the default configuration. Included by the test itself. */
#ifndef ONE_WHY_H
#define ONE_WHY_H

#include "unity.h"
#include "why_feed.h"

static why_t *why;
static agv_config_t config;

void setUp(void) {
    agv_config_defaults(&config);
    why = why_new(&config);
    TEST_ASSERT_NOT_NULL(why);
}

void tearDown(void) {
    why_free(why);
}

#endif

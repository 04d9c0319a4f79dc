/** @file one_why.h Common start of the tests of why/: one object with the default configuration. Included by the test itself. */
#ifndef ONE_WHY_H
#define ONE_WHY_H

#include "unity.h"
#include "why/why_words.h"
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

static inline void check_words(const why_trip_t *trip, const char *expected) {
    text_t text = {.used = 0};
    why_words_cause(&text, why, trip);
    TEST_ASSERT_EQUAL_STRING(expected, text.bytes);
}

#endif

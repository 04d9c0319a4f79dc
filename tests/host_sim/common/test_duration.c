/* Times as people write them. */
#include "common/duration.h"

#include <stddef.h>

#include "unity.h"

void setUp(void) {
}

void tearDown(void) {
}

static void check(const char *text, uint64_t expected_ms) {
    uint64_t ms = 0;
    TEST_ASSERT_TRUE_MESSAGE(duration_ms(text, 0, UINT64_MAX, &ms), text);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(expected_ms, ms, text);
}

void test_every_unit(void) {
    check("250ms", 250);
    check("10s", 10000);
    check("60s", 60000);
    check("1min", 60000);
    check("2h", 7200000);
    check("0s", 0);
}

void test_fractions(void) {
    check("1.5min", 90000);
    check("0.25s", 250);
    check("0.001s", 1);
    check("1.000000000h", 3600000);
    check("2.0ms", 2);
}

void test_a_number_alone_is_milliseconds(void) {
    check("7500", 7500);
    check("18446744073709551615", UINT64_MAX);
}

void test_what_is_no_time(void) {
    static const char *const bad[] = {"",
                                      "s",
                                      "-1s",
                                      "+1s",
                                      "1 s",
                                      "1.s",
                                      ".5s",
                                      "1.5",
                                      "1,5s",
                                      "1S",
                                      "1sec",
                                      "1m",
                                      "1.5msx",
                                      "0.0001s",
                                      "1e3s",
                                      "0x10ms",
                                      "1s2ms",
                                      "ms10",
                                      "1..5s",
                                      "0.0005ms",
                                      "18446744073709551616",
                                      "18446744073709551615s",
                                      "1.0000000001s"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        uint64_t ms = 0;
        TEST_ASSERT_FALSE_MESSAGE(duration_ms(bad[i], 0, UINT64_MAX, &ms), bad[i]);
    }
}

void test_the_limits(void) {
    uint64_t ms = 0;
    TEST_ASSERT_TRUE(duration_ms("1s", 1000, 1000, &ms));
    TEST_ASSERT_FALSE(duration_ms("999ms", 1000, 2000, &ms));
    TEST_ASSERT_FALSE(duration_ms("2.001s", 1000, 2000, &ms));
}

void test_a_time_as_text(void) {
    char text[DURATION_TEXT_SIZE];
    TEST_ASSERT_EQUAL_STRING("1500ms", duration_text(1500, text));
    TEST_ASSERT_EQUAL_STRING("90s", duration_text(90000, text));
    TEST_ASSERT_EQUAL_STRING("2h", duration_text(7200000, text));
    TEST_ASSERT_EQUAL_STRING("3min", duration_text(180000, text));
    TEST_ASSERT_EQUAL_STRING("0ms", duration_text(0, text));
}

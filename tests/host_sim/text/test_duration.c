/* Times as people write them. */
#include "text/duration.h"

#include <stddef.h>
#include <string.h>

#include "unity.h"

static void check_in(duration_unit_t unit, const char *text, uint64_t expected) {
    uint64_t number = 0;
    TEST_ASSERT_EQUAL_INT_MESSAGE(DURATION_OK, duration_read(text, unit, 0, UINT64_MAX, &number), text);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(expected, number, text);
}

static void check(const char *text, uint64_t expected_ms) {
    check_in(DURATION_MS, text, expected_ms);
}

static void check_bad(duration_result_t expected, const char *text) {
    uint64_t number = 0;
    TEST_ASSERT_EQUAL_INT_MESSAGE(expected, duration_read(text, DURATION_MS, 0, UINT64_MAX, &number), text);
}

void test_every_unit(void) {
    check("5000us", 5);
    check("250ms", 250);
    check("10s", 10000);
    check("60s", 60000);
    check("1min", 60000);
    check("2h", 7200000);
    check("1d", 86400000);
    check("0s", 0);
}

void test_a_blank_before_the_unit(void) {
    check("10 s", 10000);
    check_bad(DURATION_NO_TIME, "10  s");
    check_bad(DURATION_NO_TIME, "10 ");
    check_bad(DURATION_NO_TIME, " 10 s");
}

void test_fractions(void) {
    check("1.5min", 90000);
    check("0.25s", 250);
    check("0.001s", 1);
    check("1.000000000h", 3600000);
    check("6.00000000000000000000h", 21600000);
    check("2.0ms", 2);
    check_in(DURATION_US, "0.999ms", 999);
    check_in(DURATION_US, "876000h", 3153600000000000);
}

void test_a_number_alone_is_in_the_unit_that_is_counted(void) {
    check("7500", 7500);
    check("18446744073709551615", UINT64_MAX);
    check_in(DURATION_MIN, "90", 90);
    check_in(DURATION_MIN, "1.5h", 90);
    check_in(DURATION_H, "365d", 8760);
    check_in(DURATION_H, "120min", 2);
    check_in(DURATION_US, "17", 17);
}

void test_what_is_no_time(void) {
    static const char *const bad[] = {"",       "s",     "-1s",  "+1s",   "1.s",        ".5s",   "1.5",
                                      "1,5s",   "1S",    "1sec", "1m",    "1.5msx",     "1e3s",  "1e9999s",
                                      "0x10ms", "1s2ms", "ms10", "1..5s", "10 parsecs", "never", "1_000"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        check_bad(DURATION_NO_TIME, bad[i]);
    }
}

void test_what_is_too_fine(void) {
    check_bad(DURATION_TOO_FINE, "0.0001s");
    check_bad(DURATION_TOO_FINE, "0.0005ms");
    check_bad(DURATION_TOO_FINE, "1us");
    check_bad(DURATION_TOO_FINE, "1.0000000001s");
    uint64_t hours = 0;
    TEST_ASSERT_EQUAL_INT(DURATION_TOO_FINE, duration_read("90min", DURATION_H, 0, UINT64_MAX, &hours));
}

void test_the_limits(void) {
    uint64_t ms = 0;
    TEST_ASSERT_EQUAL_INT(DURATION_OK, duration_read("1s", DURATION_MS, 1000, 1000, &ms));
    TEST_ASSERT_EQUAL_INT(DURATION_OUT_OF_RANGE, duration_read("999ms", DURATION_MS, 1000, 2000, &ms));
    TEST_ASSERT_EQUAL_INT(DURATION_OUT_OF_RANGE, duration_read("2.001s", DURATION_MS, 1000, 2000, &ms));
    check_bad(DURATION_OUT_OF_RANGE, "18446744073709551616");
    check_bad(DURATION_OUT_OF_RANGE, "18446744073709551615s");
    check_bad(DURATION_OUT_OF_RANGE, "99999999999999999999999999d");
}

void test_what_is_wrong_in_words(void) {
    char problem[DURATION_PROBLEM_SIZE];
    TEST_ASSERT_EQUAL_STRING("'10 parsecs' is not a time: 250ms, 10s, 1.5min, 2h, or whole milliseconds alone",
                             duration_problem(DURATION_NO_TIME, "10 parsecs", DURATION_MS, 1, 5000, problem));
    TEST_ASSERT_EQUAL_STRING("'1us' is not a whole number of milliseconds",
                             duration_problem(DURATION_TOO_FINE, "1us", DURATION_MS, 1, 5000, problem));
    TEST_ASSERT_EQUAL_STRING("'6s' is not within 1ms to 5s",
                             duration_problem(DURATION_OUT_OF_RANGE, "6s", DURATION_MS, 1, 5000, problem));
}

void test_what_is_offered_is_accepted(void) {
    static const char *const offered[] = {
        [DURATION_US] = "'x' is not a time: 250ms, 10s, 1.5min, 2h, or whole microseconds alone",
        [DURATION_MS] = "'x' is not a time: 250ms, 10s, 1.5min, 2h, or whole milliseconds alone",
        [DURATION_S] = "'x' is not a time: 10s, 1.5min, 2h, or whole seconds alone",
        [DURATION_MIN] = "'x' is not a time: 2h, or whole minutes alone",
        [DURATION_H] = "'x' is not a time: 2h, or whole hours alone",
        [DURATION_D] = "'x' is not a time: 2d, or whole days alone",
    };
    for (size_t unit = 0; unit < sizeof offered / sizeof offered[0]; unit++) {
        char problem[DURATION_PROBLEM_SIZE];
        TEST_ASSERT_EQUAL_STRING(offered[unit],
                                 duration_problem(DURATION_NO_TIME, "x", (duration_unit_t)unit, 1, 5000, problem));
        char *times = strchr(problem, ':') + 1;
        *strstr(times, ", or whole") = '\0';
        for (char *time = strtok(times, ","); time != NULL; time = strtok(NULL, ",")) {
            uint64_t number = 0;
            TEST_ASSERT_EQUAL_INT_MESSAGE(DURATION_OK,
                                          duration_read(&time[1], (duration_unit_t)unit, 1, UINT64_MAX, &number), time);
        }
    }
}

static void check_text(const char *expected, uint64_t number, duration_unit_t unit) {
    char text[DURATION_TEXT_SIZE];
    TEST_ASSERT_EQUAL_STRING(expected, duration_text(number, unit, text));
}

void test_a_time_as_text(void) {
    check_text("1500ms", 1500, DURATION_MS);
    check_text("90s", 90000, DURATION_MS);
    check_text("2h", 7200000, DURATION_MS);
    check_text("3min", 180000, DURATION_MS);
    check_text("0ms", 0, DURATION_MS);
    check_text("100d", 2400, DURATION_H);
    check_text("999us", 999, DURATION_US);
}

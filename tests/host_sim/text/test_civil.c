/* Dates as seconds since 1970; the expected values are those of `date -u -d '...' +%s`. */
#include "text/civil.h"

#include <stdlib.h>
#include <time.h>

#include "unity.h"

static void check(civil_t civil, uint64_t expected) {
    uint64_t seconds = 1;
    TEST_ASSERT_TRUE(civil_seconds(&civil, &seconds));
    TEST_ASSERT_EQUAL_UINT64(expected, seconds);
}

static void refuse(civil_t civil) {
    uint64_t seconds = 0;
    TEST_ASSERT_FALSE(civil_seconds(&civil, &seconds));
}

void test_dates(void) {
    check((civil_t){1970, 1, 1, 0, 0, 0}, 0);
    check((civil_t){1970, 3, 1, 0, 0, 1}, 5097601);
    check((civil_t){2000, 2, 29, 23, 59, 59}, 951868799);
    check((civil_t){2023, 11, 14, 22, 13, 20}, 1700000000);
    check((civil_t){2100, 3, 1, 12, 0, 0}, 4107585600);
}

void test_what_is_no_date(void) {
    refuse((civil_t){1969, 12, 31, 0, 0, 0});
    refuse((civil_t){2023, 0, 1, 0, 0, 0});
    refuse((civil_t){2023, 13, 1, 0, 0, 0});
    refuse((civil_t){2023, 2, 29, 0, 0, 0});
    refuse((civil_t){2100, 2, 29, 0, 0, 0});
    refuse((civil_t){2023, 4, 31, 0, 0, 0});
    refuse((civil_t){2023, 4, 0, 0, 0, 0});
    refuse((civil_t){2023, 4, 1, 24, 0, 0});
    refuse((civil_t){2023, 4, 1, 0, 60, 0});
    refuse((civil_t){2023, 4, 1, 0, 0, 61});
}

void test_local_time(void) {
    char text[CIVIL_LOCAL_SIZE];
    (void)setenv("TZ", "UTC-2", 1); /* two hours east */
    tzset();
    TEST_ASSERT_EQUAL_STRING("2023-11-15 00:13:20.123", civil_local(text, 1700000000123999));
    TEST_ASSERT_EQUAL_STRING("1970-01-01 02:00:00.000", civil_local(text, 0));
}

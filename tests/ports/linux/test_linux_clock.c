/* Conversion of the kernel's stamps to time since the start, with the real clocks. A test sets the start as far back as
 * it needs. */
#include "hal_linux/linux_clock.h"

#include <time.h>

#include "unity.h"

#define S_US UINT64_C(1000000)
#define NEAR_US 50000u /* time that an interruption may take between two calls */

static uint64_t read_us(clockid_t id) {
    struct timespec now;
    TEST_ASSERT_EQUAL_INT(0, clock_gettime(id, &now));
    return (uint64_t)now.tv_sec * S_US + (uint64_t)now.tv_nsec / 1000u;
}

/* A clock that was started this long ago, which may be longer than the computer runs (unsigned). */
static linux_clock_t started(uint64_t ago_us) {
    return (linux_clock_t){.start_ns = (read_us(CLOCK_BOOTTIME) - ago_us) * 1000u};
}

static void expect_age(const linux_clock_t *clock, uint64_t stamp_us, uint64_t age_us) {
    const uint64_t before_us = linux_clock_now_us(clock);
    const uint64_t at_us = linux_clock_of_stamp(clock, stamp_us);
    const uint64_t after_us = linux_clock_now_us(clock);
    TEST_ASSERT_TRUE(at_us + age_us <= after_us + 2u);
    TEST_ASSERT_TRUE(at_us + age_us + NEAR_US >= before_us);
    TEST_ASSERT_TRUE(at_us <= after_us);
}

void test_a_clock_counts_from_its_start(void) {
    linux_clock_t clock;
    linux_clock_start(&clock);
    const uint64_t first_us = linux_clock_now_us(&clock);
    TEST_ASSERT_TRUE(first_us < S_US);
    const struct timespec pause = {.tv_nsec = 5000000};
    TEST_ASSERT_EQUAL_INT(0, nanosleep(&pause, NULL));
    const uint64_t later_us = linux_clock_now_us(&clock);
    TEST_ASSERT_TRUE(later_us - first_us >= 5000u);
    TEST_ASSERT_TRUE(later_us - first_us < S_US);
}

void test_a_stamp_is_as_old_as_it_says(void) {
    const linux_clock_t clock = started(200u * S_US);
    const uint64_t ages_us[] = {0, 1000, 250000, S_US, 59u * S_US};
    for (unsigned i = 0; i < sizeof ages_us / sizeof ages_us[0]; i++) {
        expect_age(&clock, read_us(CLOCK_REALTIME) - ages_us[i], ages_us[i]);
    }
}

void test_no_stamp_counts_as_now(void) {
    const linux_clock_t clock = started(200u * S_US);
    expect_age(&clock, 0, 0);
}

void test_a_stamp_in_the_future_counts_as_now(void) {
    const linux_clock_t clock = started(200u * S_US);
    expect_age(&clock, read_us(CLOCK_REALTIME) + S_US, 0);
    expect_age(&clock, UINT64_MAX, 0);
}

void test_a_stamp_before_the_start_counts_as_now(void) {
    const linux_clock_t clock = started(2u * S_US);
    expect_age(&clock, read_us(CLOCK_REALTIME) - 1u * S_US, 1u * S_US);
    expect_age(&clock, read_us(CLOCK_REALTIME) - 3u * S_US, 0);
}

void test_a_stamp_of_more_than_a_minute_ago_counts_as_now(void) {
    const linux_clock_t clock = started(200u * S_US);
    expect_age(&clock, read_us(CLOCK_REALTIME) - 61u * S_US, 0);
    expect_age(&clock, 1, 0);
}

void test_later_stamps_are_never_much_earlier(void) {
    const linux_clock_t clock = started(200u * S_US);
    const uint64_t stamp_us = read_us(CLOCK_REALTIME) - S_US;
    const uint64_t first_us = linux_clock_of_stamp(&clock, stamp_us);
    unsigned far = 0;
    for (unsigned i = 0; i < 1000; i++) {
        const uint64_t at_us = linux_clock_of_stamp(&clock, stamp_us + i);
        const uint64_t expected_us = first_us + i;
        far += (at_us > expected_us + 100u || at_us + 100u < expected_us) ? 1u : 0u;
    }
    TEST_ASSERT_TRUE(far < 50);
}

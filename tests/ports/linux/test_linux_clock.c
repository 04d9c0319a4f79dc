/* Conversion of the kernel's stamps to time since the start; a computer that sleeps, and frames that wait for long. The
 * program's clocks are those of the test. */
#include <time.h>

#include "hal_linux/linux_clock.h"
#include "unity.h"

#define S_US UINT64_C(1000000)

static uint64_t awake_us; /* CLOCK_MONOTONIC */
static uint64_t asleep_us;
static uint64_t set_us;        /* by which the system's time differs from the others */
static unsigned interruptions; /* of a millisecond, each before a reading of the system's time */

int clock_gettime(clockid_t id, struct timespec *time) {
    if (id == CLOCK_REALTIME && interruptions > 0) {
        interruptions--;
        awake_us += 1000;
    }
    uint64_t now_us = awake_us;
    if (id != CLOCK_MONOTONIC) {
        now_us += asleep_us;
    }
    if (id == CLOCK_REALTIME) {
        now_us += set_us;
    }
    *time = (struct timespec){.tv_sec = (time_t)(now_us / S_US), .tv_nsec = (long)(now_us % S_US) * 1000};
    return 0;
}

static linux_clock_t sut;

void setUp(void) {
    awake_us = 500 * S_US;
    asleep_us = 30 * S_US;
    set_us = 9000 * S_US;
    interruptions = 0;
    linux_clock_start(&sut);
}

void tearDown(void) {
}

/* The kernel's stamp of a frame that arrives now. */
static uint64_t stamp(void) {
    return awake_us + asleep_us + set_us;
}

void test_a_stamp_is_as_old_as_it_says_up_to_a_minute_and_since_the_start(void) {
    static const struct {
        uint64_t runs_us;
        uint64_t age_us;
        uint64_t at_us;
    } cases[] = {
        {200 * S_US, 0, 200 * S_US},
        {200 * S_US, 1000, 200 * S_US - 1000},
        {200 * S_US, 60 * S_US, 140 * S_US},
        {200 * S_US, 60 * S_US + 1, 200 * S_US},
        {2 * S_US, 2 * S_US, 0},
        {2 * S_US, 2 * S_US + 1, 2 * S_US},
        {200 * S_US, -S_US, 200 * S_US}, /* in the future */
    };
    for (unsigned i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        setUp();
        TEST_ASSERT_EQUAL_UINT64(0, linux_clock_now_us(&sut));
        awake_us += cases[i].runs_us;
        TEST_ASSERT_EQUAL_UINT64(cases[i].runs_us, linux_clock_now_us(&sut));
        TEST_ASSERT_EQUAL_UINT64(cases[i].at_us, linux_clock_of_stamp(&sut, stamp() - cases[i].age_us));
    }
    TEST_ASSERT_EQUAL_UINT64(200 * S_US, linux_clock_of_stamp(&sut, 0)); /* none */
    TEST_ASSERT_EQUAL_UINT64(200 * S_US, linux_clock_of_stamp(&sut, UINT64_MAX));
}

void test_an_interruption_between_the_readings_of_two_clocks_is_no_age(void) {
    awake_us += 2 * S_US;
    const uint64_t arrived = stamp();
    interruptions = 2;
    TEST_ASSERT_EQUAL_UINT64(2 * S_US, linux_clock_of_stamp(&sut, arrived));
    interruptions = 3; /* it gives up: older than it is, not fresher */
    TEST_ASSERT_EQUAL_UINT64(2 * S_US - 1000, linux_clock_of_stamp(&sut, arrived));
}

/* Shows: TIM-4 */
void test_the_clock_goes_on_while_the_computer_sleeps(void) {
    awake_us += 2 * S_US;
    TEST_ASSERT_EQUAL_UINT64(2 * S_US, linux_clock_now_us(&sut));
    asleep_us += 3600 * S_US;
    awake_us += 1;
    TEST_ASSERT_EQUAL_UINT64(3602 * S_US + 1, linux_clock_now_us(&sut));
}

/* Shows: TIM-4 */
void test_a_frame_from_before_a_short_sleep_is_as_old_as_it_is(void) {
    awake_us += 2 * S_US;
    const uint64_t before_us = stamp();
    asleep_us += 40 * S_US;
    TEST_ASSERT_EQUAL_UINT64(2 * S_US, linux_clock_of_stamp_after(&sut, before_us, 1 * S_US));
    TEST_ASSERT_EQUAL_UINT64(42 * S_US, linux_clock_of_stamp_after(&sut, stamp(), 1 * S_US));
}

/* Shows: TIM-4 */
void test_a_frame_that_waited_for_long_does_not_look_fresh(void) {
    awake_us += 2 * S_US;
    const uint64_t before_us = stamp();
    asleep_us += 3600 * S_US;
    TEST_ASSERT_EQUAL_UINT64(1 * S_US, linux_clock_of_stamp_after(&sut, before_us, 1 * S_US));
    TEST_ASSERT_EQUAL_UINT64(3602 * S_US,
                             linux_clock_of_stamp_after(&sut, before_us, 9999 * S_US)); /* never after now */
    TEST_ASSERT_EQUAL_UINT64(3602 * S_US, linux_clock_of_stamp(&sut, before_us));
}

void test_a_frame_that_waits_while_the_time_is_set(void) {
    awake_us += 2 * S_US;
    const uint64_t before_us = stamp();
    set_us += 600 * S_US;
    TEST_ASSERT_EQUAL_UINT64(1 * S_US, linux_clock_of_stamp_after(&sut, before_us, 1 * S_US));
    set_us -= 1200 * S_US; /* the stamp lies in the future */
    TEST_ASSERT_EQUAL_UINT64(2 * S_US, linux_clock_of_stamp_after(&sut, before_us, 1 * S_US));
    TEST_ASSERT_EQUAL_UINT64(2 * S_US, linux_clock_of_stamp_after(&sut, 0, 1 * S_US)); /* none */
}

/* Gaps in a histogram: what is exact, and how close the rest is. */
#include "traffic/gaps.h"

#include <string.h>

#include "unity.h"

static gaps_t gaps;

void setUp(void) {
    memset(&gaps, 0, sizeof gaps);
}

static void assert_within(uint64_t expected_us, uint64_t us) {
    TEST_ASSERT_UINT64_WITHIN((expected_us / 64) + 1, expected_us, us);
}

void test_no_gaps(void) {
    TEST_ASSERT_EQUAL_UINT64(0, gaps_quantile_us(&gaps, 500));
    TEST_ASSERT_EQUAL_UINT64(0, gaps_without_longest_us(&gaps, 0));
    TEST_ASSERT_EQUAL_UINT64(0, gaps_longer_than(&gaps, 0));
}

void test_shortest_and_longest_are_exact(void) {
    gaps_add(&gaps, 1000, 10017);
    gaps_add(&gaps, 11017, 9983);
    gaps_add(&gaps, 21000, 123457);
    TEST_ASSERT_EQUAL_UINT64(3, gaps.count);
    TEST_ASSERT_EQUAL_UINT64(9983, gaps.shortest_us);
    TEST_ASSERT_EQUAL_UINT64(123457, gaps.longest_us);
    TEST_ASSERT_EQUAL_UINT64(21000, gaps.longest_at_us);
    TEST_ASSERT_EQUAL_UINT64(123457, gaps_quantile_us(&gaps, 1000));
    assert_within(10017, gaps_quantile_us(&gaps, 500));
}

/* A median below the cycle of a sender that is never late would be a wrong figure. */
void test_equal_gaps_are_exact_beside_a_shorter_and_a_longer_one(void) {
    gaps_add(&gaps, 0, 31000);
    gaps_add(&gaps, 0, 700000);
    for (unsigned i = 0; i < 29; i++) {
        gaps_add(&gaps, 0, 100000);
    }
    TEST_ASSERT_EQUAL_UINT64(100000, gaps_quantile_us(&gaps, 50));
    TEST_ASSERT_EQUAL_UINT64(100000, gaps_quantile_us(&gaps, 500));
    TEST_ASSERT_EQUAL_UINT64(100000, gaps_without_longest_us(&gaps, 1));
}

/* 65536 to 66559 us is one cell. */
void test_gaps_of_one_cell_are_between_its_shortest_and_its_longest(void) {
    gaps_add(&gaps, 0, 1000);
    for (unsigned i = 0; i <= 4; i++) {
        gaps_add(&gaps, 0, 65600 + (100 * i));
    }
    TEST_ASSERT_EQUAL_UINT64(65600, gaps_quantile_us(&gaps, 333));
    TEST_ASSERT_EQUAL_UINT64(65800, gaps_quantile_us(&gaps, 600));
    TEST_ASSERT_EQUAL_UINT64(66000, gaps_quantile_us(&gaps, 1000));
    TEST_ASSERT_EQUAL_UINT64(66000, gaps_without_longest_us(&gaps, 4));
}

void test_ranks_within_the_promised_error(void) {
    for (uint64_t us = 1; us <= 100000; us++) {
        gaps_add(&gaps, 0, us);
    }
    assert_within(50000, gaps_quantile_us(&gaps, 500));
    assert_within(99900, gaps_quantile_us(&gaps, 999));
    assert_within(1000, gaps_quantile_us(&gaps, 10));
    TEST_ASSERT_EQUAL_UINT64(100, gaps_quantile_us(&gaps, 1));
    assert_within(90000, gaps_without_longest_us(&gaps, 10000));
    TEST_ASSERT_GREATER_OR_EQUAL_UINT64(90000, gaps_without_longest_us(&gaps, 10000));
    assert_within(60000, 100000 - gaps_longer_than(&gaps, 60000));
}

void test_outages_do_not_move_the_usual_longest_gap(void) {
    for (unsigned i = 0; i < 990; i++) {
        gaps_add(&gaps, 0, 10000);
    }
    for (unsigned i = 0; i < 10; i++) {
        gaps_add(&gaps, 0, 500000);
    }
    TEST_ASSERT_UINT64_WITHIN(200, 10000, gaps_without_longest_us(&gaps, 10));
    assert_within(500000, gaps_without_longest_us(&gaps, 9));
}

void test_gaps_of_hours_and_of_nothing(void) {
    gaps_add(&gaps, 0, 0);
    gaps_add(&gaps, 0, UINT64_MAX);
    gaps_add(&gaps, 0, 86400000000);
    TEST_ASSERT_EQUAL_UINT64(0, gaps_quantile_us(&gaps, 1));
    assert_within(86400000000, gaps_quantile_us(&gaps, 500));
    TEST_ASSERT_EQUAL_UINT64(UINT64_MAX, gaps_quantile_us(&gaps, 1000));
    TEST_ASSERT_EQUAL_UINT64(2, gaps_longer_than(&gaps, 1000));
}

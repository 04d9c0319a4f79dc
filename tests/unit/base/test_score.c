/* Scores of frames and budgets of time. */
#include "base/score.h"

#include "unity.h"

static agv_score_t score;
static agv_budget_t budget;

void setUp(void) {
    score = (agv_score_t){0};
    budget = (agv_budget_t){0};
}

/* ---- Scores ---- */

static void frames(const char *of, uint32_t n) {
    for (; *of != '\0'; of++) {
        agv_score_add(&score, *of == 'x', n);
    }
}

static void expect_score(unsigned value, bool present) {
    TEST_ASSERT_EQUAL_UINT8(value, score.value);
    TEST_ASSERT_EQUAL(present, score.present);
}

static void expect_score_after(const char *of, uint32_t n, unsigned value, bool present) {
    frames(of, n);
    expect_score(value, present);
}

/* Shows: SUP-4, SUP-5 */
void test_a_bad_frame_adds_two_and_a_good_one_takes_one_away(void) {
    expect_score_after("x", 3, 2, false);
    expect_score_after(".", 3, 1, false);
    expect_score_after("x", 3, 3, false);
    expect_score_after("...", 3, 0, false);
    expect_score_after(".", 3, 0, false);
}

/* N bad ones in a row, for every N that may be configured. */
/* Shows: SUP-4, SUP-5, SUP-6 */
void test_n_bad_frames_in_a_row_raise_the_fault(void) {
    for (uint32_t n = 2; n <= 100; n++) {
        setUp();
        for (uint32_t i = 1; i < n; i++) {
            frames("x", n);
            TEST_ASSERT_FALSE(score.present);
        }
        expect_score_after("x", n, 2 * n, true);
    }
}

/* It stays within 2 N: six good frames end N of 3, however many bad ones there were. */
/* Shows: SUP-4 */
void test_the_fault_lasts_until_the_score_is_0(void) {
    expect_score_after("xxxxxxxxxxxxxxxxxxxx", 3, 6, true);
    expect_score_after(".....", 3, 1, true);
    expect_score_after("x", 3, 3, true);
    expect_score_after("..", 3, 1, true);
    expect_score_after(".", 3, 0, false);
    expect_score_after("xx", 3, 4, false); /* from the beginning */
}

/* With N of 2 as well: only with N of 1 the last frame decides. */
/* Shows: SUP-4 */
void test_a_count_of_two_is_scored_too(void) {
    expect_score_after("x.", 2, 1, false);
    expect_score_after("x.", 2, 2, false);
    expect_score_after("x", 2, 4, true);
    expect_score_after("...", 2, 1, true);
    expect_score_after(".", 2, 0, false);
}

/* From 5 two more do not go beyond 6. */
void test_the_limit_holds_from_an_odd_score_as_well(void) {
    expect_score_after("xxx.", 3, 5, true);
    expect_score_after("x", 3, 6, true);
    setUp();
    expect_score_after("x.xx", 3, 5, false);
    expect_score_after("x", 3, 6, true);
}

/* A bad and a good frame add 1: 2 N - 2 such pairs and one more bad frame are some 4 N frames. */
/* Shows: SUP-4, SUP-5, SUP-6 */
TEST_CASE(3)
TEST_CASE(5)
TEST_CASE(10)
TEST_CASE(100)
void test_every_second_frame_bad_raises_the_fault_after_some_4_n_frames(uint32_t n) {
    unsigned counted = 0;
    while (!score.present) {
        agv_score_add(&score, counted % 2 == 0, n);
        counted++;
        TEST_ASSERT_TRUE(counted <= 4 * n);
    }
    TEST_ASSERT_EQUAL_UINT(2 * (2 * n - 2) + 1, counted);
}

/* Two good frames for each bad one never raise the fault. */
void test_every_third_frame_bad_raises_no_fault(void) {
    for (unsigned i = 0; i < 3000; i++) {
        agv_score_add(&score, i % 3 == 0, 2);
        TEST_ASSERT_FALSE(score.present);
    }
}

/* Shows: SUP-4 */
void test_with_n_of_1_the_last_frame_decides(void) {
    for (unsigned i = 0; i < 20; i++) {
        frames("x", 1);
        TEST_ASSERT_TRUE(score.present);
        expect_score_after((i % 2 == 0) ? "." : "x.", 1, 0, false);
    }
}

/* ---- Budgets ---- */

/* One by one, as ticks come. */
static void run(bool condition, unsigned ms, uint32_t limit_ms) {
    for (unsigned i = 0; i < ms; i++) {
        agv_budget_add(&budget, condition, 1, limit_ms);
    }
}

/* A tick that sees what the condition is from now on. The ms before it counts by what it was. */
static void begin(bool condition, uint32_t limit_ms) {
    agv_budget_add(&budget, condition, 1, limit_ms);
}

static void expect_budget(unsigned value_ms, bool present) {
    TEST_ASSERT_EQUAL_UINT16(value_ms, budget.value_ms);
    TEST_ASSERT_EQUAL(present, budget.present);
}

static void expect_budget_after(bool condition, unsigned ms, uint32_t limit_ms, unsigned value_ms, bool present) {
    run(condition, ms, limit_ms);
    expect_budget(value_ms, present);
}

/* The same in one tick. */
static void expect_budget_after_tick(bool condition, uint32_t ms, uint32_t limit_ms, unsigned value_ms, bool present) {
    agv_budget_add(&budget, condition, ms, limit_ms);
    expect_budget(value_ms, present);
}

/* Shows: SUP-10, SUP-11, SUP-12 */
void test_a_condition_that_is_seen_for_the_first_time_has_lasted_for_0_ms(void) {
    expect_budget_after_tick(true, 1, 500, 0, false);
    expect_budget_after_tick(true, 1, 500, 1, false);
}

/* Shows: SUP-10, SUP-11, SUP-12 */
void test_the_ms_before_the_tick_that_sees_the_end_counts(void) {
    begin(true, 500);
    expect_budget_after(true, 9, 500, 9, false);
    expect_budget_after_tick(false, 1, 500, 10, false);
    expect_budget_after_tick(false, 1, 500, 10, false);
    expect_budget_after_tick(false, 1, 500, 9, false);
    begin(true, 500);
    expect_budget_after_tick(true, 490, 500, 499, false);
    expect_budget_after_tick(false, 1, 500, 500, true);
}

/* It hides no condition that began since the last tick, and goes on with none that ended. */
/* Shows: SUP-10, SUP-11, SUP-12, TIM-4 */
void test_a_late_tick_counts_by_what_it_sees(void) {
    expect_budget_after_tick(true, 2, 500, 2, false);
    expect_budget_after_tick(true, 300, 500, 302, false);
    expect_budget_after_tick(false, 4, 500, 300, false);
    expect_budget_after_tick(false, 300, 500, 150, false);
    expect_budget_after_tick(true, 351, 500, 500, true);
}

/* Above idle in all but each second of ticks that come every 10 ms. */
/* Shows: SUP-5, TIM-4 */
void test_a_condition_that_pauses_at_each_second_late_tick_is_found(void) {
    for (unsigned i = 0; i < 38; i++) {
        agv_budget_add(&budget, i % 2 == 0, 10, 100);
        TEST_ASSERT_EQUAL(i >= 36, budget.present); /* 5 ms in each two, and 10 */
    }
}

/* It brings 0 ms, and does not change what the last tick saw. */
/* Shows: SUP-10, SUP-11, SUP-12 */
void test_a_frame_counts_nothing(void) {
    begin(true, 500);
    agv_budget_add(&budget, false, 0, 500);
    expect_budget_after_tick(true, 1, 500, 1, false);
    begin(false, 500); /* 2 */
    expect_budget_after_tick(true, 0, 500, 2, false);
    expect_budget_after_tick(true, 1, 500, 2, false);
    expect_budget_after_tick(true, 1, 500, 3, false);
}

/* A ms without the condition that has not been subtracted yet is kept while the condition lasts. */
/* Shows: SUP-10, SUP-11, SUP-12 */
void test_half_ms_are_kept_across_the_condition(void) {
    static const struct {
        bool condition;
        uint16_t value_ms; /* after the tick */
    } ticks[] = {{true, 0},  {true, 1}, {true, 2}, {true, 3},  {false, 4}, {true, 4},  {false, 5}, {true, 4}, {true, 5},
                 {false, 6}, {true, 6}, {true, 7}, {false, 8}, {false, 7}, {false, 7}, {true, 6},  {true, 7}};
    for (unsigned i = 0; i < sizeof ticks / sizeof ticks[0]; i++) {
        expect_budget_after_tick(ticks[i].condition, 1, 100, ticks[i].value_ms, false);
    }
}

/* Shows: SUP-10, SUP-11, SUP-12 */
void test_the_fault_is_raised_at_the_limit_of_the_budget(void) {
    begin(true, 500);
    expect_budget_after(true, 499, 500, 499, false);
    expect_budget_after(true, 1, 500, 500, true);
    expect_budget_after(true, 10000, 500, 500, true);
}

/* Shows: SUP-10, SUP-11, SUP-12 */
void test_every_second_ms_without_the_condition_takes_one_away(void) {
    begin(true, 500);
    run(true, 500, 500);
    begin(false, 500);
    expect_budget_after(false, 1, 500, 500, true);
    expect_budget_after(false, 1, 500, 499, true);
    expect_budget_after(false, 997, 500, 1, true);
    expect_budget_after(false, 1, 500, 0, false);
    expect_budget_after(false, 7, 500, 0, false);
    begin(true, 500);
    expect_budget_after(true, 499, 500, 499, false);
}

/* 19 ms with the condition, 1 ms without: only every second good ms takes one away. */
/* Shows: SUP-10, SUP-11 */
void test_one_good_ms_in_twenty_does_not_restart_the_budget(void) {
    unsigned ms = 0;
    while (!budget.present) {
        agv_budget_add(&budget, ms % 20 != 19, 1, 500);
        ms++;
        TEST_ASSERT_TRUE(ms < 1000);
    }
    /* 500 = 26 rows of 19 less 13, and 19 more: 26 * 20 + 19 ms after the first tick */
    TEST_ASSERT_EQUAL_UINT(540, ms);
}

/* 1 ms with and 2 ms without never fill the budget; 1 ms with and 1 ms without do, at half the rate. */
void test_the_good_time_that_empties_a_budget(void) {
    for (unsigned i = 0; i < 3000; i++) {
        agv_budget_add(&budget, i % 3 == 0, 1, 100);
        TEST_ASSERT_FALSE(budget.present);
    }
    setUp();
    for (unsigned i = 0; i < 395; i++) {
        agv_budget_add(&budget, i % 2 == 0, 1, 100);
    }
    expect_budget(99, false); /* 98 rows of 4 ms are 98 ms, and 1 ms more */
    expect_budget_after_tick(false, 1, 100, 100, true);
}

/* An empty budget also forgets an odd good ms. */
void test_an_empty_budget_begins_anew(void) {
    begin(true, 100); /* a good ms before it */
    run(true, 1, 100);
    begin(false, 100);
    expect_budget_after(false, 1, 100, 2, false);
    expect_budget_after(false, 1, 100, 1, false);
    expect_budget_after(false, 4, 100, 0, false);
    begin(true, 100); /* the third good ms of an empty budget */
    begin(false, 100);
    expect_budget_after(false, 1, 100, 1, false);
}

/* Late steps bring several ms at once: the same as one by one, while the condition is what it was. */
/* Shows: TIM-4 */
void test_several_ms_at_once_are_the_same_as_one_by_one(void) {
    static const struct {
        bool condition;
        unsigned ms;
    } times[] = {{true, 70}, {false, 3}, {false, 5}, {true, 11}, {false, 1}, {false, 1},  {true, 0},
                 {false, 0}, {true, 55}, {false, 7}, {true, 90}, {false, 1}, {false, 396}};
    agv_budget_t steps = {0};
    bool before = false;
    for (unsigned i = 0; i < sizeof times / sizeof times[0]; i++) {
        if (times[i].condition != before) {
            before = times[i].condition;
            agv_budget_add(&steps, before, 1, 200);
            begin(before, 200);
        }
        agv_budget_add(&steps, times[i].condition, times[i].ms, 200);
        run(times[i].condition, times[i].ms, 200);
        TEST_ASSERT_EQUAL_UINT16(budget.value_ms, steps.value_ms);
        TEST_ASSERT_EQUAL(budget.present, steps.present);
    }
    expect_budget(1, true); /* 200 less half of 1 + 1 + 396: one good ms was left over from before */
    agv_budget_add(&steps, true, 1, 65535);
    agv_budget_add(&steps, true, 0xFFFFFFFFu, 65535);
    TEST_ASSERT_EQUAL_UINT16(65535, steps.value_ms);
    agv_budget_add(&steps, false, 1, 65535);
    TEST_ASSERT_EQUAL_UINT16(65535, steps.value_ms);
    agv_budget_add(&steps, false, 0xFFFFFFFFu, 65535);
    TEST_ASSERT_EQUAL_UINT16(0, steps.value_ms);
    TEST_ASSERT_FALSE(steps.present);
}

/* Gathered time adds as in a budget, with the first ms seen as 0, and the last one after the condition has ended. */
/* Shows: FSM-12 */
void test_time_without_the_condition_takes_nothing_from_a_gathered_budget(void) {
    for (unsigned pulse = 0; pulse < 4; pulse++) {
        for (unsigned i = 0; i < 50; i++) {
            agv_budget_gather(&budget, true, 1, 200);
        }
        TEST_ASSERT_EQUAL_UINT16(50 * pulse + 49, budget.value_ms);
        TEST_ASSERT_FALSE(budget.present);
        for (unsigned i = 0; i < 1000; i++) {
            agv_budget_gather(&budget, false, 1, 200);
        }
        TEST_ASSERT_EQUAL_UINT16(50 * (pulse + 1), budget.value_ms);
    }
    TEST_ASSERT_TRUE(budget.present);
    agv_budget_gather(&budget, false, 5000, 200);
    TEST_ASSERT_EQUAL_UINT16(200, budget.value_ms);
    TEST_ASSERT_TRUE(budget.present);
}

/* Times of sending: slots on their grid, overruns, overrides. */
#include "transmit/scheduler.h"

#include "unity.h"

enum { GAP_MS = 5 };

static agv_scheduler_t scheduler;
static agv_timers_t timers;
static uint32_t now_us;

void setUp(void) {
    scheduler = (agv_scheduler_t){0};
    now_us = 0;
}

static void restart(uint32_t now_ms) {
    agv_scheduler_restart(&scheduler, now_ms);
}

static bool due(agv_message_t command, uint32_t now_ms, uint32_t *skipped) {
    const uint32_t slots = agv_scheduler_due(&scheduler, now_ms, command);
    *skipped += (slots > 1) ? slots - 1 : 0;
    return slots != 0;
}

static void overridden(agv_message_t command, uint32_t at_ms, uint32_t at_us) {
    timers.now_ms = at_ms;
    timers.now_us = at_us;
    now_us = at_us;
    agv_scheduler_overridden(&scheduler, &timers, command);
}

static const struct {
    agv_message_t command;
    uint32_t first_ms;
    uint32_t cycle_ms;
} SLOTS[] = {{AGV_MSG_TURN_SIGNAL_COMMAND, 100, 100},
             {AGV_MSG_GEAR_COMMAND, 66, 100},
             {AGV_MSG_THROTTLE_COMMAND, 33, 100},
             {AGV_MSG_STEERING_COMMAND, 25, 25}};

/* Slots lie at 0, 8 (33) and 16 (66) of each 25 ms: ticks far from all slots are left out, to save time. */
static bool is_near_a_slot(uint32_t ms) {
    return ((ms + 1) % 25) % 8 <= 2;
}

/* Each slot must be due exactly on its grid. */
static void expect_grid(uint32_t start_ms, uint32_t duration_ms) {
    uint32_t skipped = 0;
    uint32_t wrong = 0;
    restart(start_ms);
    for (uint32_t ms = 0; ms < duration_ms; ms++) {
        for (unsigned i = 0; i < 4 && is_near_a_slot(ms); i++) {
            const bool expected = ms >= SLOTS[i].first_ms && (ms - SLOTS[i].first_ms) % SLOTS[i].cycle_ms == 0;
            wrong += due(SLOTS[i].command, start_ms + ms, &skipped) != expected;
        }
    }
    TEST_ASSERT_EQUAL_UINT32(0, wrong);
    TEST_ASSERT_EQUAL_UINT32(0, skipped);
}

/* Shows: TIM-1, FSM-2 */
void test_first_slots_then_cycles_for_a_day_without_drift(void) {
    expect_grid(0, 86400000);
}

/* Shows: TIM-1, TIM-2 */
TEST_CASE(0xFFFFFFFF)
TEST_CASE(0xFFFFFFC0)
TEST_CASE(0xFFFFFC18)
TEST_CASE(0x7FFFFFF0)
void test_the_grid_goes_on_across_the_wrap(uint32_t start_ms) {
    expect_grid(start_ms, 3000);
}

/* Shows: TIM-1, TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFF80)
void test_after_an_overrun_one_frame_goes_out_and_the_grid_stands(uint32_t start_ms) {
    uint32_t skipped = 0;
    restart(start_ms);
    /* 065h was due at 25, 50, ... 325: thirteen, of which one is sent late and twelve are missed */
    TEST_ASSERT_TRUE(due(AGV_MSG_STEERING_COMMAND, start_ms + 330, &skipped));
    TEST_ASSERT_EQUAL_UINT32(12, skipped);
    for (uint32_t ms = 330; ms < 350; ms++) {
        TEST_ASSERT_FALSE(due(AGV_MSG_STEERING_COMMAND, start_ms + ms, &skipped));
    }
    TEST_ASSERT_TRUE(due(AGV_MSG_STEERING_COMMAND, start_ms + 350, &skipped));
    TEST_ASSERT_EQUAL_UINT32(12, skipped);
}

void test_a_late_frame_misses_no_slot(void) {
    uint32_t skipped = 0;
    restart(0);
    TEST_ASSERT_TRUE(due(AGV_MSG_GEAR_COMMAND, 165, &skipped));
    TEST_ASSERT_EQUAL_UINT32(0, skipped);
    TEST_ASSERT_TRUE(due(AGV_MSG_GEAR_COMMAND, 166, &skipped));
    TEST_ASSERT_EQUAL_UINT32(0, skipped);
}

/* Shows: TIM-1, TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFFB0)
void test_a_grid_that_is_shifted_goes_on_3_ms_later(uint32_t start_ms) {
    uint32_t skipped = 0;
    restart(start_ms);
    TEST_ASSERT_TRUE(due(AGV_MSG_STEERING_COMMAND, start_ms + 25, &skipped));
    agv_scheduler_shift(&scheduler, AGV_MSG_STEERING_COMMAND);
    TEST_ASSERT_FALSE(due(AGV_MSG_STEERING_COMMAND, start_ms + 52, &skipped));
    TEST_ASSERT_TRUE(due(AGV_MSG_STEERING_COMMAND, start_ms + 53, &skipped));
    TEST_ASSERT_TRUE(due(AGV_MSG_STEERING_COMMAND, start_ms + 78, &skipped));
    TEST_ASSERT_TRUE(due(AGV_MSG_THROTTLE_COMMAND, start_ms + 33, &skipped));
    TEST_ASSERT_EQUAL_UINT32(0, skipped);
}

/* FSM-1, park at standstill: the first P comes in between. */
void test_a_slot_that_begins_later_has_its_own_grid(void) {
    uint32_t skipped = 0;
    restart(0);
    agv_scheduler_restart_slot(&scheduler, 40, AGV_MSG_GEAR_COMMAND);
    TEST_ASSERT_FALSE(due(AGV_MSG_GEAR_COMMAND, 139, &skipped));
    TEST_ASSERT_TRUE(due(AGV_MSG_GEAR_COMMAND, 140, &skipped));
}

static bool answered(uint32_t ms) {
    now_us = ms * 1000;
    if (!agv_scheduler_override(&scheduler, now_us, GAP_MS, AGV_MSG_GEAR_COMMAND)) {
        return false;
    }
    overridden(AGV_MSG_GEAR_COMMAND, ms, ms * 1000);
    return true;
}

static bool answer_due(uint32_t ms) {
    now_us = ms * 1000;
    return agv_scheduler_override_due(&scheduler, now_us, GAP_MS, AGV_MSG_GEAR_COMMAND);
}

/* Shows: TOP-1, TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFFFD)
void test_an_identifier_is_overridden_at_most_every_5_ms(uint32_t start_ms) {
    restart(start_ms);
    TEST_ASSERT_TRUE(answered(start_ms));
    TEST_ASSERT_FALSE(answered(start_ms + 1));
    TEST_ASSERT_FALSE(answered(start_ms + 4));
    TEST_ASSERT_FALSE(answer_due(start_ms + 4));
    TEST_ASSERT_TRUE(answer_due(start_ms + 5));
    overridden(AGV_MSG_GEAR_COMMAND, start_ms + 5, (start_ms + 5) * 1000);
    TEST_ASSERT_FALSE(answer_due(start_ms + 20));
    TEST_ASSERT_TRUE(answered(start_ms + 20));
    TEST_ASSERT_TRUE(answered(start_ms + 25));
}

/* Shows: TOP-1 */
void test_after_an_override_the_periodic_frame_is_due_half_a_cycle_later(void) {
    uint32_t skipped = 0;
    restart(1000);
    overridden(AGV_MSG_GEAR_COMMAND, 1060, 1060000);
    overridden(AGV_MSG_STEERING_COMMAND, 1020, 1020000);
    TEST_ASSERT_FALSE(due(AGV_MSG_GEAR_COMMAND, 1109, &skipped));
    TEST_ASSERT_TRUE(due(AGV_MSG_GEAR_COMMAND, 1110, &skipped));
    TEST_ASSERT_FALSE(due(AGV_MSG_STEERING_COMMAND, 1031, &skipped));
    TEST_ASSERT_TRUE(due(AGV_MSG_STEERING_COMMAND, 1032, &skipped));
    TEST_ASSERT_TRUE(due(AGV_MSG_THROTTLE_COMMAND, 1033, &skipped)); /* not touched */
}

/* Shows: TIM-2 */
void test_a_recent_override_is_not_recent_again_after_a_turn_of_the_clock(void) {
    restart(0);
    TEST_ASSERT_TRUE(answered(10));
    TEST_ASSERT_FALSE(answer_due(16)); /* the first tick after the 5 ms */
    TEST_ASSERT_TRUE(answered(12));    /* 49.7 days later */
}

void test_when_all_are_sent_what_waited_is_forgotten(void) {
    restart(0);
    TEST_ASSERT_TRUE(answered(10));
    TEST_ASSERT_FALSE(answered(11));
    restart(12);
    TEST_ASSERT_FALSE(answer_due(100));
}

/* A restart clears waiting overrides and the times of the last ones, also with respect to a full wrap of the
 * microseconds. */
/* Shows: TOP-1, TIM-2 */
void test_a_restart_forgets_overrides(void) {
    for (unsigned i = 0; i < 4; i++) {
        overridden(SLOTS[i].command, 7, 7000);
        TEST_ASSERT_FALSE(agv_scheduler_override(&scheduler, now_us, GAP_MS, SLOTS[i].command));
    }
    restart(4294974);
    now_us = 7001;
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_FALSE(agv_scheduler_override_due(&scheduler, now_us, GAP_MS, SLOTS[i].command));
        TEST_ASSERT_TRUE(agv_scheduler_override(&scheduler, now_us, GAP_MS, SLOTS[i].command));
    }
}

/* A waiting override ends with an override, with an own frame, or by being discarded. It is not due again. */
/* Shows: TOP-1 */
void test_what_was_answered_or_discarded_does_not_wait(void) {
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE(agv_scheduler_override(&scheduler, 7000, GAP_MS, SLOTS[i].command));
        overridden(SLOTS[i].command, 7, 7000);
        TEST_ASSERT_FALSE(agv_scheduler_override_due(&scheduler, 12000, GAP_MS, SLOTS[i].command));
        TEST_ASSERT_TRUE(agv_scheduler_override(&scheduler, 12000, GAP_MS, SLOTS[i].command));
        agv_scheduler_answered(&scheduler, SLOTS[i].command);
        TEST_ASSERT_FALSE(agv_scheduler_override_due(&scheduler, 12000, GAP_MS, SLOTS[i].command));
        TEST_ASSERT_TRUE(agv_scheduler_override(&scheduler, 12000, GAP_MS, SLOTS[i].command));
    }
    agv_scheduler_discard(&scheduler);
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_FALSE(agv_scheduler_override_due(&scheduler, 17000, GAP_MS, SLOTS[i].command));
    }
}

/* 18 and 24.8 days without a step: 60000000h ms are 16106127 cycles of 100 ms and 36 ms, 7FFFFFFFh ms 21474836 and 47. */
/* Shows: TIM-1 */
TEST_CASE(0x60000000, 16106128)
TEST_CASE(0x7FFFFFFF, 21474837)
void test_a_slot_that_is_very_late_is_due(uint32_t late_ms, uint32_t slots) {
    restart(0);
    TEST_ASSERT_EQUAL_UINT32(slots, agv_scheduler_due(&scheduler, 100 + late_ms, AGV_MSG_TURN_SIGNAL_COMMAND));
}

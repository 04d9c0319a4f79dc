/* Commands that come too fast: gaps under half a cycle, scored with N = 10. */
#include "observe/intrusion.h"

#include "unity.h"

static agv_intrusion_t intrusion;
static agv_config_t config;
static agv_timers_t timers;
static agv_liveness_t liveness;
static agv_fault_monitor_t faults;

/* The clock wraps in every test. */
static uint32_t at(uint32_t ms) {
    return 0xFFFFFFC0u + ms;
}

void setUp(void) {
    agv_config_defaults(&config);
    intrusion = (agv_intrusion_t){0};
    liveness = (agv_liveness_t){0};
    faults = (agv_fault_monitor_t){0};
    agv_timers_set_time(&timers, at(0));
    agv_timers_start(&timers);
    agv_liveness_start(&liveness, &timers);
}

static bool is_too_fast(uint32_t ms) {
    agv_timers_advance(&timers, &config, at(ms), 0);
    agv_liveness_tick(&liveness, &timers, true);
    agv_intrusion_evaluate(&intrusion, &faults, &timers, &config, &liveness);
    return agv_fault_monitor_is_active(&faults, AGV_FAULT_COMMAND_TOO_FAST);
}

/* A well-formed frame of the command at that time. @return whether COMMAND_TOO_FAST is active */
static bool comes(unsigned command, uint32_t ms) {
    const uint32_t gap_ms = agv_liveness_arrived(&liveness, command, at(ms));
    agv_intrusion_command(&intrusion, &config, command, gap_ms);
    return is_too_fast(ms);
}

/* Half a cycle: 50 ms of 100; 12.5 of 25, so that 12 ms are shorter and 13 not. */
/* Shows: SUP-6, COMMAND_TOO_FAST */
TEST_CASE(AGV_MSG_TURN_SIGNAL_COMMAND, 49)
TEST_CASE(AGV_MSG_GEAR_COMMAND, 49)
TEST_CASE(AGV_MSG_THROTTLE_COMMAND, 49)
TEST_CASE(AGV_MSG_STEERING_COMMAND, 12)
void test_ten_gaps_under_half_a_cycle_in_a_row(unsigned command, uint32_t gap_ms) {
    uint32_t ms = 0;
    for (unsigned i = 0; i < 10; i++, ms += gap_ms) {
        TEST_ASSERT_FALSE(comes(command, ms));
    }
    TEST_ASSERT_TRUE(comes(command, ms));
    setUp();
    ms = 0;
    for (unsigned i = 0; i < 1000; i++, ms += gap_ms + 1) {
        TEST_ASSERT_FALSE(comes(command, ms));
    }
}

/* A second sender right behind each frame of the first: every second gap is short, some 40 of them. */
/* Shows: SUP-6, COMMAND_TOO_FAST */
void test_a_second_sender_right_behind_the_first_is_detected(void) {
    unsigned frames = 0;
    for (uint32_t ms = 0; !is_too_fast(ms); ms += 100) {
        (void)comes(AGV_MSG_GEAR_COMMAND, ms);
        (void)comes(AGV_MSG_GEAR_COMMAND, ms + 1);
        frames += 2;
        TEST_ASSERT_TRUE(frames <= 40);
    }
    TEST_ASSERT_TRUE(frames > 20);
}

/* Each command has its own score. */
/* Shows: SUP-6 */
void test_gaps_of_two_commands_are_not_added_up(void) {
    for (uint32_t i = 0; i < 9; i++) {
        TEST_ASSERT_FALSE(comes(AGV_MSG_GEAR_COMMAND, 2 * i));
        TEST_ASSERT_FALSE(comes(AGV_MSG_THROTTLE_COMMAND, 2 * i));
    }
}

static uint32_t make_it_too_fast(unsigned command) {
    for (uint32_t ms = 0; ms < 10; ms++) {
        TEST_ASSERT_FALSE(comes(command, ms));
    }
    TEST_ASSERT_TRUE(comes(command, 10));
    return 10;
}

/* The fault ends when the score is 0: after 20 gaps of a full cycle. */
/* Shows: SUP-6, COMMAND_TOO_FAST */
void test_it_ends_after_twenty_good_gaps(void) {
    uint32_t ms = make_it_too_fast(AGV_MSG_STEERING_COMMAND);
    for (unsigned i = 0; i < 19; i++) {
        ms += 25;
        TEST_ASSERT_TRUE(comes(AGV_MSG_STEERING_COMMAND, ms));
    }
    TEST_ASSERT_FALSE(comes(AGV_MSG_STEERING_COMMAND, ms + 25));
}

/* A silence longer than the command's deadline of 350 ms ends the fault, and its gap does not count. */
/* Shows: SUP-6, COMMAND_TOO_FAST */
void test_a_silence_longer_than_the_deadline_ends_it(void) {
    const uint32_t last_ms = make_it_too_fast(AGV_MSG_GEAR_COMMAND);
    TEST_ASSERT_TRUE(is_too_fast(last_ms + 350));
    TEST_ASSERT_FALSE(is_too_fast(last_ms + 351));
    setUp();
    (void)make_it_too_fast(AGV_MSG_GEAR_COMMAND);
    TEST_ASSERT_FALSE(comes(AGV_MSG_GEAR_COMMAND, last_ms + 351)); /* no tick between */
    TEST_ASSERT_EQUAL_UINT8(0, intrusion.fast_gaps[AGV_MSG_GEAR_COMMAND].value);
}

/* Also with a small score. 065h: 125 ms. */
/* Shows: SUP-6, COMMAND_TOO_FAST */
void test_a_silence_ends_a_small_score(void) {
    uint32_t ms = make_it_too_fast(AGV_MSG_STEERING_COMMAND);
    for (unsigned i = 0; i < 19; i++) {
        ms += 25;
        TEST_ASSERT_TRUE(comes(AGV_MSG_STEERING_COMMAND, ms));
    }
    TEST_ASSERT_TRUE(is_too_fast(ms + 125));
    TEST_ASSERT_FALSE(is_too_fast(ms + 126));
}

/* 065h: 125 ms. The other commands go on counting. */
/* Shows: SUP-6 */
void test_a_silent_command_does_not_affect_the_others(void) {
    for (uint32_t ms = 0; ms <= 10; ms++) {
        (void)comes(AGV_MSG_STEERING_COMMAND, ms);
        (void)comes(AGV_MSG_GEAR_COMMAND, ms);
    }
    TEST_ASSERT_TRUE(is_too_fast(10 + 126));
    TEST_ASSERT_EQUAL_UINT8(0, intrusion.fast_gaps[AGV_MSG_STEERING_COMMAND].value);
    TEST_ASSERT_EQUAL_UINT8(20, intrusion.fast_gaps[AGV_MSG_GEAR_COMMAND].value);
    TEST_ASSERT_FALSE(is_too_fast(10 + 351));
}

/* Shows: SUP-6 */
void test_the_number_of_gaps_is_a_setting(void) {
    config.command_too_fast_gaps = 2;
    (void)comes(AGV_MSG_GEAR_COMMAND, 0);
    TEST_ASSERT_FALSE(comes(AGV_MSG_GEAR_COMMAND, 1));
    TEST_ASSERT_TRUE(comes(AGV_MSG_GEAR_COMMAND, 2));
}

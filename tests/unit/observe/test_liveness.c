/* Alive senders and ages of messages: deadlines, heartbeats, saturation. */
#include "observe/liveness.h"

#include "unity.h"

static agv_liveness_t liveness;
static agv_timers_t timers;
static agv_config_t config;

static void start(uint32_t now_ms) {
    agv_config_defaults(&config);
    config.gear_command_timeout_ms = 60;
    config.throttle_command_timeout_ms = 60;
    config.steering_command_timeout_ms = 60;
    config.gear_status_timeout_ms = 60;
    liveness = (agv_liveness_t){0};
    agv_timers_set_time(&timers, now_ms);
    agv_timers_start(&timers);
    agv_liveness_start(&liveness, &timers);
}

static void tick_while(bool engaged, uint32_t now_ms) {
    agv_timers_advance(&timers, &config, now_ms, 0);
    agv_liveness_tick(&liveness, &timers, engaged);
}

static void tick(uint32_t now_ms) {
    tick_while(false, now_ms);
}

/* Ages saturate within 16 ticks, because each tick checks some of the messages only. */
static void look_at_all(uint32_t now_ms) {
    for (uint32_t i = 0; i < 16; i++) {
        tick(now_ms);
    }
}

/* Whether the deadline of a message has expired. */
static bool judge(agv_message_t message, uint32_t now_ms) {
    tick(now_ms);
    return agv_timer_reached(&timers, (uint32_t)AGV_TIMER_MESSAGE + message);
}

static void refresh(agv_message_t message, uint32_t now_ms) {
    const hal_can_frame_t frame = {.time_ms = now_ms, .length = 8};
    agv_timers_advance(&timers, &config, frame.time_ms, 0);
    agv_liveness_refresh(&liveness, &timers, &config, message, &frame);
}

static uint32_t age_ms(agv_message_t message, uint32_t now_ms) {
    agv_timers_set_time(&timers, now_ms);
    return agv_liveness_age_ms(&liveness, &timers, message);
}

static bool is_heard(agv_message_t message) {
    return (liveness.heard & (1u << (unsigned)message)) != 0;
}

void setUp(void) {
    start(0);
}

static void expect_heartbeat(agv_node_t node, agv_heartbeat_state_t expected) {
    TEST_ASSERT_EQUAL(expected, agv_liveness_heartbeat(&liveness, node));
    TEST_ASSERT_EQUAL(expected == AGV_HEARTBEAT_ALIVE, agv_liveness_alive(&liveness, node));
}

static void expect_heartbeat_at(uint32_t now_ms, agv_node_t node, agv_heartbeat_state_t expected) {
    tick(now_ms);
    expect_heartbeat(node, expected);
}

/* A frame of the message with the alive counter: 363h, 067h, 43Fh. This value is in one byte, 0 in the others. */
static void receive(agv_node_t node, unsigned byte, uint8_t value, uint32_t time_ms) {
    static const agv_message_t carrier[] = {AGV_MSG_VEHICLE_STATUS, AGV_MSG_STEERING_STATUS,
                                            AGV_MSG_TURN_SIGNAL_COMMAND};
    hal_can_frame_t frame = {.time_ms = time_ms, .length = 8};
    frame.data[byte] = value;
    (void)agv_liveness_arrived(&liveness, carrier[node], time_ms);
    agv_timers_advance(&timers, &config, frame.time_ms, 0);
    agv_liveness_refresh(&liveness, &timers, &config, carrier[node], &frame);
}

/* 363h byte 8, 067h byte 1, 43Fh byte 8. */
static const unsigned COUNTER[] = {7, 0, 7};

static void beat(agv_node_t node, uint8_t counter, uint32_t time_ms) {
    receive(node, COUNTER[node], counter, time_ms);
}

/* Shows: SUP-2, SUP-3, TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFFE0)
void test_a_deadline_expires_when_the_age_is_greater(uint32_t start_ms) {
    start(start_ms);
    (void)agv_liveness_arrived(&liveness, AGV_MSG_EPS_STATUS, start_ms + 10);
    refresh(AGV_MSG_EPS_STATUS, start_ms + 10);
    TEST_ASSERT_FALSE(judge(AGV_MSG_EPS_STATUS, start_ms + 70));
    TEST_ASSERT_TRUE(agv_liveness_fresh(&liveness, &timers, AGV_MSG_EPS_STATUS));
    TEST_ASSERT_TRUE(judge(AGV_MSG_EPS_STATUS, start_ms + 71));
    TEST_ASSERT_FALSE(agv_liveness_fresh(&liveness, &timers, AGV_MSG_EPS_STATUS));
    refresh(AGV_MSG_EPS_STATUS, start_ms + 72);
    TEST_ASSERT_FALSE(judge(AGV_MSG_EPS_STATUS, start_ms + 72));
    TEST_ASSERT_TRUE(agv_liveness_fresh(&liveness, &timers, AGV_MSG_EPS_STATUS));
}

/* Shows: TIM-2 */
void test_a_lost_heartbeat_stays_lost_over_a_full_wrap_of_the_clock(void) {
    beat(AGV_NODE_VCU, 1, 1);
    beat(AGV_NODE_VCU, 2, 2);
    for (uint32_t day = 0; day < 60; day++) {
        const uint32_t now_ms = 100 + day * 86400000;
        tick(now_ms);
        TEST_ASSERT_TRUE(judge(AGV_MSG_VEHICLE_STATUS, now_ms));
        TEST_ASSERT_TRUE(judge(AGV_MSG_EPS_STATUS, now_ms));
        expect_heartbeat(AGV_NODE_VCU, AGV_HEARTBEAT_LOST);
    }
    TEST_ASSERT_TRUE(judge(AGV_MSG_VEHICLE_STATUS, 2));
    TEST_ASSERT_TRUE(judge(AGV_MSG_EPS_STATUS, 2));
}

TEST_CASE(0)
TEST_CASE(0xFFFFFFE0)
TEST_CASE(1000)
void test_no_message_is_fresh_before_it_was_received(uint32_t start_ms) {
    start(start_ms);
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        TEST_ASSERT_FALSE(is_heard((agv_message_t)i));
        TEST_ASSERT_FALSE(agv_liveness_fresh(&liveness, &timers, (agv_message_t)i));
        TEST_ASSERT_EQUAL_UINT32(7, age_ms((agv_message_t)i, start_ms + 7)); /* since the start */
        /* the AI is not awaited */
        TEST_ASSERT_EQUAL(i != AGV_MSG_TURN_SIGNAL_COMMAND, judge((agv_message_t)i, start_ms + 61));
    }
    look_at_all(start_ms + 6001);
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        TEST_ASSERT_FALSE(is_heard((agv_message_t)i));
        TEST_ASSERT_EQUAL_UINT32(AGV_AGE_MAX, age_ms((agv_message_t)i, start_ms + 6001));
    }
}

void test_a_message_refreshes_no_other(void) {
    (void)agv_liveness_arrived(&liveness, AGV_MSG_GEAR_STATUS, 5);
    refresh(AGV_MSG_GEAR_STATUS, 5);
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        TEST_ASSERT_EQUAL(i == AGV_MSG_GEAR_STATUS, is_heard((agv_message_t)i));
        TEST_ASSERT_EQUAL(i == AGV_MSG_GEAR_STATUS, agv_liveness_fresh(&liveness, &timers, (agv_message_t)i));
    }
}

/* Shows: TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFF000)
void test_ages_and_gaps_saturate(uint32_t start_ms) {
    start(start_ms);
    TEST_ASSERT_EQUAL_UINT32(AGV_AGE_MAX, agv_liveness_arrived(&liveness, AGV_MSG_WHEEL_SPEED, start_ms));
    TEST_ASSERT_EQUAL_UINT32(10, agv_liveness_arrived(&liveness, AGV_MSG_WHEEL_SPEED, start_ms + 10));
    look_at_all(start_ms + 6010);
    TEST_ASSERT_EQUAL_UINT32(6000, age_ms(AGV_MSG_WHEEL_SPEED, start_ms + 6010));
    look_at_all(start_ms + 6011);
    TEST_ASSERT_EQUAL_UINT32(AGV_AGE_MAX, age_ms(AGV_MSG_WHEEL_SPEED, start_ms + 6011));
    TEST_ASSERT_EQUAL_UINT32(AGV_AGE_MAX, age_ms(AGV_MSG_WHEEL_SPEED, start_ms + 11));
    TEST_ASSERT_EQUAL_UINT32(AGV_AGE_MAX, agv_liveness_arrived(&liveness, AGV_MSG_WHEEL_SPEED, start_ms + 11));
    TEST_ASSERT_EQUAL_UINT32(0, age_ms(AGV_MSG_WHEEL_SPEED, start_ms + 11));
}

/* Late steps, at any distance. */
/* Shows: TIM-2 */
TEST_CASE(2)
TEST_CASE(11)
TEST_CASE(16)
TEST_CASE(100)
void test_ages_saturate_at_any_stride_of_ticks(uint32_t stride_ms) {
    for (uint32_t i = 0; i < 16; i++) {
        tick(6001 + i * stride_ms);
        TEST_ASSERT_TRUE(liveness.next_to_age < AGV_MSG_COUNT);
    }
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        TEST_ASSERT_EQUAL_UINT32(AGV_AGE_MAX, age_ms((agv_message_t)i, 6001 + 16 * stride_ms));
    }
}

/* A stamp earlier than the previous one (frames of two queues) is not a gap of 49 days. */
void test_a_stamp_that_goes_backwards_is_no_gap(void) {
    (void)agv_liveness_arrived(&liveness, AGV_MSG_WHEEL_SPEED, 20);
    TEST_ASSERT_EQUAL_UINT32(0, agv_liveness_arrived(&liveness, AGV_MSG_WHEEL_SPEED, 19));
}

/* Shows: SUP-1, SUP-2 */
TEST_CASE(0)
TEST_CASE(1)
void test_vcu_and_eps_are_awaited_from_the_start(unsigned node) {
    expect_heartbeat_at(50, (agv_node_t)node, AGV_HEARTBEAT_UNSEEN);
    expect_heartbeat_at(51, (agv_node_t)node, AGV_HEARTBEAT_LOST);
}

/* The first frame has no previous counter, so a late sender is lost, not stuck. */
/* Shows: SUP-2 */
TEST_CASE(0)
TEST_CASE(1)
void test_a_first_frame_just_before_the_deadline_is_no_repeat(unsigned node) {
    beat((agv_node_t)node, 200, 45);
    expect_heartbeat_at(51, (agv_node_t)node, AGV_HEARTBEAT_LOST);
}

/* Shows: SUP-8 */
void test_the_ai_is_not_awaited_before_it_was_seen(void) {
    expect_heartbeat_at(1000000, AGV_NODE_AI, AGV_HEARTBEAT_UNSEEN);
    beat(AGV_NODE_AI, 9, 1000000);
    expect_heartbeat(AGV_NODE_AI, AGV_HEARTBEAT_BASELINE);
    expect_heartbeat_at(1000350, AGV_NODE_AI, AGV_HEARTBEAT_BASELINE);
    expect_heartbeat_at(1000351, AGV_NODE_AI, AGV_HEARTBEAT_LOST);
}

/* Shows: SUP-1 */
TEST_CASE(0)
TEST_CASE(1)
TEST_CASE(2)
void test_the_first_frame_is_only_the_baseline(unsigned node) {
    beat((agv_node_t)node, 200, 10);
    TEST_ASSERT_FALSE(agv_liveness_alive(&liveness, (agv_node_t)node));
    beat((agv_node_t)node, 200, 20);
    TEST_ASSERT_FALSE(agv_liveness_alive(&liveness, (agv_node_t)node));
    beat((agv_node_t)node, 201, 30);
    expect_heartbeat((agv_node_t)node, AGV_HEARTBEAT_ALIVE);
}

/* Shows: SUP-1, P3 */
TEST_CASE(0)
TEST_CASE(1)
TEST_CASE(2)
void test_only_a_changed_counter_is_a_heartbeat(unsigned node) {
    for (unsigned byte = 0; byte < 8; byte++) {
        start(0);
        receive((agv_node_t)node, byte, 1, 10);
        receive((agv_node_t)node, byte, 2, 20);
        TEST_ASSERT_EQUAL(byte == COUNTER[node], agv_liveness_alive(&liveness, (agv_node_t)node));
    }
}

/* Every change counts, backwards and from 255 to 0 as well. */
void test_any_change_of_the_counter_is_a_heartbeat(void) {
    static const uint8_t counters[] = {255, 0, 7, 6, 134, 0};
    beat(AGV_NODE_VCU, 254, 0);
    for (uint32_t i = 0; i < sizeof counters; i++) {
        beat(AGV_NODE_VCU, counters[i], 40 * (i + 1));
        expect_heartbeat_at(40 * (i + 1) + 50, AGV_NODE_VCU, AGV_HEARTBEAT_ALIVE);
    }
}

/* 363h comes every 10 ms; the last counter changed at 100, the deadline of 50 ms has expired at 151. */
static void repeat_until(uint32_t last_frame_ms) {
    beat(AGV_NODE_VCU, 1, 90);
    beat(AGV_NODE_VCU, 2, 100);
    for (uint32_t ms = 110; ms <= last_frame_ms; ms += 10) {
        beat(AGV_NODE_VCU, 2, ms);
    }
    expect_heartbeat_at(150, AGV_NODE_VCU, AGV_HEARTBEAT_ALIVE);
    tick(151);
}

/* Shows: SUP-2 */
void test_a_counter_that_stands_still_is_stuck(void) {
    repeat_until(140);
    expect_heartbeat(AGV_NODE_VCU, AGV_HEARTBEAT_STUCK);
    beat(AGV_NODE_VCU, 2, 155); /* an old counter does not make the sender alive */
    expect_heartbeat(AGV_NODE_VCU, AGV_HEARTBEAT_STUCK);
    beat(AGV_NODE_VCU, 3, 160);
    expect_heartbeat(AGV_NODE_VCU, AGV_HEARTBEAT_ALIVE);
}

/* One repeat, two cycles (VCU and EPS 20 ms, AI 200 ms) before the deadline expires, or 1 ms more. */
/* Shows: SUP-2 */
TEST_CASE(0, 131, 151)
TEST_CASE(1, 131, 151)
TEST_CASE(2, 251, 451)
void test_stuck_needs_a_repeat_within_the_last_two_cycles(unsigned node, uint32_t repeat_ms, uint32_t expired_ms) {
    for (uint32_t more_ms = 0; more_ms < 2; more_ms++) {
        start(0);
        beat((agv_node_t)node, 1, 50);
        beat((agv_node_t)node, 2, 100);
        beat((agv_node_t)node, 2, repeat_ms - more_ms);
        expect_heartbeat_at(expired_ms - 1, (agv_node_t)node, AGV_HEARTBEAT_ALIVE);
        expect_heartbeat_at(expired_ms, (agv_node_t)node, (more_ms == 0) ? AGV_HEARTBEAT_STUCK : AGV_HEARTBEAT_LOST);
    }
}

/* Shows: SUP-2 */
void test_silence_is_lost(void) {
    repeat_until(0);
    expect_heartbeat(AGV_NODE_VCU, AGV_HEARTBEAT_LOST);
    beat(AGV_NODE_VCU, 2, 500);
    tick(505); /* it was lost when its deadline expired: an old counter later does not make it stuck */
    tick_while(true, 506);
    expect_heartbeat(AGV_NODE_VCU, AGV_HEARTBEAT_LOST);
    beat(AGV_NODE_VCU, 3, 510);
    expect_heartbeat(AGV_NODE_VCU, AGV_HEARTBEAT_ALIVE);
}

/* In manual a forgotten AI computer is not supervised. Its counter from before the reset is the baseline. */
/* Shows: SUP-8 */
void test_a_forgotten_ai_is_seen_again_when_its_counter_changes(void) {
    beat(AGV_NODE_AI, 1, 0);
    beat(AGV_NODE_AI, 2, 100);
    agv_liveness_forget_ai(&liveness);
    expect_heartbeat(AGV_NODE_AI, AGV_HEARTBEAT_FORGOTTEN);
    beat(AGV_NODE_AI, 2, 200);
    expect_heartbeat_at(10000, AGV_NODE_AI, AGV_HEARTBEAT_FORGOTTEN);
    beat(AGV_NODE_AI, 3, 10000);
    expect_heartbeat(AGV_NODE_AI, AGV_HEARTBEAT_ALIVE);
}

/* Its deadline of 350 ms runs on: when engaged it is lost at the expiry, or at once after it. */
/* Shows: SUP-8, FSM-11 */
TEST_CASE(450, 451)
TEST_CASE(5000, 5000)
void test_a_forgotten_ai_is_lost_when_engaged(uint32_t engaged_ms, uint32_t lost_ms) {
    beat(AGV_NODE_AI, 1, 0);
    beat(AGV_NODE_AI, 2, 100);
    tick(150);
    agv_liveness_forget_ai(&liveness);
    expect_heartbeat_at(engaged_ms, AGV_NODE_AI, AGV_HEARTBEAT_FORGOTTEN);
    tick_while(true, engaged_ms);
    expect_heartbeat(AGV_NODE_AI, (lost_ms == engaged_ms) ? AGV_HEARTBEAT_LOST : AGV_HEARTBEAT_FORGOTTEN);
    tick_while(true, lost_ms);
    expect_heartbeat(AGV_NODE_AI, AGV_HEARTBEAT_LOST);
}

/* A reset also forgets that it was lost. With frames of an old counter it is stuck at the next engagement. */
/* Shows: SUP-8, FSM-11 */
void test_a_forgotten_ai_whose_counter_stands_is_stuck_when_engaged(void) {
    beat(AGV_NODE_AI, 1, 0);
    beat(AGV_NODE_AI, 2, 100);
    expect_heartbeat_at(1000, AGV_NODE_AI, AGV_HEARTBEAT_LOST);
    agv_liveness_forget_ai(&liveness);
    beat(AGV_NODE_AI, 2, 1100);
    tick_while(true, 1101);
    expect_heartbeat(AGV_NODE_AI, AGV_HEARTBEAT_STUCK);
}

/* Shows: SUP-8 */
void test_an_ai_that_was_never_received_is_not_forgotten(void) {
    agv_liveness_forget_ai(&liveness);
    expect_heartbeat(AGV_NODE_AI, AGV_HEARTBEAT_UNSEEN);
    tick_while(true, 1000);
    expect_heartbeat(AGV_NODE_AI, AGV_HEARTBEAT_UNSEEN);
}

/* ---- Counters that count up ---- */

static void count_up(uint16_t vcu, uint16_t eps, uint16_t ai) {
    config.vcu_counter = vcu;
    config.eps_counter = eps;
    config.ai_counter = ai;
}

/* 1 to 3 more, modulo 256. */
/* Shows: SUP-2 */
void test_steps_of_one_to_three_count(void) {
    for (unsigned step = 0; step < 256; step++) {
        start(0);
        count_up(AGV_COUNTER_INCREMENTS, AGV_COUNTER_ANY, AGV_COUNTER_ANY);
        beat(AGV_NODE_VCU, 254, 10);
        beat(AGV_NODE_VCU, (uint8_t)(254 + step), 20);
        TEST_ASSERT_EQUAL(step >= 1 && step <= 3, agv_liveness_alive(&liveness, AGV_NODE_VCU));
    }
}

/* Each sender has its own setting. */
/* Shows: SUP-2 */
TEST_CASE(0)
TEST_CASE(1)
TEST_CASE(2)
void test_each_sender_has_its_own_choice(unsigned node) {
    count_up(node == 0, node == 1, node == 2);
    for (unsigned i = 0; i < 3; i++) {
        beat((agv_node_t)i, 100, 10);
        beat((agv_node_t)i, 50, 20);
        TEST_ASSERT_EQUAL(i != node, agv_liveness_alive(&liveness, (agv_node_t)i));
    }
}

/* After a wrong step two right ones in a row. 363h every 10 ms, alive at 20, deadline 50 ms. */
/* Shows: SUP-2 */
void test_after_a_wrong_step_two_right_ones_in_a_row_refresh(void) {
    count_up(1, 1, 1);
    beat(AGV_NODE_VCU, 1, 10);
    beat(AGV_NODE_VCU, 2, 20);
    beat(AGV_NODE_VCU, 200, 30); /* wrong */
    beat(AGV_NODE_VCU, 201, 40); /* right, the first one */
    beat(AGV_NODE_VCU, 201, 50); /* wrong */
    beat(AGV_NODE_VCU, 202, 60);
    expect_heartbeat_at(70, AGV_NODE_VCU, AGV_HEARTBEAT_ALIVE);
    expect_heartbeat_at(71, AGV_NODE_VCU, AGV_HEARTBEAT_STUCK);
    beat(AGV_NODE_VCU, 205, 72); /* the second one */
    expect_heartbeat(AGV_NODE_VCU, AGV_HEARTBEAT_ALIVE);
    beat(AGV_NODE_VCU, 206, 80); /* from here on each */
    expect_heartbeat_at(130, AGV_NODE_VCU, AGV_HEARTBEAT_ALIVE);
    expect_heartbeat_at(131, AGV_NODE_VCU, AGV_HEARTBEAT_LOST);
}

/* Two senders with counters of their own never look alive. */
/* Shows: SUP-2 */
void test_two_senders_that_take_turns_are_stuck(void) {
    count_up(1, 1, 1);
    for (uint32_t i = 0; i < 20; i++) {
        beat(AGV_NODE_EPS, (uint8_t)(i % 2 == 0 ? 100 + i : 20 + i), 10 * i);
        tick(10 * i + 9);
    }
    expect_heartbeat(AGV_NODE_EPS, AGV_HEARTBEAT_STUCK);
}

/* The commands are awaited from the engagement on, however long there were none; the heartbeat of the AI is not. */
/* Shows: SUP-3 */
TEST_CASE(0)
TEST_CASE(0xFFFFFFE0)
void test_at_the_engagement_the_deadlines_of_commands_begin_anew(uint32_t start_ms) {
    start(start_ms);
    tick(start_ms + 5000);
    agv_liveness_restart_commands(&timers, start_ms + 5000);
    for (unsigned i = AGV_MSG_GEAR_COMMAND; i <= AGV_MSG_STEERING_COMMAND; i++) {
        TEST_ASSERT_FALSE(judge((agv_message_t)i, start_ms + 5060));
    }
    for (unsigned i = AGV_MSG_GEAR_COMMAND; i <= AGV_MSG_STEERING_COMMAND; i++) {
        TEST_ASSERT_TRUE(judge((agv_message_t)i, start_ms + 5061));
    }
    TEST_ASSERT_FALSE(judge(AGV_MSG_TURN_SIGNAL_COMMAND, start_ms + 5061));
    TEST_ASSERT_TRUE(judge(AGV_MSG_EPS_STATUS, start_ms + 5061));
}

/* One message a tick, in their order: the first tick the first one. */
/* Shows: TIM-2 */
void test_each_tick_ages_the_next_message(void) {
    for (uint32_t i = 0; i < AGV_MSG_COUNT; i++) {
        tick(6001);
        for (uint32_t k = 0; k < AGV_MSG_COUNT; k++) {
            TEST_ASSERT_EQUAL_UINT32((k <= i) ? AGV_AGE_MAX : 6001, agv_liveness_age_ms(&liveness, &timers, k));
        }
    }
}

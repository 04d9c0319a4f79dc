/* The vehicle that misbehaves: nodes that stop, start late, restart, freeze, lag, repeat, send garbage; rogue nodes. */
#include "vehicle_fixture.h"

void setUp(void) {
    vehicle_defaults(&config);
    connected = true;
    begin();
}

static size_t count_from(vehicle_node_t node, size_t first) {
    size_t count = 0;
    for (size_t i = first; i < sent_count; i++) {
        count += (sent[i].from == node) ? 1 : 0;
    }
    return count;
}

static void expect_sent_at(uint64_t t_ms, vehicle_node_t node, size_t first, size_t count) {
    run_until(t_ms);
    TEST_ASSERT_EQUAL_size_t(count, count_from(node, first));
}

void test_nodes_start_when_they_are_told(void) {
    config.start_ms[VEHICLE_EPS] = 100;
    config.start_ms[VEHICLE_AI] = VEHICLE_NEVER;
    begin();
    expect_sent_at(100, VEHICLE_EPS, 0, 0);
    expect_sent_at(102, VEHICLE_EPS, 0, 1);
    expect_sent_at(1000, VEHICLE_AI, 0, 0);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_START, .node = VEHICLE_AI});
    expect_sent_at(1010, VEHICLE_AI, 0, 2);
    TEST_ASSERT_TRUE(look().running[VEHICLE_AI]);
}

/* 363h would bring a running EPS to angle control. */
void test_a_node_that_stops_neither_sends_nor_hears(void) {
    run_until(100);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_STOP, .node = VEHICLE_EPS});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
    const size_t first = sent_count;
    expect_sent_at(500, VEHICLE_EPS, first, 0);
    TEST_ASSERT_EQUAL_HEX8(0x80, last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[6]);
    TEST_ASSERT_FALSE(look().running[VEHICLE_EPS]);
    TEST_ASSERT_EQUAL(AGV_EPS_MODE_ASSIST, look().eps_mode);
}

void test_a_restarted_vcu_begins_anew(void) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 300});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_ENGAGE}); /* before its start: nobody hears it */
    run_until(10);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
    expect_speed_at(3000, 1200);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_RESTART, .node = VEHICLE_VCU, .ms = 500});
    const size_t first = sent_count;
    expect_sent_at(3500, VEHICLE_VCU, first, 0);
    run_until(3510);
    TEST_ASSERT_EQUAL_UINT8(0, last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[7]);
    TEST_ASSERT_EQUAL_HEX8(0x40u, last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[6]);
    expect_gear_at(3800, AGV_GEAR_N);
    TEST_ASSERT_LESS_THAN_INT32(1100, look().speed_mm_s); /* it coasted meanwhile */
}

/* Shows: P13 */
void test_a_frozen_counter_stands_still_and_runs_on(void) {
    run_until(100);
    const uint8_t before = last_of(AGV_MSG_STEERING_STATUS)->frame.data[0];
    (void)act((vehicle_action_t){.what = VEHICLE_DO_FREEZE, .node = VEHICLE_EPS});
    run_until(200);
    TEST_ASSERT_EQUAL_UINT8(before, last_of(AGV_MSG_STEERING_STATUS)->frame.data[0]);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_UNFREEZE, .node = VEHICLE_EPS});
    run_until(210);
    TEST_ASSERT_EQUAL_UINT8(before + 1, last_of(AGV_MSG_STEERING_STATUS)->frame.data[0]);
}

void test_lag_and_period_stretch_the_cycle(void) {
    run_until(100);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_LAG, .node = VEHICLE_EPS, .ms = 10});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_PERIOD, .message = AGV_MSG_GEAR_COMMAND, .ms = 20});
    run_until(200);
    const size_t first = sent_count;
    expect_count_at(1200, AGV_MSG_EPS_STATUS, first, 50);
    expect_count_at(1200, AGV_MSG_GEAR_COMMAND, first, 50);
    expect_count_at(1200, AGV_MSG_THROTTLE_COMMAND, first, 10);
}

void test_repeated_frames_are_the_same_frames(void) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REPEAT, .node = VEHICLE_EPS, .count = 2});
    expect_count_at(2, AGV_MSG_STEERING_STATUS, 0, 3);
    TEST_ASSERT_EQUAL_MEMORY(&sent[sent_count - 1].frame, &sent[sent_count - 3].frame, sizeof(hal_can_frame_t));
}

void test_garbage_of_each_kind(void) {
    vehicle_action_t garbage = {.what = VEHICLE_DO_GARBAGE, .node = VEHICLE_EPS};
    size_t lengths[AGV_DLC + 1] = {0};

    garbage.garbage = VEHICLE_GARBAGE_LENGTH;
    (void)act(garbage);
    run_until(1000);
    for (size_t i = 0; i < sent_count; i++) {
        if (sent[i].from == VEHICLE_EPS) {
            lengths[sent[i].frame.length]++;
        }
    }
    TEST_ASSERT_EQUAL_size_t(0, lengths[AGV_DLC]);
    for (size_t n = 0; n < AGV_DLC; n++) {
        TEST_ASSERT_GREATER_THAN_size_t(0, lengths[n]);
    }
    garbage.garbage = VEHICLE_GARBAGE_REMOTE;
    (void)act(garbage);
    run_until(1010);
    TEST_ASSERT_EQUAL_HEX8(HAL_CAN_REMOTE, last_of(AGV_MSG_EPS_STATUS)->frame.flags);
    garbage.garbage = VEHICLE_GARBAGE_EXTENDED;
    (void)act(garbage);
    run_until(1012);
    TEST_ASSERT_EQUAL_HEX8(HAL_CAN_EXTENDED, sent[sent_count - 1].frame.flags);
    TEST_ASSERT_EQUAL_HEX32(0x067u << 18, sent[sent_count - 1].frame.id);
    garbage.garbage = VEHICLE_GARBAGE_RANDOM;
    (void)act(garbage);
    run_until(1020);
    hal_can_frame_t before = last_of(AGV_MSG_STEERING_POSITION)->frame;
    run_until(1030);
    TEST_ASSERT_EQUAL_UINT8(AGV_DLC, before.length);
    TEST_ASSERT_FALSE(memcmp(before.data, last_of(AGV_MSG_STEERING_POSITION)->frame.data, AGV_DLC) == 0);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_RECOVER, .node = VEHICLE_EPS});
    expect_byte_at(1040, AGV_MSG_STEERING_POSITION, 0, 0x80u);
}

void test_a_message_is_muted_for_so_many_frames(void) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_MUTE, .message = AGV_MSG_EPS_STATUS, .count = 3});
    expect_count_at(100, AGV_MSG_EPS_STATUS, 0, 7);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_MUTE, .message = AGV_MSG_EPS_STATUS, .count = VEHICLE_FOREVER});
    expect_count_at(1000, AGV_MSG_EPS_STATUS, 0, 7);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_UNMUTE, .message = AGV_MSG_EPS_STATUS});
    expect_count_at(1010, AGV_MSG_EPS_STATUS, 0, 8);
}

void test_a_field_keeps_a_value_for_so_many_frames(void) {
    patch(AGV_MSG_VEHICLE_STATUS, 6, 0xC0u, 0xC0u, 2, 0);
    expect_byte_at(20, AGV_MSG_VEHICLE_STATUS, 6, 0xC0u);
    TEST_ASSERT_EQUAL_UINT8(1, last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[7]); /* the counter runs on */
    expect_byte_at(30, AGV_MSG_VEHICLE_STATUS, 6, 0x40u);
    patch(AGV_MSG_VEHICLE_STATUS, 6, 0xC0u, 0xC0u, VEHICLE_FOREVER, 0);
    expect_byte_at(1000, AGV_MSG_VEHICLE_STATUS, 6, 0xC0u);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_UNPATCH, .message = AGV_MSG_VEHICLE_STATUS});
    expect_byte_at(1010, AGV_MSG_VEHICLE_STATUS, 6, 0x40u);
}

static void expect_vehicle_status(uint32_t t_ms, uint8_t byte_1, uint8_t byte_2) {
    run_until(t_ms);
    TEST_ASSERT_EQUAL_HEX8(byte_1, last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[1]);
    TEST_ASSERT_EQUAL_HEX8(byte_2, last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[2]);
}

void test_several_fields_of_a_message_keep_values_each_for_its_own_time(void) {
    expect_vehicle_status(10, 0x00u, 0x00u);
    patch(AGV_MSG_VEHICLE_STATUS, 1, 0xFFu, 0xA5u, 2, 0);
    patch(AGV_MSG_VEHICLE_STATUS, 2, 0xFFu, 0x5Au, VEHICLE_FOREVER, 0);
    expect_vehicle_status(20, 0xA5u, 0x5Au);
    patch(AGV_MSG_VEHICLE_STATUS, 2, 0x0Fu, 0x03u, 2, 0);
    expect_vehicle_status(30, 0xA5u, 0x53u);
    expect_vehicle_status(40, 0x00u, 0x53u);
    expect_vehicle_status(50, 0x00u, 0x50u);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_UNPATCH, .message = AGV_MSG_VEHICLE_STATUS});
    expect_vehicle_status(60, 0x00u, 0x00u);
}

/* ---- Recovery ---- */

static const struct {
    const char *what;
    vehicle_action_t action;
} MISBEHAVIOURS[] = {
    {"frozen", {.what = VEHICLE_DO_FREEZE, .node = VEHICLE_EPS}},
    {"lag", {.what = VEHICLE_DO_LAG, .node = VEHICLE_EPS, .ms = 10}},
    {"repeat", {.what = VEHICLE_DO_REPEAT, .node = VEHICLE_EPS, .count = 1}},
    {"garbage", {.what = VEHICLE_DO_GARBAGE, .node = VEHICLE_EPS, .garbage = VEHICLE_GARBAGE_REMOTE}},
    {"mute", {.what = VEHICLE_DO_MUTE, .message = AGV_MSG_EPS_STATUS, .count = VEHICLE_FOREVER}},
    {"period", {.what = VEHICLE_DO_PERIOD, .message = AGV_MSG_EPS_STATUS, .ms = 20}},
    {"patch", {.what = VEHICLE_DO_PATCH, .message = AGV_MSG_STEERING_STATUS, .count = VEHICLE_FOREVER}},
    {"hold", {.what = VEHICLE_DO_HOLD, .message = AGV_MSG_STEERING_STATUS, .count = VEHICLE_FOREVER}},
    {"delay", {.what = VEHICLE_DO_DELAY, .message = AGV_MSG_STEERING_STATUS, .ms = 100}},
    {"ignore", {.what = VEHICLE_DO_IGNORE, .message = AGV_MSG_STEERING_COMMAND, .on = true}},
    {"stuck", {.what = VEHICLE_DO_EPS_STUCK, .on = true}},
    {"hunt", {.what = VEHICLE_DO_EPS_HUNT, .angle_ddeg = 100, .ms = 130}},
};

/* The AI computer turns the steering by up to 60.0 degrees: 200 ms, and up to 25 ms until its next 065h. In the last
 * 100 ms of 250 the EPS sends each of its messages ten times, whole, with a counter that runs, and then the new angle. */
static bool eps_obeys(int32_t angle_ddeg) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_N, .angle_ddeg = angle_ddeg});
    run_until(now_ms + 150);
    const size_t first = sent_count;
    const uint8_t counter = last_of(AGV_MSG_STEERING_STATUS)->frame.data[0];
    run_until(now_ms + 100);
    const hal_can_frame_t *last = &last_of(AGV_MSG_STEERING_STATUS)->frame;
    return (count_of(AGV_MSG_STEERING_STATUS, first) == 10) && (count_of(AGV_MSG_EPS_STATUS, first) == 10) &&
           (count_of(AGV_MSG_STEERING_POSITION, first) == 10) && (last->flags == 0) && (last->length == AGV_DLC) &&
           (last->data[0] == (uint8_t)(counter + 10)) && (measured_ddeg() == angle_ddeg);
}

void test_recovery_ends_every_misbehaviour_of_a_node(void) {
    for (size_t i = 0; i < sizeof MISBEHAVIOURS / sizeof MISBEHAVIOURS[0]; i++) {
        begin();
        run_until(10);
        (void)act((vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
        run_until(1000);
        TEST_ASSERT_TRUE_MESSAGE(eps_obeys(0), MISBEHAVIOURS[i].what);
        TEST_ASSERT_TRUE_MESSAGE(act(MISBEHAVIOURS[i].action), MISBEHAVIOURS[i].what);
        TEST_ASSERT_FALSE_MESSAGE(eps_obeys(600), MISBEHAVIOURS[i].what);
        (void)act((vehicle_action_t){.what = VEHICLE_DO_RECOVER, .node = VEHICLE_EPS});
        TEST_ASSERT_TRUE_MESSAGE(eps_obeys(300), MISBEHAVIOURS[i].what);
    }
}

void test_a_stranger_sends_once_or_again_and_again(void) {
    vehicle_action_t rogue = {.what = VEHICLE_DO_SEND, .side = HAL_CAN_AI, .frame = {.id = 0x7FFu, .length = 2}};

    TEST_ASSERT_TRUE(act(rogue));
    expect_sent_at(100, VEHICLE_ROGUE, 0, 1);
    for (size_t i = 0; i < sent_count; i++) {
        TEST_ASSERT_EQUAL((sent[i].from == VEHICLE_ROGUE) ? HAL_CAN_AI : HAL_CAN_VEHICLE, sent[i].side);
    }
    rogue.ms = 10;
    rogue.count = 5;
    TEST_ASSERT_TRUE(act(rogue));
    expect_sent_at(200, VEHICLE_ROGUE, 0, 6);
    rogue.count = VEHICLE_FOREVER;
    for (unsigned i = 0; i < VEHICLE_ROGUES_MAX; i++) {
        TEST_ASSERT_TRUE(act(rogue));
    }
    TEST_ASSERT_FALSE(act(rogue));
    expect_sent_at(300, VEHICLE_ROGUE, 0, 6 + (10 * VEHICLE_ROGUES_MAX));
    TEST_ASSERT_TRUE(act((vehicle_action_t){.what = VEHICLE_DO_STOP_SENDING}));
    const size_t first = sent_count;
    expect_sent_at(400, VEHICLE_ROGUE, first, 0);
}

void test_actions_that_make_no_sense_are_refused(void) {
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_STOP, .node = VEHICLE_NODES}));
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_MUTE, .message = AGV_MSG_NONE}));
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = 3}));
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = 1, .throttle_permille = 1001}));
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = 1, .angle_ddeg = 9001}));
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_DRIVE, .gear = 0}));
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_HAND_STEER, .angle_ddeg = -9001}));
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_BUTTON, .count = 3}));
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_SEND, .side = HAL_CAN_SIDES}));
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_COUNT}));
}

void test_after_a_gap_there_is_no_burst(void) {
    run_until(100);
    const size_t first = sent_count;
    now_ms = 5000;
    run_until(5001);
    TEST_ASSERT_LESS_OR_EQUAL_size_t((size_t)AGV_MSG_COUNT, sent_count - first);
    expect_count_at(6000, AGV_MSG_VEHICLE_STATUS, first, 100);
}

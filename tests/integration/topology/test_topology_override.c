/* Overriding another sender: at once, for frames of any length, and at a limited rate. */
#include <string.h>

#include "one_fixture.h"
#include "walk.h"

static fixture_t g; /* a second supervisor on the same bus */

static void foreign(uint32_t id, uint8_t length, const uint8_t data[8]) {
    hal_can_frame_t frame = {.id = id, .length = length};
    memcpy(frame.data, data, 8);
    fixture_raw(&f, HAL_CAN_VEHICLE, frame);
}

static void foreign_gear(uint8_t gear) {
    const uint8_t data[8] = {gear};
    foreign(0x168, 8, data);
}

/* 43Fh with this byte 5. */
static void foreign_signals(uint8_t fifth) {
    const uint8_t data[8] = {0, 0, 0, 0, fifth, 0, 0, 99};
    foreign(0x43F, 8, data);
}

/* Tripped, engaged, holding 9000, with the AI computer silent; the first frames are sent, and no periodic one is due
 * soon. */
static void tripped(void) {
    walk_to_tripped(&f);
    fixture_run(&f, 10);
    fixture_forget_sent(&f);
}

/* Wait until no override is recent, then empty the log. */
static void settle(void) {
    fixture_run(&f, 7);
    fixture_forget_sent(&f);
}

typedef struct {
    uint32_t id;
    uint8_t data[8];
} command_t;

static const command_t DIFFERENT[] = {
    {0x43F, {0, 0, 0, 0, 0x30}}, /* autopilot not off */
    {0x43F, {0, 0, 0, 0, 0x60}}, /* left signal off */
    {0x43F, {0, 0, 0, 0, 0x50}}, /* right signal off */
    {0x43F, {0, 0, 0, 0, 0xF0}}, /* headlight off */
    {0x168, {1}},
    {0x168, {9}},
    {0x075, {1}},
    {0x065, {0x29, 0x23}}, /* 9001 */
    {0x065, {0x28, 0x22}},
};

static const command_t THE_SAME[] = {
    {0x43F, {0, 0, 0, 0, 0x70, 0, 0, 0}},
    {0x43F, {0, 0, 0, 0, 0x70, 0, 0, 0xFF}}, /* differences in the alive counter and in reserved bits do not count: */
    {0x43F, {0xFF, 0xFF, 0xFF, 0xFF, 0x7F, 0xFF, 0xFF, 0}},
    {0x168, {8}},
    {0x168, {8, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}},
    {0x075, {0}},
    {0x075, {0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}},
    {0x065, {0x28, 0x23}},
    {0x065, {0x28, 0x23, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF}},
};

static void expect_answered_in_this_call(uint32_t id, const char *what) {
    f.what = what;
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, f.sent_count, what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(f.call, f.sent[0].call, what);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(id, f.sent[0].id, what);
    expect_safe_frame(&f, &f.sent[0], ANGLE_CENTRE);
}

/* Shows: TOP-1 */
void test_a_command_that_differs_is_overridden_in_the_same_call(void) {
    for (unsigned i = 0; i < sizeof DIFFERENT / sizeof DIFFERENT[0]; i++) {
        fixture_init(&f);
        tripped();
        foreign(DIFFERENT[i].id, 8, DIFFERENT[i].data);
        expect_answered_in_this_call(DIFFERENT[i].id, "differs");
    }
}

/* A frame that follows without a gap would meet the override at once, with the same identifier and other data. */
/* Shows: TOP-1, SUP-7, ERROR_PASSIVE */
void test_while_the_controller_is_error_passive_an_override_waits_for_a_quiet_tick(void) {
    tripped();
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_PASSIVE);
    settle();
    foreign_gear(1);
    TEST_ASSERT_EQUAL_UINT32(0, f.sent_count);
    fixture_run(&f, 1); /* it came since the last tick */
    TEST_ASSERT_EQUAL_UINT32(0, f.sent_count);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1, f.sent_count);
    TEST_ASSERT_EQUAL_HEX32(0x168, f.sent[0].id);
    expect_safe_frame(&f, &f.sent[0], ANGLE_CENTRE);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    settle();
    foreign_gear(1);
    expect_answered_in_this_call(0x168, "error-active again");
}

/* Error-passive since the trip; another sender commands a gear every 2 ms, seven times. */
static void passive_with_a_sender_that_pauses(void) {
    tripped();
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_PASSIVE);
    settle();
    const uint32_t sent[7] = {0, 1, 1, 1,
                              2, 2, 2}; /* the first override at a quiet tick, the next one behind a frame */
    for (unsigned i = 0; i < 7; i++) {
        foreign_gear(1);
        TEST_ASSERT_EQUAL_UINT32(sent[i], fixture_count_sent(&f, 0x168));
        fixture_run(&f, 2);
    }
    fixture_forget_sent(&f);
}

/* At a tick the override would meet the next frame of such a sender again and again. */
/* Shows: TOP-1, FSM-3, SUP-7, ERROR_PASSIVE */
void test_while_error_passive_a_sender_that_pauses_is_overridden_behind_its_frames(void) {
    passive_with_a_sender_that_pauses();
    foreign_gear(1);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168)); /* 6 ms after the last override */
    foreign_signals(0x30);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x43F)); /* its first frame may be the head of a burst */
}

/* The count of single frames decays: every 4 ms the third one has enough. */
/* Shows: TOP-1, ERROR_PASSIVE */
void test_while_error_passive_a_sender_that_pauses_is_known_by_its_third_frame(void) {
    f.config.override_gap_ms = 1;
    tripped();
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_PASSIVE);
    settle();
    for (unsigned i = 0; i < 3; i++) {
        foreign_gear(1);
        TEST_ASSERT_EQUAL_UINT32((i < 2) ? i : 3, fixture_count_sent(&f, 0x168));
        fixture_run(&f, 4);
    }
    TEST_ASSERT_EQUAL_UINT32(3, fixture_count_sent(&f, 0x168));
}

/* Shows: TOP-1, ERROR_PASSIVE */
void test_while_error_passive_the_last_frame_of_such_a_sender_is_overridden_too(void) {
    passive_with_a_sender_that_pauses();
    fixture_run(&f, 2); /* the last frame came 4 ms ago */
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x168));
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
}

/* Shows: TOP-1, ERROR_PASSIVE */
void test_while_error_passive_a_burst_resets_the_count_of_single_frames(void) {
    f.config.override_gap_ms = 1;
    tripped();
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_PASSIVE);
    settle();
    foreign_gear(1);
    foreign_gear(1);
    fixture_run(&f, 2);
    foreign_gear(1);
    fixture_run(&f, 3);
    TEST_ASSERT_EQUAL_UINT32(2, fixture_count_sent(&f, 0x168));
    foreign_gear(1); /* the second single frame, 3 ms after the first */
    TEST_ASSERT_EQUAL_UINT32(2, fixture_count_sent(&f, 0x168));
}

static void expect_override_behind_a_burst(uint32_t gap_ms) {
    passive_with_a_sender_that_pauses();
    fixture_run(&f, 1);
    foreign_gear(1);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    fixture_run(&f, gap_ms);
    foreign_gear(1);
    fixture_run(&f, 4 - gap_ms);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    fixture_run(&f, 1); /* 5 ms after the last override */
    TEST_ASSERT_EQUAL_UINT32(2, fixture_count_sent(&f, 0x168));
}

/* Shows: TOP-1, ERROR_PASSIVE */
void test_while_error_passive_a_burst_after_single_frames_is_overridden_at_its_end(void) {
    for (uint32_t gap_ms = 0; gap_ms < 2; gap_ms++) {
        fixture_init(&f);
        expect_override_behind_a_burst(gap_ms);
    }
}

/* Frames from the time before a late tick are over. */
/* Shows: TOP-1, ERROR_PASSIVE */
void test_while_error_passive_a_late_tick_overrides_what_came_before_it(void) {
    tripped();
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_PASSIVE);
    settle();
    foreign_gear(1);
    fixture_jump(&f, 2); /* not late */
    TEST_ASSERT_EQUAL_UINT32(0, f.sent_count);
    settle();
    foreign_signals(0x30);
    fixture_jump(&f, 3);
    TEST_ASSERT_EQUAL_UINT32(1, f.sent_count);
    TEST_ASSERT_EQUAL_HEX32(0x43F, f.sent[0].id);
}

/* Shows: TOP-1, P14 */
void test_a_command_that_does_not_differ_is_not_overridden(void) {
    tripped();
    for (unsigned i = 0; i < sizeof THE_SAME / sizeof THE_SAME[0]; i++) {
        foreign(THE_SAME[i].id, 8, THE_SAME[i].data);
    }
    expect_silence(&f);
}

/* Shows: TOP-1, INT-2, P15 */
void test_a_command_of_another_length_is_overridden_whatever_its_bytes(void) {
    for (uint8_t length = 0; length < 8; length++) {
        for (unsigned i = 0; i < sizeof THE_SAME / sizeof THE_SAME[0]; i++) {
            uint8_t data[8] = {0};
            memcpy(data, THE_SAME[i].data, length);
            fixture_init(&f);
            tripped();
            foreign(THE_SAME[i].id, length, data);
            expect_answered_in_this_call(THE_SAME[i].id, "short");
        }
    }
    TEST_ASSERT_EQUAL_UINT32(1, agv_supervisor_counters(&f.supervisor)->rejected[AGV_REJECTED_LENGTH]);
}

/* Shows: TOP-1, P15 */
void test_other_kinds_of_frames_are_not_overridden(void) {
    static const uint8_t FLAGS[] = {HAL_CAN_EXTENDED, HAL_CAN_REMOTE, HAL_CAN_ERROR};
    tripped();
    for (unsigned i = 0; i < sizeof FLAGS; i++) {
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x168, .flags = FLAGS[i], .length = 8, .data = {1}});
    }
    expect_silence(&f);
}

/* Shows: TOP-1 */
void test_init_and_safe_override_too(void) {
    fixture_mode(&f, MODE_ENGAGED);
    fixture_mute_ai(&f, true);
    fixture_start(&f);
    fixture_run(&f, 10);
    fixture_forget_sent(&f);
    expect_state(&f, AGV_STATE_INIT);
    foreign_gear(GEAR_D);
    expect_answered_in_this_call(0x168, "INIT");

    fixture_init(&f);
    walk_to_safe(&f);
    settle();
    settle();
    foreign_gear(GEAR_D);
    expect_answered_in_this_call(0x168, "SAFE");
}

/* Shows: TOP-1 */
void test_standby_and_active_override_nothing(void) {
    fixture_standby(&f);
    foreign_gear(GEAR_D);
    foreign_signals(0x00);
    expect_silence(&f);
    fixture_mode(&f, MODE_ENGAGED);
    expect_state_after(&f, 100, AGV_STATE_ACTIVE);
    foreign_gear(GEAR_D);
    foreign_signals(0x00);
    expect_silence(&f);
}

/* Shows: TOP-1, FOREIGN_COMMAND_SENDER */
void test_the_vehicle_side_of_a_gateway_is_overridden_too(void) {
    static const uint8_t park[8] = {8};
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    tripped();
    foreign_gear(GEAR_D);
    expect_answered_in_this_call(0x168, "gateway");
    fixture_run(&f, 6);
    fixture_forget_sent(&f);
    foreign(0x168, 1, park);
    expect_answered_in_this_call(0x168, "gateway, short");
    fixture_run(&f, 6);
    fixture_forget_sent(&f);
    foreign_gear(GEAR_P);
    expect_silence(&f);
}

/* Shows: TOP-1, FSM-10 */
void test_a_steering_command_is_not_overridden_while_none_is_sent(void) {
    static const uint8_t angle[8] = {0x00, 0x10};
    walk_to_safe(&f); /* manual: nothing is held */
    settle();
    foreign(0x065, 8, angle);
    foreign(0x065, 2, angle);
    expect_silence(&f);
}

/* ---- Not more often than every 5 ms ---- */

/* A sender of one frame a millisecond: an override every 5 ms, and after its last frame. */
/* Shows: TOP-1, COMMAND_TOO_FAST */
void test_a_babbling_sender_is_overridden_every_5_ms_and_last(void) {
    tripped();
    for (unsigned i = 0; i < 1000; i++) {
        foreign_gear(GEAR_D);
        fixture_run(&f, 1);
    }
    const uint32_t last_ms = f.now_ms - 1;
    fixture_run(&f, 10);
    const uint32_t count = fixture_count_sent(&f, 0x168);
    TEST_ASSERT_UINT32_WITHIN(1, 200, count);
    for (uint32_t n = 1; n < count; n++) {
        const uint32_t gap_ms = fixture_nth_sent(&f, 0x168, n)->time_ms - fixture_nth_sent(&f, 0x168, n - 1)->time_ms;
        TEST_ASSERT_EQUAL_UINT32(5, gap_ms);
    }
    TEST_ASSERT_TRUE(fixture_nth_sent(&f, 0x168, count - 1)->time_ms - last_ms <= 5);
}

/* Shows: TOP-1 */
void test_the_gap_is_a_setting(void) {
    f.config.override_gap_ms = 10;
    tripped();
    foreign_gear(GEAR_D);
    fixture_run(&f, 1);
    foreign_gear(GEAR_D);
    expect_count_after(&f, 8, 0x168, 1);
    expect_count_after(&f, 1, 0x168, 2);
}

/* D at the n-th microsecond of this millisecond. */
static void foreign_drive_at_us(uint16_t us) {
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x168, .time_us = us, .length = 8, .data = {GEAR_D}});
}

/* 5 ms are 5000 us: from t + 0.9 ms to t + 5.9 ms. */
/* Shows: TOP-1 */
void test_the_5_ms_are_exact_where_the_port_knows_microseconds(void) {
    tripped();
    foreign_drive_at_us(900);
    const uint32_t first_ms = f.now_ms;
    fixture_run_without_ticks(&f, 5);
    foreign_drive_at_us(899);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    foreign_drive_at_us(900);
    TEST_ASSERT_EQUAL_UINT32(2, fixture_count_sent(&f, 0x168));

    fixture_run(&f, 20);
    fixture_forget_sent(&f);
    foreign_drive_at_us(900);
    fixture_run(&f, 1);
    foreign_drive_at_us(0);
    expect_count_after(&f, 4, 0x168, 1); /* 4.1 ms have passed */
    expect_count_after(&f, 1, 0x168, 2);
    TEST_ASSERT_EQUAL_UINT32(5 + 20 + 6, fixture_nth_sent(&f, 0x168, 1)->time_ms - first_ms);
}

/* Shows: TOP-1 */
void test_a_frame_with_fewer_microseconds_does_not_turn_the_time_back(void) {
    tripped();
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x123, .time_us = 900, .length = 8});
    foreign_drive_at_us(100); /* overridden at 900 at the earliest */
    fixture_run_without_ticks(&f, 5);
    foreign_drive_at_us(500);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    foreign_drive_at_us(900);
    TEST_ASSERT_EQUAL_UINT32(2, fixture_count_sent(&f, 0x168));
}

/* ---- A queue that is full, a second supervisor ---- */

/* Shows: TOP-1 */
void test_at_most_one_frame_an_identifier_waits(void) {
    tripped();
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    for (unsigned i = 0; i < 80; i++) {
        foreign_gear(GEAR_D);
        foreign_signals(0x00);
        fixture_run(&f, 1);
    }
    expect_silence(&f);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    expect_count_after(&f, 1, 0x168, 1);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x43F));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x075));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x065));
}

static void hear_each_other(fixture_t *from, fixture_t *to) {
    for (uint32_t i = 0; i < from->sent_count; i++) {
        hal_can_frame_t frame = {.id = from->sent[i].id, .length = 8};
        memcpy(frame.data, from->sent[i].data, 8);
        fixture_raw(to, HAL_CAN_VEHICLE, frame);
    }
    fixture_forget_sent(from);
}

/* They hold different angles: each one overrides the other, at most every 5 ms. All other commands are equal. */
/* Shows: TOP-1 */
void test_two_supervisors_on_one_bus_do_not_drown_it(void) {
    tripped();
    fixture_init(&g);
    fixture_angle(&g, 9010);
    walk_to_tripped(&g);
    fixture_run(&g, 10);
    fixture_forget_sent(&g);
    const uint32_t before = agv_supervisor_counters(&f.supervisor)->sent + agv_supervisor_counters(&g.supervisor)->sent;
    for (unsigned i = 0; i < 1000; i++) {
        fixture_run(&f, 1);
        hear_each_other(&f, &g);
        fixture_run(&g, 1);
        hear_each_other(&g, &f);
    }
    const uint32_t after = agv_supervisor_counters(&f.supervisor)->sent + agv_supervisor_counters(&g.supervisor)->sent;
    /* Of each: 065h every 5 ms, the other three and the status frame every 100 ms; one of each identifier more or less. */
    TEST_ASSERT_UINT32_WITHIN(2 * 5, 2 * (200 + 4 * 10), after - before);
}

/* 43Fh waits for the end of its 5 ms; an override of another identifier in between does not replace it. */
/* Shows: TOP-1 */
void test_an_override_that_waits_is_not_lost_by_another_one(void) {
    tripped();
    foreign_signals(0x30);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x43F));
    fixture_run(&f, 1);
    foreign_signals(0x30);
    foreign_gear(1);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x43F));
    expect_count_after(&f, 4, 0x43F, 2);
}

/* In a stalled transmitter, manual withdraws 065h and all that the controller still has. The rest is sent again at once. */
/* Shows: TOP-1, FSM-10, TX_STALLED */
void test_an_override_that_waits_is_not_lost_when_the_steering_command_is_withdrawn(void) {
    tripped();
    fixture_run(&f, 100);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
    fixture_run(&f, 1);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101); /* one of those that are withdrawn stays */
    fixture_run(&f, 69);
    fixture_forget_sent(&f);
    foreign_signals(0x30);
    fixture_run(&f, 1);
    foreign_signals(0x30);
    const uint32_t purged = f.hal.can[HAL_CAN_VEHICLE].purges;
    walk_report(&f, MODE_MANUAL);
    TEST_ASSERT_EQUAL_UINT32(purged + 1, f.hal.can[HAL_CAN_VEHICLE].purges);
    TEST_ASSERT_EQUAL_UINT32(2, fixture_count_sent(&f, 0x43F));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x075));
}

/* Manual drops the angle while its override waits. The next angle is sent in its slot: 12 ms after the override, then every 25 ms. */
/* Shows: TOP-1, FSM-10 */
void test_an_override_of_an_angle_that_is_dropped_does_not_hasten_the_next_one(void) {
    static const uint8_t angle[8] = {0x00, 0x10};
    tripped();
    foreign(0x065, 8, angle);
    const uint32_t first_ms = f.now_ms;
    fixture_run(&f, 1);
    foreign(0x065, 8, angle);
    walk_report(&f, MODE_MANUAL);
    fixture_run(&f, 68);
    fixture_forget_sent(&f);
    walk_report(&f, MODE_ENGAGED);
    fixture_send_now(&f, AGV_MSG_STEERING_STATUS);
    expect_count_after(&f, 17, 0x065, 0);
    expect_count_after(&f, 1, 0x065, 1);
    TEST_ASSERT_EQUAL_UINT32(87, fixture_nth_sent(&f, 0x065, 0)->time_ms - first_ms);
}

/* A VCU with CAN FD may obey it. */
/* Shows: TOP-1, P15 */
void test_a_command_in_an_fd_frame_is_overridden(void) {
    tripped();
    fixture_raw(&f, HAL_CAN_VEHICLE,
                (hal_can_frame_t){.id = 0x168, .flags = HAL_CAN_FD, .length = 8, .data = {GEAR_D}});
    expect_answered_in_this_call(0x168, "FD");
}

/* After a late step an override and the periodic frame are due: one frame is enough. */
/* Shows: TOP-1, TIM-1 */
void test_a_late_override_replaces_the_periodic_frame_too(void) {
    tripped();
    foreign_gear(GEAR_D);
    fixture_run(&f, 1);
    foreign_gear(GEAR_D);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    fixture_jump(&f, 60);
    TEST_ASSERT_EQUAL_UINT32(2, fixture_count_sent(&f, 0x168));
}

/* The simulated bus when something is wrong: collisions, no acknowledge, errors, bus-off, nodes that go. */
#include <string.h>

#include "sim_bus_fixture.h"
#include "unity.h"

static fixture_t fixture;
static sim_bus_t *const bus = &fixture.bus;

void setUp(void) {
    memset(&fixture, 0xA5, sizeof fixture);
    fixture_init(&fixture, 500000); /* 2 us a bit */
}

void tearDown(void) {
}

static void assert_state(hal_can_state_t expected, sim_bus_node_t node) {
    TEST_ASSERT_EQUAL_INT(expected, status_of(&fixture, node).state);
}

static void only_a_and(sim_bus_node_t other) {
    for (sim_bus_node_t node = B; node < FIXTURE_NODES; node++) {
        sim_bus_set_power(bus, node, node == other);
    }
}

/* ---- Two nodes, one identifier, one moment ---- */

void test_identical_frames_merge(void) {
    send(&fixture, A, 0x168, 8, 7);
    send(&fixture, B, 0x168, 8, 7);
    sim_bus_run_until(bus, 1000);
    TEST_ASSERT_EQUAL_UINT(1, fixture.event_count);
    TEST_ASSERT_FALSE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_HEX32(0x3, fixture.events[0].senders);
    TEST_ASSERT_EQUAL_UINT8(A, fixture.events[0].sender);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(bus, A) + sim_bus_waiting(bus, B));
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, A) + received_by(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(1, received_by(&fixture, C));
}

/* Two senders and nobody else: no one is left to acknowledge. */
void test_identical_frames_of_all_are_not_acknowledged(void) {
    only_a_and(B);
    send(&fixture, A, 0x168, 8, 7);
    send(&fixture, B, 0x168, 8, 7);
    sim_bus_run_until(bus, 290);
    TEST_ASSERT_TRUE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, B));
}

/*
 * 00h against 80h in the first of one data byte: the first data bit differs. Bits up to it: start 1, identifier 11,
 * RTR, IDE, r0 3, DLC 4, data 1 = 20, with (20 - 1) / 4 = 4 stuff bits 24; error frame 20: 44 bits = 88 us, next start
 * 3 bits = 6 us later.
 */
void test_different_frames_destroy_each_other(void) {
    send(&fixture, A, 0x168, 1, 0x00);
    send(&fixture, B, 0x168, 1, 0x80);
    sim_bus_run_until(bus, 88);
    TEST_ASSERT_EQUAL_UINT(1, fixture.event_count);
    TEST_ASSERT_TRUE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_UINT64(88, fixture.events[0].end_us);
    TEST_ASSERT_EQUAL_HEX32(0x3, fixture.events[0].senders);
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(1, rec_of(&fixture, C));
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, C));
    sim_bus_run_until(bus, 95);
    TEST_ASSERT_EQUAL_size_t(1, sim_bus_waiting(bus, A));
    sim_bus_run_until(bus, 94 + 88);
    TEST_ASSERT_EQUAL_UINT64(94, fixture.events[1].start_us);
    TEST_ASSERT_EQUAL_UINT(16, tec_of(&fixture, A));
}

/*
 * 16 collisions of 94 us make both passive (16 x 8 = 128); the 16th ends at 15 x 94 + 88 = 1498. Passive senders wait
 * 3 + 8 bits: 1498 + 22 = 1520. Then the recessive one sees its error, but its passive error flag disturbs nobody: the
 * other gets through (1 byte: 62 bits = 124 us), and then, 8 bits later than others might, the loser.
 */
void test_a_collision_ends_when_the_loser_is_passive(void) {
    send(&fixture, A, 0x168, 1, 0x00);
    send(&fixture, B, 0x168, 1, 0x80);
    sim_bus_run_until(bus, 1498);
    TEST_ASSERT_EQUAL_UINT(16, fixture.event_count);
    assert_state(HAL_CAN_ERROR_PASSIVE, A);
    assert_state(HAL_CAN_ERROR_PASSIVE, B);
    sim_bus_run_until(bus, 1520 + 124);
    TEST_ASSERT_EQUAL_UINT(17, fixture.event_count);
    TEST_ASSERT_EQUAL_UINT64(1520, fixture.events[16].start_us);
    TEST_ASSERT_EQUAL_HEX32(0x1, fixture.events[16].senders);
    TEST_ASSERT_FALSE(fixture.events[16].error);
    TEST_ASSERT_EQUAL_UINT(127, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT(136, tec_of(&fixture, B));
    sim_bus_run_until(bus, 5000);
    TEST_ASSERT_EQUAL_UINT64(1644 + 22, fixture.events[17].start_us);
    TEST_ASSERT_EQUAL_HEX8(0x80, fixture.events[17].first);
    TEST_ASSERT_EQUAL_UINT(135, tec_of(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(2, received_by(&fixture, C));
}

/*
 * Round after round: from the second on B, passive, loses 8 and gets 1 back, 7 a round from 135: in round 19 its counter
 * is 135 + 17 x 7 = 254, + 8 = 262 > 255. A, dominant, recovers meanwhile.
 */
/* Shows: SUP-7 */
void test_endless_collisions_end_in_bus_off(void) {
    unsigned round = 0;
    while (status_of(&fixture, B).state != HAL_CAN_BUS_OFF && round < 100) {
        round++;
        send(&fixture, A, 0x168, 1, 0x00);
        send(&fixture, B, 0x168, 1, 0x80);
        sim_bus_run_until(bus, round * 10000u);
    }
    TEST_ASSERT_EQUAL_UINT(19, round);
    TEST_ASSERT_EQUAL_UINT16(1, status_of(&fixture, B).bus_off_count);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(bus, B));
    TEST_ASSERT_EQUAL_UINT(128 - 19, tec_of(&fixture, A));
    assert_state(HAL_CAN_ERROR_ACTIVE, A);
}

/* An active loser destroys the frame of a passive winner, too. */
void test_an_active_loser_destroys_the_frame(void) {
    sim_bus_set_error_counters(bus, A, 128, 0);
    send(&fixture, A, 0x168, 1, 0x00);
    send(&fixture, B, 0x168, 1, 0x80);
    sim_bus_run_until(bus, 88);
    TEST_ASSERT_TRUE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_UINT(136, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, B));
    sim_bus_run_until(bus, 94 + 62 * 2); /* and A has to wait: B alone gets through */
    TEST_ASSERT_EQUAL_HEX32(0x2, fixture.events[1].senders);
    TEST_ASSERT_FALSE(fixture.events[1].error);
}

/* Lengths 0 and 8 differ in the first bit of the DLC: 16 bits, (16 - 1) / 4 = 3 stuff bits, error frame 20 = 39. */
void test_frames_of_different_length_collide_in_their_length(void) {
    send(&fixture, A, 0x168, 0, 0);
    send(&fixture, B, 0x168, 8, 0);
    sim_bus_run_until(bus, 1000);
    TEST_ASSERT_EQUAL_UINT64(78, fixture.events[0].end_us);
}

/* 29 bits: 35 to the DLC, 4, 1 data bit = 40, 39 / 4 = 9 stuff bits, 20 = 69 bits. */
void test_extended_frames_collide_later(void) {
    const hal_can_frame_t dominant = {.id = 5, .flags = HAL_CAN_EXTENDED, .length = 1};
    const hal_can_frame_t recessive = {.id = 5, .flags = HAL_CAN_EXTENDED, .length = 1, .data = {0x80}};
    sim_bus_send(bus, A, &dominant);
    sim_bus_send(bus, B, &recessive);
    sim_bus_run_until(bus, 1000);
    TEST_ASSERT_EQUAL_UINT64(138, fixture.events[0].end_us);
}

/* Three of them: the passive one falls silent at its bit, the other two are equal and get through together. */
void test_a_passive_loser_leaves_the_others_to_merge(void) {
    sim_bus_set_error_counters(bus, C, 128, 0);
    send(&fixture, A, 0x168, 1, 0x01);
    send(&fixture, B, 0x168, 1, 0x01);
    send(&fixture, C, 0x168, 1, 0x03);
    sim_bus_run_until(bus, 124);
    TEST_ASSERT_EQUAL_HEX32(0x3, fixture.events[0].senders);
    TEST_ASSERT_FALSE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_UINT(136, tec_of(&fixture, C));
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, C)); /* nor could it read the frame that it had disputed */
    TEST_ASSERT_EQUAL_UINT(1, received_by(&fixture, D));
}

/* ---- Nobody acknowledges ---- */

/*
 * 8 bytes: 132 bits, of which the last 8 are not sent, error frame 20: 144 bits = 288 us, next try after 3 bits. The
 * 16th failure makes the node passive, at 15 x 294 + 288 = 4698; from then on it waits 8 bits more, and does not count.
 */
/* Shows: SUP-7 */
void test_a_lone_node_tries_for_ever_and_becomes_passive(void) {
    only_a_and(A);
    send(&fixture, A, 0x168, 8, 0);
    sim_bus_run_until(bus, 288);
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT64(288, fixture.events[0].end_us);
    sim_bus_run_until(bus, 4697);
    assert_state(HAL_CAN_ERROR_ACTIVE, A);
    sim_bus_run_until(bus, 4698);
    assert_state(HAL_CAN_ERROR_PASSIVE, A);
    sim_bus_run_until(bus, 50000);
    TEST_ASSERT_EQUAL_UINT64(4698 + 22, fixture.events[16].start_us);
    TEST_ASSERT_EQUAL_UINT64(4698 + 22 + 310, fixture.events[17].start_us);
    TEST_ASSERT_EQUAL_UINT(128, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT32(50, status_of(&fixture, A).tx_pending_ms);
    sim_bus_set_power(bus, B, true);
    sim_bus_run_until(bus, 51000);
    TEST_ASSERT_EQUAL_UINT(127, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT(1, received_by(&fixture, B));
}

/* An unplugged node fares the same on its own, and the bus goes on without it. */
void test_an_unplugged_node_is_alone(void) {
    sim_bus_set_plugged(bus, A, false);
    sim_bus_set_plugged(bus, A, false);
    send(&fixture, A, 0x001, 8, 0);
    send(&fixture, B, 0x168, 8, 0);
    sim_bus_run_until(bus, 264);
    TEST_ASSERT_EQUAL_HEX32(0x168, fixture.events[0].id);
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, A));
    sim_bus_run_until(bus, 294);
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, A));
    sim_bus_run_until(bus, 16 * 294);
    TEST_ASSERT_EQUAL_UINT(128, tec_of(&fixture, A));
    sim_bus_run_until(bus, 90000);
    TEST_ASSERT_EQUAL_UINT(128, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT(1, fixture.event_count);
    sim_bus_set_plugged(bus, A, true);
    sim_bus_run_until(bus, 91000);
    TEST_ASSERT_EQUAL_HEX32(0x001, fixture.events[1].id);
    TEST_ASSERT_EQUAL_UINT(127, tec_of(&fixture, A));
}

/* Its attempts end in the middle of the others' frames: 0..294, 294..588, 588..882; theirs 0..264, 270..534, ... */
void test_an_unplugged_node_keeps_its_own_time(void) {
    sim_bus_set_plugged(bus, A, false);
    send(&fixture, A, 0x001, 8, 0);
    for (unsigned i = 0; i < 4; i++) {
        send(&fixture, B, 0x168, 8, 0);
    }
    sim_bus_run_until(bus, 293);
    TEST_ASSERT_EQUAL_UINT(0, tec_of(&fixture, A));
    sim_bus_run_until(bus, 294);
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, A));
    sim_bus_run_until(bus, 882);
    TEST_ASSERT_EQUAL_UINT(24, tec_of(&fixture, A));
    sim_bus_run_until(bus, 1074);
    TEST_ASSERT_EQUAL_UINT(4, fixture.event_count);
    TEST_ASSERT_EQUAL_UINT64(1074, fixture.events[3].end_us);
}

/* ---- Errors on demand ---- */

/* Whole frame 132 bits, error frame 20: 152 bits = 304 us; then again from 310 on. */
void test_corrupted_frames_are_sent_again(void) {
    sim_bus_corrupt_all(bus, 2);
    send(&fixture, A, 0x168, 8, 0);
    sim_bus_run_until(bus, 5000);
    TEST_ASSERT_EQUAL_UINT(3, fixture.event_count);
    TEST_ASSERT_TRUE(fixture.events[0].error && fixture.events[1].error);
    TEST_ASSERT_EQUAL_UINT64(304, fixture.events[0].end_us);
    TEST_ASSERT_EQUAL_UINT64(310, fixture.events[1].start_us);
    TEST_ASSERT_FALSE(fixture.events[2].error);
    TEST_ASSERT_EQUAL_UINT(15, tec_of(&fixture, A)); /* 8 + 8 - 1 */
    TEST_ASSERT_EQUAL_UINT(1, rec_of(&fixture, B));  /* 1 + 1 - 1 */
    sim_bus_stats_t stats;
    sim_bus_stats(bus, &stats);
    TEST_ASSERT_EQUAL_UINT64(1, stats.frames);
    TEST_ASSERT_EQUAL_UINT64(2, stats.errors);
}

void test_only_the_frames_of_one_sender_are_corrupted(void) {
    sim_bus_corrupt_sent(bus, A, 1);
    send(&fixture, B, 0x100, 8, 0);
    send(&fixture, A, 0x168, 8, 0);
    sim_bus_run_until(bus, 2000);
    send(&fixture, A, 0x168, 8, 0);
    sim_bus_run_until(bus, 5000);
    TEST_ASSERT_EQUAL_UINT(4, fixture.event_count);
    TEST_ASSERT_FALSE(fixture.events[0].error);
    TEST_ASSERT_TRUE(fixture.events[1].error);
    TEST_ASSERT_EQUAL_UINT(0, tec_of(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(6, tec_of(&fixture, A));
}

/* 32 failures: the counter reaches 256 only with the last. Shows that it takes that many, and what is lost with it. */
/* Shows: SUP-7 */
void test_a_node_whose_frames_always_fail_goes_bus_off(void) {
    sim_bus_corrupt_sent(bus, A, SIM_BUS_FOREVER);
    send(&fixture, A, 0x168, 8, 0);
    send(&fixture, A, 0x169, 8, 0);
    sim_bus_run_until(bus, 100000);
    TEST_ASSERT_EQUAL_UINT(32, fixture.event_count);
    assert_state(HAL_CAN_BUS_OFF, A);
    TEST_ASSERT_EQUAL_UINT16(1, status_of(&fixture, A).bus_off_count);
    TEST_ASSERT_EQUAL_UINT32(0, status_of(&fixture, A).tx_pending_ms);
    TEST_ASSERT_FALSE(send(&fixture, A, 0x168, 8, 0));
    send(&fixture, B, 0x100, 8, 0);
    sim_bus_run_until(bus, 101000);
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, A)); /* deaf, too */
    assert_state(HAL_CAN_BUS_OFF, A);                    /* and it stays so by itself */
}

/* 9 a time (1 for the error, 8 for being the first to see it): after 15 of them 135, passive; then it only misses. */
void test_a_receiver_that_cannot_read_becomes_passive(void) {
    sim_bus_corrupt_received(bus, B, 17);
    send(&fixture, A, 0x168, 8, 0);
    sim_bus_run_until(bus, 15 * 310);
    TEST_ASSERT_EQUAL_UINT(135, rec_of(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(15, rec_of(&fixture, C));
    TEST_ASSERT_EQUAL_UINT(120, tec_of(&fixture, A));
    assert_state(HAL_CAN_ERROR_PASSIVE, B);
    sim_bus_run_until(bus, 6000);
    TEST_ASSERT_EQUAL_UINT(16, fixture.event_count);
    TEST_ASSERT_FALSE(fixture.events[15].error);
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(1, received_by(&fixture, C));
    send(&fixture, A, 0x168, 8, 0);
    sim_bus_run_until(bus, 7000); /* the 17th */
    TEST_ASSERT_EQUAL_UINT(137, rec_of(&fixture, B));
    send(&fixture, A, 0x168, 8, 0);
    sim_bus_run_until(bus, 8000); /* read again: back to 127, active */
    TEST_ASSERT_EQUAL_UINT(127, rec_of(&fixture, B));
    assert_state(HAL_CAN_ERROR_ACTIVE, B);
    TEST_ASSERT_EQUAL_UINT(1, received_by(&fixture, B));
}

/* A passive one that cannot read does not acknowledge either. */
void test_a_frame_that_nobody_could_read_is_not_acknowledged(void) {
    only_a_and(B);
    sim_bus_set_error_counters(bus, B, 0, 200);
    sim_bus_corrupt_received(bus, B, 1);
    send(&fixture, A, 0x168, 8, 0);
    sim_bus_run_until(bus, 288);
    TEST_ASSERT_TRUE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT(201, rec_of(&fixture, B));
    sim_bus_set_error_counters(bus, B, 0, 300);
    TEST_ASSERT_EQUAL_UINT(255, rec_of(&fixture, B));
    sim_bus_corrupt_received(bus, B, 1);
    sim_bus_run_until(bus, 294 + 288);
    TEST_ASSERT_EQUAL_UINT(255, rec_of(&fixture, B));
}

void test_a_full_node_refuses(void) {
    sim_bus_set_full(bus, A, true);
    TEST_ASSERT_FALSE(send(&fixture, A, 0x168, 8, 0));
    sim_bus_set_full(bus, A, false);
    TEST_ASSERT_TRUE(send(&fixture, A, 0x168, 8, 0));
}

void test_a_stalled_node_hears_but_does_not_send(void) {
    sim_bus_set_stalled(bus, A, true);
    send(&fixture, A, 0x001, 8, 0);
    send(&fixture, B, 0x168, 8, 0);
    sim_bus_run_until(bus, 5000);
    TEST_ASSERT_EQUAL_UINT(1, fixture.event_count);
    TEST_ASSERT_EQUAL_UINT(1, received_by(&fixture, A));
    TEST_ASSERT_EQUAL_UINT32(5, status_of(&fixture, A).tx_pending_ms);
    sim_bus_set_stalled(bus, A, false);
    sim_bus_run_until(bus, 6000);
    TEST_ASSERT_EQUAL_UINT64(5000, fixture.events[1].start_us);
}

void test_frames_that_the_wire_cannot_carry_may_be_delivered(void) {
    hal_can_frame_t frame = {.id = 0x168, .flags = HAL_CAN_FD, .length = 64, .data = {9}};
    sim_bus_run_until(bus, 3999);
    sim_bus_deliver(bus, A, &frame);
    frame.length = 0;
    TEST_ASSERT_TRUE(sim_bus_receive(bus, A, &frame, NULL));
    TEST_ASSERT_EQUAL_UINT8(64, frame.length);
    TEST_ASSERT_EQUAL_UINT32(3, frame.time_ms);
    sim_bus_set_power(bus, B, false);
    sim_bus_deliver(bus, B, &frame);
    sim_bus_force_bus_off(bus, C);
    sim_bus_deliver(bus, C, &frame);
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, B) + received_by(&fixture, C));
    TEST_ASSERT_EQUAL_UINT(0, fixture.event_count);
}

/* ---- Purge ---- */

/* Shows: SUP-7, FSM-2 */
void test_after_a_purge_at_most_the_frame_on_the_wire_leaves(void) {
    send(&fixture, A, 0x200, 8, 1);
    sim_bus_run_until(bus, 100);
    send(&fixture, A, 0x100, 8, 2);
    send(&fixture, A, 0x201, 8, 3);
    sim_bus_purge(bus, A);
    TEST_ASSERT_EQUAL_UINT32(0, status_of(&fixture, A).tx_pending_ms);
    send(&fixture, A, 0x300, 8, 4);
    TEST_ASSERT_EQUAL_UINT32(1, status_of(&fixture, A).tx_pending_ms);
    sim_bus_run_until(bus, 5000);
    TEST_ASSERT_EQUAL_UINT(2, fixture.event_count);
    TEST_ASSERT_EQUAL_UINT8(1, fixture.events[0].first);
    TEST_ASSERT_EQUAL_UINT8(4, fixture.events[1].first);
}

/* Shows: SUP-7, FSM-2 */
void test_a_purged_frame_that_fails_is_not_sent_again(void) {
    sim_bus_corrupt_all(bus, 1);
    send(&fixture, A, 0x100, 8, 1);
    send(&fixture, A, 0x200, 8, 2);
    sim_bus_run_until(bus, 100);
    sim_bus_purge(bus, A);
    sim_bus_run_until(bus, 5000);
    TEST_ASSERT_EQUAL_UINT(1, fixture.event_count);
    TEST_ASSERT_TRUE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(bus, A));
    TEST_ASSERT_EQUAL_UINT64(SIM_BUS_NEVER, sim_bus_due_us(bus));
}

void test_a_purge_before_the_frame_starts_leaves_nothing(void) {
    send(&fixture, A, 0x100, 8, 1);
    send(&fixture, A, 0x200, 8, 1);
    sim_bus_purge(bus, A);
    sim_bus_run_until(bus, 5000);
    TEST_ASSERT_EQUAL_UINT(0, fixture.event_count);
}

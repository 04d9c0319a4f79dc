/* The simulated bus with errors: no acknowledge, injected errors, purge. Collisions: test_sim_bus_collision.c. */
#include "one_sim_bus.h"

/* ---- No acknowledge ---- */

/*
 * 8 bytes: 132 bits, of which the last 8 are not sent, error frame 20: 144 bits = 288 us, next try after 3 bits. The
 * 16th failure makes the node passive, at 15 x 294 + 288 = 4698; from then on it waits 8 bits more, and its counter
 * stays.
 */
/* Shows: SUP-7 */
void test_a_lone_node_tries_for_ever_and_becomes_passive(void) {
    only_a_and(A);
    send_and_run_until(A, 0x168, 8, 0, 288);
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT64(288, fixture.events[0].end_us);
    assert_state_at(4697, HAL_CAN_ERROR_ACTIVE, A);
    assert_state_at(4698, HAL_CAN_ERROR_PASSIVE, A);
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

/* An unplugged node behaves the same, and the bus works without it. */
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

/* ---- Injected errors ---- */

/* Whole frame 132 bits, error frame 20: 152 bits = 304 us; then again from 310 on. */
void test_corrupted_frames_are_sent_again(void) {
    sim_bus_corrupt_all(bus, 2);
    send(&fixture, A, 0x168, 8, 0);
    assert_events_at(5000, 3);
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
    assert_events_at(5000, 4);
    TEST_ASSERT_FALSE(fixture.events[0].error);
    TEST_ASSERT_TRUE(fixture.events[1].error);
    TEST_ASSERT_EQUAL_UINT(0, tec_of(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(6, tec_of(&fixture, A));
}

/* 32 failures: the counter reaches 256 only with the last one. The waiting frames are lost then. */
/* Shows: SUP-7 */
void test_a_node_whose_frames_always_fail_goes_bus_off(void) {
    sim_bus_corrupt_sent(bus, A, SIM_BUS_FOREVER);
    send(&fixture, A, 0x168, 8, 0);
    send(&fixture, A, 0x169, 8, 0);
    assert_events_at(100000, 32);
    assert_state(HAL_CAN_BUS_OFF, A);
    TEST_ASSERT_EQUAL_UINT16(1, status_of(&fixture, A).bus_off_count);
    TEST_ASSERT_EQUAL_UINT32(0, status_of(&fixture, A).tx_pending_ms);
    TEST_ASSERT_FALSE(send(&fixture, A, 0x168, 8, 0));
    send_and_run_until(B, 0x100, 8, 0, 101000);
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, A)); /* it does not receive either */
    assert_state(HAL_CAN_BUS_OFF, A);                    /* and it does not recover by itself */
}

/* 9 for each error (1 for the error, 8 for being the first to detect it): 135 after 15 errors, passive; then it only
 * loses frames. */
void test_a_receiver_that_cannot_read_becomes_passive(void) {
    sim_bus_corrupt_received(bus, B, 17);
    send_and_run_until(A, 0x168, 8, 0, 15 * 310);
    TEST_ASSERT_EQUAL_UINT(135, rec_of(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(15, rec_of(&fixture, C));
    TEST_ASSERT_EQUAL_UINT(120, tec_of(&fixture, A));
    assert_state(HAL_CAN_ERROR_PASSIVE, B);
    assert_events_at(6000, 16);
    TEST_ASSERT_FALSE(fixture.events[15].error);
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(1, received_by(&fixture, C));
    send_and_run_until(A, 0x168, 8, 0, 7000); /* the 17th */
    TEST_ASSERT_EQUAL_UINT(137, rec_of(&fixture, B));
    send_and_run_until(A, 0x168, 8, 0, 8000); /* a good frame: back to 127, active */
    TEST_ASSERT_EQUAL_UINT(127, rec_of(&fixture, B));
    assert_state(HAL_CAN_ERROR_ACTIVE, B);
    TEST_ASSERT_EQUAL_UINT(1, received_by(&fixture, B));
    send_and_run_until(A, 0x168, 8, 0, 9000);
    TEST_ASSERT_EQUAL_UINT(126, rec_of(&fixture, B));
}

void test_a_frame_misread_once_counts_once(void) {
    sim_bus_corrupt_received(bus, B, 1);
    send_and_run_until(A, 0x168, 8, 0, 304);
    TEST_ASSERT_EQUAL_UINT(9, rec_of(&fixture, B));
    sim_bus_run_until(bus, 1000);
    TEST_ASSERT_EQUAL_UINT(8, rec_of(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(7, tec_of(&fixture, A));
    sim_bus_corrupt_received(bus, B, 1);
    send_and_run_until(A, 0x168, 8, 0, 1100);
    sim_bus_set_power(bus, B, false); /* during a frame: this frame is not affected */
    sim_bus_set_power(bus, B, true);
    sim_bus_run_until(bus, 1304);
    TEST_ASSERT_TRUE(fixture.events[2].error);
    TEST_ASSERT_EQUAL_UINT(0, rec_of(&fixture, B));
}

/* A passive receiver that misreads a frame does not acknowledge it either. */
void test_a_frame_that_no_node_could_read_is_not_acknowledged(void) {
    only_a_and(B);
    sim_bus_set_error_counters(bus, B, 0, 200);
    sim_bus_corrupt_received(bus, B, 1);
    send_and_run_until(A, 0x168, 8, 0, 288);
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

void test_a_stalled_node_receives_but_does_not_send(void) {
    sim_bus_set_stalled(bus, A, true);
    send(&fixture, A, 0x001, 8, 0);
    send(&fixture, B, 0x168, 8, 0);
    assert_events_at(5000, 1);
    TEST_ASSERT_EQUAL_UINT(1, received_by(&fixture, A));
    TEST_ASSERT_EQUAL_UINT32(5, status_of(&fixture, A).tx_pending_ms);
    sim_bus_set_stalled(bus, A, false);
    sim_bus_run_until(bus, 6000);
    TEST_ASSERT_EQUAL_UINT64(5000, fixture.events[1].start_us);
}

void test_frames_that_the_bus_cannot_carry_may_be_delivered(void) {
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

/* An error-passive sender waits 3 + 8 bits after each of its frames: 264 + 22 = 286. Others do not. */
void test_a_passive_sender_lets_the_others_go_first(void) {
    sim_bus_set_error_counters(bus, A, 200, 0);
    for (unsigned i = 0; i < 3; i++) {
        send(&fixture, A, 0x100u + i, 8, 0);
    }
    sim_bus_run_until(bus, 560); /* the second one: 286..550, and A may go on from 572 */
    TEST_ASSERT_EQUAL_UINT64(286, fixture.events[1].start_us);
    send_and_run_until(B, 0x300, 8, 0, 2000);
    TEST_ASSERT_EQUAL_HEX32(0x300, fixture.events[2].id);
    TEST_ASSERT_EQUAL_UINT64(560, fixture.events[2].start_us);
    TEST_ASSERT_EQUAL_UINT64(830, fixture.events[3].start_us);
    send_and_run_until(A, 0x103, 8, 0, 2264);
    sim_bus_set_power(bus, A, false); /* a new node has no suspend time */
    sim_bus_set_power(bus, A, true);
    send_and_run_until(A, 0x104, 8, 0, 3000);
    TEST_ASSERT_EQUAL_UINT64(2270, fixture.events[5].start_us);
}

/* ---- Purge ---- */

/* Shows: SUP-7, FSM-2 */
void test_after_a_purge_at_most_the_frame_on_the_bus_is_sent(void) {
    send_and_run_until(A, 0x200, 8, 1, 100);
    send(&fixture, A, 0x100, 8, 2);
    send(&fixture, A, 0x201, 8, 3);
    sim_bus_purge(bus, A);
    sim_bus_stats_t stats;
    sim_bus_stats(bus, &stats);
    TEST_ASSERT_EQUAL_UINT64(2, stats.purged);
    TEST_ASSERT_EQUAL_UINT32(0, status_of(&fixture, A).tx_pending_ms);
    send(&fixture, A, 0x300, 8, 4);
    TEST_ASSERT_EQUAL_UINT32(1, status_of(&fixture, A).tx_pending_ms);
    assert_events_at(5000, 2);
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
    assert_events_at(5000, 1);
    TEST_ASSERT_TRUE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(bus, A));
    TEST_ASSERT_EQUAL_UINT64(SIM_BUS_NEVER, sim_bus_due_us(bus));
}

/* The current frame need not be the oldest one. A frame sent after the purge is retransmitted as usual. */
void test_a_purge_keeps_the_frame_that_is_on_the_wire(void) {
    send(&fixture, A, 0x200, 8, 1);
    send(&fixture, A, 0x100, 8, 2);
    sim_bus_run_until(bus, 100);
    sim_bus_purge(bus, A);
    send(&fixture, A, 0x400, 8, 4);
    assert_events_at(1000, 2);
    TEST_ASSERT_EQUAL_UINT8(2, fixture.events[0].first);
    TEST_ASSERT_EQUAL_UINT8(4, fixture.events[1].first);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(bus, A));
    sim_bus_corrupt_all(bus, 1);
    send(&fixture, A, 0x300, 8, 3);
    TEST_ASSERT_EQUAL_UINT32(1, status_of(&fixture, A).tx_pending_ms);
    sim_bus_run_until(bus, 2000);
    TEST_ASSERT_TRUE(fixture.events[2].error);
    TEST_ASSERT_FALSE(fixture.events[3].error);
}

/* Between an error frame and the next attempt the bus is idle. */
void test_a_purge_between_two_tries_leaves_nothing(void) {
    sim_bus_corrupt_all(bus, 1);
    send_and_run_until(A, 0x100, 8, 1, 305);
    TEST_ASSERT_TRUE(fixture.events[0].error);
    sim_bus_purge(bus, A);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(bus, A));
    TEST_ASSERT_EQUAL_UINT64(SIM_BUS_NEVER, sim_bus_due_us(bus));
}

void test_a_purge_before_the_frame_starts_leaves_nothing(void) {
    send(&fixture, A, 0x100, 8, 1);
    send(&fixture, A, 0x200, 8, 1);
    sim_bus_purge(bus, A);
    TEST_ASSERT_EQUAL_UINT64(SIM_BUS_NEVER, sim_bus_due_us(bus));
    assert_events_at(5000, 0);
}

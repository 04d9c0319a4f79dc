/* The simulated bus without errors: frame times, arbitration, mailboxes, queues, time. */
#include "one_sim_bus.h"

/* ---- Frame times on the wire (in bits: test_sim_frame.c) ---- */

/* 8 bytes: 132 bits and 3 between frames. */
static void assert_frame_times(uint32_t bitrate, uint64_t end_us, uint64_t next_us) {
    fixture_init(&fixture, bitrate);
    TEST_ASSERT_TRUE(send(&fixture, A, 0x100, 8, 1));
    TEST_ASSERT_TRUE(send(&fixture, A, 0x100, 8, 2));
    assert_events_at(10000, 2);
    TEST_ASSERT_EQUAL_UINT64(0, fixture.events[0].start_us);
    TEST_ASSERT_EQUAL_UINT64(end_us, fixture.events[0].end_us);
    TEST_ASSERT_EQUAL_UINT64(next_us, fixture.events[1].start_us);
    TEST_ASSERT_EQUAL_UINT64(next_us + end_us, fixture.events[1].end_us);
    sim_bus_stats_t stats;
    sim_bus_stats(bus, &stats);
    TEST_ASSERT_EQUAL_UINT64(2, stats.frames);
    TEST_ASSERT_EQUAL_UINT64(0, stats.errors);
    TEST_ASSERT_EQUAL_UINT64(2 * next_us, stats.busy_us);
}

void test_frames_take_their_time_at_each_bit_rate(void) {
    assert_frame_times(125000, 1056, 1080);
    assert_frame_times(250000, 528, 540);
    assert_frame_times(500000, 264, 270);
    assert_frame_times(1000000, 132, 135);
}

void test_other_bit_rates_are_refused(void) {
    TEST_ASSERT_TRUE(sim_bus_init(bus, 1000000));
    TEST_ASSERT_FALSE(sim_bus_init(bus, 0));
    TEST_ASSERT_FALSE(sim_bus_init(bus, 100000));
    TEST_ASSERT_FALSE(sim_bus_init(bus, 800000));
    TEST_ASSERT_FALSE(sim_bus_init(bus, 2000000));
    TEST_ASSERT_EQUAL_UINT64(SIM_BUS_NEVER, sim_bus_due_us(bus));
}

/* ---- Arbitration ---- */

void test_the_lowest_identifier_goes_first_whoever_asked_first(void) {
    send(&fixture, A, 0x363, 8, 0);
    send(&fixture, B, 0x101, 8, 0);
    send(&fixture, C, 0x065, 8, 0);
    assert_events_at(5000, 3);
    TEST_ASSERT_EQUAL_HEX32(0x065, fixture.events[0].id);
    TEST_ASSERT_EQUAL_HEX32(0x101, fixture.events[1].id);
    TEST_ASSERT_EQUAL_HEX32(0x363, fixture.events[2].id);
    TEST_ASSERT_EQUAL_UINT8(C, fixture.events[0].sender);
    TEST_ASSERT_EQUAL_UINT64(540, fixture.events[2].start_us);
}

void test_a_frame_on_the_wire_is_not_interrupted(void) {
    send_and_run_until(A, 0x7FF, 8, 0, 1); /* it has begun */
    send(&fixture, B, 0x001, 8, 0);
    send(&fixture, C, 0x002, 8, 0);
    sim_bus_run_until(bus, 5000);
    TEST_ASSERT_EQUAL_HEX32(0x7FF, fixture.events[0].id);
    TEST_ASSERT_EQUAL_HEX32(0x001, fixture.events[1].id);
    TEST_ASSERT_EQUAL_HEX32(0x002, fixture.events[2].id);
    TEST_ASSERT_EQUAL_UINT64(270, fixture.events[1].start_us);
}

/* All frames sent at the same time take part in the arbitration, even if the bus was run up to that time before. */
void test_frames_sent_at_the_same_time_compete(void) {
    sim_bus_run_until(bus, 1000);
    send(&fixture, A, 0x363, 8, 0);
    sim_bus_run_until(bus, 1000);
    send(&fixture, B, 0x075, 8, 0);
    sim_bus_run_until(bus, 2000);
    TEST_ASSERT_EQUAL_HEX32(0x075, fixture.events[0].id);
    TEST_ASSERT_EQUAL_UINT64(1000, fixture.events[0].start_us);
}

/* Base identifier 100h for all: data before remote before extended data before extended remote. */
void test_data_beats_remote_beats_extended(void) {
    const uint32_t extended_id = 0x100u << 18;
    const hal_can_frame_t frames[4] = {
        {.id = extended_id, .flags = HAL_CAN_EXTENDED | HAL_CAN_REMOTE},
        {.id = extended_id, .flags = HAL_CAN_EXTENDED},
        {.id = 0x100, .flags = HAL_CAN_REMOTE},
        {.id = 0x100},
    };
    for (sim_bus_node_t node = 0; node < 4; node++) {
        TEST_ASSERT_TRUE(sim_bus_send(bus, node, &frames[node]));
    }
    assert_events_at(5000, 4);
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_HEX8(frames[3 - i].flags, fixture.events[i].flags);
        TEST_ASSERT_FALSE(fixture.events[i].error);
    }
}

void test_extended_identifiers_compete_by_all_their_bits(void) {
    const hal_can_frame_t frames[3] = {
        {.id = (0x100u << 18) + 2, .flags = HAL_CAN_EXTENDED},
        {.id = (0x100u << 18) + 1, .flags = HAL_CAN_EXTENDED},
        {.id = 0x101},
    };
    for (sim_bus_node_t node = 0; node < 3; node++) {
        TEST_ASSERT_TRUE(sim_bus_send(bus, node, &frames[node]));
    }
    sim_bus_run_until(bus, 5000);
    TEST_ASSERT_EQUAL_UINT8(1, fixture.events[0].sender);
    TEST_ASSERT_EQUAL_UINT8(0, fixture.events[1].sender);
    TEST_ASSERT_EQUAL_UINT8(2, fixture.events[2].sender);
}

/* ---- A node's mailboxes and queue ---- */

void test_a_node_offers_its_lowest_identifier_and_equal_ones_in_order(void) {
    send(&fixture, A, 0x300, 1, 1);
    send(&fixture, A, 0x100, 1, 2);
    send(&fixture, A, 0x300, 1, 3);
    send(&fixture, A, 0x100, 1, 4);
    sim_bus_run_until(bus, 5000);
    const uint8_t expected[4] = {2, 4, 1, 3};
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL_UINT8(expected[i], fixture.events[i].first);
    }
}

void test_a_fifo_node_offers_its_oldest_frame(void) {
    const sim_bus_node_config_t config = {.tx_order = SIM_BUS_TX_FIFO};
    const sim_bus_node_t node = sim_bus_attach(bus, &config);
    send(&fixture, node, 0x300, 1, 1);
    send(&fixture, node, 0x100, 1, 2);
    send(&fixture, A, 0x200, 1, 3); /* beats the 300h in front of the 100h */
    sim_bus_run_until(bus, 5000);
    const uint8_t expected[3] = {3, 1, 2};
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_EQUAL_UINT8(expected[i], fixture.events[i].first);
    }
}

void test_everyone_but_the_sender_receives(void) {
    hal_can_frame_t frame;
    uint64_t time_us = 0;
    const hal_can_frame_t sent = {.id = 0x267, .time_ms = 77, .length = 3, .data = {1, 2, 3, 4, 5}};
    sim_bus_run_until(bus, 7900);
    TEST_ASSERT_TRUE(sim_bus_send(bus, B, &sent));
    sim_bus_run_until(bus, 20000);
    TEST_ASSERT_FALSE(sim_bus_receive(bus, B, &frame, NULL));
    for (sim_bus_node_t node = 0; node < FIXTURE_NODES; node++) {
        if (node != B) {
            const uint8_t data[8] = {1, 2, 3}; /* beyond the length there is nothing */
            TEST_ASSERT_TRUE(sim_bus_receive(bus, node, &frame, &time_us));
            TEST_ASSERT_EQUAL_HEX32(0x267, frame.id);
            TEST_ASSERT_EQUAL_UINT8(3, frame.length);
            TEST_ASSERT_EQUAL_HEX8_ARRAY(data, frame.data, 8);
            TEST_ASSERT_EQUAL_UINT64(7900 + 2 * 82, time_us);
            TEST_ASSERT_EQUAL_UINT32(8, frame.time_ms);
            TEST_ASSERT_FALSE(sim_bus_receive(bus, node, &frame, NULL));
        }
    }
}

void test_a_remote_frame_carries_no_data(void) {
    hal_can_frame_t frame;
    const uint8_t none[8] = {0};
    const hal_can_frame_t sent = {.id = 0x10, .flags = HAL_CAN_REMOTE, .length = 8, .data = {1, 2, 3}};
    TEST_ASSERT_TRUE(sim_bus_send(bus, A, &sent));
    sim_bus_run_until(bus, 5000);
    TEST_ASSERT_TRUE(sim_bus_receive(bus, B, &frame, NULL));
    TEST_ASSERT_EQUAL_UINT8(8, frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(none, frame.data, 8);
}

void test_full_mailboxes_refuse(void) {
    for (unsigned i = 0; i < 8; i++) {
        TEST_ASSERT_TRUE(send(&fixture, A, 0x100 + i, 8, 0));
    }
    TEST_ASSERT_FALSE(send(&fixture, A, 0x001, 8, 0));
    TEST_ASSERT_EQUAL_size_t(8, sim_bus_waiting(bus, A));
    sim_bus_run_until(bus, 264); /* one has left */
    TEST_ASSERT_EQUAL_size_t(7, sim_bus_waiting(bus, A));
    TEST_ASSERT_TRUE(send(&fixture, A, 0x001, 8, 0));
    TEST_ASSERT_FALSE(send(&fixture, A, 0x002, 8, 0));
}

void test_frames_that_the_bus_cannot_carry_are_refused(void) {
    const hal_can_frame_t frames[6] = {
        {.id = 1, .flags = HAL_CAN_FD}, {.id = 1, .flags = HAL_CAN_ERROR},
        {.id = 1, .length = 9},         {.id = 0x800},
        {.id = 1, .flags = 0x10},       {.id = 0x20000000, .flags = HAL_CAN_EXTENDED},
    };
    for (unsigned i = 0; i < 6; i++) {
        TEST_ASSERT_FALSE(sim_bus_send(bus, A, &frames[i]));
    }
    const hal_can_frame_t last = {.id = 0x1FFFFFFF, .flags = HAL_CAN_EXTENDED, .length = 8};
    TEST_ASSERT_TRUE(sim_bus_send(bus, A, &last));
    TEST_ASSERT_TRUE(send(&fixture, A, 0x7FF, 8, 0));
}

void test_a_full_receive_queue_counts_overruns_and_keeps_the_old_frames(void) {
    hal_can_frame_t frame;
    for (unsigned i = 0; i < 11; i++) { /* the queue holds 8 */
        send_and_run_until(A, 0x100, 8, (uint8_t)i, (i + 1) * 1000);
    }
    TEST_ASSERT_EQUAL_UINT16(3, status_of(&fixture, B).overrun_count);
    for (unsigned i = 0; i < 5; i++) {
        TEST_ASSERT_TRUE(sim_bus_receive(bus, B, &frame, NULL));
        TEST_ASSERT_EQUAL_UINT8(i, frame.data[0]);
    }
    send(&fixture, A, 0x100, 8, 99); /* around the end of the ring */
    sim_bus_run_until(bus, 20000);
    for (unsigned i = 5; i < 9; i++) {
        TEST_ASSERT_TRUE(sim_bus_receive(bus, B, &frame, NULL));
        TEST_ASSERT_EQUAL_UINT8(i < 8 ? i : 99, frame.data[0]);
    }
    TEST_ASSERT_FALSE(sim_bus_receive(bus, B, &frame, NULL));
    TEST_ASSERT_EQUAL_UINT16(3, status_of(&fixture, B).overrun_count);
    sim_bus_inject_overrun(bus, B);
    TEST_ASSERT_EQUAL_UINT16(4, status_of(&fixture, B).overrun_count);
}

void test_the_age_of_the_oldest_waiting_frame_is_reported(void) {
    TEST_ASSERT_EQUAL_UINT32(0, status_of(&fixture, A).tx_pending_ms);
    sim_bus_set_stalled(bus, A, true);
    sim_bus_run_until(bus, 5500);
    send(&fixture, A, 0x300, 8, 0);
    TEST_ASSERT_EQUAL_UINT32(1, status_of(&fixture, A).tx_pending_ms);
    sim_bus_run_until(bus, 105499);
    send(&fixture, A, 0x100, 8, 0);
    TEST_ASSERT_EQUAL_UINT32(99, status_of(&fixture, A).tx_pending_ms);
    sim_bus_run_until(bus, 105500);
    TEST_ASSERT_EQUAL_UINT32(100, status_of(&fixture, A).tx_pending_ms);
    sim_bus_set_stalled(bus, A, false);
    sim_bus_run_until(bus, 105800); /* the 100h is gone, the 300h on the wire */
    TEST_ASSERT_EQUAL_UINT32(100, status_of(&fixture, A).tx_pending_ms);
    sim_bus_run_until(bus, 107000);
    TEST_ASSERT_EQUAL_UINT32(0, status_of(&fixture, A).tx_pending_ms);
    sim_bus_set_stalled(bus, A, true);
    send_and_run_until(A, 0x300, 8, 0, UINT64_C(6000000000000)); /* longer than 32 bits of milliseconds */
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, status_of(&fixture, A).tx_pending_ms);
}

void test_nodes_and_taps_are_limited_and_configurations_checked(void) {
    const sim_bus_node_config_t too_many_tx = {.tx_slots = SIM_BUS_TX_SLOTS_MAX + 1};
    const sim_bus_node_config_t too_many_rx = {.rx_slots = SIM_BUS_RX_SLOTS_MAX + 1};
    TEST_ASSERT_EQUAL_UINT8(SIM_BUS_NO_NODE, sim_bus_attach(bus, &too_many_tx));
    TEST_ASSERT_EQUAL_UINT8(SIM_BUS_NO_NODE, sim_bus_attach(bus, &too_many_rx));
    const sim_bus_node_config_t largest = {.tx_slots = SIM_BUS_TX_SLOTS_MAX, .rx_slots = SIM_BUS_RX_SLOTS_MAX};
    TEST_ASSERT_EQUAL_UINT8(FIXTURE_NODES, sim_bus_attach(bus, &largest));
    TEST_ASSERT_EQUAL_UINT8(SIM_BUS_NO_NODE, sim_bus_attach(bus, &too_many_tx));
    for (unsigned i = FIXTURE_NODES + 1; i < SIM_BUS_NODES_MAX; i++) {
        TEST_ASSERT_EQUAL_UINT8(i, sim_bus_attach(bus, NULL));
    }
    TEST_ASSERT_EQUAL_UINT8(SIM_BUS_NO_NODE, sim_bus_attach(bus, NULL));
    for (unsigned i = 1; i < SIM_BUS_TAPS_MAX; i++) {
        TEST_ASSERT_TRUE(sim_bus_add_tap(bus, fixture_record, &fixture));
    }
    TEST_ASSERT_FALSE(sim_bus_add_tap(bus, fixture_record, &fixture));
    send(&fixture, 15, 0x100, 8, 0); /* the last node works, and every tap is called */
    assert_events_at(1000, SIM_BUS_TAPS_MAX);
    TEST_ASSERT_EQUAL_HEX32(0x8000, fixture.events[0].senders);
}

/* ---- Time and callbacks ---- */

void test_a_time_in_the_past_changes_nothing(void) {
    sim_bus_run_until(bus, 500);
    sim_bus_run_until(bus, 100);
    TEST_ASSERT_EQUAL_UINT64(500, sim_bus_now_us(bus));
    TEST_ASSERT_EQUAL_UINT64(SIM_BUS_NEVER, sim_bus_due_us(bus));
    send(&fixture, A, 0x100, 8, 0);
    TEST_ASSERT_EQUAL_UINT64(501, sim_bus_due_us(bus));
    sim_bus_run_until(bus, 501);
    TEST_ASSERT_EQUAL_UINT64(764, sim_bus_due_us(bus));
    assert_events_at(764, 1);
    TEST_ASSERT_EQUAL_UINT64(SIM_BUS_NEVER, sim_bus_due_us(bus));
}

typedef struct {
    sim_bus_t *bus;
    sim_bus_node_t node;
    uint32_t answer_id;
    uint64_t at_us;
    unsigned calls;
    uint32_t time_ms;
} answerer_t;

/* Answers one frame with another at once, on any bus. */
static void answer(void *ctx, const hal_can_frame_t *frame) {
    answerer_t *answerer = ctx;
    if (answerer->calls++ == 0) {
        const hal_can_frame_t answer_frame = frame_of(answerer->answer_id, 8, 0);
        answerer->at_us = sim_bus_now_us(answerer->bus);
        answerer->time_ms = frame->time_ms;
        TEST_ASSERT_TRUE(sim_bus_send(answerer->bus, answerer->node, &answer_frame));
    }
}

/* A frame sent by a callback takes part in the next arbitration, 3 bits later. */
void test_a_callback_may_answer_at_once(void) {
    answerer_t answerer = {.bus = bus, .answer_id = 0x050};
    const sim_bus_node_config_t config = {.on_receive = answer, .ctx = &answerer};
    answerer.node = sim_bus_attach(bus, &config);
    sim_bus_run_until(bus, 5000);
    send(&fixture, A, 0x300, 8, 0);
    send(&fixture, A, 0x301, 8, 0);
    sim_bus_run_until(bus, 9000);
    TEST_ASSERT_EQUAL_UINT64(5264, answerer.at_us);
    TEST_ASSERT_EQUAL_UINT32(5, answerer.time_ms);
    TEST_ASSERT_EQUAL_HEX32(0x050, fixture.events[1].id);
    TEST_ASSERT_EQUAL_UINT64(5270, fixture.events[1].start_us);
    TEST_ASSERT_EQUAL_HEX32(0x301, fixture.events[2].id);
    TEST_ASSERT_EQUAL_UINT(2, answerer.calls);
}

/* A gateway: a frame received on one bus is sent on the other at the same time, even if the other is busy. */
void test_two_buses_run_in_the_order_of_time(void) {
    static fixture_t other;
    fixture_init(&other, 250000);
    sim_bus_t *const buses[2] = {bus, &other.bus};
    answerer_t to_other = {.bus = &other.bus, .answer_id = 0x050};
    answerer_t to_this = {.bus = bus, .answer_id = 0x060};
    const sim_bus_node_config_t here = {.on_receive = answer, .ctx = &to_other};
    const sim_bus_node_config_t there = {.on_receive = answer, .ctx = &to_this};
    to_this.node = sim_bus_attach(bus, &here);
    to_other.node = sim_bus_attach(&other.bus, &there);
    sim_bus_run_all_until(buses, 2, 1000);
    TEST_ASSERT_EQUAL_UINT64(1000, sim_bus_now_us(&other.bus));
    send(&fixture, A, 0x300, 8, 0); /* 1000..1264 */
    send(&other, A, 0x400, 8, 0);   /* 1000..1528 */
    sim_bus_run_all_until(buses, 2, 5000);
    TEST_ASSERT_EQUAL_UINT64(1264, to_other.at_us);
    TEST_ASSERT_EQUAL_UINT64(1528, to_this.at_us);
    TEST_ASSERT_EQUAL_HEX32(0x050, other.events[1].id);
    TEST_ASSERT_EQUAL_UINT64(1540, other.events[1].start_us); /* 1528 + 3 x 4 */
    TEST_ASSERT_EQUAL_HEX32(0x060, fixture.events[1].id);
    TEST_ASSERT_EQUAL_UINT64(1528, fixture.events[1].start_us);
    TEST_ASSERT_EQUAL_UINT64(5000, sim_bus_now_us(bus));
    TEST_ASSERT_EQUAL_UINT64(5000, sim_bus_now_us(&other.bus));
}

/* A frame starts on the other bus just before: the callback's frame does not take part in that arbitration. */
void test_a_callback_cannot_send_into_the_past_of_another_bus(void) {
    static fixture_t other;
    fixture_init(&other, 500000);
    sim_bus_t *const buses[2] = {bus, &other.bus};
    answerer_t to_other = {.bus = &other.bus, .node = B, .answer_id = 0x050};
    const sim_bus_node_config_t here = {.on_receive = answer, .ctx = &to_other};
    sim_bus_attach(bus, &here);
    send(&fixture, A, 0x300, 8, 0); /* arrives at 264 */
    sim_bus_run_all_until(buses, 2, 263);
    send(&other, A, 0x400, 8, 0); /* starts at 263 */
    sim_bus_run_all_until(buses, 2, 5000);
    TEST_ASSERT_EQUAL_HEX32(0x400, other.events[0].id);
    TEST_ASSERT_EQUAL_UINT64(263, other.events[0].start_us);
    TEST_ASSERT_EQUAL_HEX32(0x050, other.events[1].id);
}

void test_a_copy_is_a_snapshot(void) {
    static sim_bus_t copy;
    send(&fixture, A, 0x300, 8, 0);
    send(&fixture, B, 0x301, 8, 0);
    sim_bus_run_until(bus, 300);
    copy = *bus;
    assert_events_at(5000, 2);
    *bus = copy;
    TEST_ASSERT_EQUAL_UINT64(300, sim_bus_now_us(bus));
    assert_events_at(5000, 3);
    TEST_ASSERT_EQUAL_UINT64(fixture.events[1].end_us, fixture.events[2].end_us);
}

/* The size of the time steps does not change the result. */
void test_the_size_of_the_time_steps_makes_no_difference(void) {
    static fixture_t other;
    fixture_init(&other, 500000);
    for (uint64_t ms = 0; ms < 20; ms++) {
        for (sim_bus_node_t node = 0; node < 4; node++) {
            send(&fixture, node, 0x100u + node * 3, (uint8_t)(ms % 9), 1);
            send(&other, node, 0x100u + node * 3, (uint8_t)(ms % 9), 1);
        }
        sim_bus_run_until(bus, (ms + 1) * 1000);
        for (uint64_t us = ms * 1000; us < (ms + 1) * 1000; us++) {
            sim_bus_run_until(&other.bus, us + 1);
        }
    }
    TEST_ASSERT_EQUAL_UINT(fixture.event_count, other.event_count);
    TEST_ASSERT_TRUE(fixture.event_count >= 70);
    for (unsigned i = 0; i < fixture.event_count; i++) {
        TEST_ASSERT_EQUAL_UINT64(fixture.events[i].end_us, other.events[i].end_us);
        TEST_ASSERT_EQUAL_UINT8(fixture.events[i].sender, other.events[i].sender);
    }
}

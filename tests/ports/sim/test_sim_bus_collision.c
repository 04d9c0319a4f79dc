/* The simulated bus when several nodes send the same identifier at the same time. */
#include "one_sim_bus.h"

void test_identical_frames_merge(void) {
    send(&fixture, A, 0x168, 8, 7);
    send(&fixture, B, 0x168, 8, 7);
    assert_events_at(1000, 1);
    TEST_ASSERT_FALSE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_HEX32(0x3, fixture.events[0].senders);
    TEST_ASSERT_EQUAL_UINT8(A, fixture.events[0].sender);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(bus, A) + sim_bus_waiting(bus, B));
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, A) + received_by(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(1, received_by(&fixture, C));
}

/* Two senders and no other node: the frame is not acknowledged. */
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
    assert_events_at(88, 1);
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
 * 3 + 8 bits: 1498 + 22 = 1520. Then the recessive one detects its error, but its passive error flag does not destroy
 * the frame. The other frame is sent (1 byte: 62 bits = 124 us), and after it, with 8 bits of suspend time, that of the
 * loser.
 */
void test_a_collision_ends_when_the_loser_is_passive(void) {
    send(&fixture, A, 0x168, 1, 0x00);
    send(&fixture, B, 0x168, 1, 0x80);
    assert_events_at(1498, 16);
    assert_state(HAL_CAN_ERROR_PASSIVE, A);
    assert_state(HAL_CAN_ERROR_PASSIVE, B);
    assert_events_at(1520 + 124, 17);
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
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, B)); /* it could not read the frame of the collision */
}

/*
 * Repeated collisions: from the second on the counter of B, which is passive, rises by 8 and falls by 1, from 135 on:
 * in round 19 its counter is 135 + 17 x 7 = 254, + 8 = 262 > 255. A, dominant, recovers meanwhile.
 */
/* Shows: SUP-7 */
void test_endless_collisions_end_in_bus_off(void) {
    unsigned round = 0;
    while (status_of(&fixture, B).state != HAL_CAN_BUS_OFF && round < 100) {
        round++;
        send(&fixture, A, 0x168, 1, 0x00);
        send(&fixture, B, 0x168, 1, 0x80);
        sim_bus_run_until(bus, round * 10000);
    }
    TEST_ASSERT_EQUAL_UINT(19, round);
    TEST_ASSERT_EQUAL_UINT16(1, status_of(&fixture, B).bus_off_count);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(bus, B));
    TEST_ASSERT_EQUAL_UINT(128 - 19, tec_of(&fixture, A));
    assert_state(HAL_CAN_ERROR_ACTIVE, A);
}

/* One active node among the losers is enough. */
void test_an_active_loser_among_passive_ones_destroys_the_frame(void) {
    sim_bus_set_error_counters(bus, B, 128, 0);
    send(&fixture, A, 0x168, 1, 0x00);
    send(&fixture, B, 0x168, 1, 0x80);
    send(&fixture, D, 0x168, 1, 0x80);
    sim_bus_run_until(bus, 88);
    TEST_ASSERT_TRUE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT(8, tec_of(&fixture, D));
}

/*
 * Bits up to the first that differs, stuff bits (bits - 1) / 4, error frame 20, of 2 us: in the length of a frame 16 + 3;
 * in the last data bit 19 + 64 = 83, + 20; in the first data bit of an extended frame 40, + 9.
 */
void test_frames_collide_at_the_first_bit_that_differs(void) {
    static const struct {
        hal_can_frame_t dominant;
        hal_can_frame_t recessive;
        uint64_t end_us;
    } cases[] = {
        {{.id = 0x168}, {.id = 0x168, .length = 8}, 2 * 39},
        {{.id = 0x168, .length = 8}, {.id = 0x168, .length = 8, .data = {[7] = 1}}, 2 * 123},
        {{.id = 5, .flags = HAL_CAN_EXTENDED, .length = 1},
         {.id = 5, .flags = HAL_CAN_EXTENDED, .length = 1, .data = {0x80}},
         2 * 69},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        fixture_init(&fixture, 500000);
        sim_bus_send(bus, A, &cases[i].recessive);
        sim_bus_send(bus, B, &cases[i].dominant);
        sim_bus_run_until(bus, 1000);
        TEST_ASSERT_TRUE(fixture.events[0].error);
        TEST_ASSERT_EQUAL_UINT64(cases[i].end_us, fixture.events[0].end_us);
    }
}

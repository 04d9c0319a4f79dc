/* The simulated bus: recovery from bus-off, and nodes that lose their power. */
#include "one_sim_bus.h"

/* ---- Recovery ---- */

/* Idle bus: 128 x 11 = 1408 bits = 2816 us. */
/* Shows: SUP-7 */
void test_recovery_takes_1408_bits_of_an_idle_bus(void) {
    sim_bus_recover(bus, A); /* not in bus-off: no effect */
    sim_bus_run_until(bus, 1000);
    sim_bus_set_error_counters(bus, A, 256, 50);
    sim_bus_force_bus_off(bus, A);
    assert_state_at(10000, HAL_CAN_BUS_OFF, A);
    sim_bus_recover(bus, A);
    sim_bus_run_until(bus, 11000);
    sim_bus_recover(bus, A); /* a second request does not restart it */
    assert_state_at(12815, HAL_CAN_BUS_OFF, A);
    assert_state_at(12816, HAL_CAN_ERROR_ACTIVE, A);
    TEST_ASSERT_EQUAL_UINT(0, tec_of(&fixture, A) + rec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT16(1, status_of(&fixture, A).bus_off_count);
    TEST_ASSERT_TRUE(send(&fixture, A, 0x168, 8, 0));
    assert_events_at(13500, 1);
}

/*
 * One frame in between: 50 whole sequences (1100 us) and 9 bits that do not count, the frame 264 us and 6 between frames
 * = 1 sequence, then the other 77: 1118 + 264 + 6 + 77 x 22 = 3082.
 */
void test_a_frame_in_between_counts_as_one_sequence(void) {
    sim_bus_run_until(bus, 7000);
    sim_bus_force_bus_off(bus, A);
    sim_bus_recover(bus, A);
    sim_bus_run_until(bus, 7000 + 1118);
    send(&fixture, B, 0x100, 8, 0);
    assert_state_at(7000 + 3081, HAL_CAN_BUS_OFF, A);
    assert_state_at(7000 + 3082, HAL_CAN_ERROR_ACTIVE, A);
}

/* A bus without pauses: each frame takes 270 us and counts as one sequence: 128 x 270 = 34560. */
void test_recovery_on_a_full_bus_takes_128_frames(void) {
    sim_bus_force_bus_off(bus, A);
    send_and_run_until(B, 0x100, 8, 0, 1);
    sim_bus_recover(bus, A); /* requested during the first one */
    for (uint64_t us = 100; us < 34560; us += 100) {
        (void)send(&fixture, B, 0x100, 8, 0);
        sim_bus_run_until(bus, us);
    }
    assert_state_at(34559, HAL_CAN_BUS_OFF, A);
    assert_state_at(34560, HAL_CAN_ERROR_ACTIVE, A);
}

/* Requested between two frames: the count starts at the end of the interframe bits. */
void test_recovery_requested_between_frames(void) {
    send_and_run_until(B, 0x100, 8, 0, 264);
    sim_bus_force_bus_off(bus, A);
    sim_bus_recover(bus, A);
    assert_state_at(270 + 2815, HAL_CAN_BUS_OFF, A);
    assert_state_at(270 + 2816, HAL_CAN_ERROR_ACTIVE, A);
}

/* An unplugged node counts as on an idle bus: frames of others no longer delay it. */
void test_an_unplugged_node_recovers_on_its_own(void) {
    sim_bus_force_bus_off(bus, A);
    sim_bus_recover(bus, A);
    sim_bus_run_until(bus, 220); /* 10 sequences */
    send_and_run_until(B, 0x100, 8, 0, 320);
    sim_bus_set_plugged(bus, A, false); /* counts on from here: 118 x 22 = 2596 */
    for (uint64_t us = 400; us <= 2900; us += 100) {
        (void)send(&fixture, B, 0x100, 8, 0);
        sim_bus_run_until(bus, us);
    }
    assert_state_at(2915, HAL_CAN_BUS_OFF, A);
    assert_state_at(2916, HAL_CAN_ERROR_ACTIVE, A);
}

void test_waiting_frames_are_lost_in_bus_off_or_kept_if_configured(void) {
    const sim_bus_node_config_t keeps = {.keep_on_bus_off = true};
    const sim_bus_node_t keeper = sim_bus_attach(bus, &keeps);
    for (unsigned i = 0; i < 2; i++) {
        sim_bus_set_stalled(bus, i == 0 ? A : keeper, true);
        send(&fixture, i == 0 ? A : keeper, 0x168, 8, (uint8_t)i);
        sim_bus_force_bus_off(bus, i == 0 ? A : keeper);
        sim_bus_set_stalled(bus, i == 0 ? A : keeper, false);
        sim_bus_recover(bus, i == 0 ? A : keeper);
    }
    TEST_ASSERT_EQUAL_UINT32(0, status_of(&fixture, A).tx_pending_ms);
    TEST_ASSERT_EQUAL_UINT32(1, status_of(&fixture, keeper).tx_pending_ms);
    assert_events_at(10000, 1);
    TEST_ASSERT_EQUAL_UINT8(keeper, fixture.events[0].sender);
    TEST_ASSERT_EQUAL_UINT64(2816, fixture.events[0].start_us);
}

/* Shows: SUP-7 */
void test_a_frame_purged_in_bus_off_never_leaves(void) {
    const sim_bus_node_config_t keeps = {.keep_on_bus_off = true};
    const sim_bus_node_t keeper = sim_bus_attach(bus, &keeps);
    send_and_run_until(keeper, 0x168, 8, 0, 100);
    sim_bus_force_bus_off(bus, keeper); /* during the frame: it is aborted */
    TEST_ASSERT_EQUAL_size_t(1, sim_bus_waiting(bus, keeper));
    sim_bus_purge(bus, keeper);
    sim_bus_recover(bus, keeper);
    assert_state_at(10000, HAL_CAN_ERROR_ACTIVE, keeper);
    TEST_ASSERT_EQUAL_UINT(1, fixture.event_count);
    TEST_ASSERT_TRUE(fixture.events[0].error);
}

/* A frame is purged while it is sent, then its node goes bus-off: the frame is discarded, although the node keeps its
 * frames. */
void test_a_frame_purged_on_the_wire_is_gone_when_it_breaks_off(void) {
    const sim_bus_node_config_t keeps = {.keep_on_bus_off = true};
    const sim_bus_node_t keeper = sim_bus_attach(bus, &keeps);
    send_and_run_until(keeper, 0x168, 8, 0, 100);
    sim_bus_purge(bus, keeper);
    send(&fixture, keeper, 0x169, 8, 0);
    sim_bus_force_bus_off(bus, keeper);
    TEST_ASSERT_EQUAL_size_t(1, sim_bus_waiting(bus, keeper));
    sim_bus_recover(bus, keeper);
    sim_bus_run_until(bus, 10000);
    TEST_ASSERT_EQUAL_HEX32(0x169, fixture.events[1].id);
    TEST_ASSERT_EQUAL_UINT(2, fixture.event_count);
    sim_bus_corrupt_all(bus, 1); /* and the purge is over: a frame that fails now is retransmitted */
    send(&fixture, keeper, 0x170, 8, 0);
    assert_events_at(20000, 4);
}

/* ---- Error counters set from outside ---- */

void test_error_counters_make_the_state(void) {
    sim_bus_set_error_counters(bus, A, 127, 127);
    assert_state(HAL_CAN_ERROR_ACTIVE, A);
    sim_bus_set_error_counters(bus, A, 128, 0);
    assert_state(HAL_CAN_ERROR_PASSIVE, A);
    sim_bus_set_error_counters(bus, A, 0, 128);
    assert_state(HAL_CAN_ERROR_PASSIVE, A);
    sim_bus_set_error_counters(bus, A, 255, 0);
    assert_state(HAL_CAN_ERROR_PASSIVE, A);
    sim_bus_set_error_counters(bus, A, 256, 0);
    assert_state(HAL_CAN_BUS_OFF, A);
    sim_bus_set_error_counters(bus, A, 0, 0);
    assert_state(HAL_CAN_BUS_OFF, A);
    sim_bus_set_power(bus, B, false);
    sim_bus_force_bus_off(bus, B);
    assert_state(HAL_CAN_ERROR_ACTIVE, B);
    sim_bus_error_counters(bus, A, NULL, NULL);
}

/* ---- Power ---- */

void test_a_sender_that_loses_its_power_breaks_off(void) {
    send(&fixture, A, 0x168, 8, 0);
    send(&fixture, A, 0x169, 8, 0);
    sim_bus_run_until(bus, 100);
    sim_bus_set_power(bus, A, false);
    sim_bus_set_power(bus, A, true); /* switched on again at once: a new node, and that frame stays destroyed */
    assert_events_at(5000, 1);
    TEST_ASSERT_TRUE(fixture.events[0].error);
    TEST_ASSERT_EQUAL_UINT(1, rec_of(&fixture, B));
    TEST_ASSERT_EQUAL_UINT(0, tec_of(&fixture, A));
    TEST_ASSERT_TRUE(send(&fixture, A, 0x168, 8, 0));
    sim_bus_run_until(bus, 6000);
    TEST_ASSERT_FALSE(fixture.events[1].error);
}

void test_a_node_without_power_takes_no_part(void) {
    send_and_run_until(B, 0x100, 8, 0, 1000);
    sim_bus_set_error_counters(bus, A, 100, 100);
    sim_bus_inject_overrun(bus, A);
    sim_bus_set_power(bus, A, false);
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, A));
    TEST_ASSERT_FALSE(send(&fixture, A, 0x168, 8, 0));
    send_and_run_until(B, 0x100, 8, 0, 2000);
    sim_bus_set_power(bus, A, true);
    TEST_ASSERT_EQUAL_UINT(0, received_by(&fixture, A));
    TEST_ASSERT_EQUAL_UINT(0, tec_of(&fixture, A) + rec_of(&fixture, A));
    TEST_ASSERT_EQUAL_UINT16(0, status_of(&fixture, A).overrun_count);
}

void test_power_off_and_on_ends_bus_off(void) {
    send(&fixture, A, 0x168, 8, 0);
    sim_bus_force_bus_off(bus, A);
    TEST_ASSERT_EQUAL_UINT64(SIM_BUS_NEVER, sim_bus_due_us(bus)); /* waiting frames are lost */
    sim_bus_recover(bus, A);
    sim_bus_set_power(bus, A, false);
    sim_bus_set_power(bus, A, true);
    assert_state(HAL_CAN_ERROR_ACTIVE, A);
    TEST_ASSERT_EQUAL_UINT16(0, status_of(&fixture, A).bus_off_count);
    TEST_ASSERT_EQUAL_UINT64(SIM_BUS_NEVER, sim_bus_due_us(bus));
}

/* Sending: order, waiting, a full kernel queue, purging, a lost echo. */

#include "one_port.h"

static uint32_t pending_ms(void) {
    return port_status(&hal, HAL_CAN_VEHICLE).tx_pending_ms;
}

/* Frames without a receiver, until the kernel's queue is full. */
static void fill_kernel_queue(void) {
    while (vcan_try(tester, 0x7FF)) {
    }
}

void test_a_frame_is_sent_at_once_when_none_is_in_flight(void) {
    TEST_ASSERT_TRUE(port_send(&hal, 0x105));
    vcan_expect_id(tester, 0x105);
    TEST_ASSERT_TRUE(pending_ms() >= 1); /* until its echo was read */
    (void)port_drain(&hal);
    TEST_ASSERT_EQUAL_UINT32(0, pending_ms());
    TEST_ASSERT_EQUAL_UINT(1, left.count);
}

void test_waiting_frames_are_sent_by_identifier(void) {
    const uint32_t ids[] = {0x108, 0x105, 0x107, 0x104, 0x10F, 0x100, 0x106};
    const uint32_t order[] = {0x108, 0x100, 0x104, 0x105, 0x106, 0x107, 0x10F};
    const uint8_t numbers[] = {0, 5, 3, 1, 6, 2, 4};
    for (uint8_t i = 0; i < 7; i++) {
        const hal_can_frame_t frame = {.id = ids[i], .length = 1, .data = {i}};
        TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &frame));
    }
    vcan_expect_id(tester, 0x108);
    vcan_expect_nothing(tester); /* one at a time */
    TEST_ASSERT_EQUAL_UINT(0, port_drain(&hal));
    for (uint8_t i = 1; i < 7; i++) {
        vcan_expect(tester, order[i], 1, (const uint8_t[8]){numbers[i]});
    }
    vcan_expect_nothing(tester);
    TEST_ASSERT_EQUAL_UINT(7, left.count);
    for (uint8_t i = 0; i < 7; i++) {
        TEST_ASSERT_EQUAL_HEX32(order[i], left.frames[i].id);
        TEST_ASSERT_EQUAL_HEX8(numbers[i], left.frames[i].data[0]);
    }
    TEST_ASSERT_EQUAL_UINT32(0, pending_ms());
}

static void send_numbered(uint32_t id, uint8_t number) {
    const hal_can_frame_t frame = {.id = id, .length = 1, .data = {number}};
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &frame));
}

/* Frames that are given within 1 ms. On a busy computer it takes some attempts. */
/* Shows: TOP-3 */
void test_frames_with_one_identifier_that_are_given_together_all_wait(void) {
    uint64_t begun_us;
    do {
        (void)port_drain(&hal);
        vcan_drain(tester);
        begun_us = linux_hal_now_us(&hal);
        send_numbered(0x10F, 0);
        send_numbered(0x105, 1);
        send_numbered(0x105, 2);
        send_numbered(0x105, 3);
    } while (linux_hal_now_us(&hal) - begun_us > 1000);
    (void)port_drain(&hal);
    vcan_expect(tester, 0x10F, 1, (const uint8_t[8]){0});
    for (uint8_t i = 1; i < 4; i++) {
        vcan_expect(tester, 0x105, 1, (const uint8_t[8]){i});
    }
    vcan_expect_nothing(tester);
}

/* Shows: TOP-1, TOP-2, SUP-7 */
void test_of_older_frames_with_one_identifier_the_newest_waits_and_is_as_old_as_the_first(void) {
    vcan_stick();
    send_numbered(0x10F, 0);
    send_numbered(0x105, 1);
    send_numbered(0x105, 1); /* together with the one before: both wait, until a later one comes */
    send_numbered(0x106, 2);
    fill_kernel_queue();
    (void)port_drain(&hal); /* 10Fh was sent; the others find no room */
    for (uint8_t i = 3; i < 23; i++) {
        vcan_pause_ms(2);
        send_numbered(0x105, i);
    }
    (void)port_drain(&hal);
    TEST_ASSERT_TRUE(pending_ms() >= 40);
    vcan_unstick();
    vcan_drain(tester);
    (void)linux_hal_tick(&hal);
    (void)port_drain(&hal);
    vcan_expect(tester, 0x105, 1, (const uint8_t[8]){22});
    vcan_expect(tester, 0x106, 1, (const uint8_t[8]){2});
    vcan_expect_nothing(tester);
    TEST_ASSERT_EQUAL_UINT32(0, pending_ms());
}

void test_a_frame_that_replaces_the_only_one_waits_in_its_place(void) {
    vcan_stick();
    send_numbered(0x10F, 0);
    send_numbered(0x105, 1);
    fill_kernel_queue();
    (void)port_drain(&hal); /* 10Fh was sent, 105h finds no room */
    vcan_pause_ms(2);
    send_numbered(0x105, 2);
    TEST_ASSERT_TRUE(pending_ms() >= 2);
    vcan_unstick();
    vcan_drain(tester);
    (void)linux_hal_tick(&hal);
    (void)port_drain(&hal);
    vcan_expect(tester, 0x105, 1, (const uint8_t[8]){2});
    vcan_expect_nothing(tester);
    TEST_ASSERT_EQUAL_UINT32(0, pending_ms());
}

void test_extended_identifiers_are_ranked_as_on_the_bus(void) {
    hal_can_frame_t frame = vcan_frame(0x10F);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &frame));
    frame = (hal_can_frame_t){.id = 0x101u << 18, .flags = HAL_CAN_EXTENDED};
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &frame));
    frame = (hal_can_frame_t){.id = 0x065, .flags = HAL_CAN_EXTENDED};
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &frame));
    TEST_ASSERT_TRUE(port_send(&hal, 0x101));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    (void)port_drain(&hal);
    vcan_expect_id(tester, 0x10F);
    vcan_expect_id(tester, CAN_EFF_FLAG | 0x065); /* the first 11 bits of it are 0 */
    vcan_expect_id(tester, 0x100);
    vcan_expect_id(tester, 0x101);
    vcan_expect_id(tester, CAN_EFF_FLAG | (0x101u << 18));
}

void test_sixteen_frames_may_wait_behind_the_one_in_flight(void) {
    for (unsigned i = 0; i < 16; i++) {
        TEST_ASSERT_TRUE(port_send(&hal, 0x100 + i));
    }
    TEST_ASSERT_TRUE(port_send(&hal, 0x065));
    TEST_ASSERT_FALSE(port_send(&hal, 0x066));
    (void)port_drain(&hal);
    TEST_ASSERT_EQUAL_UINT(17, left.count);
    TEST_ASSERT_TRUE(port_send(&hal, 0x065));
}

void test_frames_that_cannot_be_sent_are_refused(void) {
    const hal_can_frame_t frames[] = {{.id = 0x800},
                                      {.id = 0x100, .length = 9},
                                      {.id = 0x100, .flags = HAL_CAN_FD},
                                      {.id = 0x100, .flags = HAL_CAN_ERROR}};
    for (unsigned waiting = 0; waiting < 2; waiting++) {
        for (unsigned i = 0; i < 4; i++) {
            TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_VEHICLE, &frames[i]));
        }
        TEST_ASSERT_TRUE(port_send(&hal, 0x100)); /* from here on one frame is in flight */
    }
}

/* Shows: SUP-7 */
void test_a_full_kernel_queue_refuses_a_frame(void) {
    vcan_stick();
    for (unsigned i = 0; i < VCAN_STUCK_MAX; i++) {
        TEST_ASSERT_TRUE(port_send(&hal, 0x100));
        (void)port_drain(&hal);
    }
    vcan_drain(tester);
    for (unsigned i = 0; i < 3; i++) {
        TEST_ASSERT_FALSE(port_send(&hal, 0x100));
        TEST_ASSERT_EQUAL_UINT32(0, pending_ms());
    }
    vcan_unstick();
    port_run_ms(&hal, 3);
    vcan_expect_nothing(tester); /* refused, so not sent later either */
    TEST_ASSERT_TRUE(port_send(&hal, 0x101));
    vcan_expect_id(tester, 0x101);
}

void test_a_waiting_frame_is_tried_again_in_ticks_only(void) {
    vcan_stick();
    TEST_ASSERT_TRUE(port_send(&hal, 0x10F));
    TEST_ASSERT_TRUE(port_send(&hal, 0x101));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    fill_kernel_queue();
    (void)port_drain(&hal); /* 10Fh was sent, 100h is tried and finds no room */
    TEST_ASSERT_EQUAL_UINT(1, left.count);
    const unsigned before = vcan_dropped();
    for (unsigned i = 0; i < 1000; i++) {
        port_received_t received;
        TEST_ASSERT_FALSE(linux_hal_receive(&hal, &received.side, &received.frame, &received.at_us));
    }
    TEST_ASSERT_EQUAL_UINT(before, vcan_dropped());
    for (unsigned i = 0; i < 10; i++) {
        (void)linux_hal_tick(&hal);
    }
    TEST_ASSERT_EQUAL_UINT(before + 10, vcan_dropped());
    TEST_ASSERT_TRUE(port_send(&hal, 0x105)); /* it waits behind 100h and is not tried */
    TEST_ASSERT_EQUAL_UINT(before + 10, vcan_dropped());
    vcan_unstick();
    vcan_drain(tester);
    (void)linux_hal_tick(&hal);
    (void)port_drain(&hal);
    vcan_expect_id(tester, 0x100);
    vcan_expect_id(tester, 0x101);
    vcan_expect_id(tester, 0x105);
    vcan_expect_nothing(tester);
}

void test_the_age_of_waiting_frames_grows(void) {
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    vcan_pause_ms(20);
    TEST_ASSERT_EQUAL_UINT32(1, pending_ms()); /* the echo lies unread, so it is not a late one */
    const uint64_t taken_us = linux_hal_now_us(&hal);
    TEST_ASSERT_TRUE(port_send(&hal, 0x10F));
    vcan_stick();
    fill_kernel_queue();
    (void)port_drain(&hal); /* 100h was sent: the age is now that of 10Fh, which finds no room */
    vcan_pause_ms(30);
    (void)port_drain(&hal);
    const uint32_t age_ms = pending_ms();
    TEST_ASSERT_TRUE(age_ms >= 30);
    TEST_ASSERT_TRUE(age_ms <= (linux_hal_now_us(&hal) - taken_us) / 1000);
}

/* Shows: SUP-7 */
void test_after_a_purge_only_the_frame_in_the_kernel_is_sent(void) {
    TEST_ASSERT_TRUE(port_send(&hal, 0x10F));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    TEST_ASSERT_TRUE(port_send(&hal, 0x101));
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT32(0, pending_ms());
    TEST_ASSERT_TRUE(port_send(&hal, 0x102)); /* waits until 10Fh was sent: never two frames in the kernel */
    TEST_ASSERT_TRUE(pending_ms() >= 1);
    vcan_expect_id(tester, 0x10F);
    vcan_expect_nothing(tester);
    port_run_ms(&hal, 3);
    vcan_expect_id(tester, 0x102);
    vcan_expect_nothing(tester);
    TEST_ASSERT_EQUAL_UINT(2, left.count);
    TEST_ASSERT_EQUAL_UINT32(0, pending_ms());
}

void test_a_lost_echo_does_not_block_the_queue(void) {
    const hal_can_frame_t foreign = vcan_frame(0x105);
    for (unsigned i = 0; i < 2000; i++) {
        vcan_send(tester, 0x105, 8, foreign.data);
    }
    vcan_pause_ms(VCAN_SETTLED_MS);
    TEST_ASSERT_TRUE(port_send(&hal, 0x100)); /* its echo finds no room in the socket */
    TEST_ASSERT_TRUE(port_send(&hal, 0x101));
    const unsigned received = port_drain(&hal);
    TEST_ASSERT_TRUE(received > 10 && received < 2000);
    port_run_ms(&hal, 3);
    TEST_ASSERT_EQUAL_UINT(0, left.count);
    vcan_drain(tester);
    vcan_send(tester, 0x105, 8, foreign.data); /* with it the kernel reports the loss */
    port_run_ms(&hal, 3);
    vcan_expect_id(tester, 0x101);
    vcan_expect_nothing(tester);
    TEST_ASSERT_EQUAL_UINT(1, left.count);
    TEST_ASSERT_EQUAL_UINT32(0, pending_ms());
    TEST_ASSERT_EQUAL_UINT16(2000 - received + 1, port_status(&hal, HAL_CAN_VEHICLE).overrun_count);
}

void test_a_loss_before_a_frame_was_sent_does_not_affect_it(void) {
    const hal_can_frame_t foreign = vcan_frame(0x105);
    for (unsigned i = 0; i < 2000; i++) {
        vcan_send(tester, 0x105, 8, foreign.data);
    }
    TEST_ASSERT_TRUE(port_drain(&hal) < 2000);
    vcan_send(tester, 0x105, 8, foreign.data);
    vcan_pause_ms(VCAN_SETTLED_MS);
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    TEST_ASSERT_TRUE(port_send(&hal, 0x101));
    vcan_drain(tester);
    TEST_ASSERT_EQUAL_HEX32(0x105, port_receive(&hal).frame.id); /* reports the loss, and came before 100h */
    TEST_ASSERT_TRUE(port_status(&hal, HAL_CAN_VEHICLE).overrun_count > 0);
    TEST_ASSERT_TRUE(hal.sides[HAL_CAN_VEHICLE].in_flight);
    vcan_expect_nothing(tester);
    (void)port_drain(&hal);
    vcan_expect_id(tester, 0x101);
}

void test_a_port_that_finishes_sends_waiting_frames(void) {
    const hal_can_frame_t foreign = vcan_frame(0x105);
    TEST_ASSERT_TRUE(port_send(&hal, 0x065));
    TEST_ASSERT_TRUE(port_send(&hal, 0x101));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    vcan_send(tester, 0x105, 8, foreign.data); /* received frames do not delay it */
    linux_hal_finish(&hal);
    TEST_ASSERT_EQUAL_UINT32(0, pending_ms());
    vcan_expect_id(tester, 0x065);
    vcan_expect_id(tester, 0x100);
    vcan_expect_id(tester, 0x101);
    vcan_expect_nothing(tester);
    TEST_ASSERT_EQUAL_UINT(3, left.count);
}

void test_a_port_that_finishes_tries_a_full_kernel_again(void) {
    vcan_stick();
    TEST_ASSERT_TRUE(port_send(&hal, 0x10F));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    fill_kernel_queue();
    const unsigned before = vcan_dropped();
    const uint64_t began_us = linux_hal_now_us(&hal);
    linux_hal_finish(&hal);
    const uint64_t took_us = linux_hal_now_us(&hal) - began_us;
    TEST_ASSERT_EQUAL_UINT(1, left.count);
    TEST_ASSERT_TRUE(took_us >= LINUX_HAL_FINISH_MS * 1000); /* it ends after its limit, not earlier */
    const unsigned tries = vcan_dropped() - before;
    TEST_ASSERT_TRUE(tries > 1 && tries <= LINUX_HAL_FINISH_MS + 2); /* one try a millisecond: no busy loop */
}

void test_a_port_that_finishes_does_not_send_on_a_side_that_is_down(void) {
    TEST_ASSERT_TRUE(port_send(&hal, 0x10F));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    vcan_down("vcan0");
    (void)linux_hal_tick(&hal);
    vcan_up("vcan0");
    linux_hal_finish(&hal);
    linux_hal_close(&hal);
    TEST_ASSERT_EQUAL_UINT(1, left.count);
    TEST_ASSERT_EQUAL_HEX32(0x10F, left.frames[0].id);
}

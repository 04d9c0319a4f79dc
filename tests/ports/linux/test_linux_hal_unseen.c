/* What the port does when an echo or an error frame does not come: without interfaces, at times that the test says. A pair of
 * sockets is the kernel, which takes frames and does with them what it likes. */
#include <sys/socket.h>
#include <unistd.h>

#include <linux/can/error.h>

#include "linux_hal_internal.h"
#include "unity.h"

enum { MS = 1000 };

static linux_hal_side_t side;
static int kernel;

void setUp(void) {
    int ends[2];
    TEST_ASSERT_EQUAL_INT(0, socketpair(AF_UNIX, SOCK_DGRAM | SOCK_NONBLOCK, 0, ends));
    side = (linux_hal_side_t){.can = {.fd = ends[0]}, .is_open = true, .is_up = true};
    kernel = ends[1];
}

void tearDown(void) {
    (void)close(side.can.fd);
    (void)close(kernel);
}

static hal_can_frame_t frame_of(uint32_t id) {
    return (hal_can_frame_t){.id = id, .length = 1, .data = {0x11}};
}

static void send_at(uint32_t id, uint64_t now_us) {
    const hal_can_frame_t frame = frame_of(id);
    TEST_ASSERT_TRUE(linux_hal_queue_take(&side, &frame, now_us));
    linux_hal_queue_give(&side, now_us);
}

static void echo(uint32_t id) {
    const hal_can_frame_t frame = frame_of(id);
    linux_hal_queue_left(&side, &frame);
}

/* Frames that the kernel was given since the last call. */
static unsigned given(void) {
    char bytes[72];
    unsigned count = 0;
    while (recv(kernel, bytes, sizeof bytes, MSG_DONTWAIT) > 0) {
        count++;
    }
    return count;
}

static void error_frame(uint32_t classes) {
    const hal_can_frame_t frame = {.id = classes, .flags = HAL_CAN_ERROR, .length = 8};
    linux_hal_controller_error(&side, &frame);
}

/* Shows: SUP-7 */
void test_after_a_purge_a_frame_whose_echo_was_lost_holds_nothing_up(void) {
    send_at(0x7F0, 5 * MS);
    TEST_ASSERT_EQUAL_UINT32(101, linux_hal_queue_pending_ms(&side, 106 * MS)); /* the supervisor trips, and purges */
    linux_hal_queue_purge(&side, 106 * MS);
    TEST_ASSERT_EQUAL_UINT32(0, linux_hal_queue_pending_ms(&side, 106 * MS));
    send_at(0x075, 106 * MS);
    TEST_ASSERT_EQUAL_UINT(2, given());
    echo(0x075);
    send_at(0x168, 107 * MS);
    TEST_ASSERT_EQUAL_UINT(1, given());
}

/* Shows: SUP-7 */
void test_a_purge_waits_for_the_echo_of_a_frame_that_was_given_just_now(void) {
    send_at(0x7F0, 5 * MS);
    linux_hal_queue_purge(&side, 105 * MS);
    send_at(0x075, 105 * MS);
    TEST_ASSERT_EQUAL_UINT(1, given());
    echo(0x7F0);
    linux_hal_queue_give(&side, 106 * MS);
    TEST_ASSERT_EQUAL_UINT(1, given());
}

/* The supervisor withdraws all frames every 101 ms while the bus is blocked. Each frame given up is one more in the kernel. */
/* Shows: SUP-7 */
void test_few_frames_gather_in_a_kernel_that_is_blocked(void) {
    uint64_t now_us = 0;
    for (unsigned i = 0; i < 100; i++) {
        linux_hal_queue_purge(&side, now_us);
        send_at(0x065, now_us);
        now_us += 101 * MS;
    }
    TEST_ASSERT_EQUAL_UINT(7, given()); /* at 0, 0.1, 0.3, 0.7, 1.5, 3.1 and 6.4 s */
    for (unsigned i = 0; i < 100; i++) {
        linux_hal_queue_purge(&side, now_us);
        send_at(0x065, now_us);
        now_us += 13000 * MS;
    }
    TEST_ASSERT_EQUAL_UINT(99, given()); /* all but the first: the patience has a limit */
}

void test_an_echo_ends_the_patience(void) {
    for (unsigned i = 0; i < 4; i++) {
        linux_hal_queue_purge(&side, (uint64_t)i * 5000 * MS);
        send_at(0x075, (uint64_t)i * 5000 * MS);
    }
    TEST_ASSERT_EQUAL_UINT(4, given());
    echo(0x075);
    send_at(0x168, 20000 * MS);
    linux_hal_queue_purge(&side, 20101 * MS);
    send_at(0x43F, 20101 * MS);
    TEST_ASSERT_EQUAL_UINT(2, given());
}

/* Nobody purges the AI side, nor the vehicle side before there is a vehicle. The stall is reported long before. */
void test_without_a_purge_a_lost_echo_holds_nothing_up_after_a_second(void) {
    send_at(0x363, 0);
    send_at(0x067, 10 * MS);
    linux_hal_queue_look(&side, 1000 * MS);
    linux_hal_queue_give(&side, 1000 * MS);
    TEST_ASSERT_EQUAL_UINT32(1000, linux_hal_queue_pending_ms(&side, 1000 * MS));
    TEST_ASSERT_EQUAL_UINT(1, given());
    linux_hal_queue_look(&side, 1001 * MS);
    linux_hal_queue_give(&side, 1001 * MS);
    TEST_ASSERT_EQUAL_UINT(1, given());
    TEST_ASSERT_EQUAL_UINT32(
        991, linux_hal_queue_pending_ms(&side, 1001 * MS)); /* the stall goes on until that one leaves */
    echo(0x067);
    TEST_ASSERT_EQUAL_UINT32(0, linux_hal_queue_pending_ms(&side, 1002 * MS));
}

void test_a_late_echo_is_not_taken_for_that_of_another_frame(void) {
    send_at(0x7F0, 0);
    linux_hal_queue_purge(&side, 101 * MS);
    send_at(0x075, 101 * MS);
    echo(0x7F0); /* after all */
    TEST_ASSERT_TRUE(side.in_flight);
    send_at(0x168, 102 * MS);
    TEST_ASSERT_EQUAL_UINT(2, given());
    echo(0x075);
    linux_hal_queue_give(&side, 103 * MS);
    TEST_ASSERT_EQUAL_UINT(1, given());
}

/* They cannot be told apart: then two frames are in the kernel until the second echo comes, and no more. */
void test_a_late_echo_of_an_equal_frame_counts_as_that_of_the_frame_in_flight(void) {
    send_at(0x075, 0);
    linux_hal_queue_purge(&side, 101 * MS);
    send_at(0x075, 101 * MS);
    echo(0x075);
    send_at(0x168, 102 * MS);
    send_at(0x43F, 102 * MS);
    TEST_ASSERT_EQUAL_UINT(3, given());
    echo(0x075);
    linux_hal_queue_give(&side, 103 * MS);
    TEST_ASSERT_EQUAL_UINT(0, given());
    echo(0x168);
    linux_hal_queue_give(&side, 104 * MS);
    TEST_ASSERT_EQUAL_UINT(1, given());
}

void test_the_age_of_a_frame_is_that_up_to_which_echoes_were_read(void) {
    send_at(0x075, 50 * MS);
    TEST_ASSERT_EQUAL_UINT32(1, linux_hal_queue_pending_ms(&side, 49 * MS));
    TEST_ASSERT_EQUAL_UINT32(1, linux_hal_queue_pending_ms(&side, 50 * MS));
    TEST_ASSERT_EQUAL_UINT32(70, linux_hal_queue_pending_ms(&side, 120 * MS));
}

/* Shows: SUP-7 */
void test_a_restart_says_that_there_was_a_bus_off(void) {
    send_at(0x7F0, 0);
    send_at(0x075, 0);
    error_frame(CAN_ERR_RESTARTED);
    TEST_ASSERT_EQUAL(HAL_CAN_ERROR_ACTIVE, side.state);
    TEST_ASSERT_EQUAL_UINT16(1, side.bus_offs);
    TEST_ASSERT_FALSE(side.in_flight);
    TEST_ASSERT_EQUAL_UINT(0, side.waiting_count);
    error_frame(CAN_ERR_BUSOFF);
    error_frame(CAN_ERR_RESTARTED);
    TEST_ASSERT_EQUAL_UINT16(2, side.bus_offs);
}

/* Shows: SUP-7 */
void test_a_bus_off_whose_error_frame_was_lost_is_found(void) {
    send_at(0x7F0, 0);
    send_at(0x075, 0);
    linux_hal_controller_asked(&side, HAL_CAN_ERROR_PASSIVE);
    TEST_ASSERT_EQUAL(HAL_CAN_ERROR_ACTIVE, side.state); /* only error frames say this */
    linux_hal_controller_asked(&side, HAL_CAN_BUS_OFF);
    TEST_ASSERT_EQUAL(HAL_CAN_BUS_OFF, side.state);
    TEST_ASSERT_EQUAL_UINT16(1, side.bus_offs);
    TEST_ASSERT_EQUAL_UINT(0, side.waiting_count);
    TEST_ASSERT_FALSE(side.in_flight);
    linux_hal_controller_asked(&side, HAL_CAN_BUS_OFF);
    error_frame(CAN_ERR_BUSOFF); /* read later */
    TEST_ASSERT_EQUAL_UINT16(1, side.bus_offs);
}

/* The second look comes 100 ms later: by then the error frame was read, if there is one. */
void test_the_end_of_a_bus_off_is_found_at_the_second_look(void) {
    error_frame(CAN_ERR_BUSOFF);
    linux_hal_controller_asked(&side, HAL_CAN_ERROR_ACTIVE);
    linux_hal_controller_asked(&side, HAL_CAN_BUS_OFF);
    linux_hal_controller_asked(&side, HAL_CAN_ERROR_PASSIVE);
    TEST_ASSERT_EQUAL(HAL_CAN_BUS_OFF, side.state);
    linux_hal_controller_asked(&side, HAL_CAN_ERROR_PASSIVE);
    TEST_ASSERT_EQUAL(HAL_CAN_ERROR_PASSIVE, side.state);
    TEST_ASSERT_EQUAL_UINT16(1, side.bus_offs);
    error_frame(CAN_ERR_BUSOFF);
    linux_hal_controller_asked(&side, HAL_CAN_ERROR_ACTIVE);
    TEST_ASSERT_EQUAL(HAL_CAN_BUS_OFF, side.state);
    TEST_ASSERT_EQUAL_UINT16(2, side.bus_offs);
}

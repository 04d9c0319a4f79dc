/* The port: opening, receiving from one and two interfaces, and the functions without hardware. */
#include <string.h>

#include "hal_linux/linux_hal.h"
#include "port.h"
#include "unity.h"
#include "vcan.h"

static hal_t hal;
static port_left_t left;

void setUp(void) {
    vcan_begin();
    memset(&hal, 0, sizeof hal);
    hal.sides[HAL_CAN_VEHICLE].can.fd = hal.sides[HAL_CAN_AI].can.fd = -1;
}

void tearDown(void) {
    linux_hal_close(&hal);
    vcan_restore();
}

static void expect_refusal(const char *vehicle, const char *ai, const char *line) {
    char error[LINUX_CAN_ERROR_SIZE];
    const linux_hal_config_t config = {.interfaces = {[HAL_CAN_VEHICLE] = vehicle, [HAL_CAN_AI] = ai}};
    TEST_ASSERT_FALSE(linux_hal_open(&hal, &config, error));
    TEST_ASSERT_EQUAL_STRING(line, error);
    TEST_ASSERT_EQUAL_INT(-1, linux_hal_fd(&hal, HAL_CAN_VEHICLE));
    TEST_ASSERT_EQUAL_INT(-1, linux_hal_fd(&hal, HAL_CAN_AI));
}

void test_an_interface_that_cannot_be_opened_is_named(void) {
    expect_refusal("lo", "vcan1", "lo: not a CAN interface");
    expect_refusal("vcan0", "vcan9", "vcan9: there is no such interface");
    expect_refusal("vcan0", "vcan0", "vcan0: both sides on one interface: a gateway needs two");
    expect_refusal(NULL, "vcan0", "the interface of the vehicle side is missing");
}

void test_a_second_name_is_no_second_interface(void) {
    vcan_run("ip link property add dev vcan0 altname vehicle-bus");
    expect_refusal("vcan0", "vehicle-bus", "vehicle-bus: both sides on one interface: a gateway needs two");
    vcan_run("ip link property del dev vcan0 altname vehicle-bus");
}

void test_a_fresh_port(void) {
    port_open(&hal, "vcan0", NULL, NULL);
    TEST_ASSERT_TRUE(linux_hal_fd(&hal, HAL_CAN_VEHICLE) >= 0);
    TEST_ASSERT_EQUAL_INT(-1, linux_hal_fd(&hal, HAL_CAN_AI));
    const hal_can_status_t status = port_status(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL(HAL_CAN_ERROR_ACTIVE, status.state);
    TEST_ASSERT_EQUAL_UINT32(0, status.tx_pending_ms);
    TEST_ASSERT_EQUAL_UINT16(0, status.bus_off_count);
    TEST_ASSERT_EQUAL_UINT16(0, status.overrun_count);
    TEST_ASSERT_FALSE(hal.led_on);
    TEST_ASSERT_FALSE(hal.output_closed);
    TEST_ASSERT_FALSE(linux_hal_tick(&hal));
    port_receive_nothing(&hal);
}

void test_a_side_that_does_not_exist(void) {
    port_open(&hal, "vcan0", NULL, NULL);
    const hal_can_frame_t frame = vcan_frame(0x100);
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_AI, &frame));
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_SIDES, &frame));
    hal_can_purge(&hal, HAL_CAN_AI);
    hal_can_recover(&hal, HAL_CAN_AI);
    const hal_can_status_t status = port_status(&hal, HAL_CAN_AI);
    TEST_ASSERT_EQUAL(HAL_CAN_ERROR_ACTIVE, status.state);
    TEST_ASSERT_EQUAL_UINT32(0, status.tx_pending_ms + status.bus_off_count + status.overrun_count);
}

void test_the_parts_without_hardware(void) {
    const uint8_t record[4] = {1, 2, 3, 4};
    uint8_t read[8] = {0};
    port_open(&hal, "vcan0", NULL, NULL);
    TEST_ASSERT_EQUAL(HAL_RESET_POWER_ON, hal_reset_cause(&hal));
    hal_led_set(&hal, true);
    hal_safety_output_set(&hal, true);
    hal_watchdog_feed(&hal);
    hal_watchdog_feed(&hal);
    TEST_ASSERT_TRUE(hal.led_on);
    TEST_ASSERT_TRUE(hal.output_closed);
    TEST_ASSERT_EQUAL_UINT32(2, hal.feeds);
    TEST_ASSERT_EQUAL_UINT(0, hal_store_read_latch(&hal, read, sizeof read));
    TEST_ASSERT_TRUE(hal_store_write_latch(&hal, record, sizeof record));
    TEST_ASSERT_EQUAL_UINT(4, hal_store_read_latch(&hal, read, sizeof read));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(record, read, 4);
    TEST_ASSERT_EQUAL_HEX8(0, read[4]);
    memset(read, 0, sizeof read);
    TEST_ASSERT_EQUAL_UINT(4, hal_store_read_latch(&hal, read, 2));
    TEST_ASSERT_EQUAL_HEX8(2, read[1]);
    TEST_ASSERT_EQUAL_HEX8(0, read[2]);
    TEST_ASSERT_FALSE(hal_store_write_latch(&hal, hal.sides, HAL_STORE_LATCH_SIZE_MAX + 1));
    TEST_ASSERT_FALSE(hal_store_write_latch(&hal, record, 0));
    TEST_ASSERT_FALSE(hal_store_append(&hal, record, sizeof record));
    TEST_ASSERT_EQUAL_UINT(0, hal_store_read_record(&hal, 0, read, sizeof read));
}

void test_the_clock_is_the_one_of_the_stamps(void) {
    port_open(&hal, "vcan0", NULL, NULL);
    const int tester = vcan_open("vcan0");
    vcan_pause_ms(10);
    TEST_ASSERT_TRUE(hal_clock_now_ms(&hal) >= 10);
    const uint64_t before_us = linux_hal_now_us(&hal);
    vcan_send(tester, 0x100, 8, vcan_frame(0).data);
    const uint64_t after_us = linux_hal_now_us(&hal);
    vcan_pause_ms(100); /* it waits in the socket and must not look fresh */
    const port_received_t received = port_receive(&hal);
    TEST_ASSERT_TRUE(received.at_us + 100 >= before_us); /* reading two clocks takes its time */
    TEST_ASSERT_TRUE(received.at_us <= after_us + 2);
    TEST_ASSERT_EQUAL_UINT32(received.at_us / 1000, received.frame.time_ms);
    TEST_ASSERT_EQUAL_UINT16(received.at_us % 1000, received.frame.time_us);
    TEST_ASSERT_TRUE(hal_clock_now_ms(&hal) >= received.frame.time_ms + 100);
}

void test_each_side_receives_from_its_own_interface(void) {
    port_open(&hal, "vcan0", "vcan1", NULL);
    const int vehicle = vcan_open("vcan0");
    const int ai = vcan_open("vcan1");
    const hal_can_frame_t frame = vcan_frame(0x105);
    vcan_send(ai, 0x110, 8, frame.data); /* not in use */
    vcan_send(ai, 0x100, 8, frame.data);
    TEST_ASSERT_EQUAL(HAL_CAN_AI, port_receive(&hal).side);
    vcan_send(vehicle, 0x100, 8, frame.data);
    TEST_ASSERT_EQUAL(HAL_CAN_VEHICLE, port_receive(&hal).side);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_AI, &frame));
    vcan_expect(ai, 0x105, 8, frame.data);
    vcan_expect_nothing(vehicle);
}

void test_frames_of_two_interfaces_come_in_the_order_of_their_arrival(void) {
    static const char ORDER[] = "VAAVVVAVAAAAVVAV";
    port_open(&hal, "vcan0", "vcan1", NULL);
    const int vehicle = vcan_open("vcan0");
    const int ai = vcan_open("vcan1");
    for (uint8_t i = 0; i < 16; i++) {
        const uint8_t data[8] = {i};
        vcan_send((ORDER[i] == 'V') ? vehicle : ai, 0x100, 1, data);
        vcan_pause_ms(1);
    }
    vcan_pause_ms(VCAN_SETTLED_MS);
    uint64_t last_us = 0;
    for (uint8_t i = 0; i < 16; i++) {
        const port_received_t received = port_receive(&hal);
        TEST_ASSERT_EQUAL_UINT8(i, received.frame.data[0]);
        TEST_ASSERT_EQUAL((ORDER[i] == 'V') ? HAL_CAN_VEHICLE : HAL_CAN_AI, received.side);
        TEST_ASSERT_TRUE(received.at_us >= last_us);
        last_us = received.at_us;
    }
    port_receive_nothing(&hal);
}

/* Shows: TOP-1 */
void test_own_frames_are_reported_and_never_received(void) {
    port_open(&hal, "vcan0", NULL, &left);
    const int tester = vcan_open("vcan0");
    const hal_can_frame_t frame = vcan_frame(0x065);
    const uint64_t before_us = linux_hal_now_us(&hal);
    TEST_ASSERT_TRUE(port_send(&hal, 0x065));
    const uint64_t after_us = linux_hal_now_us(&hal);
    port_receive_nothing(&hal);
    vcan_expect(tester, 0x065, 8, frame.data);
    TEST_ASSERT_EQUAL_UINT(1, left.count);
    TEST_ASSERT_EQUAL(HAL_CAN_VEHICLE, left.sides[0]);
    TEST_ASSERT_EQUAL_HEX32(0x065, left.frames[0].id);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(frame.data, left.frames[0].data, 8);
    TEST_ASSERT_EQUAL_UINT32(left.at_us[0] / 1000, left.frames[0].time_ms);
    TEST_ASSERT_TRUE(left.at_us[0] + 100 >= before_us);
    TEST_ASSERT_TRUE(left.at_us[0] <= after_us + 2);
    vcan_send(tester, 0x065, 8, frame.data); /* the same frame from another program of this computer */
    const port_received_t foreign = port_receive(&hal);
    TEST_ASSERT_EQUAL_HEX32(0x065, foreign.frame.id);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(frame.data, foreign.frame.data, 8);
    TEST_ASSERT_EQUAL_UINT(1, left.count);
}

/* Of three frames the first is in the kernel and was sent; the other two are never sent. */
void test_sent_frames_are_reported_at_the_close_and_nothing_follows(void) {
    port_open(&hal, "vcan0", NULL, &left);
    const int tester = vcan_open("vcan0");
    const hal_can_frame_t frame = vcan_frame(0x065);
    TEST_ASSERT_TRUE(port_send(&hal, 0x065));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    vcan_expect(tester, 0x065, 8, frame.data);
    TEST_ASSERT_EQUAL_UINT(0, left.count); /* its echo has not been read yet */
    linux_hal_close(&hal);
    TEST_ASSERT_EQUAL_UINT(1, left.count);
    TEST_ASSERT_EQUAL_HEX32(0x065, left.frames[0].id);
    vcan_expect_nothing(tester);
}

void test_the_ai_side_is_closed_first(void) {
    port_open(&hal, "vcan0", "vcan1", &left);
    const hal_can_frame_t frame = vcan_frame(0x100);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &frame));
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_AI, &frame));
    linux_hal_close(&hal); /* a side reports its last frame when it is closed */
    TEST_ASSERT_EQUAL_UINT(2, left.count);
    TEST_ASSERT_EQUAL(HAL_CAN_AI, left.sides[0]);
    TEST_ASSERT_EQUAL(HAL_CAN_VEHICLE, left.sides[1]);
}

void test_a_closed_port_does_nothing(void) {
    port_open(&hal, "vcan0", "vcan1", NULL);
    const int tester = vcan_open("vcan0");
    linux_hal_close(&hal);
    TEST_ASSERT_FALSE(port_send(&hal, 0x100));
    vcan_send(tester, 0x100, 8, vcan_frame(0).data);
    port_receive_nothing(&hal);
    vcan_expect_nothing(tester);
}

/* Errors: error frames, lost frames, interfaces that go down or are removed. A tester sends the error frames. */

#include "one_port.h"

static void expect_status(hal_can_state_t state, unsigned bus_offs, unsigned overruns) {
    const hal_can_status_t status = port_status(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL(state, status.state);
    TEST_ASSERT_EQUAL_UINT16(bus_offs, status.bus_off_count);
    TEST_ASSERT_EQUAL_UINT16(overruns, status.overrun_count);
}

/* Send an error frame; the port also passes it on. */
static void error_frame(uint32_t classes, uint8_t controller) {
    vcan_send_error(tester, classes, controller);
    const port_received_t received = port_receive(&hal);
    TEST_ASSERT_EQUAL_HEX8(HAL_CAN_ERROR, received.frame.flags);
    TEST_ASSERT_EQUAL_HEX32(classes, received.frame.id);
}

static void expect_status_after(uint32_t classes, uint8_t controller, hal_can_state_t state, unsigned bus_offs,
                                unsigned overruns) {
    error_frame(classes, controller);
    expect_status(state, bus_offs, overruns);
}

/* Receives, and a tick, which reports a file that has changed meanwhile, and no other. */
static bool tick(void) {
    const int fd = linux_hal_fd(&hal, HAL_CAN_VEHICLE);
    (void)port_drain(&hal);
    const bool changed = linux_hal_tick(&hal);
    TEST_ASSERT_EQUAL(fd != linux_hal_fd(&hal, HAL_CAN_VEHICLE), changed);
    return changed;
}

/* Ticks until the state is reported. @return whether a file has changed meanwhile */
static bool run_until(hal_can_state_t state) {
    bool changed = false;
    for (unsigned i = 0; port_status(&hal, HAL_CAN_VEHICLE).state != state; i++) {
        TEST_ASSERT_TRUE(i < VCAN_SOON_MS / VCAN_SETTLED_MS);
        changed = tick() || changed;
    }
    return changed;
}

void test_error_passive_and_back(void) {
    expect_status_after(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE, HAL_CAN_ERROR_PASSIVE, 0, 0);
    expect_status_after(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING, HAL_CAN_ERROR_ACTIVE, 0, 0);
    expect_status_after(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE, HAL_CAN_ERROR_PASSIVE, 0, 0);
    expect_status_after(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_WARNING, HAL_CAN_ERROR_ACTIVE, 0, 0);
    expect_status_after(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_PASSIVE | CAN_ERR_CRTL_TX_WARNING, HAL_CAN_ERROR_PASSIVE, 0, 0);
    expect_status_after(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE, HAL_CAN_ERROR_ACTIVE, 0, 0);
}

void test_other_errors_change_nothing(void) {
    expect_status_after(CAN_ERR_PROT | CAN_ERR_ACK | CAN_ERR_BUSERROR, 0, HAL_CAN_ERROR_ACTIVE, 0, 0);
    error_frame(CAN_ERR_PROT, CAN_ERR_CRTL_TX_PASSIVE); /* without the class the byte does not concern the controller */
    expect_status(HAL_CAN_ERROR_ACTIVE, 0, 0);
    expect_status_after(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_OVERFLOW, HAL_CAN_ERROR_ACTIVE, 0, 0);
}

/* Shows: SUP-7 */
void test_an_overrun_of_the_controller_is_counted(void) {
    expect_status_after(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW, HAL_CAN_ERROR_ACTIVE, 0, 1);
    expect_status_after(CAN_ERR_CRTL, CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_RX_PASSIVE, HAL_CAN_ERROR_PASSIVE, 0, 2);
}

/* Shows: SUP-7 */
void test_bus_off_lasts_until_the_restart(void) {
    expect_status_after(CAN_ERR_BUSOFF, 0, HAL_CAN_BUS_OFF, 1, 0);
    error_frame(CAN_ERR_BUSOFF, 0);
    error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE);
    error_frame(CAN_ERR_CRTL, CAN_ERR_CRTL_TX_WARNING);
    port_run_ms(&hal, 5);
    hal_can_recover(&hal, HAL_CAN_VEHICLE); /* there is no controller to restart */
    port_run_ms(&hal, 5);
    expect_status(HAL_CAN_BUS_OFF, 1, 0);
    TEST_ASSERT_FALSE(port_send(&hal, 0x100));
    expect_status_after(CAN_ERR_RESTARTED, 0, HAL_CAN_ERROR_ACTIVE, 1, 0);
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    expect_status_after(CAN_ERR_BUSOFF, 0, HAL_CAN_BUS_OFF, 2, 0);
    expect_status_after(CAN_ERR_CRTL, CAN_ERR_CRTL_ACTIVE, HAL_CAN_ERROR_ACTIVE, 2, 0);
}

void test_a_restart_that_comes_with_passive(void) {
    error_frame(CAN_ERR_BUSOFF, 0);
    expect_status_after(CAN_ERR_RESTARTED | CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE, HAL_CAN_ERROR_PASSIVE, 1, 0);
}

/* Shows: SUP-7 */
void test_frames_that_wait_at_bus_off_are_never_sent(void) {
    vcan_send_error(tester, CAN_ERR_BUSOFF, 0); /* not read yet, when the supervisor sends */
    TEST_ASSERT_TRUE(port_send(&hal, 0x10F));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    TEST_ASSERT_TRUE(port_send(&hal, 0x101));
    TEST_ASSERT_EQUAL_HEX8(HAL_CAN_ERROR, port_receive(&hal).frame.flags);
    expect_status(HAL_CAN_BUS_OFF, 1, 0);
    TEST_ASSERT_EQUAL_UINT32(0, port_status(&hal, HAL_CAN_VEHICLE).tx_pending_ms);
    port_run_ms(&hal, 10);
    error_frame(CAN_ERR_RESTARTED, 0);
    port_run_ms(&hal, 10);
    vcan_expect_id(tester, 0x10F); /* the kernel had it; a real controller would have discarded it */
    vcan_expect_nothing(tester);
    TEST_ASSERT_EQUAL_UINT(1, left.count);
    TEST_ASSERT_TRUE(port_send(&hal, 0x102));
    vcan_expect_id(tester, 0x102);
}

/* Shows: SUP-7 */
void test_an_interface_that_goes_down_and_comes_back(void) {
    const hal_can_frame_t frame = vcan_frame(0x105);
    const int fd = linux_hal_fd(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_TRUE(port_send(&hal, 0x10F));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    vcan_expect_id(tester, 0x10F);
    vcan_down("vcan0");
    (void)port_drain(&hal);
    expect_status(HAL_CAN_BUS_OFF, 1, 0);
    TEST_ASSERT_EQUAL_UINT32(0, port_status(&hal, HAL_CAN_VEHICLE).tx_pending_ms);
    TEST_ASSERT_FALSE(port_send(&hal, 0x101));
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    port_run_ms(&hal, 10);
    expect_status(HAL_CAN_BUS_OFF, 1, 0);
    vcan_up("vcan0");
    vcan_drain(tester);
    TEST_ASSERT_FALSE(run_until(HAL_CAN_ERROR_ACTIVE));
    expect_status(HAL_CAN_ERROR_ACTIVE, 1, 0);
    TEST_ASSERT_EQUAL_INT(fd, linux_hal_fd(&hal, HAL_CAN_VEHICLE));
    port_run_ms(&hal, 5);
    vcan_expect_nothing(tester); /* 100h waited when it went down */
    TEST_ASSERT_TRUE(port_send(&hal, 0x102));
    vcan_expect_id(tester, 0x102);
    vcan_send(tester, 0x105, 8, frame.data);
    TEST_ASSERT_EQUAL_HEX32(0x105, port_receive(&hal).frame.id);
}

void test_an_interface_that_is_down_at_the_start(void) {
    linux_hal_close(&hal);
    vcan_down("vcan0");
    port_open(&hal, "vcan0", NULL, NULL);
    expect_status(HAL_CAN_BUS_OFF, 1, 0);
    TEST_ASSERT_FALSE(port_send(&hal, 0x100));
    vcan_up("vcan0");
    TEST_ASSERT_FALSE(run_until(HAL_CAN_ERROR_ACTIVE));
    expect_status(HAL_CAN_ERROR_ACTIVE, 1, 0);
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
}

void test_error_frames_from_before_it_went_down_do_not_bring_it_up(void) {
    error_frame(CAN_ERR_BUSOFF, 0);
    vcan_send_error(tester, CAN_ERR_RESTARTED, 0);
    vcan_down("vcan0");
    (void)port_drain(&hal);
    expect_status(HAL_CAN_BUS_OFF, 1, 0); /* it was in bus-off already */
    vcan_up("vcan0");
    (void)run_until(HAL_CAN_ERROR_ACTIVE);
    expect_status(HAL_CAN_ERROR_ACTIVE, 1, 0);
}

void test_an_adapter_that_is_unplugged_and_plugged_in_again(void) {
    const hal_can_frame_t frame = vcan_frame(0x105);
    TEST_ASSERT_TRUE(port_send(&hal, 0x10F));
    TEST_ASSERT_TRUE(port_send(&hal, 0x100));
    vcan_remove("vcan0");
    if (!run_until(HAL_CAN_BUS_OFF)) { /* it was down first, then gone */
        TEST_ASSERT_TRUE(tick());
    }
    expect_status(HAL_CAN_BUS_OFF, 1, 0);
    TEST_ASSERT_EQUAL_INT(-1, linux_hal_fd(&hal, HAL_CAN_VEHICLE));
    TEST_ASSERT_FALSE(linux_hal_tick(&hal)); /* reported once */
    TEST_ASSERT_FALSE(port_send(&hal, 0x101));
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    port_run_ms(&hal, 150);
    expect_status(HAL_CAN_BUS_OFF, 1, 0);
    vcan_add("vcan0");
    vcan_up("vcan0");
    tester = vcan_open("vcan0");
    const uint64_t back_us = linux_hal_now_us(&hal);
    TEST_ASSERT_TRUE(run_until(HAL_CAN_ERROR_ACTIVE));
    TEST_ASSERT_TRUE(linux_hal_now_us(&hal) - back_us < 1000000);
    expect_status(HAL_CAN_ERROR_ACTIVE, 1, 0);
    TEST_ASSERT_TRUE(linux_hal_fd(&hal, HAL_CAN_VEHICLE) >= 0);
    port_run_ms(&hal, 5);
    vcan_expect_nothing(tester); /* 100h waited when it went */
    TEST_ASSERT_TRUE(port_send(&hal, 0x102));
    vcan_expect_id(tester, 0x102);
    vcan_send(tester, 0x105, 8, frame.data);
    TEST_ASSERT_EQUAL_HEX32(0x105, port_receive(&hal).frame.id);
    vcan_send_error(tester, CAN_ERR_CRTL, CAN_ERR_CRTL_TX_PASSIVE); /* the options are those of the first socket */
    (void)port_receive(&hal);
    expect_status(HAL_CAN_ERROR_PASSIVE, 1, 0);
}

/* The fastest of several searches counts, because the computer may be busy. A search must not start a program
 * (modprobe). */
void test_looking_for_an_adapter_takes_no_time(void) {
    uint64_t quickest_us = UINT64_MAX;
    vcan_remove("vcan0");
    (void)run_until(HAL_CAN_BUS_OFF);
    for (unsigned i = 0; i < 5; i++) {
        vcan_pause_ms(110);
        const uint64_t before_us = linux_hal_now_us(&hal);
        (void)linux_hal_tick(&hal);
        const uint64_t took_us = linux_hal_now_us(&hal) - before_us;
        quickest_us = (took_us < quickest_us) ? took_us : quickest_us;
    }
    TEST_ASSERT_TRUE(quickest_us < 5000);
}

void test_one_side_works_without_the_other(void) {
    linux_hal_close(&hal);
    port_open(&hal, "vcan0", "vcan1", NULL);
    const int ai = vcan_open("vcan1");
    const hal_can_frame_t frame = vcan_frame(0x105);
    vcan_down("vcan0");
    vcan_send(ai, 0x105, 8, frame.data);
    TEST_ASSERT_EQUAL(HAL_CAN_AI, port_receive(&hal).side);
    expect_status(HAL_CAN_BUS_OFF, 1, 0);
    const hal_can_status_t status = port_status(&hal, HAL_CAN_AI);
    TEST_ASSERT_EQUAL(HAL_CAN_ERROR_ACTIVE, status.state);
    TEST_ASSERT_EQUAL_UINT16(0, status.bus_off_count);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_AI, &frame));
    vcan_expect_id(ai, 0x105);
}

/* The simulated port: controllers on a bus and without one, clock, outputs, watchdog, resets. */
#include <string.h>

#include "hal_sim/sim_hal.h"
#include "unity.h"

static sim_bus_t bus;
static sim_bus_t ai_bus;
static sim_store_t store;
static struct hal hal;
static sim_bus_node_t other;
static sim_bus_node_t ai_other;

static const hal_can_frame_t FRAME = {.id = 0x168, .length = 8, .data = {1, 2, 3}};

/* A port on two buses, with another node on each. */
static void init_on_bus(const sim_hal_config_t *config) {
    const sim_bus_node_config_t queue = {.rx_slots = 8};
    sim_bus_init(&bus, 500000);
    sim_bus_init(&ai_bus, 500000);
    sim_hal_init(&hal, config);
    TEST_ASSERT_TRUE(sim_hal_attach(&hal, HAL_CAN_VEHICLE, &bus, NULL));
    TEST_ASSERT_TRUE(sim_hal_attach(&hal, HAL_CAN_AI, &ai_bus, NULL));
    other = sim_bus_attach(&bus, &queue);
    ai_other = sim_bus_attach(&ai_bus, &queue);
}

static void run_until(uint64_t time_us) {
    sim_bus_t *const buses[2] = {&bus, &ai_bus};
    sim_bus_run_all_until(buses, 2, time_us);
}

static hal_can_status_t status_of(hal_can_side_t side) {
    hal_can_status_t status;
    hal_can_status(&hal, side, &status);
    return status;
}

void setUp(void) {
    memset(&hal, 0xA5, sizeof hal);
    sim_store_init(&store);
    init_on_bus(&(sim_hal_config_t){.store = &store});
}

/* ---- On a bus ---- */

void test_frames_come_and_go_on_the_side_that_they_belong_to(void) {
    hal_can_frame_t frame;
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    run_until(1000);
    TEST_ASSERT_TRUE(sim_bus_receive(&bus, other, &frame, NULL));
    TEST_ASSERT_EQUAL_HEX32(0x168, frame.id);
    TEST_ASSERT_FALSE(sim_bus_receive(&ai_bus, ai_other, &frame, NULL));
    TEST_ASSERT_FALSE(sim_hal_receive(&hal, HAL_CAN_VEHICLE, &frame)); /* never one of its own */
    sim_bus_send(&ai_bus, ai_other, &FRAME);
    run_until(2000);
    TEST_ASSERT_FALSE(sim_hal_receive(&hal, HAL_CAN_VEHICLE, &frame));
    TEST_ASSERT_TRUE(sim_hal_receive(&hal, HAL_CAN_AI, &frame));
    TEST_ASSERT_EQUAL_UINT32(1, frame.time_ms);
    TEST_ASSERT_FALSE(sim_hal_receive(&hal, HAL_CAN_AI, &frame));
    TEST_ASSERT_EQUAL_UINT32(1, hal.can[HAL_CAN_VEHICLE].sent);
    TEST_ASSERT_EQUAL_UINT32(1, hal.can[HAL_CAN_AI].received);
}

void test_a_side_can_be_attached_once_and_to_a_bus_with_room(void) {
    const sim_bus_node_config_t invalid = {.tx_slots = 99};
    TEST_ASSERT_FALSE(sim_hal_attach(&hal, HAL_CAN_VEHICLE, &bus, NULL));
    TEST_ASSERT_FALSE(sim_hal_attach(&hal, HAL_CAN_SIDES, &bus, NULL));
    sim_hal_init(&hal, NULL);
    TEST_ASSERT_FALSE(sim_hal_attach(&hal, HAL_CAN_AI, &bus, &invalid));
    TEST_ASSERT_TRUE(sim_hal_attach(&hal, HAL_CAN_AI, &bus, NULL));
    sim_hal_init_direct(&hal, NULL, 2, NULL, NULL);
    TEST_ASSERT_FALSE(sim_hal_attach(&hal, HAL_CAN_AI, &bus, NULL));
}

/* On the shared bus there is no AI side. */
void test_a_side_that_does_not_exist_refuses_and_reports_nothing(void) {
    hal_can_frame_t frame;
    sim_bus_init(&bus, 500000);
    sim_hal_init(&hal, NULL);
    TEST_ASSERT_EQUAL_UINT32(0, hal_clock_now_ms(&hal)); /* no bus yet: the time does not advance */
    sim_hal_attach(&hal, HAL_CAN_VEHICLE, &bus, NULL);
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_AI, &FRAME));
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_SIDES, &FRAME));
    TEST_ASSERT_FALSE(sim_hal_receive(&hal, HAL_CAN_AI, &frame));
    TEST_ASSERT_FALSE(sim_hal_receive(&hal, HAL_CAN_SIDES, &frame));
    sim_bus_run_until(&bus, 7000);
    TEST_ASSERT_EQUAL_UINT32(7, hal_clock_now_ms(&hal));
    hal_can_purge(&hal, HAL_CAN_AI);
    hal_can_recover(&hal, HAL_CAN_AI);
    sim_hal_add_overrun(&hal, HAL_CAN_AI);
    sim_hal_set_full(&hal, HAL_CAN_AI, true);
    sim_hal_set_tx_pending_ms(&hal, HAL_CAN_AI, 5);
    sim_hal_set_can_state(&hal, HAL_CAN_AI, HAL_CAN_BUS_OFF);
    const hal_can_status_t status = status_of(HAL_CAN_AI);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_ERROR_ACTIVE, status.state);
    TEST_ASSERT_EQUAL_UINT32(0, status.tx_pending_ms);
    TEST_ASSERT_EQUAL_UINT16(0, status.bus_off_count + status.overrun_count);
}

/* A port that joins a bus late: its watchdog starts then, and its clock is that of the bus time. */
void test_a_port_may_join_a_bus_that_has_run_for_long(void) {
    sim_bus_init(&bus, 500000);
    sim_bus_run_until(&bus, 500000);
    sim_hal_init(&hal, NULL);
    sim_hal_attach(&hal, HAL_CAN_VEHICLE, &bus, NULL);
    sim_hal_fail_at(&hal, 1, 1, SIM_HAL_OP_ALL);
    TEST_ASSERT_EQUAL_UINT32(500, hal_clock_now_ms(&hal));
    sim_bus_run_until(&bus, 600000);
    TEST_ASSERT_FALSE(sim_hal_poll(&hal));
}

void test_a_purge_reaches_the_controller(void) {
    sim_bus_set_stalled(&bus, hal.can[HAL_CAN_VEHICLE].node, true);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT32(0, status_of(HAL_CAN_VEHICLE).tx_pending_ms);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(&bus, hal.can[HAL_CAN_VEHICLE].node));
}

void test_a_recovery_request_counts_without_a_status_call(void) {
    sim_bus_force_bus_off(&bus, hal.can[HAL_CAN_VEHICLE].node);
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT32(1, hal.can[HAL_CAN_VEHICLE].recover_requests);
}

/* Shows: SUP-7 */
void test_bus_off_purge_and_recovery_through_the_port(void) {
    hal_can_recover(&hal, HAL_CAN_VEHICLE); /* not in bus-off: no request */
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    TEST_ASSERT_EQUAL_UINT32(1, status_of(HAL_CAN_VEHICLE).tx_pending_ms);
    sim_bus_force_bus_off(&bus, hal.can[HAL_CAN_VEHICLE].node);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_BUS_OFF, status_of(HAL_CAN_VEHICLE).state);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_ERROR_ACTIVE, status_of(HAL_CAN_AI).state);
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT32(1, hal.can[HAL_CAN_VEHICLE].recover_requests);
    TEST_ASSERT_EQUAL_UINT32(1, hal.can[HAL_CAN_VEHICLE].purges);
    TEST_ASSERT_EQUAL_UINT32(1, hal.can[HAL_CAN_VEHICLE].refused);
    run_until(2815);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_BUS_OFF, status_of(HAL_CAN_VEHICLE).state);
    run_until(2816); /* 128 x 11 bits of 2 us */
    TEST_ASSERT_EQUAL_INT(HAL_CAN_ERROR_ACTIVE, status_of(HAL_CAN_VEHICLE).state);
    TEST_ASSERT_EQUAL_UINT16(1, status_of(HAL_CAN_VEHICLE).bus_off_count);
    sim_hal_add_overrun(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT16(1, status_of(HAL_CAN_VEHICLE).overrun_count);
    sim_hal_set_full(&hal, HAL_CAN_VEHICLE, true);
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
}

void test_a_swallowed_frame_counts_as_sent_and_is_never_sent(void) {
    sim_hal_set_swallowing(&hal, HAL_CAN_VEHICLE, true);
    sim_hal_set_swallowing(&hal, HAL_CAN_SIDES, true); /* the side does not exist: no effect */
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    TEST_ASSERT_EQUAL_UINT32(1, hal.can[HAL_CAN_VEHICLE].sent);
    TEST_ASSERT_EQUAL_UINT32(0, status_of(HAL_CAN_VEHICLE).tx_pending_ms);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(&bus, hal.can[HAL_CAN_VEHICLE].node));
    sim_hal_set_swallowing(&hal, HAL_CAN_VEHICLE, false);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    TEST_ASSERT_EQUAL_size_t(1, sim_bus_waiting(&bus, hal.can[HAL_CAN_VEHICLE].node));
}

/* With a bus the controller's state comes from the bus and cannot be set. */
void test_on_a_bus_the_state_is_the_controllers(void) {
    sim_hal_set_can_state(&hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    sim_hal_set_tx_pending_ms(&hal, HAL_CAN_VEHICLE, 50);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_ERROR_ACTIVE, status_of(HAL_CAN_VEHICLE).state);
    TEST_ASSERT_EQUAL_UINT32(0, status_of(HAL_CAN_VEHICLE).tx_pending_ms);
}

/* ---- Clock ---- */

/* Shows: TIM-2 */
void test_the_clock_starts_anywhere_and_wraps(void) {
    hal_can_frame_t frame;
    init_on_bus(&(sim_hal_config_t){.clock_start_ms = UINT32_MAX - 1, .clock_phase_us = 700});
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFE, hal_clock_now_ms(&hal));
    run_until(299);
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFE, hal_clock_now_ms(&hal));
    run_until(300);
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFF, hal_clock_now_ms(&hal));
    run_until(1300 - 264);
    sim_bus_send(&bus, other, &FRAME); /* arrives 264 us later, at the wrap */
    run_until(1299);
    TEST_ASSERT_EQUAL_HEX32(0xFFFFFFFF, hal_clock_now_ms(&hal));
    run_until(1300);
    TEST_ASSERT_EQUAL_HEX32(0, hal_clock_now_ms(&hal));
    run_until(9000);
    TEST_ASSERT_TRUE(sim_hal_receive(&hal, HAL_CAN_VEHICLE, &frame));
    TEST_ASSERT_EQUAL_HEX32(0, frame.time_ms); /* the time of arrival, not of the call */
    TEST_ASSERT_EQUAL_UINT32(7, sim_hal_now_ms(&hal));
    TEST_ASSERT_EQUAL_UINT32(0xFFFFFFFF, sim_hal_clock_at(&hal, 1299));
}

/* ---- Outputs ---- */

void test_outputs_can_be_seen_and_their_changes_are_counted(void) {
    TEST_ASSERT_FALSE(hal.led.on || hal.safety_output.on);
    run_until(5000);
    hal_led_set(&hal, true);
    hal_safety_output_set(&hal, true);
    run_until(6000);
    hal_led_set(&hal, true);
    hal_safety_output_set(&hal, true);
    TEST_ASSERT_TRUE(hal.led.on && hal.safety_output.on);
    TEST_ASSERT_EQUAL_UINT32(5, hal.led.changed_ms);
    TEST_ASSERT_EQUAL_UINT32(5, hal.safety_output.changed_ms);
    hal_led_set(&hal, false);
    hal_safety_output_set(&hal, false);
    TEST_ASSERT_FALSE(hal.led.on || hal.safety_output.on);
    TEST_ASSERT_EQUAL_UINT32(2, hal.led.changes);
    TEST_ASSERT_EQUAL_UINT32(2, hal.safety_output.changes);
    TEST_ASSERT_EQUAL_UINT32(6, hal.safety_output.changed_ms);
}

/* ---- Watchdog ---- */

/* Shows: FSM-4, TIM-3 */
void test_the_watchdog_opens_the_output_and_holds_the_processor(void) {
    hal_can_frame_t frame;
    hal_safety_output_set(&hal, true);
    hal_led_set(&hal, true);
    run_until(50000);
    hal_watchdog_feed(&hal);
    run_until(150999); /* 100 ms later, by the clock */
    TEST_ASSERT_FALSE(sim_hal_poll(&hal));
    hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME);
    run_until(160000);
    TEST_ASSERT_TRUE(hal.safety_output.on);
    TEST_ASSERT_TRUE(sim_hal_poll(&hal));
    TEST_ASSERT_TRUE(sim_hal_poll(&hal));
    TEST_ASSERT_TRUE(hal.held);
    TEST_ASSERT_EQUAL_UINT32(1, hal.bites);
    TEST_ASSERT_FALSE(hal.safety_output.on || hal.led.on);
    TEST_ASSERT_EQUAL_UINT32(150, hal.safety_output.changed_ms);
    hal_watchdog_feed(&hal); /* too late: the port is held in reset */
    hal_safety_output_set(&hal, true);
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    TEST_ASSERT_FALSE(sim_hal_receive(&hal, HAL_CAN_VEHICLE, &frame));
    TEST_ASSERT_FALSE(hal_store_write_latch(&hal, "x", 1));
    TEST_ASSERT_FALSE(hal.safety_output.on);
    TEST_ASSERT_EQUAL_UINT32(1, hal.feeds);
}

void test_a_feed_that_comes_too_late_does_not_save(void) {
    hal_safety_output_set(&hal, true);
    run_until(101000);
    hal_watchdog_feed(&hal);
    TEST_ASSERT_TRUE(hal.held);
    TEST_ASSERT_FALSE(hal.safety_output.on);
    TEST_ASSERT_EQUAL_UINT32(0, hal.feeds);
}

void test_the_period_of_the_watchdog_is_configured_and_it_can_be_off(void) {
    init_on_bus(&(sim_hal_config_t){.watchdog_ms = 7, .clock_start_ms = UINT32_MAX - 3});
    run_until(7000);
    TEST_ASSERT_FALSE(sim_hal_poll(&hal));
    run_until(8000);
    TEST_ASSERT_TRUE(sim_hal_poll(&hal));
    TEST_ASSERT_EQUAL_UINT32(0, hal.safety_output.changes);
    init_on_bus(&(sim_hal_config_t){.watchdog_ms = SIM_HAL_WATCHDOG_OFF});
    run_until(UINT64_C(3600000000));
    TEST_ASSERT_FALSE(sim_hal_poll(&hal));
}

/* ---- Reset ---- */

/* Shows: FSM-4, FSM-7 */
void test_a_reset_keeps_the_latch_and_opens_the_output(void) {
    const uint8_t latch[4] = {1, 2, 3, 4};
    uint8_t read[4] = {0};
    hal_can_frame_t frame;
    hal_safety_output_set(&hal, true);
    TEST_ASSERT_TRUE(hal_store_write_latch(&hal, latch, sizeof latch));
    TEST_ASSERT_TRUE(hal_store_append(&hal, "event", 5));
    sim_bus_send(&bus, other, &FRAME);
    run_until(1000);
    hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME);
    sim_hal_add_overrun(&hal, HAL_CAN_VEHICLE);
    run_until(120000);
    sim_hal_poll(&hal);
    sim_hal_reset(&hal, HAL_RESET_WATCHDOG);
    TEST_ASSERT_FALSE(hal.held || hal.safety_output.on);
    TEST_ASSERT_EQUAL_INT(HAL_RESET_WATCHDOG, hal_reset_cause(&hal));
    TEST_ASSERT_EQUAL_size_t(4, hal_store_read_latch(&hal, read, sizeof read));
    TEST_ASSERT_EQUAL_HEX8_ARRAY(latch, read, 4);
    TEST_ASSERT_EQUAL_size_t(5, hal_store_read_record(&hal, 0, read, sizeof read));
    TEST_ASSERT_EQUAL_UINT16(0, status_of(HAL_CAN_VEHICLE).overrun_count);
    TEST_ASSERT_FALSE(sim_hal_receive(&hal, HAL_CAN_VEHICLE, &frame)); /* the queue was in RAM */
    run_until(220000);
    TEST_ASSERT_FALSE(sim_hal_poll(&hal)); /* the reset feeds it */
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    TEST_ASSERT_EQUAL_UINT32(1, hal.resets);
}

/* Shows: FSM-4 */
void test_a_reset_in_the_middle_of_everything(void) {
    hal_safety_output_set(&hal, true);
    hal_led_set(&hal, true);
    run_until(9100);
    hal_watchdog_feed(&hal);
    hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME);
    sim_bus_set_stalled(&ai_bus, hal.can[HAL_CAN_AI].node, true);
    hal_can_send(&hal, HAL_CAN_AI, &FRAME);
    (void)status_of(HAL_CAN_AI);
    sim_hal_reset(&hal, HAL_RESET_BROWN_OUT);
    TEST_ASSERT_FALSE(hal.safety_output.on || hal.led.on);
    TEST_ASSERT_EQUAL_UINT32(9, hal.safety_output.changed_ms);
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(&bus, hal.can[HAL_CAN_VEHICLE].node));
    TEST_ASSERT_EQUAL_size_t(0, sim_bus_waiting(&ai_bus, hal.can[HAL_CAN_AI].node));
    sim_hal_fail_at(&hal, hal.calls + 1, 2, SIM_HAL_OP_ALL);
    TEST_ASSERT_EQUAL_UINT32(9, hal_clock_now_ms(&hal)); /* the last value that could be read: at the reset */
    TEST_ASSERT_EQUAL_UINT32(0, status_of(HAL_CAN_AI).tx_pending_ms);
}

/* Shows: FSM-7 */
void test_a_power_on_loses_the_latch_but_not_the_log(void) {
    uint8_t read[8];
    hal_store_write_latch(&hal, "latch", 5);
    hal_store_append(&hal, "event", 5);
    sim_hal_hold(&hal);
    TEST_ASSERT_TRUE(sim_hal_poll(&hal));
    sim_hal_reset(&hal, HAL_RESET_POWER_ON);
    TEST_ASSERT_EQUAL_INT(HAL_RESET_POWER_ON, hal_reset_cause(&hal));
    TEST_ASSERT_EQUAL_size_t(0, hal_store_read_latch(&hal, read, sizeof read));
    TEST_ASSERT_EQUAL_size_t(5, hal_store_read_record(&hal, 0, read, sizeof read));
    store.keep_latch = true;
    hal_store_write_latch(&hal, "latch", 5);
    sim_hal_reset(&hal, HAL_RESET_POWER_ON);
    TEST_ASSERT_EQUAL_size_t(5, hal_store_read_latch(&hal, read, sizeof read));
    sim_hal_init(&hal, NULL);
    sim_hal_reset(&hal, HAL_RESET_POWER_ON); /* without a store, too */
    TEST_ASSERT_EQUAL_UINT32(0, hal.bites);
}

/* ---- Without a bus ---- */

typedef struct {
    unsigned count;
    hal_can_side_t side;
    hal_can_frame_t frame;
} sink_t;

static void sink(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    sink_t *into = ctx;
    into->count++;
    into->side = side;
    into->frame = *frame;
}

void test_direct_frames_reach_the_sink_in_the_very_call(void) {
    sink_t into = {0};
    hal_can_frame_t frame;
    sim_hal_init_direct(&hal, NULL, 2, sink, &into);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_AI, &FRAME));
    TEST_ASSERT_EQUAL_UINT(1, into.count);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_AI, into.side);
    TEST_ASSERT_EQUAL_MEMORY(&FRAME, &into.frame, sizeof FRAME);
    TEST_ASSERT_FALSE(sim_hal_receive(&hal, HAL_CAN_VEHICLE, &frame));
    sim_hal_init_direct(&hal, NULL, 1, sink, &into);
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_AI, &FRAME));
    TEST_ASSERT_EQUAL_UINT(1, into.count);
    sim_hal_init_direct(&hal, NULL, 1, NULL, NULL);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    TEST_ASSERT_EQUAL_UINT32(1, hal.can[HAL_CAN_VEHICLE].sent);
}

void test_direct_state_comes_from_outside(void) {
    sink_t into = {0};
    sim_hal_init_direct(&hal, NULL, 1, sink, &into);
    sim_hal_set_can_state(&hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_PASSIVE);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_ERROR_PASSIVE, status_of(HAL_CAN_VEHICLE).state);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT32(0, hal.can[HAL_CAN_VEHICLE].recover_requests);
    sim_hal_set_tx_pending_ms(&hal, HAL_CAN_VEHICLE, 99);
    TEST_ASSERT_EQUAL_UINT32(99, status_of(HAL_CAN_VEHICLE).tx_pending_ms);
    sim_hal_set_can_state(&hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    TEST_ASSERT_EQUAL_UINT16(1, status_of(HAL_CAN_VEHICLE).bus_off_count);
    sim_hal_set_can_state(&hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    sim_hal_set_can_state(&hal, HAL_CAN_AI, HAL_CAN_BUS_OFF); /* does not exist */
    sim_hal_set_tx_pending_ms(&hal, HAL_CAN_AI, 5);
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    hal_can_recover(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT32(1, hal.can[HAL_CAN_VEHICLE].recover_requests);
    TEST_ASSERT_EQUAL_INT(HAL_CAN_BUS_OFF, status_of(HAL_CAN_VEHICLE).state);
    TEST_ASSERT_EQUAL_UINT16(1, status_of(HAL_CAN_VEHICLE).bus_off_count);
    TEST_ASSERT_EQUAL_UINT32(0, status_of(HAL_CAN_VEHICLE).tx_pending_ms);
    sim_hal_set_can_state(&hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    TEST_ASSERT_TRUE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    sim_hal_set_tx_pending_ms(&hal, HAL_CAN_VEHICLE, 5);
    hal_can_purge(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT32(0, status_of(HAL_CAN_VEHICLE).tx_pending_ms);
    sim_hal_add_overrun(&hal, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT16(1, status_of(HAL_CAN_VEHICLE).overrun_count);
    sim_hal_set_full(&hal, HAL_CAN_VEHICLE, true);
    TEST_ASSERT_FALSE(hal_can_send(&hal, HAL_CAN_VEHICLE, &FRAME));
    TEST_ASSERT_EQUAL_UINT(2, into.count);
    sim_hal_reset(&hal, HAL_RESET_SOFTWARE);
    TEST_ASSERT_EQUAL_UINT16(0, status_of(HAL_CAN_VEHICLE).overrun_count);
}

void test_direct_time_is_set(void) {
    sim_hal_init_direct(&hal, &(sim_hal_config_t){.clock_start_ms = UINT32_MAX}, 1, NULL, NULL);
    TEST_ASSERT_EQUAL_HEX32(UINT32_MAX, hal_clock_now_ms(&hal));
    sim_hal_set_now_ms(&hal, 3);
    TEST_ASSERT_EQUAL_UINT32(3, hal_clock_now_ms(&hal));
    TEST_ASSERT_EQUAL_UINT32(3, sim_hal_clock_at(&hal, 123456789));
    sim_hal_set_now_ms(&hal, 100);
    TEST_ASSERT_TRUE(sim_hal_poll(&hal)); /* 101 ms since the start */
}

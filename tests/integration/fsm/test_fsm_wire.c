/* Frames on the bus at a trip: the simulated bus with frame times and arbitration, 500 kbit/s. */

#include "expect.h"
#include "fixture.h"
#include "hal_sim/sim_bus.h"
#include "unity.h"
#include "walk.h"

enum { WIRE_MAX = 64 };

static fixture_t f;
static sim_bus_t vehicle_bus;
static sim_bus_t ai_bus;
static sim_bus_node_t vcu; /* the other node on the vehicle side */
static uint32_t flood_id;  /* which it sends without a pause; 0: none */
static uint32_t start_ms;
static hal_can_frame_t wire[WIRE_MAX]; /* sent by the supervisor on the vehicle side */
static uint32_t wire_count;

static void on_wire(void *ctx, const sim_bus_event_t *event) {
    (void)ctx;
    if (!event->error && event->frame->id != 0x7F0 && /* without status frames */
        event->sender == f.hal.can[HAL_CAN_VEHICLE].node && wire_count < WIRE_MAX) {
        wire[wire_count++] = *event->frame;
    }
}

static void run_bus_until_us(uint64_t us) {
    sim_bus_t *const buses[] = {&vehicle_bus, &ai_bus};
    sim_bus_run_all_until(buses, 2, us);
}

static void flood(void) {
    const hal_can_frame_t frame = {.id = flood_id, .length = 8};
    while (flood_id != 0 && sim_bus_send(&vehicle_bus, vcu, &frame)) {
    }
}

static void run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        flood();
        run_bus_until_us(1000 * (uint64_t)(f.now_ms - start_ms + 1));
        fixture_run(&f, 1);
    }
}

/* The fixture's supervisor on two buses, each with another node that acknowledges. The traffic is passed to it
 * directly. mailboxes: of its controllers; 0 = 8 */
static void engage(uint8_t mailboxes) {
    const sim_bus_node_config_t own = {.tx_slots = mailboxes, .rx_slots = SIM_BUS_RX_SLOTS_MAX};
    flood_id = 0;
    fixture_init(&f);
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.long_run = true;
    start_ms = f.now_ms;
    fixture_start(&f);
    const sim_hal_config_t config = {.clock_start_ms = f.now_ms, .store = &f.store};
    TEST_ASSERT_TRUE(sim_bus_init(&vehicle_bus, 500000) && sim_bus_init(&ai_bus, 500000));
    sim_hal_init(&f.hal, &config);
    TEST_ASSERT_TRUE(sim_hal_attach(&f.hal, HAL_CAN_VEHICLE, &vehicle_bus, &own));
    TEST_ASSERT_TRUE(sim_hal_attach(&f.hal, HAL_CAN_AI, &ai_bus, &own));
    vcu = sim_bus_attach(&vehicle_bus, NULL);
    (void)sim_bus_attach(&ai_bus, NULL);
    (void)sim_bus_add_tap(&vehicle_bus, on_wire, NULL);
    agv_supervisor_start(&f.supervisor, &f.ports, &f.config, f.now_ms);
    run(600);
    expect_state(&f, AGV_STATE_STANDBY);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_gear(&f, GEAR_D);
    run(1000);
    expect_state(&f, AGV_STATE_ACTIVE);
    fixture_mute_ai(&f, true);
    run(3);
    wire_count = 0;
}

void setUp(void) {
    engage(0);
}

/* D, 20 %, 5.0 degrees: accepted by the controller. */
static void ai_commands(void) {
    static const uint8_t drive[8] = {GEAR_D};
    static const uint8_t throttle[8] = {50};
    static const uint8_t angle[8] = {0x5A, 0x23};
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, drive);
    fixture_frame(&f, AGV_MSG_THROTTLE_COMMAND, throttle);
    fixture_frame(&f, AGV_MSG_STEERING_COMMAND, angle);
    TEST_ASSERT_EQUAL_UINT32(3, sim_bus_waiting(&vehicle_bus, f.hal.can[HAL_CAN_VEHICLE].node));
}

/* By identifier they win in this order: 065h with the held 9000, 075h, 168h, 43Fh. */
static void expect_safe_commands_from(uint32_t n) {
    TEST_ASSERT_TRUE(wire_count >= n + 4);
    TEST_ASSERT_EQUAL_HEX32(0x065, wire[n].id);
    TEST_ASSERT_EQUAL_HEX8(0x28, wire[n].data[0]);
    TEST_ASSERT_EQUAL_HEX8(0x23, wire[n].data[1]);
    TEST_ASSERT_EQUAL_HEX32(0x075, wire[n + 1].id);
    TEST_ASSERT_EQUAL_HEX8(0, wire[n + 1].data[0]);
    TEST_ASSERT_EQUAL_HEX32(0x168, wire[n + 2].id);
    TEST_ASSERT_EQUAL_HEX8(GEAR_P, wire[n + 2].data[0]);
    TEST_ASSERT_EQUAL_HEX32(0x43F, wire[n + 3].id);
    TEST_ASSERT_EQUAL_HEX8(0x70, wire[n + 3].data[4]);
}

/* Shows: FSM-2, TOP-2 */
void test_without_a_trip_the_commands_are_sent(void) {
    ai_commands();
    run(2);
    TEST_ASSERT_EQUAL_UINT32(3, wire_count);
    TEST_ASSERT_EQUAL_HEX8(0x5A, wire[0].data[0]);
    TEST_ASSERT_EQUAL_HEX8(50, wire[1].data[0]);
    TEST_ASSERT_EQUAL_HEX8(GEAR_D, wire[2].data[0]);
}

/* Shows: FSM-2 */
void test_commands_that_wait_in_the_controller_are_never_sent_after_a_trip(void) {
    ai_commands();
    walk_trip(&f);
    run(5);
    expect_safe_commands_from(0);
    TEST_ASSERT_EQUAL_UINT32(4, wire_count);
}

/* 100 us later the first of them is on the bus. Only this one precedes the safe commands. */
/* Shows: FSM-2 */
void test_at_most_the_frame_on_the_wire_precedes_the_first_safe_one(void) {
    ai_commands();
    run_bus_until_us(1000 * (uint64_t)(f.now_ms - start_ms) + 100);
    walk_trip(&f);
    run(5);
    TEST_ASSERT_EQUAL_HEX32(0x065, wire[0].id);
    TEST_ASSERT_EQUAL_HEX8(0x5A, wire[0].data[0]);
    expect_safe_commands_from(1);
    TEST_ASSERT_EQUAL_UINT32(5, wire_count);
}

/* Other nodes occupy the bus for 5 ms. The waiting commands are purged, and the safe commands are sent as soon as the
 * bus is free. */
/* Shows: FSM-2, TOP-1 */
void test_behind_a_blocked_bus_the_safe_commands_are_the_first(void) {
    sim_bus_set_stalled(&vehicle_bus, f.hal.can[HAL_CAN_VEHICLE].node, true);
    ai_commands();
    run(5);
    walk_trip(&f);
    run(20);
    TEST_ASSERT_EQUAL_UINT32(0, wire_count);
    sim_bus_set_stalled(&vehicle_bus, f.hal.can[HAL_CAN_VEHICLE].node, false);
    run(2);
    expect_safe_commands_from(0);
}

/* The operator takes over while commands wait in the controller. Only throttle 0 leaves it. */
/* Shows: TOP-2 */
void test_commands_that_wait_in_the_controller_are_never_sent_in_manual(void) {
    sim_bus_set_stalled(&vehicle_bus, f.hal.can[HAL_CAN_VEHICLE].node, true);
    ai_commands();
    fixture_mode(&f, MODE_MANUAL);
    run(40);
    expect_state(&f, AGV_STATE_STANDBY);
    sim_bus_set_stalled(&vehicle_bus, f.hal.can[HAL_CAN_VEHICLE].node, false);
    run(20);
    TEST_ASSERT_EQUAL_UINT32(1, wire_count);
    TEST_ASSERT_EQUAL_HEX32(0x075, wire[0].id);
    TEST_ASSERT_EQUAL_HEX8(0, wire[0].data[0]);
}

/* Shows: FSM-2, INT-5, MEMORY_CORRUPTED */
void test_after_memory_corruption_frames_that_wait_in_the_controller_are_never_sent(void) {
    ai_commands();
    fixture_flip_bit(&f, 1000);
    fixture_send_now(&f, AGV_MSG_THROTTLE_STATUS);
    expect_reason(&f, AGV_FAULT_MEMORY_CORRUPTED);
    run(5);
    TEST_ASSERT_EQUAL_UINT32(3, wire_count); /* no angle is known yet */
    TEST_ASSERT_EQUAL_HEX32(0x075, wire[0].id);
    TEST_ASSERT_EQUAL_HEX8(0, wire[0].data[0]);
    TEST_ASSERT_EQUAL_HEX32(0x168, wire[1].id);
    TEST_ASSERT_EQUAL_HEX8(GEAR_P, wire[1].data[0]);
    TEST_ASSERT_EQUAL_HEX32(0x43F, wire[2].id);
}

/* Recovery is requested 100 ms after bus-off. No earlier frame is sent afterwards; all safe commands are sent at
 * once. */
/* Shows: SUP-7, BUS_OFF, FSM-2 */
void test_after_bus_off_only_safe_commands_are_sent(void) {
    ai_commands();
    sim_bus_force_bus_off(&vehicle_bus, f.hal.can[HAL_CAN_VEHICLE].node);
    run(99);
    expect_tripped(&f, AGV_FAULT_BUS_OFF);
    TEST_ASSERT_EQUAL_UINT32(0, f.hal.can[HAL_CAN_VEHICLE].recover_requests);
    run(4);
    TEST_ASSERT_EQUAL_UINT32(1, f.hal.can[HAL_CAN_VEHICLE].recover_requests);
    run(20); /* 128 times 11 bits of an idle bus are 2.8 ms */
    expect_safe_commands_from(0);
}

static uint32_t count_on_wire(uint32_t id) {
    uint32_t count = 0;
    for (uint32_t i = 0; i < wire_count; i++) {
        count += (wire[i].id == id) ? 1 : 0;
    }
    return count;
}

/* Another node sends 400h without a pause: 43Fh cannot leave, and the controller has room for one frame. The others go
 * first, and again when 43Fh has waited for 100 ms. */
/* Shows: SUP-7, FSM-2, TX_STALLED */
void test_a_flood_that_stops_43fh_does_not_stop_gear_p(void) {
    engage(1);
    flood_id = 0x400;
    walk_trip(&f);
    run(5);
    TEST_ASSERT_EQUAL_UINT32(1, count_on_wire(0x168));
    TEST_ASSERT_EQUAL_HEX32(0x065, wire[0].id);
    TEST_ASSERT_EQUAL_HEX32(0x075, wire[1].id);
    TEST_ASSERT_EQUAL_HEX32(0x168, wire[2].id);
    TEST_ASSERT_EQUAL_HEX8(GEAR_P, wire[2].data[0]);
    run(1000);
    TEST_ASSERT_UINT32_WITHIN(1, 10, count_on_wire(0x168) - 1);
    TEST_ASSERT_EQUAL_UINT32(0, count_on_wire(0x43F));
    flood_id = 0;
    run(20);
    TEST_ASSERT_EQUAL_UINT32(1, count_on_wire(0x43F));
}

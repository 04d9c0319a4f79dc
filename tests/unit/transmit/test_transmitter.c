/* Sending: own commands, forwarded frames and their pace, the status frame; waiting frames; reports. */
#include "transmit/transmitter.h"

#include <string.h>

#include "mock_can.h"
#include "unity.h"

/* The context of a port; the core never accesses its members. */
struct hal {
    int unused;
};
static hal_t hal;

static agv_transmitter_t transmitter;
static agv_timers_t timers;
static agv_config_t config;
static agv_ids_t ids;
static agv_tx_orders_t orders;

/* The frames that the HAL accepted. */
typedef struct {
    hal_can_side_t side;
    hal_can_frame_t frame;
} sent_t;
static sent_t sent[64];
static unsigned sent_count;
static bool hal_takes;

static bool send_stub(hal_t *port, hal_can_side_t side, const hal_can_frame_t *frame, int calls) {
    (void)calls;
    TEST_ASSERT_EQUAL_PTR(&hal, port);
    if (hal_takes) {
        TEST_ASSERT_TRUE(sent_count < sizeof sent / sizeof sent[0]);
        sent[sent_count++] = (sent_t){side, *frame};
    }
    return hal_takes;
}

/* TRIPPED, with an angle of +12.3 degrees held: 9123 = 23A3h. */
void setUp(void) {
    hal_can_send_Stub(send_stub);
    hal_takes = true;
    sent_count = 0;
    agv_config_defaults(&config);
    config.status_frame_id = 0; /* tested separately */
    agv_config_ids(&config, &ids);
    agv_timers_set_time(&timers, 1000);
    agv_timers_start(&timers);
    transmitter = (agv_transmitter_t){0};
    agv_transmitter_start(&transmitter, 1000);
    orders = (agv_tx_orders_t){.hal = &hal,
                               .config = &config,
                               .ids = &ids,
                               .timers = &timers,
                               .hold = {.raw = 9123, .check = 0xDC5C},
                               .state = AGV_STATE_TRIPPED,
                               .first_reason = AGV_FAULT_BUS_OFF,
                               .park_released = true,
                               .holdable = true,
                               .config_checksum = 0x12345678};
}

static void tick(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        agv_timers_advance(&timers, &config, timers.now_ms + 1, 0);
        agv_transmitter_tick(&transmitter, &orders);
    }
}

static void burst(void) {
    agv_transmitter_burst(&transmitter, &orders);
}

static void expect_sent(unsigned n, hal_can_side_t side, uint32_t id, const uint8_t data[8]) {
    TEST_ASSERT_TRUE(n < sent_count);
    TEST_ASSERT_EQUAL(side, sent[n].side);
    TEST_ASSERT_EQUAL_HEX32(id, sent[n].frame.id);
    TEST_ASSERT_EQUAL_UINT8(8, sent[n].frame.length);
    TEST_ASSERT_EQUAL_UINT8(0, sent[n].frame.flags);
    TEST_ASSERT_EQUAL_UINT32(timers.now_ms, sent[n].frame.time_ms);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, sent[n].frame.data, 8);
}

/* Whenever it was sent. */
static void expect_sent_data(unsigned n, uint32_t id, const uint8_t data[8]) {
    TEST_ASSERT_TRUE(n < sent_count);
    TEST_ASSERT_EQUAL_HEX32(id, sent[n].frame.id);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, sent[n].frame.data, 8);
}

static agv_tx_report_t report(void) {
    return agv_transmitter_take_report(&transmitter);
}

static const uint8_t SIGNALS[8] = {0, 0, 0, 0, 0x70};
static const uint8_t PARK[8] = {8};
static const uint8_t ZEROS[8] = {0};
static const uint8_t HELD[8] = {0xA3, 0x23};
static const uint8_t DRIVE[8] = {1};

/* ---- The safe commands ---- */

/* Shows: FSM-1, FSM-2, FSM-10 */
void test_all_safe_commands_at_once(void) {
    burst();
    TEST_ASSERT_EQUAL_UINT(4, sent_count);
    expect_sent(0, HAL_CAN_VEHICLE, 0x43F, SIGNALS);
    expect_sent(1, HAL_CAN_VEHICLE, 0x168, PARK);
    expect_sent(2, HAL_CAN_VEHICLE, 0x075, ZEROS);
    expect_sent(3, HAL_CAN_VEHICLE, 0x065, HELD);
}

/* Shows: P1 */
void test_the_safe_commands_on_the_identifiers_of_this_vehicle(void) {
    config.id_set = AGV_ID_SET_TABLE;
    config.id_gear_command = 0x300;
    agv_config_ids(&config, &ids);
    burst();
    expect_sent(0, HAL_CAN_VEHICLE, 0x201, SIGNALS);
    expect_sent(1, HAL_CAN_VEHICLE, 0x300, PARK);
}

/* Shows: FSM-1, FSM-10 */
void test_p_and_the_held_angle_are_sent_when_they_may_be(void) {
    orders.park_released = false;
    orders.holdable = false;
    burst();
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    expect_sent(0, HAL_CAN_VEHICLE, 0x43F, SIGNALS);
    expect_sent(1, HAL_CAN_VEHICLE, 0x075, ZEROS);
    TEST_ASSERT_FALSE(report().park_sent);
    orders.holdable = true;
    orders.hold.check = 0; /* none is held */
    burst();
    TEST_ASSERT_EQUAL_UINT(4, sent_count);
}

/* Shows: FSM-6 */
void test_in_standby_and_active_there_is_no_own_command(void) {
    orders.state = AGV_STATE_STANDBY;
    burst();
    tick(500);
    orders.state = AGV_STATE_ACTIVE;
    tick(500);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
}

/* 43Fh after 100 ms, 168h after 66, 075h after 33, 065h after 25. */
/* Shows: FSM-2, TIM-1 */
void test_the_slots_after_all_were_sent_at_once(void) {
    burst();
    tick(24);
    TEST_ASSERT_EQUAL_UINT(4, sent_count);
    tick(1);
    expect_sent(4, HAL_CAN_VEHICLE, 0x065, HELD);
    tick(8);
    expect_sent(5, HAL_CAN_VEHICLE, 0x075, ZEROS);
    tick(33);
    TEST_ASSERT_EQUAL_UINT(8, sent_count); /* 065h at 50, 168h at 66 */
    expect_sent(7, HAL_CAN_VEHICLE, 0x168, PARK);
    tick(34);
    TEST_ASSERT_EQUAL_UINT(11, sent_count); /* 065h at 75 and 100, 43Fh at 100 */
}

/* Shows: FSM-8 */
TEST_CASE(AGV_OWN_HEARTBEAT_RUNNING, 1)
TEST_CASE(AGV_OWN_HEARTBEAT_FROZEN, 0)
void test_the_own_alive_counter_runs_or_is_frozen(int heartbeat, int counter) {
    const uint8_t second[8] = {0, 0, 0, 0, 0x70, 0, 0, (uint8_t)counter};
    config.own_heartbeat = (uint16_t)heartbeat;
    burst();
    burst();
    expect_sent(0, HAL_CAN_VEHICLE, 0x43F, SIGNALS);
    expect_sent(4, HAL_CAN_VEHICLE, 0x43F, second);
}

/* The first P is sent as soon as it is released, then on its cycle from that time. */
/* Shows: FSM-1 */
void test_p_that_was_held_back_is_sent_as_soon_as_it_may_be(void) {
    orders.park_released = false;
    orders.holdable = false;
    burst();
    tick(10);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    orders.park_released = true;
    tick(1);
    expect_sent(2, HAL_CAN_VEHICLE, 0x168, PARK);
    tick(99);
    TEST_ASSERT_EQUAL_UINT(5, sent_count); /* 075h, 43Fh */
    tick(1);
    expect_sent(5, HAL_CAN_VEHICLE, 0x168, PARK);
}

/* ---- The report ---- */

void test_a_report_is_taken_once(void) {
    burst();
    agv_tx_report_t first = report();
    TEST_ASSERT_EQUAL_UINT16(4, first.sent);
    TEST_ASSERT_TRUE(first.park_sent);
    TEST_ASSERT_TRUE(first.hold_sent);
    TEST_ASSERT_EQUAL_UINT16(0, first.shadowed);
    TEST_ASSERT_EQUAL_UINT16(0, first.refused);
    TEST_ASSERT_EQUAL_UINT16(0, first.dropped);
    TEST_ASSERT_EQUAL_UINT32(0, first.skipped_slots);
    first = report();
    TEST_ASSERT_EQUAL_UINT16(0, first.sent);
    TEST_ASSERT_FALSE(first.park_sent);
    TEST_ASSERT_FALSE(first.hold_sent);
}

/* Shows: TOP-4 */
void test_in_shadow_mode_all_is_reported_and_nothing_sent(void) {
    config.shadow = AGV_SHADOW_ON;
    burst();
    const agv_tx_report_t did = report();
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    TEST_ASSERT_EQUAL_UINT16(4, did.shadowed);
    TEST_ASSERT_EQUAL_UINT16(0, did.sent);
}

/* Shows: INT-4, TX_GATE_REFUSED */
void test_a_frame_refused_by_the_gate_is_reported(void) {
    orders.state = AGV_STATE_STANDBY;
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, DRIVE); /* shared bus */
    const agv_tx_report_t did = report();
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    TEST_ASSERT_EQUAL_UINT16(1, did.refused);
    tick(10);
    TEST_ASSERT_EQUAL_UINT16(0, report().refused); /* it does not wait */
}

/* 330 ms late: of 065h twelve slots are missed, of 43Fh two, of 168h and 075h two each (at 66, 166, 266 and 33 ...). */
/* Shows: TIM-1 */
void test_missed_slots_are_reported(void) {
    burst();
    agv_timers_advance(&timers, &config, 1330, 0);
    agv_transmitter_tick(&transmitter, &orders);
    TEST_ASSERT_EQUAL_UINT32(12 + 2 + 2 + 2, report().skipped_slots);
    TEST_ASSERT_EQUAL_UINT(8, sent_count);
}

/* ---- Frames that the HAL refuses ---- */

/* The frame is built again at every tick until it is sent. After more than 100 ms the transmitter is stalled. */
/* Shows: SUP-7, TX_STALLED */
void test_an_own_command_waits_and_is_stalled(void) {
    hal_takes = false;
    burst();
    agv_tx_report_t did = report();
    TEST_ASSERT_FALSE(did.park_sent);
    TEST_ASSERT_FALSE(did.hold_sent);
    tick(100);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    tick(1);
    TEST_ASSERT_TRUE(agv_transmitter_is_stalled(&timers));
    hal_takes = true;
    tick(1);
    TEST_ASSERT_EQUAL_UINT(4, sent_count);
    expect_sent(0, HAL_CAN_VEHICLE, 0x43F, SIGNALS); /* the counter has not increased */
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    did = report();
    TEST_ASSERT_TRUE(did.park_sent);
    TEST_ASSERT_TRUE(did.hold_sent);
}

/* A frame that is no longer wanted does not wait any more. */
void test_a_command_that_is_not_wanted_any_more_is_not_stalled(void) {
    hal_takes = false;
    burst();
    tick(50);
    orders.state = AGV_STATE_STANDBY;
    tick(200);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
}

static void be_gateway(void) {
    config.topology = AGV_TOPOLOGY_GATEWAY;
    orders.state = AGV_STATE_ACTIVE;
}

/* Shows: TOP-2 */
void test_commands_pass_to_the_vehicle_and_status_to_the_ai(void) {
    static const uint8_t speeds[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    be_gateway();
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, DRIVE);
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_WHEEL_SPEED, speeds);
    expect_sent(0, HAL_CAN_VEHICLE, 0x168, DRIVE);
    expect_sent(1, HAL_CAN_AI, 0x101, speeds);
    TEST_ASSERT_EQUAL_UINT16(2, report().sent);
}

/* Only the newest frame of each message waits. */
/* Shows: TOP-2 */
void test_a_waiting_frame_is_replaced_by_a_newer_one(void) {
    static const uint8_t older[8] = {2};
    be_gateway();
    hal_takes = false;
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, older);
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_THROTTLE_COMMAND, older);
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, DRIVE);
    TEST_ASSERT_EQUAL_UINT16(1, report().dropped);
    tick(5);
    hal_takes = true;
    tick(1);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    expect_sent(0, HAL_CAN_VEHICLE, 0x168, DRIVE);
    expect_sent(1, HAL_CAN_VEHICLE, 0x075, older);
    tick(5);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
}

/* Each side alone. */
/* Shows: FSM-2, TOP-2 */
void test_a_discarded_frame_is_never_sent(void) {
    be_gateway();
    hal_takes = false;
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, DRIVE);
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_STEERING_COMMAND, ZEROS);
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_WHEEL_SPEED, ZEROS);
    tick(101);
    TEST_ASSERT_TRUE(agv_transmitter_is_stalled(&timers));
    agv_transmitter_discard(&transmitter, &timers, HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT16(2, report().dropped);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    hal_takes = true;
    tick(1);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    expect_sent(0, HAL_CAN_AI, 0x101, ZEROS);
    hal_takes = false;
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_WHEEL_SPEED, ZEROS);
    agv_transmitter_discard(&transmitter, &timers, HAL_CAN_AI);
    TEST_ASSERT_EQUAL_UINT16(1, report().dropped);
    hal_takes = true;
    tick(10);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
}

/* A stalled AI side does not open the output. */
void test_only_the_vehicle_side_is_stalled(void) {
    be_gateway();
    hal_takes = false;
    agv_transmitter_pass(&transmitter, &orders, AGV_MSG_WHEEL_SPEED, ZEROS);
    tick(500);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
}

/* Shows: SUP-7, TOP-3 */
void test_in_bus_off_no_own_frame_is_passed_to_the_hal(void) {
    config.status_frame_id = 0x123;
    agv_timer_start(&timers, AGV_TIMER_BUS_OFF);
    burst();
    tick(500);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
}

/* ---- The pace of the gateway ---- */

static const uint8_t REVERSE[8] = {2};
static const uint8_t NEUTRAL[8] = {4};

static void pass(unsigned message, const uint8_t data[8]) {
    agv_transmitter_pass(&transmitter, &orders, message, data);
}

/* Of the frames within half a cycle the newest is sent at its end; the others are dropped and counted. */
/* Shows: TOP-2 */
void test_a_command_passes_at_most_once_in_half_its_cycle(void) {
    be_gateway();
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    tick(10);
    pass(AGV_MSG_GEAR_COMMAND, REVERSE);
    tick(10);
    pass(AGV_MSG_GEAR_COMMAND, NEUTRAL);
    TEST_ASSERT_EQUAL_UINT16(1, report().dropped);
    tick(29);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    tick(1);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    expect_sent(1, HAL_CAN_VEHICLE, 0x168, NEUTRAL);
    tick(49); /* from the time at which it was sent */
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    tick(1);
    expect_sent(2, HAL_CAN_VEHICLE, 0x168, DRIVE);
    TEST_ASSERT_EQUAL_UINT16(0, report().dropped);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
}

/* Half of 100 ms is 50; half of 25 is 12.5, so the first whole ms after it is 13. A frame at that time is sent at
 * once. */
/* Shows: TOP-2 */
TEST_CASE(AGV_MSG_TURN_SIGNAL_COMMAND, 50)
TEST_CASE(AGV_MSG_GEAR_COMMAND, 50)
TEST_CASE(AGV_MSG_THROTTLE_COMMAND, 50)
TEST_CASE(AGV_MSG_STEERING_COMMAND, 13)
void test_half_a_cycle_of_each_command(unsigned command, uint32_t half_ms) {
    static const uint8_t drive[8] = {1};
    static const uint8_t lights[8] = {0};
    const uint8_t *const data = (command == AGV_MSG_TURN_SIGNAL_COMMAND) ? lights : drive;
    be_gateway();
    pass(command, data);
    tick(half_ms - 1);
    pass(command, data);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    tick(1);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    tick(half_ms);
    pass(command, data);
    TEST_ASSERT_EQUAL_UINT(3, sent_count);
}

/* A frame is handled before the tick of its time: the half cycle is over by its stamp. */
/* Shows: TOP-2 */
void test_a_frame_at_the_end_of_the_half_cycle_goes_at_once(void) {
    be_gateway();
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    tick(49);
    agv_timers_advance(&timers, &config, timers.now_ms + 1, 0);
    pass(AGV_MSG_GEAR_COMMAND, NEUTRAL);
    expect_sent(1, HAL_CAN_VEHICLE, 0x168, NEUTRAL);
}

/* Each command has its own pace; status messages have none. */
/* Shows: TOP-2 */
void test_the_pace_is_one_of_each_command(void) {
    be_gateway();
    for (unsigned command = AGV_MSG_GEAR_COMMAND; command <= AGV_MSG_STEERING_COMMAND; command++) {
        pass(command, DRIVE);
        TEST_ASSERT_EQUAL_UINT(command, sent_count);
    }
    sent_count = 0;
    for (unsigned i = 0; i < 20; i++) {
        pass(AGV_MSG_WHEEL_SPEED, ZEROS);
    }
    TEST_ASSERT_EQUAL_UINT(20, sent_count);
}

/* Of a flood from the AI side 20 frames a second are sent. */
/* Shows: TOP-2, SUP-6 */
void test_a_flood_leaves_at_the_pace(void) {
    be_gateway();
    for (unsigned i = 0; i < 500; i++) {
        pass(AGV_MSG_GEAR_COMMAND, DRIVE);
        pass(AGV_MSG_GEAR_COMMAND, DRIVE);
        tick(1);
    }
    const agv_tx_report_t did = report();
    TEST_ASSERT_EQUAL_UINT(11, sent_count); /* at 0, 50 ... 500 */
    TEST_ASSERT_EQUAL_UINT16(1000 - 11, did.dropped);
}

/* The last command was almost 49.7 days ago, so this one is not too soon. */
/* Shows: TOP-2, TIM-2 */
void test_a_command_passed_a_full_wrap_ago_is_not_recent(void) {
    be_gateway();
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    tick(50);
    agv_timers_set_time(&timers, 1000 + 10);
    pass(AGV_MSG_GEAR_COMMAND, NEUTRAL);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
}

/* Shows: TOP-2 */
void test_a_waiting_command_that_is_no_longer_allowed_is_dropped(void) {
    be_gateway();
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    pass(AGV_MSG_GEAR_COMMAND, REVERSE);
    agv_transmitter_drop(&transmitter, &timers, AGV_MSG_THROTTLE_COMMAND); /* none waits */
    TEST_ASSERT_EQUAL_UINT16(0, report().dropped);
    agv_transmitter_drop(&transmitter, &timers, AGV_MSG_GEAR_COMMAND);
    TEST_ASSERT_EQUAL_UINT16(1, report().dropped);
    tick(200);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
}

/* A dropped command that the HAL refused no longer counts as stalled. */
/* Shows: TOP-2, SUP-7 */
void test_a_dropped_command_does_not_stall(void) {
    be_gateway();
    hal_takes = false;
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    tick(50);
    agv_transmitter_drop(&transmitter, &timers, AGV_MSG_GEAR_COMMAND);
    tick(200);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
}

/* A command counts as given to the vehicle when it is sent. */
/* Shows: SUP-5, SUP-11 */
void test_a_forwarded_frame_is_reported_when_it_is_sent(void) {
    be_gateway();
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    pass(AGV_MSG_STEERING_COMMAND, HELD);
    TEST_ASSERT_EQUAL_HEX8(1u << AGV_MSG_GEAR_COMMAND | 1u << AGV_MSG_STEERING_COMMAND, report().passed);
    pass(AGV_MSG_GEAR_COMMAND, NEUTRAL);
    pass(AGV_MSG_WHEEL_SPEED, ZEROS);
    TEST_ASSERT_EQUAL_HEX8(0, report().passed);
    tick(50);
    TEST_ASSERT_EQUAL_HEX8(1u << AGV_MSG_GEAR_COMMAND, report().passed);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(NEUTRAL, agv_transmitter_passed(&transmitter, AGV_MSG_GEAR_COMMAND), 8);
    hal_takes = false;
    tick(50);
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    tick(10);
    TEST_ASSERT_EQUAL_HEX8(0, report().passed);
}

/* ---- Throttle 0 at the end of an engagement ---- */

static void end_engagement(void) {
    orders.state = AGV_STATE_STANDBY;
    agv_transmitter_end_engagement(&transmitter, &orders);
}

/* One frame, at once, even directly after a 075h. It does not count as forwarded and is not reported as a command. */
/* Shows: TOP-2 */
void test_an_engagement_ends_with_throttle_0(void) {
    static const uint8_t half[8] = {125};
    be_gateway();
    pass(AGV_MSG_THROTTLE_COMMAND, half);
    tick(1);
    (void)report();
    end_engagement();
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    expect_sent(1, HAL_CAN_VEHICLE, 0x075, ZEROS);
    TEST_ASSERT_EQUAL_HEX8(0, report().passed);
    tick(48);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    orders.state = AGV_STATE_ACTIVE;
    tick(1);
    pass(AGV_MSG_THROTTLE_COMMAND, half); /* 50 ms after the last pass */
    TEST_ASSERT_EQUAL_UINT(3, sent_count);
}

/* It is tried again until it is sent. */
/* Shows: TOP-2, SUP-7 */
void test_throttle_0_waits_for_the_hal(void) {
    be_gateway();
    hal_takes = false;
    end_engagement();
    tick(100);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    tick(1);
    TEST_ASSERT_TRUE(agv_transmitter_is_stalled(&timers));
    hal_takes = true;
    tick(1);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    expect_sent(0, HAL_CAN_VEHICLE, 0x075, ZEROS);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    tick(100);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
}

/* Discarded by a trip, and by the next engagement, because it would follow newer frames. */
/* Shows: TOP-2, FSM-2 */
void test_throttle_0_that_waits_is_discarded_and_replaced(void) {
    static const uint8_t half[8] = {125};
    be_gateway();
    hal_takes = false;
    end_engagement();
    agv_transmitter_discard(&transmitter, &timers, HAL_CAN_VEHICLE);
    hal_takes = true;
    tick(10);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    hal_takes = false;
    end_engagement();
    orders.state = AGV_STATE_ACTIVE;
    pass(AGV_MSG_GEAR_COMMAND, DRIVE); /* not by another command */
    pass(AGV_MSG_THROTTLE_COMMAND, half);
    hal_takes = true;
    tick(10);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    expect_sent_data(0, 0x168, DRIVE);
    expect_sent_data(1, 0x075, half);
}

/* Shows: TOP-2, SUP-7 */
void test_in_bus_off_no_throttle_0_is_passed_to_the_hal(void) {
    be_gateway();
    agv_timer_start(&timers, AGV_TIMER_BUS_OFF);
    end_engagement();
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    agv_timer_stop(&timers, AGV_TIMER_BUS_OFF);
    tick(10);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
}

/* ---- Overrides ---- */

/* Shows: TOP-1 */
void test_a_command_that_differs_is_overridden(void) {
    static const uint8_t reserved[8] = {8, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF};
    agv_transmitter_answer(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, PARK);
    agv_transmitter_answer(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, reserved); /* reserved bits command nothing */
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    agv_transmitter_answer(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, DRIVE);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    expect_sent(0, HAL_CAN_VEHICLE, 0x168, PARK);
    agv_transmitter_answer(&transmitter, &orders, AGV_MSG_THROTTLE_COMMAND, NULL); /* malformed */
    expect_sent(1, HAL_CAN_VEHICLE, 0x075, ZEROS);
}

/* Another alive counter does not make another command. */
/* Shows: TOP-1 */
void test_the_alive_counter_of_a_foreign_43f_commands_nothing(void) {
    static const uint8_t same[8] = {0, 0, 0, 0, 0x70, 0, 0, 77};
    static const uint8_t other[8] = {0, 0, 0, 0, 0x30, 0, 0, 77};
    agv_transmitter_answer(&transmitter, &orders, AGV_MSG_TURN_SIGNAL_COMMAND, same);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    agv_transmitter_answer(&transmitter, &orders, AGV_MSG_TURN_SIGNAL_COMMAND, other);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
}

/* Shows: TOP-1 */
void test_a_command_that_is_not_sent_is_not_overridden(void) {
    orders.park_released = false;
    agv_transmitter_answer(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, DRIVE);
    orders.state = AGV_STATE_STANDBY;
    agv_transmitter_answer(&transmitter, &orders, AGV_MSG_THROTTLE_COMMAND, DRIVE);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
}

/* Shows: TOP-1 */
void test_within_5_ms_the_override_waits_and_is_sent_by_a_tick(void) {
    burst();
    sent_count = 0;
    tick(1);
    agv_transmitter_answer(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, DRIVE);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    tick(1);
    agv_transmitter_answer(&transmitter, &orders, AGV_MSG_GEAR_COMMAND, DRIVE);
    tick(3);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    tick(1);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    expect_sent(1, HAL_CAN_VEHICLE, 0x168, PARK);
}

/* ---- The status frame ---- */

static void with_status_frame(void) {
    config.status_frame_id = 0x123;
    orders.state = AGV_STATE_STANDBY;
    orders.first_reason = AGV_FAULT_NONE;
}

/* State, rank of the reason or FFh, output, counter, checksum with the low byte first. The first one at the start. */
/* Shows: TOP-3 */
void test_the_status_frame(void) {
    const uint8_t first[8] = {0x33, 0xFF, 1, 0, 0x78, 0x56, 0x34, 0x12};
    const uint8_t second[8] = {0x55, AGV_FAULT_BUS_OFF, 0, 1, 0x78, 0x56, 0x34, 0x12};
    with_status_frame();
    orders.output_closed = true;
    agv_transmitter_status(&transmitter, &orders);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    expect_sent(0, HAL_CAN_VEHICLE, 0x123, first);
    TEST_ASSERT_EQUAL_UINT16(1, report().sent);
    orders.output_closed = false;
    tick(99);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    orders.state = AGV_STATE_TRIPPED;
    orders.first_reason = AGV_FAULT_BUS_OFF;
    orders.park_released = false;
    orders.holdable = false;
    tick(1);
    expect_sent(sent_count - 1, HAL_CAN_VEHICLE, 0x123, second);
}

/* 100 ms by default, and its counter wraps. */
/* Shows: TOP-3 */
void test_the_period_of_the_status_frame(void) {
    with_status_frame();
    for (unsigned i = 0; i < 300; i++) {
        sent_count = 0;
        tick((i == 0) ? 1 : 100);
        TEST_ASSERT_EQUAL_UINT(1, sent_count);
        TEST_ASSERT_EQUAL_UINT8(i, sent[0].frame.data[3]);
    }
    config.status_frame_period_ms = 10;
    tick(100);
    sent_count = 0;
    tick(100);
    TEST_ASSERT_EQUAL_UINT(10, sent_count);
}

/* Version 1.2.3 of the revision 89ABCDEFh, after the 256th frame. The bits 5 to 8 of byte 3 are the page. */
/* Shows: TOP-3, HW-6 */
void test_the_status_frame_reports_the_version_once_in_256_frames(void) {
    static const agv_version_t version = {.major = 1, .minor = 2, .patch = 3, .revision = 0x89ABCDEF};
    const uint8_t regular[8] = {0x33, 0xFF, 1, 255, 0x78, 0x56, 0x34, 0x12};
    const uint8_t first[8] = {0x33, 0xFF, 0x11, 255, 1, 2, 3, 0};
    const uint8_t second[8] = {0x33, 0xFF, 0x21, 255, 0xEF, 0xCD, 0xAB, 0x89};
    with_status_frame();
    orders.output_closed = true;
    orders.version = &version;
    config.status_version = AGV_STATUS_VERSION_ON;
    agv_transmitter_status(&transmitter, &orders);
    for (unsigned i = 1; i < 512; i++) {
        sent_count = 0;
        tick(100);
        TEST_ASSERT_EQUAL_UINT((i % 256 == 255) ? 3 : 1, sent_count);
    }
    expect_sent(0, HAL_CAN_VEHICLE, 0x123, regular);
    expect_sent(1, HAL_CAN_VEHICLE, 0x123, first);
    expect_sent(2, HAL_CAN_VEHICLE, 0x123, second);
    TEST_ASSERT_EQUAL_UINT16(512 + 4, report().sent);
}

static void expect_one_frame_in_each_period(void) {
    with_status_frame();
    agv_transmitter_status(&transmitter, &orders);
    for (unsigned i = 1; i < 300; i++) {
        sent_count = 0;
        tick(100);
        TEST_ASSERT_EQUAL_UINT(1, sent_count);
    }
}

/* Shows: TOP-3, HW-6 */
void test_the_version_is_reported_by_choice(void) {
    static const agv_version_t version = {.major = 1};
    orders.version = &version;
    expect_one_frame_in_each_period();
}

/* Shows: TOP-3, HW-6 */
void test_a_program_without_a_version_reports_none(void) {
    config.status_version = AGV_STATUS_VERSION_ON;
    expect_one_frame_in_each_period();
}

/* Of several missed frames one is sent, and the grid stays. */
/* Shows: TOP-3, TIM-1 */
void test_a_late_step_sends_one_status_frame(void) {
    with_status_frame();
    tick(1);
    agv_timers_advance(&timers, &config, 1430, 0);
    agv_transmitter_tick(&transmitter, &orders);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    tick(69);
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    tick(1);
    TEST_ASSERT_EQUAL_UINT(3, sent_count);
}

/* The status frame tests the transmit path: it is tried again at every tick, and counts as stalled after more than 100
 * ms. */
/* Shows: TOP-3, SUP-7, TX_STALLED */
void test_a_status_frame_that_is_not_taken_waits_and_stalls(void) {
    with_status_frame();
    hal_takes = false;
    agv_transmitter_status(&transmitter, &orders);
    tick(100);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    tick(1);
    TEST_ASSERT_TRUE(agv_transmitter_is_stalled(&timers));
    hal_takes = true;
    tick(1);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    TEST_ASSERT_EQUAL_UINT8(0, sent[0].frame.data[3]);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    tick(97);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    tick(1); /* 200 ms after the start: on the grid */
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
}

/* Shows: TOP-3, TOP-4 */
void test_there_is_no_status_frame_in_shadow_or_when_it_is_off(void) {
    with_status_frame();
    config.shadow = AGV_SHADOW_ON;
    tick(250);
    TEST_ASSERT_EQUAL_UINT16(0, report().shadowed);
    config.shadow = AGV_SHADOW_OFF;
    config.status_frame_id = 0;
    tick(250);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
}

/* No status frame during bus-off, not even one that waits. Afterwards it is on its grid again. */
/* Shows: TOP-3, SUP-7 */
void test_there_is_no_status_frame_in_bus_off(void) {
    with_status_frame();
    hal_takes = false;
    tick(50);
    agv_timer_start(&timers, AGV_TIMER_BUS_OFF);
    hal_takes = true;
    tick(100);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    agv_timer_stop(&timers, AGV_TIMER_BUS_OFF);
    tick(49);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    tick(1);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
}

/* At a start no status frame was passed to the HAL that could be discarded. */
/* Shows: TOP-3 */
void test_before_the_first_status_frame_none_is_sent_again(void) {
    with_status_frame();
    transmitter.status_due_ms = timers.now_ms + 50;
    agv_transmitter_discard(&transmitter, &timers, HAL_CAN_VEHICLE);
    tick(49);
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
}

/* A status frame passed to the HAL up to 2 ms before waiting frames are discarded may be lost, so it is sent again. */
/* Shows: TOP-3, FSM-2 */
TEST_CASE(0, 1)
TEST_CASE(2, 1)
TEST_CASE(3, 0)
void test_a_status_frame_that_may_have_been_discarded_is_sent_again(uint32_t before_ms, unsigned again) {
    with_status_frame();
    agv_transmitter_status(&transmitter, &orders);
    tick(before_ms);
    agv_transmitter_discard(&transmitter, &timers, HAL_CAN_VEHICLE);
    tick(1);
    TEST_ASSERT_EQUAL_UINT(1 + again, sent_count);
    tick(50);
    TEST_ASSERT_EQUAL_UINT(1 + again, sent_count);
}

/* Frames discarded on the AI side do not matter. */
void test_what_is_discarded_for_the_ai_side_is_no_status_frame(void) {
    with_status_frame();
    agv_transmitter_status(&transmitter, &orders);
    agv_transmitter_discard(&transmitter, &timers, HAL_CAN_AI);
    tick(50);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
}

/* A start just before the wrap. */
/* Shows: TOP-3, TIM-2 */
void test_the_status_frame_across_the_wrap(void) {
    with_status_frame();
    agv_timers_set_time(&timers, 0xFFFFFFF0u);
    transmitter = (agv_transmitter_t){0};
    agv_transmitter_start(&transmitter, timers.now_ms);
    agv_transmitter_status(&transmitter, &orders);
    tick(99);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    tick(201);
    TEST_ASSERT_EQUAL_UINT(4, sent_count);
}

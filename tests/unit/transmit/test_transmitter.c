/* Sending: own commands, forwarded frames and their pace, overrides; waiting frames; reports. */
#include "mock_can.h"
#include "one_transmitter.h"

/* ---- The safe commands ---- */

/* The lowest identifier goes first: a port may have room for one frame, and a flood may keep 43Fh from leaving. */
/* Shows: FSM-1, FSM-2, FSM-10 */
void test_all_safe_commands_at_once(void) {
    burst();
    TEST_ASSERT_EQUAL_UINT(4, sent_count);
    expect_sent(0, HAL_CAN_VEHICLE, 0x065, HELD);
    expect_sent(1, HAL_CAN_VEHICLE, 0x075, ZEROS);
    expect_sent(2, HAL_CAN_VEHICLE, 0x168, PARK);
    expect_sent(3, HAL_CAN_VEHICLE, 0x43F, SIGNALS);
}

/* Shows: P1 */
void test_the_safe_commands_on_the_identifiers_of_this_vehicle(void) {
    config.id_set = AGV_ID_SET_TABLE;
    config.id_gear_command = 0x300;
    agv_config_ids(&config, &ids);
    burst();
    expect_sent(2, HAL_CAN_VEHICLE, 0x300, PARK);
    expect_sent(3, HAL_CAN_VEHICLE, 0x201, SIGNALS);
}

/* Shows: FSM-1, FSM-10 */
void test_p_and_the_held_angle_are_sent_when_they_may_be(void) {
    orders.park_released = false;
    orders.holdable = false;
    burst();
    TEST_ASSERT_EQUAL_UINT(2, sent_count);
    expect_sent(0, HAL_CAN_VEHICLE, 0x075, ZEROS);
    expect_sent(1, HAL_CAN_VEHICLE, 0x43F, SIGNALS);
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
    EXPECT_COUNT_AFTER(500, 0);
}

/* 43Fh after 100 ms, 168h after 66, 075h after 33, 065h after 25. */
/* Shows: FSM-2, TIM-1 */
void test_the_slots_after_all_were_sent_at_once(void) {
    burst();
    EXPECT_COUNT_AFTER(24, 4);
    tick(1);
    expect_sent(4, HAL_CAN_VEHICLE, 0x065, HELD);
    tick(8);
    expect_sent(5, HAL_CAN_VEHICLE, 0x075, ZEROS);
    EXPECT_COUNT_AFTER(33, 8); /* 065h at 50, 168h at 66 */
    expect_sent(7, HAL_CAN_VEHICLE, 0x168, PARK);
    EXPECT_COUNT_AFTER(34, 11); /* 065h at 75 and 100, 43Fh at 100 */
}

/* Shows: FSM-8 */
TEST_CASE(AGV_OWN_HEARTBEAT_RUNNING, 1)
TEST_CASE(AGV_OWN_HEARTBEAT_FROZEN, 0)
void test_the_own_alive_counter_runs_or_is_frozen(int heartbeat, int counter) {
    const uint8_t second[8] = {0, 0, 0, 0, 0x70, 0, 0, (uint8_t)counter};
    config.own_heartbeat = (uint16_t)heartbeat;
    burst();
    burst();
    expect_sent(3, HAL_CAN_VEHICLE, 0x43F, SIGNALS);
    expect_sent(7, HAL_CAN_VEHICLE, 0x43F, second);
}

/* The first P is sent as soon as it is released, then on its cycle from that time. */
/* Shows: FSM-1 */
void test_p_that_was_held_back_is_sent_as_soon_as_it_may_be(void) {
    orders.park_released = false;
    orders.holdable = false;
    burst();
    EXPECT_COUNT_AFTER(10, 2);
    orders.park_released = true;
    tick(1);
    expect_sent(2, HAL_CAN_VEHICLE, 0x168, PARK);
    EXPECT_COUNT_AFTER(99, 5); /* 075h, 43Fh */
    tick(1);
    expect_sent(5, HAL_CAN_VEHICLE, 0x168, PARK);
}

/* In the safe state again without all commands at once: P is sent, the others wait for their slots. */
/* Shows: FSM-1, FSM-2 */
void test_only_p_does_not_wait_for_its_slot(void) {
    burst();
    orders.state = AGV_STATE_STANDBY;
    EXPECT_COUNT_AFTER(1, 4);
    orders.state = AGV_STATE_TRIPPED;
    EXPECT_COUNT_AFTER(1, 5);
    expect_sent(4, HAL_CAN_VEHICLE, 0x168, PARK);
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
    pass(AGV_MSG_GEAR_COMMAND, DRIVE); /* shared bus */
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
    EXPECT_STALLED_AFTER(100, false);
    EXPECT_STALLED_AFTER(1, true);
    hal_takes = true;
    EXPECT_COUNT_AFTER(1, 4);
    expect_sent(0, HAL_CAN_VEHICLE, 0x065, HELD);
    expect_sent(3, HAL_CAN_VEHICLE, 0x43F, SIGNALS); /* the counter has not increased */
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    did = report();
    TEST_ASSERT_TRUE(did.park_sent);
    TEST_ASSERT_TRUE(did.hold_sent);
}

/* Also when it waits alone, as 43Fh does in a gateway in manual. */
/* Shows: SUP-7, TX_STALLED */
TEST_CASE(AGV_MSG_TURN_SIGNAL_COMMAND)
TEST_CASE(AGV_MSG_GEAR_COMMAND)
TEST_CASE(AGV_MSG_THROTTLE_COMMAND)
TEST_CASE(AGV_MSG_STEERING_COMMAND)
void test_each_command_that_waits_is_stalled(unsigned command) {
    be_gateway();
    hal_takes = false;
    pass(command, (command == AGV_MSG_GEAR_COMMAND) ? DRIVE : ZEROS);
    EXPECT_STALLED_AFTER(100, false);
    EXPECT_STALLED_AFTER(1, true);
}

/* Whatever waits for the vehicle: 43Fh, 168h, 075h, 065h, or the status frame. */
/* Shows: SUP-7, TX_STALLED */
TEST_CASE(AGV_TIMER_TX_TURN_SIGNAL)
TEST_CASE(AGV_TIMER_TX_GEAR)
TEST_CASE(AGV_TIMER_TX_THROTTLE)
TEST_CASE(AGV_TIMER_TX_STEERING)
TEST_CASE(AGV_TIMER_TX_STATUS)
void test_each_frame_that_waits(unsigned timer) {
    TEST_ASSERT_FALSE(agv_transmitter_waits(&timers));
    agv_timer_start(&timers, timer);
    TEST_ASSERT_TRUE(agv_transmitter_waits(&timers));
    agv_timer_stop(&timers, timer);
    TEST_ASSERT_FALSE(agv_transmitter_waits(&timers));
}

/* A frame that is no longer wanted does not wait any more. */
void test_a_command_that_is_not_wanted_any_more_is_not_stalled(void) {
    hal_takes = false;
    burst();
    tick(50);
    orders.state = AGV_STATE_STANDBY;
    EXPECT_STALLED_AFTER(200, false);
}

/* Shows: TOP-2 */
void test_commands_pass_to_the_vehicle_and_status_to_the_ai(void) {
    static const uint8_t speeds[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    be_gateway();
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    pass(AGV_MSG_WHEEL_SPEED, speeds);
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
    pass(AGV_MSG_GEAR_COMMAND, older);
    pass(AGV_MSG_THROTTLE_COMMAND, older);
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    TEST_ASSERT_EQUAL_UINT16(1, report().dropped);
    tick(5);
    hal_takes = true;
    EXPECT_COUNT_AFTER(1, 2);
    expect_sent(0, HAL_CAN_VEHICLE, 0x168, DRIVE);
    expect_sent(1, HAL_CAN_VEHICLE, 0x075, older);
    EXPECT_COUNT_AFTER(5, 2);
}

/* Each side alone. */
/* Shows: FSM-2, TOP-2 */
void test_a_discarded_frame_is_never_sent(void) {
    be_gateway();
    hal_takes = false;
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    pass(AGV_MSG_STEERING_COMMAND, ZEROS);
    pass(AGV_MSG_WHEEL_SPEED, ZEROS);
    EXPECT_STALLED_AFTER(101, true);
    discard(HAL_CAN_VEHICLE);
    TEST_ASSERT_EQUAL_UINT16(2, report().dropped);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    hal_takes = true;
    EXPECT_COUNT_AFTER(1, 1);
    expect_sent(0, HAL_CAN_AI, 0x101, ZEROS);
    hal_takes = false;
    pass(AGV_MSG_WHEEL_SPEED, ZEROS);
    TEST_ASSERT_TRUE(agv_timer_is_started(&timers, AGV_TIMER_TX_AI));
    discard(HAL_CAN_AI);
    TEST_ASSERT_FALSE(agv_timer_is_started(&timers, AGV_TIMER_TX_AI));
    TEST_ASSERT_EQUAL_UINT16(1, report().dropped);
    hal_takes = true;
    EXPECT_COUNT_AFTER(10, 1);
}

/* A stalled AI side does not open the output. */
void test_only_the_vehicle_side_is_stalled(void) {
    be_gateway();
    hal_takes = false;
    pass(AGV_MSG_WHEEL_SPEED, ZEROS);
    EXPECT_STALLED_AFTER(500, false);
}

/* Shows: SUP-7, TOP-3 */
void test_in_bus_off_no_own_frame_is_passed_to_the_hal(void) {
    config.status_frame_id = 0x123;
    agv_timer_start(&timers, AGV_TIMER_BUS_OFF);
    burst();
    EXPECT_COUNT_AFTER(500, 0);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
}

/* ---- The pace of the gateway ---- */

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
    EXPECT_COUNT_AFTER(29, 1);
    EXPECT_COUNT_AFTER(1, 2);
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
    EXPECT_COUNT_AFTER(1, 2);
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
    drop(AGV_MSG_GEAR_COMMAND);
    TEST_ASSERT_EQUAL_UINT16(1, report().dropped);
    EXPECT_COUNT_AFTER(200, 1);
}

/* A dropped command that the HAL refused no longer counts as stalled. */
/* Shows: TOP-2, SUP-7 */
void test_a_dropped_command_does_not_stall(void) {
    be_gateway();
    hal_takes = false;
    pass(AGV_MSG_GEAR_COMMAND, DRIVE);
    tick(50);
    drop(AGV_MSG_GEAR_COMMAND);
    EXPECT_STALLED_AFTER(200, false);
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

/* ---- The end of an engagement ---- */

/* What waits in the controller is purged. */
static void end_engagement(void) {
    orders.state = AGV_STATE_STANDBY;
    hal_can_purge_Expect(&hal, HAL_CAN_VEHICLE);
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
    EXPECT_COUNT_AFTER(48, 2);
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
    EXPECT_STALLED_AFTER(100, false);
    EXPECT_STALLED_AFTER(1, true);
    hal_takes = true;
    EXPECT_COUNT_AFTER(1, 1);
    expect_sent(0, HAL_CAN_VEHICLE, 0x075, ZEROS);
    TEST_ASSERT_FALSE(agv_transmitter_is_stalled(&timers));
    EXPECT_COUNT_AFTER(100, 1);
}

/* Discarded by a trip, and by the next engagement, because it would follow newer frames. */
/* Shows: TOP-2, FSM-2 */
void test_throttle_0_that_waits_is_discarded_and_replaced(void) {
    static const uint8_t half[8] = {125};
    be_gateway();
    hal_takes = false;
    end_engagement();
    discard(HAL_CAN_VEHICLE);
    hal_takes = true;
    EXPECT_COUNT_AFTER(10, 0);
    hal_takes = false;
    end_engagement();
    orders.state = AGV_STATE_ACTIVE;
    pass(AGV_MSG_GEAR_COMMAND, DRIVE); /* not by another command */
    pass(AGV_MSG_THROTTLE_COMMAND, half);
    hal_takes = true;
    EXPECT_COUNT_AFTER(10, 2);
    expect_sent_data(0, 0x168, DRIVE);
    expect_sent_data(1, 0x075, half);
}

/* In the next engagement the HAL takes another command before the throttle 0. */
/* Shows: TOP-2 */
TEST_CASE(AGV_MSG_TURN_SIGNAL_COMMAND)
TEST_CASE(AGV_MSG_GEAR_COMMAND)
TEST_CASE(AGV_MSG_STEERING_COMMAND)
void test_throttle_0_is_not_replaced_by_another_command(unsigned command) {
    be_gateway();
    hal_takes = false;
    end_engagement();
    orders.state = AGV_STATE_ACTIVE;
    hal_takes = true;
    pass(command, (command == AGV_MSG_GEAR_COMMAND) ? DRIVE : ZEROS);
    TEST_ASSERT_EQUAL_UINT(1, sent_count);
    EXPECT_COUNT_AFTER(10, 2);
    expect_sent_data(1, 0x075, ZEROS);
}

/* Shows: TOP-2, SUP-7 */
void test_in_bus_off_no_throttle_0_is_passed_to_the_hal(void) {
    be_gateway();
    agv_timer_start(&timers, AGV_TIMER_BUS_OFF);
    end_engagement();
    TEST_ASSERT_EQUAL_UINT(0, sent_count);
    agv_timer_stop(&timers, AGV_TIMER_BUS_OFF);
    EXPECT_COUNT_AFTER(10, 0);
}

/* ---- Overrides ---- */

/* The queue is full: the override is tried again, and also answers a frame that came within its 5 ms. */
/* Shows: TOP-1 */
void test_an_override_that_waits_for_the_hal_answers_what_comes_meanwhile(void) {
    burst();
    sent_count = 0;
    hal_takes = false;
    answer(AGV_MSG_GEAR_COMMAND, DRIVE);
    tick(1);
    answer(AGV_MSG_GEAR_COMMAND, DRIVE);
    hal_takes = true;
    EXPECT_COUNT_AFTER(1, 1);
    expect_sent(0, HAL_CAN_VEHICLE, 0x168, PARK);
    EXPECT_COUNT_AFTER(10, 1);
}

/* Shows: SUP-7, FSM-2 */
void test_an_override_that_waits_is_discarded_too(void) {
    burst();
    sent_count = 0;
    tick(1);
    answer(AGV_MSG_GEAR_COMMAND, DRIVE);
    tick(1);
    answer(AGV_MSG_GEAR_COMMAND, DRIVE);
    discard(HAL_CAN_VEHICLE);
    EXPECT_COUNT_AFTER(10, 1);
}

void test_there_is_a_report_only_after_something_was_done(void) {
    TEST_ASSERT_FALSE(agv_transmitter_has_report(&transmitter));
    burst();
    TEST_ASSERT_TRUE(agv_transmitter_has_report(&transmitter));
    (void)report();
    TEST_ASSERT_FALSE(agv_transmitter_has_report(&transmitter));
}

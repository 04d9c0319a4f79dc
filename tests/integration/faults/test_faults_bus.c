/* Faults of the controllers (SUP-7) and of the supervisor's own time (TIM-4). The test sets the controller's state
 * between two ticks; the next tick reads it. */
#include "one_fixture.h"
#include "walk.h"

static void set_state(hal_can_side_t side, hal_can_state_t state) {
    sim_hal_set_can_state(&f.hal, side, state);
}

static uint32_t purges(hal_can_side_t side) {
    return f.hal.can[side].purges;
}

static uint32_t recoveries(hal_can_side_t side) {
    return f.hal.can[side].recover_requests;
}

/* ---- BUS_OFF ---- */

static void expect_bus_off_trip(void) {
    expect_fault(&f, AGV_FAULT_BUS_OFF, true);
    expect_tripped(&f, AGV_FAULT_BUS_OFF);
    expect_output(&f, false); /* at once, because no command can be sent */
    expect_led(&f, 14);
    expect_silence(&f);
}

/* Shows: SUP-7, FSM-2, FSM-4, BUS_OFF */
void test_bus_off_trips_and_opens_the_output(void) {
    fixture_active(&f);
    expect_output(&f, true);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    expect_nothing(&f, AGV_FAULT_BUS_OFF, AGV_STATE_ACTIVE);
    fixture_run(&f, 1);
    expect_bus_off_trip();
    expect_fault_after(&f, 200, AGV_FAULT_TX_STALLED, false); /* and nothing else of the bus */
    expect_fault(&f, AGV_FAULT_ERROR_PASSIVE, false);
    expect_fault(&f, AGV_FAULT_AI_BUS_OFF, false);
}

/* After 100 ms. Queued frames are purged with the request. */
/* Shows: SUP-7, BUS_OFF */
void test_recovery_is_requested(void) {
    fixture_active(&f);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    fixture_run(&f, 1);
    fixture_run(&f, 99);
    TEST_ASSERT_EQUAL_UINT32(0, recoveries(HAL_CAN_VEHICLE));
    const uint32_t purged = purges(HAL_CAN_VEHICLE);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1, recoveries(HAL_CAN_VEHICLE));
    TEST_ASSERT_EQUAL_UINT32(purged + 1, purges(HAL_CAN_VEHICLE));
    expect_silence(&f);
}

/* Recovered: all safe commands at once, the trip stays. */
/* Shows: SUP-7, FSM-3, BUS_OFF */
void test_after_the_recovery(void) {
    fixture_active(&f);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    expect_fault_after(&f, 137, AGV_FAULT_BUS_OFF, true);
    expect_silence(&f);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    expect_fault_after(&f, 1, AGV_FAULT_BUS_OFF, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, AGV_FAULT_BUS_OFF));
    expect_safe_commands(&f, f.call, ANGLE_CENTRE);
    expect_tripped(&f, AGV_FAULT_BUS_OFF);
    expect_output(&f, false); /* until the next STANDBY */
    expect_led(&f, 14);
}

/* A bus-off that ends between two ticks: the controller's count shows it. Trip and recovery together send the safe
 * commands once. */
/* Shows: SUP-7, FSM-2, BUS_OFF */
void test_bus_off_between_two_ticks(void) {
    fixture_active(&f);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    expect_trip_after(&f, 1, AGV_FAULT_BUS_OFF, ANGLE_CENTRE);
    expect_output(&f, false);
    expect_fault_after(&f, 1, AGV_FAULT_BUS_OFF, false);
}

/* In INIT nothing latches; recovered, the safe commands go out at once. */
/* Shows: SUP-7, BUS_OFF */
void test_bus_off_in_init(void) {
    fixture_start(&f);
    fixture_run(&f, 40);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    fixture_forget_sent(&f);
    expect_fault_after(&f, 1500, AGV_FAULT_BUS_OFF, true);
    expect_state(&f, AGV_STATE_INIT);
    expect_reason(&f, AGV_FAULT_NONE);
    expect_silence(&f);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    fixture_run(&f, 1);
    expect_safe_commands(&f, f.call, NO_HOLD); /* INIT sends no 065h */
    expect_state_after(&f, 600, AGV_STATE_STANDBY);
}

/* A frame that waited to be forwarded at bus-off is never sent. */
/* Shows: SUP-7, TOP-2, BUS_OFF */
void test_queued_frames_are_never_sent(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    fixture_run_before(&f, AGV_MSG_TURN_SIGNAL_COMMAND);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    fixture_run(&f, 30); /* 43Fh, 168h, 065h wait */
    set_state(HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    fixture_run(&f, 120);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    fixture_mute_ai(&f, true);
    fixture_forget_sent(&f);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    fixture_run(&f, 1);
    expect_safe_commands(&f, f.call, ANGLE_CENTRE);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x43F));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
}

/* ---- TX_STALLED ---- */

/* The trip purges the controller, so that the safe commands go out. */
/* Shows: SUP-7, FSM-2, FSM-4, TX_STALLED */
void test_a_frame_that_is_not_sent(void) {
    fixture_active(&f);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 100);
    expect_nothing_after(&f, 10, AGV_FAULT_TX_STALLED, AGV_STATE_ACTIVE);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
    const uint32_t purged = purges(HAL_CAN_VEHICLE);
    expect_trip_after(&f, 1, AGV_FAULT_TX_STALLED, ANGLE_CENTRE);
    expect_output(&f, false);
    expect_led(&f, 14);
    TEST_ASSERT_EQUAL_UINT32(purged + 1, purges(HAL_CAN_VEHICLE));
    expect_fault_after(&f, 1, AGV_FAULT_TX_STALLED, false); /* no frame is pending any more */
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, AGV_FAULT_TX_STALLED));
    expect_reason(&f, AGV_FAULT_TX_STALLED);
}

/* The controller holds a frame that cannot leave. Each 101 ms all frames are withdrawn, and the safe commands go out anew. */
/* Shows: SUP-7, FSM-1, TX_STALLED */
void test_in_tripped_a_frame_that_cannot_leave_is_withdrawn_again_and_again(void) {
    fixture_active(&f);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
    fixture_run(&f, 1);
    expect_tripped(&f, AGV_FAULT_TX_STALLED);
    for (uint32_t n = 1; n <= 5; n++) {
        const uint32_t purged = purges(HAL_CAN_VEHICLE);
        sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 100);
        fixture_run(&f, 100);
        TEST_ASSERT_EQUAL_UINT32(purged, purges(HAL_CAN_VEHICLE));
        sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
        fixture_run(&f, 1);
        TEST_ASSERT_EQUAL_UINT32(purged + 1, purges(HAL_CAN_VEHICLE));
        expect_safe_commands(&f, f.call, ANGLE_CENTRE);
        expect_fault(&f, AGV_FAULT_TX_STALLED, true); /* that was no end of it */
    }
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, AGV_FAULT_TX_STALLED));
    expect_fault_after(&f, 1, AGV_FAULT_TX_STALLED, false); /* none waits */
}

static void expect_withdrawals_in_init(bool vcu_is_there, uint32_t expected) {
    setUp();
    fixture_start(&f);
    fixture_mute_vcu(&f, !vcu_is_there);
    fixture_run(&f, 30);
    const uint32_t purged = purges(HAL_CAN_VEHICLE);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
    fixture_forget_sent(&f);
    expect_fault_after(&f, 1, AGV_FAULT_TX_STALLED, true);
    TEST_ASSERT_EQUAL_UINT32(purged + expected, purges(HAL_CAN_VEHICLE));
    TEST_ASSERT_EQUAL_UINT32(expected, fixture_count_sent(&f, 0x168));
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    expect_fault_after(&f, 1, AGV_FAULT_TX_STALLED, false);
}

/* In INIT the frames wait as long as no VCU is there to receive them. A bus-off ends the stall. */
/* Shows: SUP-7, TX_STALLED, BUS_OFF */
void test_in_init_a_frame_that_cannot_leave_waits_for_a_vcu(void) {
    expect_withdrawals_in_init(false, 0);
    expect_withdrawals_in_init(true, 1);
}

/* A stall that began before the VCU was there is answered when it is. A node that sends 400h without a pause keeps back 43Fh. */
/* Shows: SUP-7, TX_STALLED, TOP-1 */
void test_in_init_a_frame_that_cannot_leave_is_withdrawn_for_a_late_vcu(void) {
    fixture_start(&f);
    fixture_mute_vcu(&f, true);
    fixture_run(&f, 30);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
    fixture_run(&f, 200);
    const uint32_t purged = purges(HAL_CAN_VEHICLE);
    fixture_mute_vcu(&f, false);
    fixture_run(&f, 1);
    fixture_forget_sent(&f);
    fixture_run(&f, 30);
    TEST_ASSERT_EQUAL_UINT32(purged + 1, purges(HAL_CAN_VEHICLE));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x43F));
}

/* The status frame goes out in its next slot: it may be what cannot leave, and would be next in the controller. */
/* Shows: SUP-7, TOP-3, TX_STALLED */
void test_a_status_frame_that_is_withdrawn_waits_for_its_slot(void) {
    fixture_active(&f);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
    fixture_run(&f, 1);
    for (uint32_t before = f.status_count; f.status_count == before;) {
        fixture_run(&f, 1);
    }
    const uint32_t count = f.status_count;
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
    fixture_run(&f, 95);
    TEST_ASSERT_EQUAL_UINT32(count, f.status_count);
    fixture_run(&f, 5);
    TEST_ASSERT_EQUAL_UINT32(count + 1, f.status_count);
}

/* A controller from which they cannot be withdrawn is asked once: the commands do not flood it. */
/* Shows: SUP-7, TX_STALLED */
void test_a_stall_without_an_end_is_answered_once(void) {
    fixture_active(&f);
    const uint32_t purged = purges(HAL_CAN_VEHICLE);
    for (uint32_t n = 0; n < 300; n++) {
        sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
        fixture_run(&f, 1);
    }
    TEST_ASSERT_EQUAL_UINT32(purged + 1, purges(HAL_CAN_VEHICLE));
    fixture_forget_sent(&f);
    for (uint32_t n = 0; n < 100; n++) {
        sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
        fixture_run(&f, 1);
    }
    TEST_ASSERT_UINT32_WITHIN(1, 1, fixture_count_sent(&f, 0x43F));
}

/* The queue accepts nothing: INIT's first 075h is due 33 ms after the start, so the transmitter is stalled 101 ms
 * later. */
/* Shows: SUP-7, TX_STALLED */
void test_a_queue_that_accepts_nothing_in_init(void) {
    fixture_start(&f);
    fixture_run(&f, 10);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    expect_nothing_after(&f, 133 - 10, AGV_FAULT_TX_STALLED, AGV_STATE_INIT);
    expect_fault_after(&f, 1, AGV_FAULT_TX_STALLED, true);
    expect_led(&f, 14);
    expect_state_after(&f, 1000, AGV_STATE_INIT);
    expect_reason(&f, AGV_FAULT_NONE);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    expect_fault_after(&f, 2, AGV_FAULT_TX_STALLED, false);
    expect_state_after(&f, 600, AGV_STATE_STANDBY);
}

/* The gateway cannot forward: it trips 101 ms after the first refused command. When the queue accepts frames again, the
 * safe commands are sent, not the waiting ones. */
/* Shows: SUP-7, TOP-2, FSM-2, TX_STALLED */
void test_a_queue_that_accepts_nothing_in_a_gateway(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    fixture_run_before(&f, AGV_MSG_STEERING_COMMAND);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    fixture_run(&f, 1);
    expect_nothing_after(&f, 100, AGV_FAULT_TX_STALLED, AGV_STATE_ACTIVE);
    expect_fault_after(&f, 1, AGV_FAULT_TX_STALLED, true);
    expect_tripped(&f, AGV_FAULT_TX_STALLED);
    expect_output(&f, false);
    fixture_run(&f, 50);
    fixture_mute_ai(&f, true);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    fixture_forget_sent(&f);
    fixture_run(&f, 1);
    expect_safe_commands(&f, f.call, ANGLE_CENTRE);
}

/* ---- Warnings ---- */

/* A transient: ends a second after the last overrun. */
/* Shows: SUP-7, RX_OVERRUN */
void test_receive_overrun(void) {
    fixture_active(&f);
    sim_hal_add_overrun(&f.hal, HAL_CAN_VEHICLE);
    expect_nothing(&f, AGV_FAULT_RX_OVERRUN, AGV_STATE_ACTIVE);
    fixture_run(&f, 1);
    expect_warning(&f, AGV_FAULT_RX_OVERRUN, AGV_STATE_ACTIVE);
    expect_led(&f, 14);
    fixture_run(&f, 500);
    sim_hal_add_overrun(&f.hal, HAL_CAN_VEHICLE);
    fixture_run(&f, 1);
    expect_fault_after(&f, 999, AGV_FAULT_RX_OVERRUN, true);
    expect_fault_after(&f, 1, AGV_FAULT_RX_OVERRUN, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, AGV_FAULT_RX_OVERRUN));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, AGV_FAULT_RX_OVERRUN));
    expect_led(&f, 0);
    expect_silence(&f);
}

/* An overrun of the AI side only warns: an AI computer that babbles must not hinder the operator. */
/* Shows: SUP-7, FSM-3, RX_OVERRUN */
void test_an_overrun_that_trips_is_one_of_the_vehicle_side(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    agv_fault_set_put(&f.config.trips, AGV_FAULT_RX_OVERRUN, true);
    fixture_standby(&f);
    sim_hal_add_overrun(&f.hal, HAL_CAN_AI);
    expect_nothing_after(&f, 100, AGV_FAULT_RX_OVERRUN, AGV_STATE_STANDBY);
    sim_hal_add_overrun(&f.hal, HAL_CAN_VEHICLE);
    fixture_run(&f, 1);
    expect_tripped(&f, AGV_FAULT_RX_OVERRUN);
}

/* Corrupted memory is found, and the supervisor begins anew: what the controllers counted before is no new overrun. */
/* Shows: SUP-7, INT-5, RX_OVERRUN */
void test_an_overrun_before_a_corruption_is_not_raised_again(void) {
    for (unsigned side = 0; side < 2; side++) {
        fixture_init(&f);
        f.config.topology = AGV_TOPOLOGY_GATEWAY;
        fixture_standby(&f);
        sim_hal_add_overrun(&f.hal, (hal_can_side_t)side);
        expect_fault_after(&f, 1, AGV_FAULT_RX_OVERRUN, true);
        expect_fault_after(&f, 1000, AGV_FAULT_RX_OVERRUN, false);
        fixture_flip_bit(&f, 1000);
        expect_tripped_after(&f, 1, AGV_FAULT_MEMORY_CORRUPTED);
        expect_fault_after(&f, 10, AGV_FAULT_RX_OVERRUN, false);
        TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, AGV_FAULT_RX_OVERRUN));
    }
}

/* Shows: SUP-7, ERROR_PASSIVE */
void test_error_passive(void) {
    fixture_active(&f);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_ERROR_PASSIVE);
    fixture_run(&f, 1);
    expect_warning(&f, AGV_FAULT_ERROR_PASSIVE, AGV_STATE_ACTIVE);
    expect_led(&f, 14);
    expect_fault_after(&f, 3000, AGV_FAULT_ERROR_PASSIVE, true);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    expect_fault_after(&f, 1, AGV_FAULT_ERROR_PASSIVE, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, AGV_FAULT_ERROR_PASSIVE));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, AGV_FAULT_ERROR_PASSIVE));
    expect_state(&f, AGV_STATE_ACTIVE);
    expect_led(&f, 0);
}

/* A warning in INIT does not keep INIT from being left. */
/* Shows: SUP-7, ERROR_PASSIVE, RX_OVERRUN */
void test_warnings_of_the_bus_in_init(void) {
    fixture_start(&f);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_ERROR_PASSIVE);
    sim_hal_add_overrun(&f.hal, HAL_CAN_VEHICLE);
    expect_fault_after(&f, 1, AGV_FAULT_ERROR_PASSIVE, true);
    expect_fault(&f, AGV_FAULT_RX_OVERRUN, true);
    expect_state_after(&f, 600, AGV_STATE_STANDBY);
}

/* The AI side only warns. Recovery is requested there, and only there. */
/* Shows: SUP-7, AI_BUS_OFF */
void test_bus_off_of_the_ai_side(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_standby(&f);
    set_state(HAL_CAN_AI, HAL_CAN_BUS_OFF);
    fixture_run(&f, 1);
    expect_warning(&f, AGV_FAULT_AI_BUS_OFF, AGV_STATE_STANDBY);
    expect_led(&f, 14);
    expect_output(&f, true);
    fixture_run(&f, 99);
    TEST_ASSERT_EQUAL_UINT32(0, recoveries(HAL_CAN_AI));
    const uint32_t purged = purges(HAL_CAN_AI);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1, recoveries(HAL_CAN_AI));
    TEST_ASSERT_EQUAL_UINT32(purged + 1, purges(HAL_CAN_AI));
    TEST_ASSERT_EQUAL_UINT32(0, recoveries(HAL_CAN_VEHICLE));
    set_state(HAL_CAN_AI, HAL_CAN_ERROR_ACTIVE);
    expect_fault_after(&f, 1, AGV_FAULT_AI_BUS_OFF, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, AGV_FAULT_AI_BUS_OFF));
    expect_state(&f, AGV_STATE_STANDBY);
}

static void active_before_a_status_message(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    f.long_run = true;
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
}

/* No frame for the AI side leaves for more than 100 ms. */
/* Shows: SUP-7, AI_BUS_OFF */
void test_a_queue_of_the_ai_side_that_accepts_nothing_only_warns(void) {
    active_before_a_status_message();
    sim_hal_set_full(&f.hal, HAL_CAN_AI, true);
    fixture_run(&f, 1);
    expect_nothing_after(&f, 100, AGV_FAULT_AI_BUS_OFF, AGV_STATE_ACTIVE);
    expect_fault_after(&f, 1, AGV_FAULT_AI_BUS_OFF, true);
    expect_warning(&f, AGV_FAULT_AI_BUS_OFF, AGV_STATE_ACTIVE);
    expect_output(&f, true);
    sim_hal_set_full(&f.hal, HAL_CAN_AI, false);
    expect_fault_after(&f, 2, AGV_FAULT_AI_BUS_OFF, false);
    expect_state(&f, AGV_STATE_ACTIVE);
}

/* Some of the status messages always wait, but the others leave. */
/* Shows: SUP-7, AI_BUS_OFF */
void test_a_queue_of_the_ai_side_that_is_full_most_of_the_time_is_no_fault(void) {
    active_before_a_status_message();
    for (uint32_t i = 0; i < 20; i++) {
        sim_hal_set_full(&f.hal, HAL_CAN_AI, true);
        expect_nothing_after(&f, 90, AGV_FAULT_AI_BUS_OFF, AGV_STATE_ACTIVE);
        sim_hal_set_full(&f.hal, HAL_CAN_AI, false);
        fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    }
}

/* Shows: SUP-7, AI_BUS_OFF */
void test_a_queue_of_the_ai_side_that_accepts_nothing_trips_if_so_chosen(void) {
    agv_fault_set_put(&f.config.trips, AGV_FAULT_AI_BUS_OFF, true);
    active_before_a_status_message();
    sim_hal_set_full(&f.hal, HAL_CAN_AI, true);
    fixture_run(&f, 102);
    expect_tripped(&f, AGV_FAULT_AI_BUS_OFF);
}

/* Frames that wait for the AI side at its bus-off are dropped in that tick, one for each status message, and never
 * sent. */
/* Shows: SUP-7, TOP-2, AI_BUS_OFF */
void test_waiting_frames_for_the_ai_side_are_discarded_in_its_bus_off(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_standby(&f);
    fixture_run_before(&f, AGV_MSG_TURN_SIGNAL_COMMAND);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true); /* 43Fh waits for the other side and is kept */
    sim_hal_set_full(&f.hal, HAL_CAN_AI, true);
    fixture_run(&f, 30); /* every status message has come */
    fixture_mute_vcu(&f, true);
    fixture_mute_eps(&f, true);
    const uint32_t dropped = agv_supervisor_counters(&f.supervisor)->dropped;
    set_state(HAL_CAN_AI, HAL_CAN_BUS_OFF);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(dropped + 7, agv_supervisor_counters(&f.supervisor)->dropped);
    sim_hal_set_full(&f.hal, HAL_CAN_AI, false);
    set_state(HAL_CAN_AI, HAL_CAN_ERROR_ACTIVE);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    fixture_forget_sent(&f);
    fixture_run(&f, 10);
    TEST_ASSERT_EQUAL_UINT32(1, f.sent_count);
    TEST_ASSERT_EQUAL_HEX16(0x43F, f.sent[0].id);
}

/* Frames that came during the bus-off are dropped, too, even if it ends before the next tick. */
/* Shows: SUP-7, TOP-2, AI_BUS_OFF */
void test_waiting_frames_for_the_ai_side_are_discarded_in_a_bus_off_between_two_ticks(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_mute_ai(&f, true);
    fixture_standby(&f);
    set_state(HAL_CAN_AI, HAL_CAN_BUS_OFF);
    fixture_run(&f, 50);
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_mute_vcu(&f, true);
    fixture_mute_eps(&f, true);
    const uint32_t dropped = agv_supervisor_counters(&f.supervisor)->dropped;
    fixture_forget_sent(&f);
    set_state(HAL_CAN_AI, HAL_CAN_ERROR_ACTIVE);
    fixture_run(&f, 10);
    TEST_ASSERT_EQUAL_UINT32(0, f.sent_count);
    TEST_ASSERT_EQUAL_UINT32(dropped + 1, agv_supervisor_counters(&f.supervisor)->dropped);
}

/* Bus-off while the safe commands wait for a full queue: BUS_OFF, not TX_STALLED. */
/* Shows: SUP-7, BUS_OFF, TX_STALLED */
void test_in_bus_off_nothing_is_stalled(void) {
    fixture_active(&f);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x80; /* S-driver alarm: trips */
    expect_state_after(&f, 50, AGV_STATE_TRIPPED);
    set_state(HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    expect_fault_after(&f, 300, AGV_FAULT_BUS_OFF, true);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, AGV_FAULT_TX_STALLED));
}

/* While engaged the AI side's bus-off does not trip by itself; the AI's silence does. */
/* Shows: SUP-7, AI_BUS_OFF, STEERING_COMMAND_TIMEOUT */
void test_bus_off_of_the_ai_side_while_engaged(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_STEERING_COMMAND);
    set_state(HAL_CAN_AI, HAL_CAN_BUS_OFF);
    fixture_mute_ai(&f, true);
    expect_fault_after(&f, 125, AGV_FAULT_AI_BUS_OFF, true);
    expect_state(&f, AGV_STATE_ACTIVE);
    expect_reason_after(&f, 1, AGV_FAULT_STEERING_COMMAND_TIMEOUT);
}

/* An AI side that accepts no frames, or does not send them, only warns. */
/* Shows: SUP-7 */
void test_an_overfull_ai_side_only_warns(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_AI, 101);
    sim_hal_set_full(&f.hal, HAL_CAN_AI, true);
    expect_state_after(&f, 3000, AGV_STATE_ACTIVE);
    TEST_ASSERT_TRUE(agv_supervisor_counters(&f.supervisor)->warnings > 0);
    expect_fault(&f, AGV_FAULT_TX_STALLED, false);
}

/* Errors and lost frames of the AI side do not trip. Error-passive is checked on the vehicle side only. */
/* Shows: SUP-7, ERROR_PASSIVE, RX_OVERRUN */
void test_errors_of_the_ai_side(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    set_state(HAL_CAN_AI, HAL_CAN_ERROR_PASSIVE);
    sim_hal_add_overrun(&f.hal, HAL_CAN_AI);
    expect_state_after(&f, 2000, AGV_STATE_ACTIVE);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, AGV_FAULT_ERROR_PASSIVE));
}

/* Shows: TX_STALLED, SUP-7 */
void test_a_controller_that_accepts_nothing_is_detected_after_a_trip(void) {
    walk_to_tripped(&f);
    sim_hal_fail_at(&f.hal, 1, UINT32_MAX, 1u << SIM_HAL_OP_CAN_SEND);
    expect_fault_after(&f, 300, AGV_FAULT_TX_STALLED, true);
    expect_output(&f, false);
}

/* Intrusion (SUP-6): a foreign sender of a command on the vehicle side of a gateway, and commands that come faster than
 * half their cycle. */
#include "one_fixture.h"

/* ---- FOREIGN_COMMAND_SENDER ---- */

static const agv_fault_t FOREIGN = AGV_FAULT_FOREIGN_COMMAND_SENDER;

static void send_foreign(uint32_t id, uint8_t length) {
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = id, .length = length, .data = {1}});
}

static void gateway(agv_id_set_t id_set) {
    fixture_init(&f);
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.config.id_set = (uint16_t)id_set;
}

static void check_foreign(agv_id_set_t id_set, uint32_t id) {
    gateway(id_set);
    fixture_standby(&f);
    const uint32_t dropped = agv_supervisor_counters(&f.supervisor)->dropped;
    send_foreign(id, 8);
    TEST_ASSERT_EQUAL_UINT32(dropped + 1, agv_supervisor_counters(&f.supervisor)->dropped);
    expect_trip(&f, FOREIGN, f.call, NO_HOLD);
    TEST_ASSERT_EQUAL_UINT32(3, f.sent_count); /* it was not forwarded to the AI side */
    expect_led_after(&f, 1, 14);
    gateway(id_set);
    fixture_active(&f);
    send_foreign(id, 8);
    expect_trip(&f, FOREIGN, f.call, ANGLE_CENTRE);
    expect_fault_after(&f, 999, FOREIGN, true);
    expect_fault_after(&f, 1, FOREIGN, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, FOREIGN));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, FOREIGN));
    expect_reason(&f, FOREIGN);
}

/* Shows: SUP-6, TOP-2, FSM-2, P1, FOREIGN_COMMAND_SENDER */
void test_each_command_on_the_vehicle_side(void) {
    static const uint32_t HEADING[] = {0x43F, 0x168, 0x075, 0x065};
    static const uint32_t TABLE[] = {0x201, 0x168, 0x075, 0x065};
    for (unsigned i = 0; i < 4; i++) {
        check_foreign(AGV_ID_SET_HEADING, HEADING[i]);
        check_foreign(AGV_ID_SET_TABLE, TABLE[i]);
    }
}

/* In INIT it latches nothing. */
/* Shows: SUP-6, FOREIGN_COMMAND_SENDER */
void test_a_foreign_sender_in_init(void) {
    gateway(AGV_ID_SET_HEADING);
    fixture_start(&f);
    fixture_run(&f, 100);
    send_foreign(0x075, 8);
    expect_fault(&f, FOREIGN, true);
    expect_state_after(&f, 1200, AGV_STATE_INIT);
    expect_reason(&f, AGV_FAULT_NONE);
    expect_state_after(&f, 400, AGV_STATE_STANDBY);
}

/* Any data frame with the 11-bit identifier of a command, of any length, classic or FD: a VCU may obey it. */
/* Shows: SUP-6, P15, FSM-2, FOREIGN_COMMAND_SENDER */
void test_a_foreign_command_of_any_length(void) {
    static const uint32_t IDS[] = {0x43F, 0x168, 0x075, 0x065};
    for (unsigned i = 0; i < 4 * 9 * 2; i++) {
        const uint8_t flags = i % 2 == 0 ? 0 : HAL_CAN_FD;
        gateway(AGV_ID_SET_HEADING);
        fixture_standby(&f);
        fixture_raw(&f, HAL_CAN_VEHICLE,
                    (hal_can_frame_t){.id = IDS[i / 18], .length = (uint8_t)(i / 2 % 9), .flags = flags});
        expect_trip(&f, FOREIGN, f.call, NO_HOLD);
    }
}

/* No foreign commands: remote requests, 29-bit identifiers, the other set's identifiers, unknown identifiers. */
/* Shows: SUP-6, P1, P15, FOREIGN_COMMAND_SENDER */
void test_frames_that_are_no_foreign_command(void) {
    static const uint8_t FLAGS[] = {HAL_CAN_EXTENDED, HAL_CAN_REMOTE, HAL_CAN_ERROR};
    gateway(AGV_ID_SET_HEADING);
    fixture_active(&f);
    send_foreign(0x201, 8);
    send_foreign(0x169, 8);
    send_foreign(0x169, 7);
    for (unsigned i = 0; i < 3; i++) {
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x168, .length = 8, .flags = FLAGS[i]});
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x168, .length = 3, .flags = FLAGS[i]});
        fixture_raw(&f, HAL_CAN_VEHICLE,
                    (hal_can_frame_t){.id = 0x168, .length = 8, .flags = (uint8_t)(FLAGS[i] | HAL_CAN_FD)});
    }
    expect_nothing_after(&f, 100, FOREIGN, AGV_STATE_ACTIVE);
}

/* On the shared bus the AI computer is on the vehicle side. */
/* Shows: SUP-6, TOP-1 */
void test_no_foreign_sender_on_the_shared_bus(void) {
    fixture_active(&f);
    send_foreign(0x168, 8);
    send_foreign(0x43F, 8);
    expect_nothing_after(&f, 200, FOREIGN, AGV_STATE_ACTIVE);
}

/* ---- COMMAND_TOO_FAST ---- */

static const agv_fault_t FAST = AGV_FAULT_COMMAND_TOO_FAST;

/* The first frame comes a whole cycle after the previous one; then this many gaps follow. */
static void send_first(agv_message_t message) {
    fixture_run_past(&f, message);
    f.traffic[message].muted = true;
    fixture_run(&f, f.traffic[message].cycle_ms);
    fixture_send_now(&f, message);
}

static void send_gaps(agv_message_t message, unsigned count, uint32_t gap_ms) {
    for (unsigned i = 0; i < count; i++) {
        fixture_run(&f, gap_ms);
        fixture_send_now(&f, message);
    }
}

/* Frames with a value out of range count, too (in manual they are dropped). */
/* Shows: SUP-5, SUP-6, COMMAND_TOO_FAST */
void test_frames_out_of_range_count_too(void) {
    fixture_standby(&f);
    send_first(AGV_MSG_GEAR_COMMAND);
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = 3;
    send_gaps(AGV_MSG_GEAR_COMMAND, 9, 10);
    expect_nothing(&f, FAST, AGV_STATE_STANDBY);
    send_gaps(AGV_MSG_GEAR_COMMAND, 1, 10);
    expect_warning(&f, FAST, AGV_STATE_STANDBY);
    expect_fault_after(&f, 350, FAST, true);
    expect_fault_after(&f, 1, FAST, false); /* a tick after the deadline ends it */
}

/* The same warning while engaged and in INIT. The number of gaps is a setting. */
/* Shows: SUP-6, COMMAND_TOO_FAST */
void test_too_fast_in_other_states(void) {
    f.config.command_too_fast_gaps = 2;
    fixture_active(&f);
    send_first(AGV_MSG_STEERING_COMMAND);
    send_gaps(AGV_MSG_STEERING_COMMAND, 1, 5);
    expect_nothing(&f, FAST, AGV_STATE_ACTIVE);
    send_gaps(AGV_MSG_STEERING_COMMAND, 1, 5);
    expect_warning(&f, FAST, AGV_STATE_ACTIVE);
    fixture_init(&f);
    fixture_start(&f);
    send_first(AGV_MSG_THROTTLE_COMMAND);
    send_gaps(AGV_MSG_THROTTLE_COMMAND, 10, 10);
    expect_fault(&f, FAST, true);
    expect_state_after(&f, 500, AGV_STATE_STANDBY); /* a warning does not keep INIT */
}

/* Malformed frames are no commands: they are not counted here. */
/* Shows: SUP-6, P15, COMMAND_TOO_FAST */
void test_malformed_frames_are_not_too_fast(void) {
    fixture_standby(&f);
    for (unsigned i = 0; i < 50; i++) {
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x168, .length = 7, .data = {8}});
        fixture_run(&f, 2);
    }
    expect_nothing(&f, FAST, AGV_STATE_STANDBY);
}

/* The rate is checked in every mode: the end of an engagement does not clear the score. */
/* Shows: SUP-6, COMMAND_TOO_FAST */
void test_gaps_are_counted_across_the_end_of_an_engagement(void) {
    fixture_active(&f);
    send_first(AGV_MSG_TURN_SIGNAL_COMMAND);
    send_gaps(AGV_MSG_TURN_SIGNAL_COMMAND, 5, 10);
    fixture_mode(&f, MODE_MANUAL);
    send_gaps(AGV_MSG_TURN_SIGNAL_COMMAND, 4, 10);
    expect_fault(&f, FAST, false);
    send_gaps(AGV_MSG_TURN_SIGNAL_COMMAND, 1, 10);
    expect_fault(&f, FAST, true);
}

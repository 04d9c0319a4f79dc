/* Reaction: its time, the first frames, and the schedule after it. */
#include "one_fixture.h"
#include "walk.h"

/* Shows: FSM-2, S_DRIVER_ALARM */
void test_a_fault_in_a_frame_trips_in_the_same_call(void) {
    fixture_angle(&f, 9123);
    fixture_command_angle(&f, 9123);
    fixture_active(&f);
    expect_silence(&f);
    walk_alarm(&f, ALARM_S_DRIVER);
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    expect_trip(&f, AGV_FAULT_S_DRIVER_ALARM, f.call, 9123);
    TEST_ASSERT_EQUAL_UINT32(4, f.sent_count);
}

/* Shows: FSM-2, AI_COMMAND_OUT_OF_RANGE */
void test_a_command_out_of_range_is_answered_once_and_in_its_own_handling(void) {
    static const uint8_t no_gear[8] = {3};
    fixture_active(&f);
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, no_gear);
    expect_trip(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, f.call, 9000);
    TEST_ASSERT_EQUAL_UINT32(4, f.sent_count); /* no additional override */
}

static void expect_sent_at(uint32_t trip_ms, uint32_t id, const uint32_t *after_ms, uint32_t count) {
    TEST_ASSERT_EQUAL_UINT32(count, fixture_count_sent(&f, id));
    for (uint32_t n = 0; n < count; n++) {
        TEST_ASSERT_EQUAL_UINT32(after_ms[n], fixture_nth_sent(&f, id, n)->time_ms - trip_ms);
    }
}

/* Shows: FSM-2, TIM-1 */
void test_the_schedule_after_a_trip(void) {
    static const uint32_t SIGNALS[] = {0, 100, 200, 300};
    static const uint32_t GEAR[] = {0, 66, 166, 266};
    static const uint32_t THROTTLE[] = {0, 33, 133, 233};
    static const uint32_t STEERING[] = {0, 25, 50, 75, 100, 125, 150, 175, 200, 225, 250, 275, 300};
    walk_to_tripped(&f);
    const uint32_t trip_ms = f.now_ms;
    fixture_run(&f, 310);
    expect_sent_at(trip_ms, 0x43F, SIGNALS, 4);
    expect_sent_at(trip_ms, 0x168, GEAR, 4);
    expect_sent_at(trip_ms, 0x075, THROTTLE, 4);
    expect_sent_at(trip_ms, 0x065, STEERING, 13);
}

/* Shows: FSM-2, FSM-8 */
void test_the_bytes_after_a_trip(void) {
    walk_to_tripped(&f);
    fixture_run(&f, 1000);
    const uint8_t first = fixture_nth_sent(&f, 0x43F, 0)->data[7];
    uint8_t counter = first;
    for (uint32_t i = 0; i < f.sent_count; i++) {
        expect_safe_frame(&f, &f.sent[i], ANGLE_CENTRE);
        if (f.sent[i].id == 0x43F) {
            TEST_ASSERT_EQUAL_UINT8(counter++, f.sent[i].data[7]);
        }
    }
    TEST_ASSERT_EQUAL_UINT8(11, (uint8_t)(counter - first)); /* at 0, 100 ... 1000 ms */
}

/* Shows: FSM-2, FSM-5 */
void test_a_second_trip_cause_sends_nothing_at_once(void) {
    walk_to_tripped(&f);
    fixture_run(&f, 10);
    fixture_forget_sent(&f);
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0x80;
    fixture_send_now(&f, AGV_MSG_EPS_STATUS);
    expect_silence(&f);
    expect_fault(&f, AGV_FAULT_EPS_POSITION_ENCODER, true);
}

/* ---- Frames that wait at a trip ---- */

/* The AI side commands D, 20 % and an angle while the vehicle side accepts nothing: all frames wait in the
 * supervisor. */
static void let_commands_wait(void) {
    static const uint8_t drive[8] = {GEAR_D};
    static const uint8_t throttle[8] = {50};
    static const uint8_t angle[8] = {0x30, 0x23};
    static const uint8_t signals[8] = {0, 0, 0, 0, 0x80, 0, 0, 77};
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, drive);
    fixture_frame(&f, AGV_MSG_THROTTLE_COMMAND, throttle);
    fixture_frame(&f, AGV_MSG_STEERING_COMMAND, angle);
    fixture_frame(&f, AGV_MSG_TURN_SIGNAL_COMMAND, signals);
    fixture_forget_sent(&f);
}

static void expect_each_command_sent(uint32_t times) {
    TEST_ASSERT_EQUAL_UINT32(times, fixture_count_sent(&f, 0x43F));
    TEST_ASSERT_EQUAL_UINT32(times, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(times, fixture_count_sent(&f, 0x075));
    TEST_ASSERT_EQUAL_UINT32(times, fixture_count_sent(&f, 0x065));
}

/* Shows: FSM-2 */
void test_frames_that_wait_in_the_supervisor_at_a_trip_are_discarded(void) {
    let_commands_wait();
    const uint32_t dropped = agv_supervisor_counters(&f.supervisor)->dropped;
    const uint32_t purges = f.hal.can[HAL_CAN_VEHICLE].purges;
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    walk_trip(&f);
    TEST_ASSERT_EQUAL_UINT32(purges + 1, f.hal.can[HAL_CAN_VEHICLE].purges);
    TEST_ASSERT_EQUAL_UINT32(dropped + 4, agv_supervisor_counters(&f.supervisor)->dropped);
    expect_each_command_sent(1);
    fixture_mute_ai(&f, true);
    fixture_run(&f, 24);
    expect_each_command_sent(1);
    fixture_run(&f, 500); /* the oracle checks every frame */
}

/* Shows: FSM-2, TOP-1 */
void test_refused_safe_commands_wait_one_per_message(void) {
    let_commands_wait();
    walk_trip(&f);
    fixture_mute_ai(&f, true);
    fixture_run(&f, 70); /* slots of 065h, 075h and 168h pass meanwhile */
    expect_each_command_sent(0);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    fixture_run(&f, 1);
    expect_each_command_sent(1);
    expect_count_after(&f, 28, 0x43F, 1); /* the schedule stands: 43Fh is due 100 ms after the trip */
    expect_count_after(&f, 1, 0x43F, 2);
}

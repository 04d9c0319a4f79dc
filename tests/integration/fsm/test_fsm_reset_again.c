/* Effects of an earlier reset, trip or start on the next reset, and the state that a reset clears. */
#include "one_fixture.h"
#include "walk.h"

/* The AI computer is forgotten in the frame that releases the button, not only in the next tick. */
static void expect_reset_in_a_frame(agv_fault_t forgotten) {
    fixture_vehicle_confirms(&f);
    expect_fault_after(&f, 300, forgotten, true);
    walk_button(&f, true);
    expect_state_after(&f, 999, AGV_STATE_SAFE);
    fixture_run_without_ticks(&f, 1);
    walk_button(&f, false);
    expect_state(&f, AGV_STATE_STANDBY);
    expect_fault(&f, forgotten, false);
}

/* The reset forgets that it was alive, but not its silence: an engagement before the next tick finds it lost. */
/* Shows: FSM-3, FSM-11, SUP-8, AI_HEARTBEAT_LOST, AI_HEARTBEAT_STUCK */
void test_a_reset_forgets_the_ai_computer_at_once(void) {
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    fixture_run(&f, 500);
    expect_reset_in_a_frame(AGV_FAULT_AI_HEARTBEAT_LOST);
    walk_report(&f, MODE_ENGAGED);
    expect_tripped(&f, AGV_FAULT_AI_HEARTBEAT_LOST);
    fixture_init(&f);
    fixture_active(&f);
    f.traffic[AGV_MSG_TURN_SIGNAL_COMMAND].frozen = true;
    fixture_run(&f, 500);
    expect_reset_in_a_frame(AGV_FAULT_AI_HEARTBEAT_STUCK);
}

/* A trip directly after a reset. The button is pressed in the next frame, with which all conditions hold again. */
/* Shows: FSM-3 */
void test_a_second_reset_needs_its_own_second(void) {
    walk_to_safe(&f);
    walk_reset(&f, 1000);
    fixture_run(&f, 2000);
    walk_trip(&f);
    walk_button(&f, true);
    expect_state(&f, AGV_STATE_SAFE);
    fixture_run(&f, 999);
    walk_button(&f, false);
    expect_state(&f, AGV_STATE_SAFE);
    walk_reset(&f, 1000);
}

/* The first frame after the start, before any tick, reports the button pressed: that press did not begin after the trip. */
/* Shows: FSM-3, FSM-7 */
void test_a_button_that_is_held_over_a_restart_resets_nothing(void) {
    walk_to_safe(&f);
    fixture_button(&f, true);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state_after(&f, 3000, AGV_STATE_SAFE);
    walk_button(&f, false);
    fixture_run(&f, 20);
    walk_reset(&f, 1000);
}

/* Shows: FSM-3, INT-3 */
void test_the_event_of_the_reset_names_no_fault(void) {
    agv_event_t event = {0};
    walk_to_safe(&f);
    walk_reset(&f, 1000);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_events(&f, AGV_EVENT_STATE, AGV_STATE_SAFE, ANY, &event));
    TEST_ASSERT_EQUAL_HEX8(AGV_STATE_STANDBY, event.b);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_NONE, event.c);
}

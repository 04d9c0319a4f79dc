/* The reset input: which of the two buttons resets, and how a push button is debounced. */
#include "one_fixture.h"
#include "walk.h"

static void choose(uint16_t input) {
    fixture_init(&f);
    f.config.reset_input = input;
    f.board = (sim_board_t){.has_reset_button = true};
    walk_to_safe(&f);
    fixture_run(&f, 1100);
}

static void push(bool pressed) {
    f.hal.board.button_is_down = pressed;
}

static void push_for(uint32_t ms) {
    push(true);
    fixture_run(&f, ms);
    push(false);
    fixture_run(&f, 21);
}

/* The debounced button follows 20 ms after press and release, so the press lasts as long as that of the finger. */
/* Shows: HW-3 */
void test_with_pin_the_push_button_resets_and_the_remote_button_does_not(void) {
    choose(AGV_RESET_INPUT_PIN);
    walk_button(&f, true);
    fixture_run(&f, 1500);
    walk_button(&f, false);
    expect_state(&f, AGV_STATE_SAFE);
    expect_refusals(&f, 0, 0);
    push(true);
    fixture_run(&f, 1000);
    push(false);
    expect_state_after(&f, 20, AGV_STATE_SAFE);
    expect_state_after(&f, 1, AGV_STATE_STANDBY);
}

/* Shows: HW-3 */
void test_with_can_the_push_button_resets_nothing(void) {
    choose(AGV_RESET_INPUT_CAN);
    push_for(1500);
    expect_state(&f, AGV_STATE_SAFE);
    expect_refusals(&f, 0, 0);
    walk_reset(&f, 1000);
}

/* Shows: HW-3 */
void test_with_both_either_button_resets(void) {
    choose(AGV_RESET_INPUT_BOTH);
    push_for(1000);
    expect_state(&f, AGV_STATE_STANDBY);
    choose(AGV_RESET_INPUT_BOTH);
    walk_reset(&f, 1000);
}

/* The remote button was up when the push button reset. A press from before the next trip resets nothing all the same. */
/* Shows: FSM-3, HW-3 */
void test_a_press_of_the_remote_button_after_a_reset_by_the_push_button(void) {
    choose(AGV_RESET_INPUT_BOTH);
    push_for(1000);
    expect_state(&f, AGV_STATE_STANDBY);
    walk_button(&f, true);
    fixture_run(&f, 50);
    walk_trip(&f);
    expect_state_after(&f, 1500, AGV_STATE_SAFE);
    walk_button(&f, false);
    expect_refusals(&f, 1, AGV_MISSING_BUTTON);
    expect_state(&f, AGV_STATE_SAFE);
}

/* A press in vain is reported with what was missing, also while the other button is not touched. */
/* Shows: HW-3, FSM-3 */
void test_a_press_of_the_push_button_in_vain_is_reported(void) {
    choose(AGV_RESET_INPUT_BOTH);
    push(true);
    fixture_run(&f, 5100);
    push(false);
    expect_state_after(&f, 100, AGV_STATE_SAFE);
    expect_refusals(&f, 1, AGV_MISSING_RELEASED);
}

/* Also while the push button is not touched. */
/* Shows: HW-3, FSM-3 */
void test_a_press_of_the_remote_button_in_vain_is_reported(void) {
    choose(AGV_RESET_INPUT_BOTH);
    walk_button(&f, true);
    fixture_run(&f, 5100);
    walk_button(&f, false);
    expect_state_after(&f, 100, AGV_STATE_SAFE);
    expect_refusals(&f, 1, AGV_MISSING_RELEASED);
}

/* The remote button is down too long for a reset, from 5001 ms on. The push button resets whenever its own press ends: in the same
 * millisecond, with and without a frame in it, before or after. */
/* Shows: HW-3, FSM-3 */
void test_a_press_in_vain_of_one_button_does_not_hinder_the_other(void) {
    for (uint32_t run = 0; run < 50; run++) {
        choose(AGV_RESET_INPUT_BOTH);
        fixture_run(&f, run % 10);
        walk_button(&f, true);
        fixture_run(&f, 3500);
        push(true);
        fixture_run(&f, 4978 - 3500 + (run / 10));
        push(false);
        expect_state_after(&f, 25, AGV_STATE_STANDBY);
    }
}

/* The other way round: the push button is down too long, 21 ms and 5001 ms after it was pushed. The 363h that releases the remote
 * button comes before, in the same millisecond, or after. */
/* Shows: HW-3, FSM-3 */
void test_a_push_button_that_is_down_too_long_does_not_hinder_the_remote_button(void) {
    for (uint32_t run = 0; run < 10; run++) {
        choose(AGV_RESET_INPUT_BOTH);
        fixture_run(&f, run);
        push(true);
        fixture_run(&f, 3500);
        walk_button(&f, true);
        fixture_run(&f, 5015 - 3500);
        fixture_button(&f, false);
        expect_state_after(&f, 10, AGV_STATE_STANDBY);
    }
}

/* A press that began before the trip is a stuck button. */
/* Shows: HW-3, FSM-3 */
void test_a_push_button_that_was_down_at_the_trip_does_not_reset(void) {
    fixture_init(&f);
    f.config.reset_input = AGV_RESET_INPUT_PIN;
    f.board = (sim_board_t){.has_reset_button = true};
    fixture_active(&f);
    push(true);
    fixture_run(&f, 100);
    walk_trip(&f);
    fixture_vehicle_confirms(&f);
    expect_state_after(&f, 2000, AGV_STATE_SAFE);
    push(false);
    expect_state_after(&f, 100, AGV_STATE_SAFE);
    expect_refusals(&f, 1, AGV_MISSING_BUTTON);
    push_for(1000);
    expect_state(&f, AGV_STATE_STANDBY);
    push(true); /* and once more, after a good press */
    fixture_run(&f, 100);
    walk_trip(&f);
    expect_state_after(&f, 2000, AGV_STATE_SAFE);
    push(false);
    expect_state_after(&f, 100, AGV_STATE_SAFE);
    expect_refusals(&f, 2, AGV_MISSING_BUTTON);
}

/* A press on which the VCU was lost says nothing about the vehicle that came back (FSM-3). */
/* Shows: HW-3, FSM-3, VCU_HEARTBEAT_LOST */
void test_the_loss_of_the_vcu_ends_a_press_of_the_push_button(void) {
    choose(AGV_RESET_INPUT_PIN);
    push(true);
    fixture_run(&f, 1300);
    f.traffic[AGV_MSG_VEHICLE_STATUS].muted = true;
    expect_state_after(&f, 100, AGV_STATE_TRIPPED);
    expect_refusals(&f, 1, AGV_MISSING_VCU_HEARTBEAT);
    f.traffic[AGV_MSG_VEHICLE_STATUS].muted = false;
    expect_state_after(&f, 1500, AGV_STATE_SAFE);
    push(false);
    expect_state_after(&f, 100, AGV_STATE_SAFE);
    expect_refusals(&f, 2, AGV_MISSING_BUTTON);
    push_for(1000);
    expect_state(&f, AGV_STATE_STANDBY);
}

/* Shows: HW-3, FSM-3 */
void test_an_input_that_falls_silent_is_no_release(void) {
    choose(AGV_RESET_INPUT_PIN);
    push(true);
    fixture_run(&f, 1500);
    f.hal.board.has_reset_button = false;
    fixture_run(&f, 100);
    expect_state(&f, AGV_STATE_SAFE);
    expect_refusals(&f, 1, AGV_MISSING_BUTTON);
    f.hal.board.has_reset_button = true;
    fixture_run(&f, 100);
    push(false);
    expect_state_after(&f, 100, AGV_STATE_SAFE);
    push_for(1000);
    expect_state(&f, AGV_STATE_STANDBY);
}

/* The output that was confirmed in time is still closed, and its contact reads so. */
/* Shows: HW-1, FSM-3 */
void test_a_closed_contact_of_a_closed_output_does_not_hinder_the_reset(void) {
    fixture_init(&f);
    f.board = (sim_board_t){.has_feedback = true};
    walk_to_safe(&f);
    expect_output(&f, true);
    fixture_run(&f, 1100);
    walk_reset(&f, 1000);
}

/* Trips after a reset (FSM-11): causes of the AI computer, which never prevent a reset. */
#include "expect.h"
#include "fixture.h"
#include "unity.h"
#include "walk.h"

static fixture_t f;

void setUp(void) {
    fixture_init(&f);
    f.long_run = true;
}

/* 168h comes every 10 ms: gaps under half its cycle. As a trip it neither prevents the reset nor trips in manual. */
static void babble(bool on) {
    f.traffic[AGV_MSG_GEAR_COMMAND].cycle_ms = on ? 10 : 100;
    f.traffic[AGV_MSG_GEAR_COMMAND].phase_ms = 8;
}

static void reset_while_the_ai_babbles(void) {
    fixture_init(&f);
    f.long_run = true;
    agv_fault_set_put(&f.config.trips, AGV_FAULT_COMMAND_TOO_FAST, true);
    fixture_active(&f);
    babble(true);
    fixture_run(&f, 300);
    expect_tripped(&f, AGV_FAULT_COMMAND_TOO_FAST);
    walk_confirm_and_reset(&f);
    expect_fault_after(&f, 5000, AGV_FAULT_COMMAND_TOO_FAST, true);
    expect_state(&f, AGV_STATE_STANDBY);
}

/* Shows: FSM-11, FSM-3, COMMAND_TOO_FAST */
void test_a_cause_that_outlived_the_reset_trips_at_the_next_engagement(void) {
    reset_while_the_ai_babbles();
    walk_report(&f, MODE_ENGAGED);
    expect_tripped(&f, AGV_FAULT_COMMAND_TOO_FAST);
}

/* Shows: FSM-11, COMMAND_TOO_FAST */
void test_in_manual_it_trips_when_it_has_ended_and_comes_again(void) {
    reset_while_the_ai_babbles();
    babble(false);
    expect_fault_after(&f, 5000, AGV_FAULT_COMMAND_TOO_FAST, false);
    expect_state(&f, AGV_STATE_STANDBY);
    babble(true);
    expect_reason_after(&f, 300, AGV_FAULT_COMMAND_TOO_FAST);
    expect_state(&f, AGV_STATE_SAFE); /* the vehicle stands in P */
}

/* A transient that lasts longer than the reset takes. */
/* Shows: FSM-11, AI_COMMAND_OUT_OF_RANGE */
void test_a_transient_that_has_not_ended_trips_at_the_next_engagement(void) {
    static const uint8_t no_gear[8] = {3};
    f.config.event_hold_ms = 10000;
    fixture_active(&f);
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, no_gear);
    expect_tripped(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE);
    walk_confirm_and_reset(&f);
    expect_fault(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, true);
    walk_report(&f, MODE_ENGAGED);
    expect_tripped(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE);
}

/* reengage_ms: the deadlines of the commands begin anew, though the engagement before ended less than 1 s ago. */
/* Shows: FSM-3, SUP-3 */
void test_an_engagement_soon_after_a_reset_does_not_continue_the_one_that_tripped(void) {
    f.config.reengage_ms = 1000;
    f.config.reset_hold_ms = 500;
    fixture_active(&f);
    fixture_run(&f, 2000);
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    fixture_run(&f, 200);
    expect_tripped(&f, AGV_FAULT_STEERING_COMMAND_TIMEOUT);
    fixture_vehicle_confirms(&f);
    walk_reset(&f, 700);
    expect_state(&f, AGV_STATE_STANDBY);
    walk_report(&f, MODE_ENGAGED);
    expect_state_after(&f, 80, AGV_STATE_ACTIVE);
    expect_tripped_after(&f, 100, AGV_FAULT_STEERING_COMMAND_TIMEOUT);
}

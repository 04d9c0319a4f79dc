/* The reset: its conditions, interruptions, and the report of a refused press. */
#include "one_fixture.h"
#include "spoil.h"
#include "walk.h"

/* Press now, release after this many milliseconds. */
static void hold_for(uint32_t ms) {
    walk_button(&f, true);
    fixture_run(&f, ms);
    walk_button(&f, false);
}

/* Shows: FSM-3, FSM-4, FSM-5 */
void test_a_press_of_1_s_with_all_conditions_resets_at_its_release(void) {
    agv_event_t event = {0};
    walk_to_safe(&f);
    walk_reset(&f, 1000);
    expect_reason(&f, AGV_FAULT_NONE);
    expect_output(&f, true);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_events(&f, AGV_EVENT_RESET, 1, ANY, &event));
    TEST_ASSERT_EQUAL_UINT32(0, fixture_events(&f, AGV_EVENT_RESET, 0, ANY, &event));
    fixture_forget_sent(&f);
    expect_state_after(&f, 2000, AGV_STATE_STANDBY);
    expect_silence(&f);
}

/* ---- Each condition missing in turn ---- */

typedef struct {
    spoil_t spoil;
    agv_state_t state;
    uint16_t missing;
} condition_t;

static const condition_t CONDITIONS[] = {
    {{"moving", M_WHEELS, BYTE, 1, .value = 50}, AGV_STATE_SAFE, AGV_MISSING_STANDSTILL},
    {{"moving backwards", .by = spoil_wheel}, AGV_STATE_SAFE, AGV_MISSING_STANDSTILL},
    {{"not manual", M_VEHICLE, BYTE, 7, .value = MODE_NEITHER}, AGV_STATE_SAFE, AGV_MISSING_MANUAL},
    {{"EPS frozen", M_STEERING_STATUS, .how = FROZEN},
     AGV_STATE_SAFE,
     AGV_MISSING_EPS_HEARTBEAT | AGV_MISSING_TRIP_CAUSE},
    {{"EPS fault", M_EPS_STATUS, BYTE, 8, .value = 0x08}, AGV_STATE_SAFE, AGV_MISSING_TRIP_CAUSE},
    {{"alarm", M_VEHICLE, BYTE, 5, .value = ALARM_S_DRIVER}, AGV_STATE_SAFE, AGV_MISSING_TRIP_CAUSE},
    {{"no 050h", M_THROTTLE_STATUS, .how = SILENT}, AGV_STATE_SAFE, AGV_MISSING_TRIP_CAUSE | AGV_MISSING_MESSAGES},
    {{"not in P", M_GEAR_STATUS, BYTE, 1, .value = GEAR_N},
     AGV_STATE_TRIPPED,
     AGV_MISSING_STATE | AGV_MISSING_TRIP_CAUSE},
    {{"throttle", M_THROTTLE_STATUS, BYTE, 1, .value = 3}, AGV_STATE_SAFE, AGV_MISSING_THROTTLE},
    {{"throttle invalid", M_THROTTLE_STATUS, BYTE, 1, .value = 251}, AGV_STATE_SAFE, AGV_MISSING_THROTTLE},
    {{"moving, by the VCU's speed", .by = spoil_speed}, AGV_STATE_SAFE, AGV_MISSING_STANDSTILL},
    {{"engaged", .by = spoil_mode}, AGV_STATE_TRIPPED, AGV_MISSING_STATE | AGV_MISSING_TRIP_CAUSE | AGV_MISSING_MANUAL},
};

static void begin(const condition_t *condition) {
    fixture_init(&f);
    f.what = condition->spoil.what;
    f.long_run = true;
    walk_to_safe(&f);
    spoil_set(&f, &condition->spoil, true);
    expect_state_after(&f, 700, condition->state); /* a deadline has expired, SAFE_STATE_UNCONFIRMED has been raised */
}

/* At its release, or at 5 s. */
/* Shows: FSM-3 */
void test_each_missing_condition_refuses_and_is_named_once_a_press(void) {
    for (unsigned i = 0; i < sizeof CONDITIONS / sizeof CONDITIONS[0]; i++) {
        const uint16_t missing = CONDITIONS[i].missing;
        begin(&CONDITIONS[i]);
        walk_button(&f, true);
        fixture_run(&f, 1500);
        expect_refusals(&f, 0, 0);
        walk_button(&f, false);
        expect_refusals(&f, 1, missing);
        fixture_run(&f, 30);
        walk_button(&f, true);
        fixture_run(&f, 5001);
        expect_refusals(&f, 2, missing | AGV_MISSING_RELEASED);
        fixture_run(&f, 1000);
        walk_button(&f, false);
        expect_refusals(&f, 2, missing | AGV_MISSING_RELEASED);
        expect_state(&f, CONDITIONS[i].state);
    }
}

/* Shows: FSM-3 */
void test_the_conditions_must_hold_in_the_releasing_frame_too(void) {
    walk_to_safe(&f);
    walk_button(&f, true);
    fixture_run(&f, 1500);
    fixture_mode(&f, MODE_BOTH); /* manual stays valid, but both bits confirm nothing */
    walk_button(&f, false);
    expect_refusals(&f, 1, AGV_MISSING_STATE);
    expect_state(&f, AGV_STATE_TRIPPED);
}

/* 067h comes for the last time this many milliseconds after the press. The button is released after 1000 ms. */
static void release_with_old_067h(uint32_t last_ms) {
    fixture_init(&f);
    f.traffic[AGV_MSG_EPS_STATUS].phase_ms = 8;
    walk_to_safe(&f);
    fixture_run_past(&f, AGV_MSG_STEERING_STATUS);
    fixture_run(&f, 1000 - last_ms); /* so that one comes then */
    walk_button(&f, true);
    fixture_run(&f, last_ms);
    f.traffic[AGV_MSG_STEERING_STATUS].muted = true;
    fixture_run(&f, 1000 - last_ms);
    walk_button(&f, false);
}

/* Shows: FSM-3, EPS_HEARTBEAT_LOST */
void test_a_deadline_that_expires_in_the_last_tick(void) {
    release_with_old_067h(949);
    expect_fault(&f, AGV_FAULT_EPS_HEARTBEAT_LOST, true);
    expect_refusals(&f, 1, AGV_MISSING_EPS_HEARTBEAT | AGV_MISSING_TRIP_CAUSE);
    release_with_old_067h(950);
    expect_state(&f, AGV_STATE_STANDBY);
}

/* ---- The edge of the button ---- */

static void expect_no_reset_before_a_new_press(void) {
    uint16_t missing = 0;
    expect_state_after(&f, 3000, AGV_STATE_SAFE);
    walk_button(&f, false);
    expect_state(&f, AGV_STATE_SAFE);
    TEST_ASSERT_EQUAL_UINT32(1, walk_refusals(&f, &missing));
    TEST_ASSERT_BITS_HIGH(AGV_MISSING_BUTTON, missing);
    walk_reset(&f, 1000);
}

/* Shows: FSM-3 */
void test_a_press_in_the_very_frame_of_the_trip_does_not_count(void) {
    fixture_active(&f);
    fixture_button(&f, true);
    walk_trip(&f);
    fixture_mute_ai(&f, true);
    fixture_vehicle_confirms(&f);
    expect_no_reset_before_a_new_press();
}

/* Shows: FSM-3, FSM-4 */
void test_a_press_from_before_a_second_trip_does_not_reset_it(void) {
    walk_to_safe(&f);
    walk_reset(&f, 1000);
    walk_button(&f, true);
    fixture_run(&f, 50);
    walk_trip(&f);
    expect_no_reset_before_a_new_press();
}

/* ---- The VCU is lost ---- */

/* Shows: FSM-3, VCU_HEARTBEAT_LOST */
void test_the_loss_of_the_vcu_ends_a_press(void) {
    walk_to_safe(&f);
    walk_button(&f, true);
    fixture_run(&f, 1200);
    f.traffic[AGV_MSG_VEHICLE_STATUS].muted = true;
    expect_state_after(&f, 100, AGV_STATE_TRIPPED);
    expect_refusals(&f, 1, AGV_MISSING_VCU_HEARTBEAT);
    f.traffic[AGV_MSG_VEHICLE_STATUS].muted = false;
    expect_state_after(&f, 1500, AGV_STATE_SAFE);
    walk_button(&f, false);
    expect_refusals(&f, 2, AGV_MISSING_BUTTON); /* it was pressed before the VCU came back */
    expect_state(&f, AGV_STATE_SAFE);
    walk_reset(&f, 1000);
}

/* Shows: FSM-3, VCU_HEARTBEAT_STUCK */
void test_the_button_of_a_vcu_that_is_not_alive_does_not_count(void) {
    walk_to_safe(&f);
    f.traffic[AGV_MSG_VEHICLE_STATUS].frozen = true;
    expect_state_after(&f, 100, AGV_STATE_TRIPPED);
    hold_for(1500);
    expect_refusals(&f, 0, 0);
    walk_button(&f, true);
    fixture_run(&f, 1500);
    f.traffic[AGV_MSG_VEHICLE_STATUS].frozen = false;
    fixture_run(&f, 1500);
    walk_button(&f, false);
    expect_refusals(&f, 1, AGV_MISSING_BUTTON);
    expect_state(&f, AGV_STATE_SAFE);
}

/* The silence of 050h only warns, by choice: the throttle is not known to be idle all the same. */
/* Shows: FSM-3, THROTTLE_STATUS_TIMEOUT */
void test_a_throttle_status_whose_silence_only_warns_is_needed_too(void) {
    agv_fault_set_put(&f.config.trips, AGV_FAULT_THROTTLE_STATUS_TIMEOUT, false);
    walk_to_safe(&f);
    f.traffic[AGV_MSG_THROTTLE_STATUS].muted = true;
    fixture_run(&f, 100);
    hold_for(1500);
    expect_state(&f, AGV_STATE_SAFE);
    expect_refusals(&f, 1, AGV_MISSING_THROTTLE);
    f.traffic[AGV_MSG_THROTTLE_STATUS].muted = false;
    fixture_run(&f, 100);
    walk_reset(&f, 1100);
}

/* ---- The remote receiver is lost ---- */

/* The operator holds the button. The VCU reports the receiver as lost and the button as not pressed. */
static void lose_the_receiver(uint8_t alarm_bits) {
    fixture_init(&f);
    agv_fault_set_put(&f.config.trips, AGV_FAULT_REMOTE_SIGNAL_LOST, false); /* else it prevents the reset */
    agv_fault_set_put(&f.config.trips, AGV_FAULT_REMOTE_POWER_LOST, false);
    walk_to_safe(&f);
    walk_button(&f, true);
    fixture_run(&f, 1500);
    walk_alarm(&f, alarm_bits);
    walk_button(&f, false);
}

/* The loss does not count as a release, and a pressed button after it is no rising edge. */
/* Shows: FSM-3, REMOTE_SIGNAL_LOST, REMOTE_POWER_LOST */
void test_a_receiver_that_is_lost_and_comes_back_is_neither_release_nor_press(void) {
    static const uint8_t ALARMS[] = {ALARM_REMOTE_SIGNAL, ALARM_REMOTE_POWER};
    for (unsigned i = 0; i < 2; i++) {
        lose_the_receiver(ALARMS[i]);
        expect_state(&f, AGV_STATE_SAFE);
        expect_refusals(&f, 1, AGV_MISSING_BUTTON);
        fixture_run(&f, 200);
        walk_alarm(&f, ALARM_NONE);
        hold_for(1500);
        expect_state(&f, AGV_STATE_SAFE);
        expect_refusals(&f, 2, AGV_MISSING_BUTTON);
        walk_reset(&f, 1000);
    }
}

/* Shows: FSM-3 */
void test_button_2_resets_nothing(void) {
    walk_to_safe(&f);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[6] = 0x42;
    fixture_run(&f, 2000);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[6] = 0x40;
    expect_state_after(&f, 1000, AGV_STATE_SAFE);
    expect_refusals(&f, 0, 0);
}

/* Shows: FSM-3 */
void test_a_press_outside_the_latch_is_no_event(void) {
    fixture_standby(&f);
    hold_for(2000);
    walk_button(&f, true);
    fixture_run(&f, 3000);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run(&f, 3000);
    walk_button(&f, false);
    expect_state_after(&f, 100, AGV_STATE_ACTIVE);
    expect_refusals(&f, 0, 0);
}

/* ---- The AI computer does not prevent a reset ---- */

static void trip_by_silent_ai(void) {
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    expect_state_after(&f, 500, AGV_STATE_TRIPPED);
    fixture_vehicle_confirms(&f);
    expect_state_after(&f, 300, AGV_STATE_SAFE);
}

/* 065h is the fastest: 126 ms after the last one. */
/* Shows: FSM-3, SUP-8, STEERING_COMMAND_TIMEOUT */
void test_a_dead_ai_computer_does_not_hinder(void) {
    trip_by_silent_ai();
    expect_reason(&f, AGV_FAULT_STEERING_COMMAND_TIMEOUT);
    walk_reset(&f, 1000);
    expect_state_after(&f, 3000, AGV_STATE_STANDBY);
}

/* Shows: FSM-3, SUP-8, AI_HEARTBEAT_STUCK */
void test_a_frozen_ai_computer_does_not_hinder_though_it_trips_in_manual(void) {
    f.config.ai_lost_in_manual = AGV_AI_LOST_TRIP;
    fixture_active(&f);
    f.traffic[AGV_MSG_TURN_SIGNAL_COMMAND].frozen = true;
    expect_tripped_after(&f, 500, AGV_FAULT_AI_HEARTBEAT_STUCK);
    fixture_vehicle_confirms(&f);
    fixture_run(&f, 300);
    walk_reset(&f, 1000);
}

/* Three of four frames are D, 100 % and out of range, one a millisecond. */
static bool babble(fixture_t *fixture, agv_message_t message, hal_can_frame_t *frame) {
    static const uint8_t values[] = {1, 250, 3, 0xFF};
    (void)fixture;
    if (message == AGV_MSG_GEAR_COMMAND || message == AGV_MSG_THROTTLE_COMMAND) {
        frame->data[0] = values[f.now_ms % 4];
    }
    return true;
}

static void expect_babbling_ai_does_not_hinder(uint16_t topology) {
    fixture_init(&f);
    f.long_run = true;
    f.config.topology = topology;
    walk_to_safe(&f);
    fixture_mute_ai(&f, false);
    for (unsigned message = AGV_MSG_GEAR_COMMAND; message <= AGV_MSG_STEERING_COMMAND; message++) {
        f.traffic[message].cycle_ms = 1;
        f.traffic[message].phase_ms = 0;
    }
    f.edit = babble;
    expect_fault_after(&f, 200, AGV_FAULT_COMMAND_TOO_FAST, true);
    walk_reset(&f, 1000);
}

/* Shows: FSM-3, COMMAND_TOO_FAST */
void test_a_babbling_ai_computer_does_not_hinder(void) {
    expect_babbling_ai_does_not_hinder(AGV_TOPOLOGY_SHARED);
    expect_babbling_ai_does_not_hinder(AGV_TOPOLOGY_GATEWAY);
}

/* Shows: FSM-3, AI_BUS_OFF */
void test_a_dead_ai_side_of_a_gateway_does_not_hinder(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    walk_to_safe(&f);
    sim_hal_set_can_state(&f.hal, HAL_CAN_AI, HAL_CAN_BUS_OFF);
    expect_fault_after(&f, 200, AGV_FAULT_AI_BUS_OFF, true);
    walk_reset(&f, 1000);
}

/* ---- After it ---- */

/* The throttle is at idle since the frames of a late step: of its 99 ms, 10 count. */
/* Shows: FSM-3, TIM-4 */
void test_of_a_late_step_10_ms_count_for_the_conditions(void) {
    static const struct {
        uint32_t more_ms;
        agv_state_t state;
    } cases[] = {{989, AGV_STATE_SAFE}, {990, AGV_STATE_STANDBY}};
    for (unsigned i = 0; i < 2; i++) {
        fixture_init(&f);
        walk_to_safe(&f);
        f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
        fixture_throttle(&f, 3);
        fixture_run(&f, 500);
        walk_button(&f, true);
        fixture_run(&f, 500);
        fixture_run_without_ticks(&f, 60);
        fixture_throttle(&f, 0);
        fixture_send_now(&f, AGV_MSG_THROTTLE_STATUS);
        fixture_run(&f, 1);
        fixture_run(&f, cases[i].more_ms);
        walk_button(&f, false);
        expect_state(&f, cases[i].state);
    }
}

/* The gateway: limits of throttle, steering and gear changes. */
#include "one_gateway.h"

/* ---- Limits ---- */

static void expect_steering(uint16_t commanded, uint16_t passed) {
    const uint8_t command[8] = {(uint8_t)commanded, (uint8_t)(commanded >> 8)};
    const uint8_t expected[8] = {(uint8_t)passed, (uint8_t)(passed >> 8)};
    fixture_run(&f, 25);
    expect_pass(0x065, command, expected);
}

/* 100.0 degrees a second are 2.5 degrees, 25 counts, in 25 ms; from the measured angle with every engagement. */
/* Shows: TOP-2 */
void test_the_slew_rate_starts_anew_with_every_engagement(void) {
    f.config.steering_slew_ddeg_s = 1000;
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    expect_steering(9000, 9000);
    fixture_mode(&f, MODE_MANUAL);
    fixture_angle(&f, 9300);
    expect_state_after(&f, 50, AGV_STATE_STANDBY);
    walk_engage(&f);
    expect_steering(9000, 9275);
}

/* In manual 067h has no valid angle, and the last one is of another time: no 065h passes before there is a new one. */
/* Shows: TOP-2 */
void test_the_slew_rate_starts_from_no_angle_that_is_out_of_date(void) {
    static const uint8_t centre[8] = {0x28, 0x23};
    f.config.steering_slew_ddeg_s = 1000;
    fixture_angle(&f, 9600);
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    fixture_mode(&f, MODE_MANUAL);
    fixture_angle(&f, 18001);
    expect_state_after(&f, 100, AGV_STATE_STANDBY);
    walk_engage(&f);
    expect_dropped(0x065, centre);
    fixture_angle(&f, 9010);
    fixture_run_past(&f, AGV_MSG_STEERING_STATUS);
    expect_pass(0x065, centre, centre);
    expect_state(&f, AGV_STATE_ACTIVE);
}

/* ---- Changes of the gear ---- */

static const uint8_t REVERSE[8] = {2};

/* The vehicle reports D and moves. */
static void active_on_the_move(void) {
    fixture_active(&f);
    fixture_drive(&f, 500);
    fixture_run(&f, 50);
    f.traffic[AGV_MSG_GEAR_COMMAND].muted = true;
    fixture_run(&f, 60);
}

/* Standstill is 100 ms of it. */
/* Shows: TOP-2 */
void test_the_gear_changes_at_standstill(void) {
    active_on_the_move();
    fixture_drive(&f, 0);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    fixture_run(&f, 99);
    expect_dropped(0x168, REVERSE);
    fixture_run(&f, 1);
    expect_pass(0x168, REVERSE, REVERSE);
}

/* A 168h that is dropped for this reason still refreshes its deadline. */
/* Shows: TOP-2, SUP-3, GEAR_COMMAND_TIMEOUT */
void test_a_gear_command_that_is_dropped_came_all_the_same(void) {
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = GEAR_R;
    fixture_active(&f);
    fixture_drive(&f, 500);
    f.long_run = true;
    expect_state_after(&f, 2000, AGV_STATE_ACTIVE);
    fixture_forget_sent(&f);
    expect_count_after(&f, 500, 0x168, 0);
}

/* R waits until the vehicle stands; the throttle that passes is 0 until then, or until D is commanded again. */
/* Shows: TOP-2 */
void test_while_a_gear_waits_the_throttle_that_passes_is_0(void) {
    static const uint8_t commanded[8] = {75};
    static const uint8_t nothing[8] = {0};
    fixture_active(&f);
    fixture_drive(&f, 500);
    fixture_run(&f, 200);
    f.traffic[AGV_MSG_THROTTLE_COMMAND].muted = true;
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = GEAR_R;
    fixture_run(&f, 100);
    expect_pass(0x075, commanded, nothing);
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = GEAR_D;
    fixture_send_now(&f, AGV_MSG_GEAR_COMMAND);
    fixture_run(&f, 100);
    expect_pass(0x075, commanded, commanded);
}

/* D was sent before manual, which does not count: the vehicle reverses now. Throttle 0 passes. */
static void expect_no_throttle_after_manual(uint16_t reengage_ms) {
    static const uint8_t commanded[8] = {75};
    static const uint8_t nothing[8] = {0};
    setUp();
    f.config.reengage_ms = reengage_ms;
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = GEAR_D;
    fixture_active(&f);
    fixture_run(&f, 200);
    fixture_mode(&f, MODE_MANUAL);
    expect_state_after(&f, 50, AGV_STATE_STANDBY);
    fixture_gear(&f, GEAR_R);
    fixture_drive(&f, -500);
    fixture_run(&f, 500);
    walk_engage(&f);
    fixture_run(&f, 150);
    f.traffic[AGV_MSG_THROTTLE_COMMAND].muted = true;
    fixture_run(&f, 100);
    expect_pass(0x075, commanded, nothing);
}

/* Also where the second engagement continues the first one. */
/* Shows: TOP-2 */
void test_a_gear_of_before_manual_was_not_sent_in_this_engagement(void) {
    expect_no_throttle_after_manual(100);
    expect_no_throttle_after_manual(1000);
}

/* Only a warning here: R was sent at standstill, 0A3h still says D. In motion D is another gear. */
/* Shows: TOP-2, GEAR_STATUS_TIMEOUT */
void test_a_silent_gear_status_is_not_the_gear(void) {
    agv_fault_set_put(&f.config.trips, AGV_FAULT_GEAR_STATUS_TIMEOUT, false);
    fixture_active(&f);
    fixture_gear(&f, GEAR_D);
    fixture_run(&f, 100);
    f.traffic[AGV_MSG_GEAR_STATUS].muted = true;
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = GEAR_R;
    fixture_run(&f, 300);
    fixture_drive(&f, -500);
    fixture_run(&f, 20);
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = GEAR_D;
    fixture_forget_sent(&f);
    expect_count_after(&f, 300, 0x168, 0);
    expect_state(&f, AGV_STATE_ACTIVE);
}

/* Only a warning here: D was sent in this engagement, so the next D is no change of the gear. */
/* Shows: TOP-2, GEAR_STATUS_TIMEOUT */
void test_the_gear_that_was_sent_passes_in_motion_while_its_status_is_silent(void) {
    static const uint8_t drive[8] = {1};
    agv_fault_set_put(&f.config.trips, AGV_FAULT_GEAR_STATUS_TIMEOUT, false);
    f.traffic[AGV_MSG_GEAR_COMMAND].data[0] = GEAR_D;
    fixture_active(&f);
    fixture_gear(&f, GEAR_D);
    fixture_run(&f, 100);
    f.traffic[AGV_MSG_GEAR_STATUS].muted = true;
    fixture_run(&f, 300);
    fixture_drive(&f, 500);
    fixture_run(&f, 100);
    f.traffic[AGV_MSG_GEAR_COMMAND].muted = true;
    fixture_run(&f, 60);
    expect_pass(0x168, drive, drive);
}

/* P was sent at standstill in manual. Then the operator drives off, and 0A3h still says P. */
/* Shows: TOP-2, FSM-1 */
void test_p_that_was_sent_in_manual_does_not_pass_in_motion(void) {
    static const uint8_t park[8] = {8};
    f.config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    f.config.park = AGV_PARK_AT_STANDSTILL;
    fixture_gear(&f, GEAR_P);
    f.traffic[AGV_MSG_GEAR_COMMAND].muted = true;
    fixture_standby(&f);
    fixture_run(&f, 200);
    expect_pass(0x168, park, park);
    fixture_drive(&f, 500);
    fixture_run(&f, 200);
    expect_dropped(0x168, park);
}

/* Nor does D, which was sent before, when 0A3h is silent: the operator may have changed the gear since. */
/* Shows: TOP-2, GEAR_STATUS_TIMEOUT */
void test_d_that_was_sent_in_manual_does_not_pass_in_motion(void) {
    static const uint8_t drive[8] = {1};
    f.config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    agv_fault_set_put(&f.config.trips, AGV_FAULT_GEAR_STATUS_TIMEOUT, false);
    f.traffic[AGV_MSG_GEAR_COMMAND].muted = true;
    fixture_standby(&f);
    fixture_run(&f, 200);
    expect_pass(0x168, drive, drive);
    f.traffic[AGV_MSG_GEAR_STATUS].muted = true;
    fixture_drive(&f, 500);
    fixture_run(&f, 200);
    expect_dropped(0x168, drive);
}

/* ---- Withheld commands ---- */

/* Each time, one 363h reports manual before the message, and one reports autopilot after it. */
static void only_while_manual(uint16_t topology, agv_message_t message, uint32_t every_ms, uint32_t for_ms) {
    setUp();
    f.config.topology = topology;
    fixture_active(&f);
    f.traffic[message].muted = true;
    for (uint32_t ms = 0; ms < for_ms; ms += every_ms) {
        walk_report(&f, MODE_MANUAL);
        fixture_send_now(&f, message);
        walk_report(&f, MODE_ENGAGED);
        fixture_run(&f, every_ms);
    }
}

/* A motion command that is withheld because of the mode has not reached the vehicle: its deadline runs on. */
/* Shows: TOP-2, SUP-3, STEERING_COMMAND_TIMEOUT, THROTTLE_COMMAND_TIMEOUT, GEAR_COMMAND_TIMEOUT */
void test_a_command_that_is_withheld_misses_its_deadline(void) {
    only_while_manual(AGV_TOPOLOGY_GATEWAY, AGV_MSG_STEERING_COMMAND, 25, 175);
    expect_tripped(&f, AGV_FAULT_STEERING_COMMAND_TIMEOUT);
    only_while_manual(AGV_TOPOLOGY_GATEWAY, AGV_MSG_THROTTLE_COMMAND, 100, 500);
    expect_tripped(&f, AGV_FAULT_THROTTLE_COMMAND_TIMEOUT);
    only_while_manual(AGV_TOPOLOGY_GATEWAY, AGV_MSG_GEAR_COMMAND, 66, 462);
    expect_tripped(&f, AGV_FAULT_GEAR_COMMAND_TIMEOUT);
}

/* 43Fh passes in manual, too; what the vehicle reports is not withheld; on the shared bus nothing is. */
/* Shows: TOP-2, SUP-1, SUP-3 */
void test_what_is_not_withheld_meets_its_deadline(void) {
    only_while_manual(AGV_TOPOLOGY_GATEWAY, AGV_MSG_TURN_SIGNAL_COMMAND, 100, 1000);
    expect_state(&f, AGV_STATE_ACTIVE);
    only_while_manual(AGV_TOPOLOGY_GATEWAY, AGV_MSG_THROTTLE_STATUS, 20, 500);
    expect_state(&f, AGV_STATE_ACTIVE);
    only_while_manual(AGV_TOPOLOGY_SHARED, AGV_MSG_STEERING_COMMAND, 25, 1000);
    expect_state(&f, AGV_STATE_ACTIVE);
}

/* 065h ends at 0, and its deadline is 75 ms. 363h reports manual from 60 ms on, which ends the engagement with the fifth. */
static void manual_soon_after_the_last_angle(uint16_t topology, uint32_t manual_for_ms) {
    setUp();
    f.config.topology = topology;
    f.config.mode_frames = 5;
    f.config.steering_command_timeout_ms = 75;
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_STEERING_COMMAND);
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    fixture_run(&f, 60);
    fixture_mode(&f, MODE_MANUAL);
    fixture_run(&f, manual_for_ms);
}

/* The gateway passes no command to an operator who takes over, so it expects none. Then autopilot or both bits follow. */
/* Shows: TOP-2, SUP-3, STEERING_COMMAND_TIMEOUT */
void test_while_manual_is_reported_no_command_is_late(void) {
    manual_soon_after_the_last_angle(AGV_TOPOLOGY_SHARED, 30);
    expect_tripped(&f, AGV_FAULT_STEERING_COMMAND_TIMEOUT);
    manual_soon_after_the_last_angle(AGV_TOPOLOGY_GATEWAY, 60);
    expect_state(&f, AGV_STATE_STANDBY);
    manual_soon_after_the_last_angle(AGV_TOPOLOGY_GATEWAY, 30);
    expect_state(&f, AGV_STATE_ACTIVE);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run(&f, 20);
    expect_tripped(&f, AGV_FAULT_STEERING_COMMAND_TIMEOUT);
    manual_soon_after_the_last_angle(AGV_TOPOLOGY_GATEWAY, 30);
    fixture_mode(&f, MODE_BOTH);
    fixture_run(&f, 20);
    expect_tripped(&f, AGV_FAULT_STEERING_COMMAND_TIMEOUT);
}

/* ---- The rest of the envelope ---- */

static uint32_t limited(void) {
    return agv_supervisor_counters(&f.supervisor)->limited;
}

static void expect_rise(uint8_t commanded, uint8_t passed) {
    const uint32_t before = limited();
    const uint8_t command[8] = {commanded};
    const uint8_t expected[8] = {passed};
    expect_pass(0x075, command, expected);
    TEST_ASSERT_EQUAL_UINT32(before + (commanded != passed ? 1 : 0), limited());
    fixture_run(&f, 100);
}

/* 100 % a second. */
static void active_with_a_rise(void) {
    f.config.throttle_rise_pct_s = 100;
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_THROTTLE_COMMAND);
    f.traffic[AGV_MSG_THROTTLE_COMMAND].muted = true;
    fixture_run(&f, 100);
}

/* 25 counts in 100 ms; with each engagement from 0. */
/* Shows: TOP-2 */
void test_the_rise_begins_anew_with_every_engagement(void) {
    active_with_a_rise();
    expect_rise(250, 25);
    expect_rise(250, 50);
    disengage();
    fixture_run(&f, 50);
    walk_engage(&f);
    expect_rise(250, 25);
}

/* 30.0 degrees above 1000 mm/s. */
/* Shows: TOP-2 */
void test_steering_is_limited_above_a_speed(void) {
    f.config.steering_fast_max_ddeg = 300;
    f.config.fast_mm_s = 1000;
    fixture_active(&f);
    fixture_drive(&f, 1001);
    fixture_run(&f, 50);
    f.traffic[AGV_MSG_STEERING_COMMAND].muted = true;
    expect_steering(9400, 9300);
    TEST_ASSERT_EQUAL_UINT32(1, limited());
}

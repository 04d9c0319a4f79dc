/* The vehicle obeys its commands (SUP-11), and both measurements of its speed agree (SUP-12): budgets. Calculated by
 * hand: the tick in the millisecond of a frame sees it for the first time, so T ms are reached T ms later. A budget
 * decreases at half the rate. */
#include "one_fixture.h"
#include "walk.h"

static const agv_fault_t THROTTLE = AGV_FAULT_THROTTLE_DEVIATION;
static const agv_fault_t GEAR = AGV_FAULT_GEAR_DEVIATION;
static const agv_fault_t IGNORED = AGV_FAULT_AUTOPILOT_OFF_IGNORED;
static const agv_fault_t SPEED = AGV_FAULT_SPEED_IMPLAUSIBLE;

/* Set the first byte of a message, and run until its next frame has come. */
static void send_first_byte(agv_message_t message, uint8_t value) {
    fixture_run_before(&f, message);
    f.traffic[message].data[0] = value;
    fixture_run(&f, 1);
}

static void command_throttle(uint8_t counts) {
    send_first_byte(AGV_MSG_THROTTLE_COMMAND, counts);
}

static void measure_throttle(uint8_t counts) {
    send_first_byte(AGV_MSG_THROTTLE_STATUS, counts);
}

static void command_gear(uint8_t gear) {
    send_first_byte(AGV_MSG_GEAR_COMMAND, gear);
}

static void expect_trip_at(agv_fault_t fault, uint32_t moment_ms, int led) {
    walk_run_to(&f, moment_ms - 1);
    expect_nothing(&f, fault, AGV_STATE_ACTIVE);
    fixture_forget_sent(&f);
    expect_trip_after(&f, 1, fault, ANGLE_CENTRE);
    expect_led(&f, led);
}

/* Engaged in D, as commanded. The wheels turn, so that the steering is held at a trip. */
static void active_in_d(void) {
    fixture_active(&f);
    fixture_wheels(&f, 500, 500);
    command_gear(GEAR_D);
}

/* ---- THROTTLE_DEVIATION ---- */

/* 26 counts above the command for 500 ms. */
/* Shows: SUP-11, FSM-2, THROTTLE_DEVIATION */
void test_throttle_above_its_command(void) {
    active_in_d();
    command_throttle(100);
    measure_throttle(126);
    expect_trip_at(THROTTLE, f.now_ms + 500, 7);
    measure_throttle(124); /* down, but not by 25 */
    expect_fault_after(&f, 999, THROTTLE, true);
    expect_fault_after(&f, 1, THROTTLE, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, THROTTLE));
}

/* A ramp from 250 counts, which are in range: each 25 that it comes down empty the budget, 24 do not. */
/* Shows: SUP-5, SUP-11, P6, THROTTLE_DEVIATION */
void test_a_throttle_on_its_way_down(void) {
    active_in_d();
    command_throttle(250);
    measure_throttle(250);
    expect_state_after(&f, 500, AGV_STATE_ACTIVE);
    TEST_ASSERT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_active(&f.supervisor));
    command_throttle(0);
    for (uint8_t counts = 225; counts >= 50; counts = (uint8_t)(counts - 25)) {
        fixture_run(&f, 460);
        measure_throttle(counts);
        expect_nothing(&f, THROTTLE, AGV_STATE_ACTIVE);
    }
    const uint32_t emptied_ms = f.now_ms;
    fixture_run(&f, 100);
    measure_throttle(26); /* 24 */
    expect_trip_at(THROTTLE, emptied_ms + 500, 7);
}

/* Gateway: compared with the forwarded command. 40 % of 250 are 100 counts. */
/* Shows: SUP-11, TOP-2, THROTTLE_DEVIATION */
void test_the_throttle_is_compared_with_the_forwarded_command(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.config.throttle_ceiling_pct = 40;
    f.long_run = true;
    active_in_d();
    command_throttle(250);
    measure_throttle(125);
    expect_nothing_after(&f, 2000, THROTTLE, AGV_STATE_ACTIVE);
    measure_throttle(126);
    expect_trip_at(THROTTLE, f.now_ms + 500, 7);
}

/* ---- AUTOPILOT_OFF_IGNORED ---- */

/* 43Fh byte 5, bit 7: asks for autopilot off. */
static void ask_for_off(bool off) {
    fixture_run_before(&f, AGV_MSG_TURN_SIGNAL_COMMAND);
    f.traffic[AGV_MSG_TURN_SIGNAL_COMMAND].data[4] = off ? 0xC0 : 0x80;
    fixture_run(&f, 1);
}

/* Shows: SUP-11, FSM-2, AUTOPILOT_OFF_IGNORED */
void test_autopilot_off_is_ignored(void) {
    active_in_d();
    ask_for_off(true);
    expect_trip_at(IGNORED, f.now_ms + 1000, -1);
    fixture_mode(&f, MODE_MANUAL);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_fault(&f, IGNORED, false);
}

/* Through a gateway, too: it counts from the 43Fh that was passed on. */
/* Shows: SUP-11, TOP-2, AUTOPILOT_OFF_IGNORED */
void test_a_forwarded_autopilot_off_is_ignored(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.long_run = true;
    active_in_d();
    ask_for_off(true);
    expect_reason_after(&f, 1010, IGNORED);
}

/* The VCU obeys within the second: no fault, and the next engagement starts without the old command. */
/* Shows: SUP-11, AUTOPILOT_OFF_IGNORED */
void test_autopilot_off_is_obeyed(void) {
    active_in_d();
    ask_for_off(true);
    fixture_run(&f, 900);
    fixture_mode(&f, MODE_MANUAL);
    expect_nothing_after(&f, 500, IGNORED, AGV_STATE_STANDBY);
    ask_for_off(false);
    fixture_mode(&f, MODE_ENGAGED);
    expect_nothing_after(&f, 3000, IGNORED, AGV_STATE_ACTIVE);
}

/* Times are settings. P is commanded while the vehicle reports D. */
/* Shows: SUP-11, FSM-2, INT-2, GEAR_DEVIATION */
void test_the_budgets_are_settings(void) {
    f.config.gear_deviation_ms = 321;
    f.config.throttle_idle_counts = 5;
    fixture_active(&f);
    measure_throttle(6);
    expect_trip_at(GEAR, f.now_ms + 321, 8);
    fixture_init(&f);
    f.config.autopilot_off_ms = 234;
    active_in_d();
    ask_for_off(true);
    expect_trip_at(IGNORED, f.now_ms + 234, -1);
    fixture_init(&f);
    f.config.throttle_deviation_ms = 111;
    f.config.throttle_deviation_counts = 5;
    active_in_d();
    measure_throttle(6);
    expect_trip_at(THROTTLE, f.now_ms + 111, 7);
}

/* ---- SPEED_IMPLAUSIBLE: 36 counts of 363h are 10 mm/s ---- */

/* Set the speeds of 363h and 101h, and run until both have come, in the same millisecond. */
static void set_speeds(uint16_t counts, int32_t left_mm_s, int32_t right_mm_s) {
    f.traffic[AGV_MSG_WHEEL_SPEED].phase_ms = f.traffic[AGV_MSG_VEHICLE_STATUS].phase_ms;
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_speed(&f, counts);
    fixture_wheels(&f, left_mm_s, right_mm_s);
    fixture_run(&f, 1);
}

static void expect_warning_at(uint32_t moment_ms) {
    walk_run_to(&f, moment_ms - 1);
    expect_nothing(&f, SPEED, AGV_STATE_STANDBY);
    fixture_run(&f, 1);
    expect_warning(&f, SPEED, AGV_STATE_STANDBY);
    expect_led(&f, 8);
}

/* 1000 mm/s of the VCU (3600 counts): a quarter of it and 500 are 750, so wheels at 250 agree, at 249 they do not. In
 * the other direction wheels at 2000 allow 1000. */
/* Shows: SUP-12, SPEED_IMPLAUSIBLE */
void test_two_measurements_of_speed(void) {
    fixture_standby(&f);
    set_speeds(3600, 250, 250);
    expect_nothing_after(&f, 3000, SPEED, AGV_STATE_STANDBY);
    set_speeds(3600, 2000, 2000);
    expect_nothing_after(&f, 3000, SPEED, AGV_STATE_STANDBY);
    set_speeds(3600, 249, 249);
    expect_warning_at(f.now_ms + 1000);
    set_speeds(3600, 1000, 1000);
    expect_fault_after(&f, 1999, SPEED, true);
    expect_fault_after(&f, 1, SPEED, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, SPEED));
}

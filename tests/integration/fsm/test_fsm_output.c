/* The hardware safety output: when it closes, when it opens, and that it then stays open. */
#include "one_fixture.h"
#include "walk.h"

static void reset_by_button(void) {
    walk_reset(&f, 1020);
}

/* Shows: FSM-4 */
void test_the_output_closes_on_entry_to_standby_and_not_before(void) {
    fixture_start(&f);
    (void)walk_until(&f, AGV_STATE_STANDBY, 1000);
    expect_output(&f, true);
    TEST_ASSERT_EQUAL_UINT32(1, f.hal.safety_output.changes);
}

/* Shows: FSM-4 */
void test_it_stays_closed_while_the_vehicle_obeys(void) {
    walk_to_safe(&f);
    expect_output(&f, true);
    reset_by_button();
    expect_output(&f, true);
    TEST_ASSERT_EQUAL_UINT32(1, f.hal.safety_output.changes);
}

/* After 500 ms without the confirmation, counted from the tick after this moment, it is open until the next STANDBY. */
static void expect_opens_at(uint32_t moment_ms) {
    expect_fault_after(&f, moment_ms + 500 - f.now_ms, AGV_FAULT_SAFE_STATE_UNCONFIRMED, false);
    expect_output(&f, true);
    expect_fault_after(&f, 1, AGV_FAULT_SAFE_STATE_UNCONFIRMED, true);
    const agv_fault_set_t trips = agv_supervisor_active_trips(&f.supervisor);
    TEST_ASSERT_TRUE(agv_fault_is_in(&trips, AGV_FAULT_SAFE_STATE_UNCONFIRMED));
    expect_output(&f, false);
}

static void expect_open_until_the_reset(void) {
    fixture_vehicle_confirms(&f);
    expect_state_after(&f, 200, AGV_STATE_SAFE);
    expect_fault(&f, AGV_FAULT_SAFE_STATE_UNCONFIRMED, false);
    expect_output(&f, false);
    reset_by_button();
    expect_output(&f, true);
}

/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_autopilot_off_is_not_confirmed(void) {
    walk_to_tripped(&f);
    const uint32_t trip_ms = f.now_ms;
    fixture_gear(&f, GEAR_P);
    fixture_wheels(&f, 0, 0);
    expect_opens_at(trip_ms);
    expect_reason(&f, AGV_FAULT_S_DRIVER_ALARM);
    expect_open_until_the_reset();
}

/* A tick finds the AI computer silent: the 500 ms count from this tick. */
/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_after_a_trip_in_a_tick_the_time_counts_from_that_tick(void) {
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    (void)walk_until(&f, AGV_STATE_TRIPPED, 1000);
    fixture_gear(&f, GEAR_P);
    fixture_wheels(&f, 0, 0);
    expect_fault_after(&f, 499, AGV_FAULT_SAFE_STATE_UNCONFIRMED, false);
    expect_output(&f, true);
    expect_fault_after(&f, 1, AGV_FAULT_SAFE_STATE_UNCONFIRMED, true);
    expect_output(&f, false);
}

/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_p_is_not_confirmed(void) {
    walk_to_tripped(&f);
    const uint32_t trip_ms = f.now_ms;
    fixture_mode(&f, MODE_MANUAL);
    expect_opens_at(trip_ms);
    expect_open_until_the_reset();
}

/* P is sent in the tick of 3000 ms. */
/* Shows: FSM-4, FSM-1, SAFE_STATE_UNCONFIRMED */
void test_p_counts_from_the_first_p_that_was_sent(void) {
    f.config.park = AGV_PARK_AT_STANDSTILL;
    walk_to_tripped_driving(&f, 1000);
    const uint32_t trip_ms = f.now_ms;
    fixture_mode(&f, MODE_MANUAL);
    expect_opens_at(trip_ms + 2999);
}

/* P is not reported for this time, then it is again. */
static void lose_p_for(uint32_t ms) {
    fixture_gear(&f, GEAR_D);
    fixture_send_now(&f, AGV_MSG_GEAR_STATUS);
    expect_state(&f, AGV_STATE_TRIPPED);
    fixture_run(&f, ms);
    fixture_gear(&f, GEAR_P);
    fixture_send_now(&f, AGV_MSG_GEAR_STATUS);
}

/* The sums are empty after 5 s of SAFE; then 500 ms in all, with interruptions. */
/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_a_confirmation_that_comes_and_goes_opens_it(void) {
    walk_to_safe(&f);
    expect_state_after(&f, 5100, AGV_STATE_SAFE);
    for (unsigned i = 0; i < 4; i++) {
        lose_p_for(100);
        expect_state(&f, AGV_STATE_SAFE);
        fixture_run(&f, 1000);
    }
    expect_output(&f, true);
    lose_p_for(99);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, AGV_FAULT_SAFE_STATE_UNCONFIRMED));
    expect_output(&f, true);
    lose_p_for(2);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, AGV_FAULT_SAFE_STATE_UNCONFIRMED));
    expect_open_until_the_reset();
}

static void expect_open_at_once(agv_state_t before, agv_fault_t fault) {
    expect_state(&f, before);
    expect_output(&f, true);
    if (fault == AGV_FAULT_BUS_OFF) {
        sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    } else {
        sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
    }
    expect_fault_after(&f, 1, fault, true);
    expect_output(&f, false);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 0);
    expect_open_until_the_reset();
}

static void expect_open_at_once_in_each_state(agv_fault_t fault) {
    fixture_standby(&f);
    expect_open_at_once(AGV_STATE_STANDBY, fault);
    fixture_init(&f);
    fixture_active(&f);
    expect_open_at_once(AGV_STATE_ACTIVE, fault);
    fixture_init(&f);
    walk_to_tripped(&f);
    expect_open_at_once(AGV_STATE_TRIPPED, fault);
    fixture_init(&f);
    walk_to_safe(&f);
    expect_open_at_once(AGV_STATE_SAFE, fault);
}

/* Shows: FSM-4, BUS_OFF */
void test_bus_off_opens_it_at_once(void) {
    expect_open_at_once_in_each_state(AGV_FAULT_BUS_OFF);
}

/* Shows: FSM-4, TX_STALLED */
void test_a_stalled_frame_opens_it_at_once(void) {
    expect_open_at_once_in_each_state(AGV_FAULT_TX_STALLED);
}

/* Shows: FSM-4, FSM-7 */
void test_a_crash_opens_it_and_it_stays_open_until_the_reset(void) {
    walk_to_safe(&f);
    fixture_button(&f, false);
    sim_hal_hold(&f.hal);
    TEST_ASSERT_FALSE(f.hal.safety_output.on);
    fixture_restart(&f, HAL_RESET_LOCK_UP);
    expect_output(&f, false);
    expect_state(&f, AGV_STATE_TRIPPED);
    fixture_run(&f, 1200);
    expect_open_until_the_reset();
}

/* The port's watchdog is off, so only the supervisor can open the output. */
/* Shows: FSM-4, TIM-3 */
void test_it_opens_while_the_hardware_watchdog_is_not_fed(void) {
    walk_to_safe(&f);
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    f.receive_path_dead = true;
    fixture_run(&f, 101); /* a step that is 100 ms late feeds it again after 101 ms */
    expect_output(&f, true);
    fixture_run(&f, 1);
    expect_output(&f, false);
    f.receive_path_dead = false;
    expect_open_until_the_reset();
}

/* Shows: FSM-4, FSM-7 */
void test_a_start_opens_it(void) {
    fixture_standby(&f);
    expect_output(&f, true);
    f.hal.config.reset_cause = HAL_RESET_POWER_ON;
    agv_supervisor_start(&f.supervisor, &f.ports, &f.config, f.now_ms); /* the port still has it closed */
    expect_output(&f, false);
}

/* After a restart while engaged and moving, P waits for standstill; the 500 ms for autopilot off count from the
 * start. */
/* Shows: FSM-4, FSM-7, SAFE_STATE_UNCONFIRMED */
void test_after_a_restart_autopilot_off_is_awaited_from_the_start(void) {
    f.config.park = AGV_PARK_AT_STANDSTILL;
    fixture_active(&f);
    fixture_wheels(&f, 1000, 1000);
    fixture_mute_ai(&f, true);
    fixture_run(&f, 50);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    expect_fault_after(&f, 499, AGV_FAULT_SAFE_STATE_UNCONFIRMED, false);
    expect_fault_after(&f, 1, AGV_FAULT_SAFE_STATE_UNCONFIRMED, true);
}

/* TRIPPED and SAFE: confirmation of the safe state, and its withdrawal. */
#include "one_fixture.h"
#include "spoil.h"
#include "walk.h"

static void trip_and_confirm_all_but(const spoil_t *spoil) {
    fixture_init(&f);
    f.what = spoil->what;
    f.long_run = true;
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    walk_trip(&f);
    fixture_vehicle_confirms(&f);
    spoil_set(&f, spoil, true);
    fixture_run(&f, 4900); /* after that a moving vehicle is a fault */
}

/* Shows: FSM-4 */
void test_without_each_part_of_the_confirmation_it_stays_tripped(void) {
    static const spoil_t ROWS[] = {{"D", M_GEAR_STATUS, BYTE, 1, .value = GEAR_D},
                                   {"N", M_GEAR_STATUS, BYTE, 1, .value = GEAR_N},
                                   {"R", M_GEAR_STATUS, BYTE, 1, .value = GEAR_R},
                                   {"P and D at once", M_GEAR_STATUS, BYTE, 1, .value = 9},
                                   {"no 0A3h", M_GEAR_STATUS, .how = SILENT},
                                   {"engaged", M_VEHICLE, BYTE, 7, .value = MODE_ENGAGED},
                                   {"VCU counter stands still", M_VEHICLE, .how = FROZEN},
                                   {"VCU silent", .by = fixture_mute_vcu}};
    for (unsigned i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        trip_and_confirm_all_but(&ROWS[i]);
        expect_tripped(&f, AGV_FAULT_S_DRIVER_ALARM);
        expect_fault(&f, AGV_FAULT_SAFE_STATE_UNCONFIRMED, true);
        expect_output(&f, false);
    }
}

/* Shows: FSM-4 */
void test_conditions_that_the_confirmation_does_not_need(void) {
    static const spoil_t ROWS[] = {{.what = "nothing"},
                                   {"neither mode", M_VEHICLE, BYTE, 7, .value = MODE_NEITHER},
                                   {"EPS silent", .by = fixture_mute_eps}};
    for (unsigned i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        trip_and_confirm_all_but(&ROWS[i]);
        expect_state(&f, AGV_STATE_SAFE);
        expect_fault(&f, AGV_FAULT_SAFE_STATE_UNCONFIRMED, false);
        expect_output(&f, true);
    }
}

/* A vehicle that still rolls confirms, and has 5 s to stop (FSM-12). */
/* Shows: FSM-4 */
void test_the_confirmation_does_not_need_standstill(void) {
    f.long_run = true;
    walk_to_tripped_driving(&f, 900);
    fixture_vehicle_confirms(&f);
    fixture_drive(&f, 900);
    expect_state_after(&f, 4900, AGV_STATE_SAFE);
    expect_output(&f, true);
}

/* Shows: FSM-2, FSM-4 */
void test_the_confirmation_counts_with_its_last_frame(void) {
    walk_to_tripped(&f);
    fixture_vehicle_confirms(&f);
    for (unsigned i = 0; i < 3; i++) {
        fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
        expect_state(&f, AGV_STATE_TRIPPED);
    }
    fixture_send_now(&f, AGV_MSG_GEAR_STATUS);
    expect_state(&f, AGV_STATE_SAFE);
    fixture_init(&f);
    walk_to_tripped(&f);
    fixture_vehicle_confirms(&f);
    fixture_send_now(&f, AGV_MSG_GEAR_STATUS);
    for (unsigned i = 0; i < 3; i++) { /* not engaged: with the third one */
        expect_state(&f, AGV_STATE_TRIPPED);
        fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    }
    expect_state(&f, AGV_STATE_SAFE);
}

/* Shows: FSM-2, FSM-10 */
void test_safe_sends_as_tripped_does(void) {
    walk_to_tripped(&f);
    const uint32_t trip_ms = f.now_ms;
    fixture_vehicle_confirms(&f);
    fixture_mode(&f, MODE_NEITHER); /* so that the steering is held */
    expect_state_after(&f, 90, AGV_STATE_SAFE);
    fixture_forget_sent(&f);
    expect_count_after(&f, 1000, 0x43F, 10); /* from 91 to 1090 ms after the trip */
    TEST_ASSERT_EQUAL_UINT32(10, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(10, fixture_count_sent(&f, 0x075));
    TEST_ASSERT_EQUAL_UINT32(40, fixture_count_sent(&f, 0x065));
    TEST_ASSERT_EQUAL_UINT32(100, fixture_nth_sent(&f, 0x43F, 0)->time_ms - trip_ms);
    TEST_ASSERT_EQUAL_UINT32(166, fixture_nth_sent(&f, 0x168, 0)->time_ms - trip_ms);
    TEST_ASSERT_EQUAL_UINT32(133, fixture_nth_sent(&f, 0x075, 0)->time_ms - trip_ms);
    TEST_ASSERT_EQUAL_UINT32(100, fixture_nth_sent(&f, 0x065, 0)->time_ms - trip_ms);
}

/* ---- Withdrawal ---- */

/* Shows: FSM-3, FSM-4 */
void test_leaving_p_or_engaging_withdraws_the_confirmation_in_that_frame(void) {
    static const uint8_t GEARS[] = {GEAR_D, GEAR_N, GEAR_R, 0, 0xFF};
    walk_to_safe(&f);
    for (unsigned i = 0; i < sizeof GEARS; i++) {
        fixture_gear(&f, GEARS[i]);
        fixture_send_now(&f, AGV_MSG_GEAR_STATUS);
        expect_state(&f, AGV_STATE_TRIPPED);
        fixture_gear(&f, GEAR_P);
        fixture_send_now(&f, AGV_MSG_GEAR_STATUS);
        expect_state(&f, AGV_STATE_SAFE);
    }
    walk_report(&f, MODE_ENGAGED);
    expect_state(&f, AGV_STATE_TRIPPED);
    fixture_mode(&f, MODE_MANUAL);
    for (unsigned i = 0; i < 3; i++) {
        expect_state(&f, AGV_STATE_TRIPPED);
        fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    }
    expect_state(&f, AGV_STATE_SAFE);
    expect_reason(&f, AGV_FAULT_S_DRIVER_ALARM);
    expect_output(&f, true);
}

/* The deadline of 0A3h is 125 ms. */
/* Shows: FSM-4, SUP-3 */
void test_a_gear_that_is_not_fresh_confirms_nothing(void) {
    walk_to_safe(&f);
    fixture_run_past(&f, AGV_MSG_GEAR_STATUS);
    f.traffic[AGV_MSG_GEAR_STATUS].muted = true;
    expect_state_after(&f, 125, AGV_STATE_SAFE);
    expect_state_after(&f, 1, AGV_STATE_TRIPPED);
    f.traffic[AGV_MSG_GEAR_STATUS].muted = false;
    fixture_run_past(&f, AGV_MSG_GEAR_STATUS);
    expect_state(&f, AGV_STATE_SAFE);
}

/* The deadline of the VCU's heartbeat is 50 ms; one repeated counter does not revive it, a changed one does. */
/* Shows: FSM-4, SUP-2 */
void test_a_vcu_that_is_not_alive_confirms_nothing(void) {
    walk_to_safe(&f);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    f.traffic[AGV_MSG_VEHICLE_STATUS].muted = true;
    expect_state_after(&f, 50, AGV_STATE_SAFE);
    expect_state_after(&f, 1, AGV_STATE_TRIPPED);
    f.traffic[AGV_MSG_VEHICLE_STATUS].frozen = true;
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state(&f, AGV_STATE_TRIPPED);
    f.traffic[AGV_MSG_VEHICLE_STATUS].frozen = false;
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state(&f, AGV_STATE_SAFE);
}

/* Shows: FSM-3, FSM-5 */
void test_the_state_is_latched_whatever_the_vehicle_reports(void) {
    static const uint8_t MODES[] = {MODE_MANUAL, MODE_ENGAGED, MODE_NEITHER, MODE_BOTH};
    static const uint8_t GEARS[] = {GEAR_P, GEAR_D, GEAR_N, GEAR_R, 0};
    f.long_run = true;
    walk_to_safe(&f);
    fixture_mute_ai(&f, false);
    for (unsigned i = 0; i < 4 * 5; i++) {
        fixture_mode(&f, MODES[i % 4]);
        fixture_gear(&f, GEARS[i % 5]);
        fixture_run(&f, 1500);
        const agv_state_t state = agv_supervisor_state(&f.supervisor);
        TEST_ASSERT_TRUE(state == AGV_STATE_TRIPPED || state == AGV_STATE_SAFE);
        expect_reason(&f, AGV_FAULT_S_DRIVER_ALARM);
    }
}

/* Shows: FSM-4, MODE_INVALID */
void test_both_modes_at_once_after_engaged_confirm_nothing(void) {
    walk_to_tripped(&f);
    fixture_vehicle_confirms(&f);
    fixture_mode(&f, MODE_BOTH); /* engaged stands until MODE_INVALID */
    expect_state_after(&f, 50, AGV_STATE_TRIPPED);
}

/* Both modes at once do not count as "not engaged", whatever the mode was before. */
/* Shows: FSM-4, MODE_INVALID */
void test_both_modes_at_once_after_manual_withdraw_the_confirmation(void) {
    walk_to_safe(&f);
    fixture_mode(&f, MODE_BOTH);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state(&f, AGV_STATE_TRIPPED);
    fixture_mode(&f, MODE_MANUAL);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_state(&f, AGV_STATE_SAFE);
}

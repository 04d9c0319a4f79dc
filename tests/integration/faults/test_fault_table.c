/* The table of faults: name, rank, default class and LED code, by hand; classes that the configuration may change. */
#include "agv/names.h"
#include "causes.h"
#include "one_fixture.h"

/* Shows: FSM-5, LED-1, SUP-4 */
void test_names_ranks_classes_and_led_codes(void) {
    TEST_ASSERT_EQUAL_INT(FAULT_ROWS, AGV_FAULT_COUNT);
    for (unsigned i = 0; i < FAULT_ROWS; i++) {
        TEST_ASSERT_EQUAL_STRING(FAULT_ROW[i].name, agv_fault_name((agv_fault_t)i));
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(i, agv_fault_from_name(FAULT_ROW[i].name), FAULT_ROW[i].name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(FAULT_ROW[i].trip, agv_fault_is_in(&f.config.trips, i), FAULT_ROW[i].name);
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(FAULT_ROW[i].led, agv_fault_led_code(i), FAULT_ROW[i].name);
    }
}

/* ---- Classes that configuration has changed ---- */

static void set_class(agv_fault_t fault, bool trip) {
    agv_fault_set_put(&f.config.trips, fault, trip);
}

/* Shows: SUP-4, INT-2, EPS_TEMP_ABOVE_110, STEERING_POSITION_TIMEOUT */
void test_a_warning_may_be_made_a_trip(void) {
    set_class(AGV_FAULT_EPS_TEMP_ABOVE_110, true);
    set_class(AGV_FAULT_STEERING_POSITION_TIMEOUT, true);
    fixture_active(&f);
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0x10;
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    expect_trip(&f, AGV_FAULT_EPS_TEMP_ABOVE_110, f.traffic[AGV_MSG_EPS_STATUS].call, ANGLE_CENTRE);
    fixture_init(&f);
    set_class(AGV_FAULT_STEERING_POSITION_TIMEOUT, true);
    f.traffic[AGV_MSG_STEERING_POSITION].muted = true;
    fixture_start(&f);
    expect_state_after(&f, 2000, AGV_STATE_INIT); /* now INIT waits for this message, too */
    fixture_init(&f);
    set_class(AGV_FAULT_STEERING_POSITION_TIMEOUT, true);
    fixture_standby(&f);
    fixture_run_past(&f, AGV_MSG_STEERING_POSITION);
    f.traffic[AGV_MSG_STEERING_POSITION].muted = true;
    expect_trip_after(&f, 61, AGV_FAULT_STEERING_POSITION_TIMEOUT, NO_HOLD);
}

/* Shows: SUP-4, INT-2, REMOTE_SIGNAL_LOST, WHEEL_SPEED_TIMEOUT, THROTTLE_STATUS_TIMEOUT */
void test_some_trips_may_be_made_warnings(void) {
    set_class(AGV_FAULT_REMOTE_SIGNAL_LOST, false);
    set_class(AGV_FAULT_WHEEL_SPEED_TIMEOUT, false);
    fixture_active(&f);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x01;
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_warning(&f, AGV_FAULT_REMOTE_SIGNAL_LOST, AGV_STATE_ACTIVE);
    expect_led(&f, 17);
    f.traffic[AGV_MSG_WHEEL_SPEED].muted = true;
    expect_fault_after(&f, 100, AGV_FAULT_WHEEL_SPEED_TIMEOUT, true);
    expect_state(&f, AGV_STATE_ACTIVE);
    fixture_init(&f);
    set_class(AGV_FAULT_THROTTLE_STATUS_TIMEOUT, false);
    f.traffic[AGV_MSG_THROTTLE_STATUS].muted = true;
    fixture_standby(&f); /* INIT does not wait for it either */
    fixture_init(&f);
    set_class(AGV_FAULT_WHEEL_SPEED_TIMEOUT, false);
    f.traffic[AGV_MSG_WHEEL_SPEED].muted = true;
    fixture_start(&f);
    expect_state_after(&f, 2000, AGV_STATE_INIT); /* for standstill */
}

/* A warning is counted when it is raised, not when it ends. Trips are not counted. */
/* Shows: VCU_LEVEL2_ALARM, S_DRIVER_ALARM */
void test_warnings_are_counted(void) {
    fixture_standby(&f);
    const uint32_t before = agv_supervisor_counters(&f.supervisor)->warnings;
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[5] = 1;
    fixture_run(&f, 20);
    TEST_ASSERT_EQUAL_UINT32(before + 1, agv_supervisor_counters(&f.supervisor)->warnings);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[5] = 0;
    fixture_run(&f, 20);
    TEST_ASSERT_EQUAL_UINT32(before + 1, agv_supervisor_counters(&f.supervisor)->warnings);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x80;
    expect_fault_after(&f, 20, AGV_FAULT_S_DRIVER_ALARM, true);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0;
    fixture_run(&f, 20);
    TEST_ASSERT_EQUAL_UINT32(before + 1, agv_supervisor_counters(&f.supervisor)->warnings);
}

/* The time of P after a trip: at once, or at standstill (`park`). */
#include "one_fixture.h"
#include "walk.h"

/* A vehicle at 1 m/s trips; the AI computer is silent from then on. @return time of the trip */
static uint32_t trip_while_driving(void) {
    f.config.park = AGV_PARK_AT_STANDSTILL;
    walk_to_tripped_driving(&f, 1000);
    return f.now_ms;
}

/* Shows: FSM-1 */
void test_by_default_p_is_commanded_at_once_while_driving(void) {
    walk_to_tripped_driving(&f, 1000);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_HEX8(GEAR_P, fixture_nth_sent(&f, 0x168, 0)->data[0]);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x43F));
    TEST_ASSERT_EQUAL_HEX8(0x70, fixture_nth_sent(&f, 0x43F, 0)->data[4]);
}

static void expect_p_in_mode(uint8_t mode, const char *what) {
    fixture_init(&f);
    f.what = what;
    fixture_standby(&f);
    fixture_mode(&f, mode);
    fixture_run(&f, 40);
    fixture_forget_sent(&f);
    walk_trip(&f);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, fixture_count_sent(&f, 0x168), what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, fixture_count_sent(&f, 0x43F), what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, fixture_count_sent(&f, 0x075), what);
}

/* Shows: FSM-1 */
void test_p_and_autopilot_off_are_commanded_in_every_mode(void) {
    expect_p_in_mode(MODE_MANUAL, "manual");
    expect_p_in_mode(MODE_ENGAGED, "engaged");
    expect_p_in_mode(MODE_NEITHER, "neither");
    expect_p_in_mode(MODE_BOTH, "both");
}

/* Shows: FSM-1 */
void test_at_standstill_throttle_0_and_autopilot_off_go_out_at_once_and_p_does_not(void) {
    (void)trip_while_driving();
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x43F));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x075));
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x168));
    expect_count_after(&f, 1000, 0x168, 0);
    TEST_ASSERT_EQUAL_UINT32(1 + 10, fixture_count_sent(&f, 0x43F)); /* the others keep their cycles */
}

/* Standstill is 100 ms after the first slow 101h. P follows at once, then every 100 ms. */
/* Shows: FSM-1 */
void test_at_standstill_p_is_sent_when_the_vehicle_stands(void) {
    (void)trip_while_driving();
    fixture_run(&f, 500);
    fixture_wheels(&f, 49, -49); /* that 363h still reports 1 m/s does not matter: the wheels stand */
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    const uint32_t slow_ms = f.now_ms;
    expect_count_after(&f, 99, 0x168, 0);
    expect_count_after(&f, 300, 0x168, 3);
    for (uint32_t n = 0; n < 3; n++) {
        TEST_ASSERT_EQUAL_UINT32(100 + 100 * n, fixture_nth_sent(&f, 0x168, n)->time_ms - slow_ms);
    }
}

/* Shows: FSM-1 */
void test_at_standstill_p_goes_out_with_the_others_when_the_vehicle_stands_already(void) {
    f.config.park = AGV_PARK_AT_STANDSTILL;
    walk_to_tripped(&f);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(fixture_nth_sent(&f, 0x43F, 0)->call, fixture_nth_sent(&f, 0x168, 0)->call);
}

static void expect_p_only_after_3_s(uint32_t trip_ms) {
    fixture_run(&f, trip_ms + 2999 - f.now_ms);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, fixture_count_sent(&f, 0x168), f.what);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, fixture_count_sent(&f, 0x168), f.what);
    fixture_run(&f, 100);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(2, fixture_count_sent(&f, 0x168), f.what);
}

/* Shows: FSM-1 */
void test_at_standstill_p_is_sent_after_3_s_at_the_latest(void) {
    const uint32_t trip_ms = trip_while_driving();
    fixture_wheels(&f, 0, -50);
    expect_p_only_after_3_s(trip_ms);
}

/* Shows: FSM-1, WHEEL_SPEED_TIMEOUT */
void test_at_standstill_a_wheel_speed_that_is_not_fresh_is_no_standstill(void) {
    const uint32_t trip_ms = trip_while_driving();
    fixture_wheels(&f, 0, 0);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    f.traffic[AGV_MSG_WHEEL_SPEED].muted = true; /* one slow frame, then silence: stale 61 ms later */
    expect_p_only_after_3_s(trip_ms);
}

/* A command that is not sent is not an override either. */
/* Shows: FSM-1, TOP-1 */
void test_at_standstill_a_gear_command_of_another_sender_is_not_overridden_before(void) {
    static const uint8_t drive[8] = {GEAR_D};
    const uint32_t trip_ms = trip_while_driving();
    fixture_run(&f, 500);
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, drive);
    expect_count_after(&f, 20, 0x168, 0);
    expect_p_only_after_3_s(trip_ms);
    fixture_run(&f, 10);
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, drive);
    TEST_ASSERT_EQUAL_UINT32(3, fixture_count_sent(&f, 0x168));
}

/* Shows: FSM-1, FSM-7 */
void test_at_standstill_in_init_p_is_sent_when_the_vehicle_stands(void) {
    const uint32_t start_ms = f.now_ms;
    f.config.park = AGV_PARK_AT_STANDSTILL;
    fixture_mute_ai(&f, true);
    fixture_start(&f);
    fixture_run(&f, 400); /* the first 101h comes at 3 ms */
    TEST_ASSERT_EQUAL_UINT32(103, fixture_nth_sent(&f, 0x168, 0)->time_ms - start_ms);
    TEST_ASSERT_EQUAL_UINT32(203, fixture_nth_sent(&f, 0x168, 1)->time_ms - start_ms);
}

/* Shows: FSM-1 */
void test_at_standstill_a_second_trip_waits_anew(void) {
    f.config.park = AGV_PARK_AT_STANDSTILL;
    walk_to_safe(&f);
    walk_reset(&f, 1000);
    fixture_drive(&f, 300);
    fixture_run(&f, 200);
    fixture_forget_sent(&f);
    walk_trip(&f);
    expect_p_only_after_3_s(f.now_ms);
}

/* The mode (SUP-9): too many engagements, and a missing mode. An engagement ends with the third 363h in a row without
 * bit 8; one that begins within 100 ms continues it. */
#include "one_fixture.h"
#include "walk.h"

static const agv_message_t VCU = AGV_MSG_VEHICLE_STATUS;

/* The next 363h frames, this many, report this mode. */
static void report(uint8_t mode, unsigned frames) {
    fixture_mode(&f, mode);
    for (unsigned i = 0; i < frames; i++) {
        fixture_run_past(&f, VCU);
    }
}

/* ---- The end of an engagement ---- */

/* Shows: SUP-9, FSM-2 */
void test_an_engagement_ends_with_the_third_frame(void) {
    static const uint8_t MODES[] = {MODE_MANUAL, MODE_NEITHER};
    for (unsigned i = 0; i < 2; i++) {
        fixture_init(&f);
        fixture_active(&f);
        report(MODES[i], 2);
        expect_state(&f, AGV_STATE_ACTIVE);
        report(MODE_ENGAGED, 1);
        report(MODES[i], 2); /* counted anew */
        expect_state(&f, AGV_STATE_ACTIVE);
        report(MODES[i], 1);
        expect_state(&f, AGV_STATE_STANDBY);
    }
}

/* ---- MODE_FLAPPING ---- */

static const agv_fault_t FLAPPING = AGV_FAULT_MODE_FLAPPING;

/* The engagement ends, and begins again with the 363h this long after the one that began it. */
static void flap(uint32_t period_ms) {
    const uint32_t began_ms = f.now_ms;
    report(MODE_MANUAL, 3);
    expect_state(&f, AGV_STATE_STANDBY);
    fixture_run(&f, period_ms - (f.now_ms - began_ms) - 1);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run(&f, 1);
}

/* Engaged at standstill; then the wheels turn, so that the steering is held at the trip. */
static void engage_first(void) {
    fixture_standby(&f);
    fixture_wheels(&f, 500, 500);
    fixture_run(&f, 20);
    report(MODE_ENGAGED, 1);
    expect_state(&f, AGV_STATE_ACTIVE);
}

/* The fourth engagement 5000 ms after the first trips in its frame. */
/* Shows: SUP-9, FSM-2, MODE_FLAPPING */
void test_the_fourth_engagement_within_5_s(void) {
    engage_first();
    flap(1000);
    flap(3000);
    expect_nothing(&f, FLAPPING, AGV_STATE_ACTIVE);
    fixture_forget_sent(&f);
    flap(1000);
    expect_trip(&f, FLAPPING, f.traffic[VCU].call, ANGLE_CENTRE);
    expect_led(&f, -1);
}

/* An engagement that is continued within 100 ms is a change to engaged, too: 30 ms off, 40 ms off. */
/* Shows: SUP-9, MODE_FLAPPING */
void test_glitches_count(void) {
    engage_first();
    for (unsigned i = 0; i < 2; i++) {
        flap(70);
        expect_nothing(&f, FLAPPING, AGV_STATE_ACTIVE);
    }
    flap(70);
    expect_reason(&f, FLAPPING);
}

/* Manual in every second frame: 10 ms up, 10 ms half down. Then driving is not judged for half of the time. */
/* Shows: SUP-9, MODE_FLAPPING */
void test_manual_that_flickers_while_engaged(void) {
    fixture_active(&f);
    for (unsigned i = 0; i < 47; i++) {
        report(MODE_MANUAL, 1);
        report(MODE_ENGAGED, 1);
    }
    expect_nothing(&f, FLAPPING, AGV_STATE_ACTIVE);
    for (unsigned i = 0; i < 4; i++) {
        report(MODE_MANUAL, 1);
        report(MODE_ENGAGED, 1);
    }
    expect_reason(&f, FLAPPING);
}

/* Engagements that begin in TRIPPED do not count, but those before a reset do: three engagements, a trip and a
 * reset. */
/* Shows: SUP-9, MODE_FLAPPING */
void test_engagements_while_tripped_do_not_count(void) {
    f.config.mode_flapping_ms = 60000;
    fixture_active(&f); /* the first */
    walk_trip(&f);
    for (unsigned i = 0; i < 5; i++) {
        report(MODE_MANUAL, 10);
        report(MODE_ENGAGED, 10);
    }
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, FLAPPING));
    fixture_vehicle_confirms(&f);
    fixture_run(&f, 2000);
    walk_reset(&f, 1000);
    for (unsigned i = 0; i < 3; i++) {
        fixture_run(&f, 200);
        report(MODE_MANUAL, 3);
        expect_fault(&f, FLAPPING, false);
        report(MODE_ENGAGED, 1);
    }
    expect_reason(&f, FLAPPING);
}

/* ---- MODE_NONE ---- */

static const agv_fault_t NONE = AGV_FAULT_MODE_NONE;

static void drive_in_manual(void) {
    fixture_standby(&f);
    fixture_wheels(&f, 500, 500);
    fixture_run(&f, 20);
}

/* Shows: SUP-9, FSM-2, MODE_NONE */
void test_no_mode_for_500_ms_in_motion(void) {
    drive_in_manual();
    report(MODE_NEITHER, 1);
    expect_nothing_after(&f, 499, NONE, AGV_STATE_STANDBY);
    expect_trip_after(&f, 1, NONE, ANGLE_CENTRE);
    expect_led(&f, -1);
    expect_fault_after(&f, 1000, NONE, true);
    report(MODE_MANUAL, 1);
    expect_fault(&f, NONE, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, NONE));
}

/* At standstill there is no fault, and standstill ends it. */
/* Shows: SUP-9, MODE_NONE */
void test_no_mode_at_standstill(void) {
    fixture_standby(&f);
    report(MODE_NEITHER, 1);
    expect_nothing_after(&f, 3000, NONE, AGV_STATE_STANDBY);
    fixture_wheels(&f, 500, 500);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    expect_nothing_after(&f, 499, NONE, AGV_STATE_STANDBY); /* both together for 500 ms */
    expect_reason_after(&f, 2, NONE);
    fixture_wheels(&f, 0, 0);
    expect_fault_after(&f, 120, NONE, false);
}

/* Not checked in INIT and TRIPPED. */
/* Shows: SUP-9, MODE_NONE */
void test_no_mode_in_other_states(void) {
    fixture_mode(&f, MODE_NEITHER);
    fixture_wheels(&f, 500, 500);
    fixture_start(&f);
    expect_nothing_after(&f, 2000, NONE, AGV_STATE_INIT);
    fixture_init(&f);
    walk_to_tripped_driving(&f, 500);
    report(MODE_NEITHER, 1);
    fixture_run(&f, 2000);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, NONE));
}

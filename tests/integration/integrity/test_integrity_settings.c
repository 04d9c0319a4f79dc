/* Times and counts are settings. Each is set to a different value and checked to the millisecond. Also frames that come
 * in the last possible millisecond. test_timers has the settings of all timers. */
#include "agv/names.h"
#include "causes.h"
#include "one_fixture.h"
#include "walk.h"

/* ---- Deadlines ---- */

/* From its next frame on the message has this cycle. */
static void slow_down(unsigned message, uint32_t cycle_ms) {
    fixture_run_past(&f, message);
    f.traffic[message].cycle_ms = (uint16_t)cycle_ms;
    f.traffic[message].phase_ms = (uint16_t)(f.elapsed_ms % cycle_ms);
}

static void check_last_millisecond(const cause_t *cause) {
    const uint32_t deadline_ms = cause_deadline_ms(cause);
    fixture_init(&f);
    f.what = agv_fault_name(cause->fault);
    fixture_active(&f);
    slow_down(cause->message, deadline_ms + 1);
    expect_nothing_after(&f, 3000, cause->fault, AGV_STATE_ACTIVE);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, fixture_raised(&f, cause->fault), f.what);
    slow_down(cause->message, deadline_ms + 2);
    expect_nothing_after(&f, deadline_ms, cause->fault, AGV_STATE_ACTIVE);
    expect_fault_after(&f, 1, cause->fault, true);
}

/* Frames are handled before the tick of their millisecond: one frame each deadline + 1 ms is always just in time. */
/* Shows: SUP-2, SUP-3 */
void test_a_frame_in_the_last_millisecond(void) {
    for (unsigned i = 0; i < CAUSES; i++) {
        if (cause_is_silence(&CAUSE[i])) {
            check_last_millisecond(&CAUSE[i]);
        }
    }
}

/* ---- Other times and counts ---- */

/* Grace 123 ms, then a budget of 67 ms, of which the tick at 123 ms is the first. */
/* Shows: SUP-5, THROTTLE_IN_PARK */
void test_grace_and_throttle_in_park_time(void) {
    f.config.engaged_grace_ms = 123;
    f.config.throttle_in_park_ms = 67;
    fixture_standby(&f);
    f.traffic[AGV_MSG_THROTTLE_STATUS].data[0] = 10;
    walk_engage(&f);
    expect_nothing_after(&f, 123 + 66, AGV_FAULT_THROTTLE_IN_PARK, AGV_STATE_ACTIVE);
    expect_trip_after(&f, 1, AGV_FAULT_THROTTLE_IN_PARK, ANGLE_CENTRE);
}

static void check_count(agv_message_t message, const uint8_t bad[8], unsigned frames, agv_fault_t fault) {
    fixture_active(&f);
    f.what = agv_fault_name(fault);
    fixture_run_past(&f, message);
    for (unsigned i = 0; i < 8; i++) {
        f.traffic[message].data[i] = bad[i];
    }
    for (unsigned i = 1; i < frames; i++) {
        fixture_run_past(&f, message);
        expect_nothing(&f, fault, AGV_STATE_ACTIVE);
    }
    fixture_run_past(&f, message);
    expect_fault(&f, fault, true);
    expect_reason(&f, fault);
}

/* Shows: SUP-4, SUP-5, EPS_MODE_OFF, GEAR_STATUS_INVALID, THROTTLE_STATUS_INVALID, STEERING_ANGLE_INVALID */
void test_counts_of_frames(void) {
    static const struct {
        agv_message_t message;
        uint8_t bad[8];
        unsigned frames;
        agv_fault_t fault;
    } rows[] = {{AGV_MSG_EPS_STATUS, {0, 0, 0, 1, 0, 0, 0, 0x01}, 2, AGV_FAULT_EPS_UNDER_VOLTAGE},
                {AGV_MSG_EPS_STATUS, {0, 0, 0, 0xFF}, 7, AGV_FAULT_EPS_MODE_OFF},
                {AGV_MSG_GEAR_STATUS, {0}, 4, AGV_FAULT_GEAR_STATUS_INVALID},
                {AGV_MSG_THROTTLE_STATUS, {251}, 4, AGV_FAULT_THROTTLE_STATUS_INVALID},
                {AGV_MSG_STEERING_STATUS, {0, 100, 0xFF, 0xFF}, 4, AGV_FAULT_STEERING_ANGLE_INVALID}};
    for (unsigned i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        fixture_init(&f);
        f.config.eps_supply_fault_frames = 2;
        f.config.eps_mode_frames = 7;
        f.config.status_invalid_frames = 4;
        check_count(rows[i].message, rows[i].bad, rows[i].frames, rows[i].fault);
    }
}

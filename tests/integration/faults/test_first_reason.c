/* The first reason (FSM-5): of two simultaneous faults the upper row of the table, within a row the left name. causes.c
 * has this order. */
#include "causes.h"
#include "one_fixture.h"

/* ---- Two in one frame ---- */

/* Both bits from one frame on. */
static void check_bits(const cause_t *upper, const cause_t *lower) {
    fixture_init(&f);
    fixture_active(&f);
    fixture_run_past(&f, upper->message);
    cause_set(f.traffic, upper, true);
    cause_set(f.traffic, lower, true);
    for (unsigned i = 0; i < upper->count; i++) {
        expect_reason(&f, AGV_FAULT_NONE);
        fixture_run_past(&f, upper->message);
    }
    expect_fault(&f, upper->fault, true);
    expect_fault(&f, lower->fault, true);
    expect_reason(&f, upper->fault);
}

static bool is_trip_by_bits(const cause_t *cause) {
    return FAULT_ROW[cause->fault].trip && (cause->how == BY_BITS || cause->how == BY_BITS_ENGAGED);
}

static bool are_raised_by_one_frame(const cause_t *upper, const cause_t *lower) {
    return is_trip_by_bits(upper) && is_trip_by_bits(lower) && upper->message == lower->message &&
           upper->count == lower->count;
}

/* 167h: four at once and three that are scored; 363h: six. */
/* Shows: FSM-5, SUP-4 */
void test_two_bits_of_one_frame(void) {
    unsigned pairs = 0;
    for (unsigned upper = 0; upper < CAUSES; upper++) {
        for (unsigned lower = upper + 1; lower < CAUSES; lower++) {
            if (are_raised_by_one_frame(&CAUSE[upper], &CAUSE[lower])) {
                check_bits(&CAUSE[upper], &CAUSE[lower]);
                pairs++;
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT32(6 + 3 + 15, pairs);
}

/* A warning is never the reason, even with a higher rank: EPS_TEMP_ABOVE_110 ranks above the VCU's alarms of the
 * EPS. */
/* Shows: FSM-5, EPS_TEMP_ABOVE_110 */
void test_a_warning_is_never_the_reason(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0x10;
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    expect_warning(&f, AGV_FAULT_EPS_TEMP_ABOVE_110, AGV_STATE_ACTIVE);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x01;
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_reason(&f, AGV_FAULT_REMOTE_SIGNAL_LOST);
    expect_led(&f, 17); /* trips are shown before warnings */
}

/* ---- Two deadlines in one tick ---- */

static bool is_trip_by_silence(const cause_t *cause) {
    return FAULT_ROW[cause->fault].trip && cause_is_silence(cause);
}

/* A command is awaited while engaged only, the heartbeat of the AI computer also in manual. */
static bool is_awaited_while_engaged(const cause_t *cause) {
    return cause->how == BY_SILENCE_ENGAGED && cause->message != M_SIGNALS;
}

/* The last frame comes at a time for which its deadline expires exactly in that millisecond. */
static void send_last(const cause_t *row, uint32_t expires_ms) {
    if (f.now_ms == expires_ms - cause_deadline_ms(row) - 1) {
        fixture_send_now(&f, row->message);
        f.traffic[row->message].muted = true;
    }
}

static void check_tick(const cause_t *upper, const cause_t *lower) {
    fixture_init(&f);
    fixture_active(&f);
    const uint32_t expires_ms = f.now_ms + 400;
    for (unsigned i = 0; i < 400; i++) {
        expect_reason(&f, AGV_FAULT_NONE);
        send_last(upper, expires_ms);
        send_last(lower, expires_ms);
        fixture_run(&f, 1);
    }
    expect_fault(&f, upper->fault, true);
    expect_fault(&f, lower->fault, !(upper->fault == AGV_FAULT_VCU_HEARTBEAT_LOST && is_awaited_while_engaged(lower)));
    expect_reason(&f, upper->fault);
}

/* The loss of the VCU ends the engagement: AI commands are not awaited any more. */
/* Shows: FSM-5, SUP-2, SUP-3 */
void test_two_deadlines_in_one_tick(void) {
    unsigned pairs = 0;
    for (unsigned upper = 0; upper < CAUSES; upper++) {
        for (unsigned lower = upper + 1; lower < CAUSES; lower++) {
            if (is_trip_by_silence(&CAUSE[upper]) && is_trip_by_silence(&CAUSE[lower])) {
                check_tick(&CAUSE[upper], &CAUSE[lower]);
                pairs++;
            }
        }
    }
    TEST_ASSERT_EQUAL_UINT32(45, pairs);
}

/* ---- One after the other ---- */

/* Frames are processed before the tick of their millisecond, so a frame's fault is first, whatever its rank. */
/* Shows: FSM-5, SUP-2 */
void test_a_frame_comes_before_the_tick(void) {
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_STEERING_STATUS);
    f.traffic[AGV_MSG_STEERING_STATUS].muted = true;
    f.traffic[AGV_MSG_VEHICLE_STATUS].phase_ms = 5; /* 51 ms later */
    fixture_run(&f, 50);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x02;
    expect_reason(&f, AGV_FAULT_NONE);
    expect_fault_after(&f, 1, AGV_FAULT_EPS_HEARTBEAT_LOST, true);
    expect_fault(&f, AGV_FAULT_REMOTE_POWER_LOST, true);
    expect_reason(&f, AGV_FAULT_REMOTE_POWER_LOST);
    expect_led(&f, 12); /* the LED shows the highest-ranking one */
}

/* A later fault is never the first reason, even if it ranks higher or the first one has ended. */
/* Shows: FSM-5 */
void test_a_later_fault_is_not_the_first_reason(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x02;
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0;
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0x08;
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    fixture_mute_vcu(&f, true);
    expect_fault_after(&f, 200, AGV_FAULT_VCU_HEARTBEAT_LOST, true);
    expect_reason(&f, AGV_FAULT_REMOTE_POWER_LOST);
}

/* Faults that a single message causes (causes.c): each is raised at the exact frame or millisecond, with its class and
 * LED code, and ends with the right frame. In manual, engaged, and in INIT. */
#include <stdio.h>

#include "causes.h"
#include "one_fixture.h"
#include "walk.h"

static const fault_row_t *row_of(const cause_t *cause) {
    return &FAULT_ROW[cause->fault];
}

static int led_of(const cause_t *cause) {
    return row_of(cause)->led != 0 ? row_of(cause)->led : -1;
}

static bool is_by_bits(const cause_t *cause) {
    return cause->how == BY_BITS || cause->how == BY_BITS_ENGAGED;
}

static void begin_case(const cause_t *cause, const char *where) {
    static char what[80];
    (void)snprintf(what, sizeof what, "%s: %s", row_of(cause)->name, where);
    fixture_init(&f);
    f.what = what;
}

static void check_all(cause_how_t how, void (*check)(const cause_t *)) {
    for (unsigned i = 0; i < CAUSES; i++) {
        if (CAUSE[i].how == how) {
            check(&CAUSE[i]);
        }
    }
}

/* ---- From healthy to raised to ended ---- */

/* Nothing is raised before the last frame or millisecond. The last one raises exactly this fault. */
static void raise(const cause_t *cause, agv_state_t state) {
    fixture_run_past(&f, cause->message);
    cause_set(f.traffic, cause, true);
    for (unsigned i = 1; is_by_bits(cause) && i < cause->count; i++) {
        fixture_run_past(&f, cause->message);
        expect_nothing(&f, cause->fault, state);
    }
    if (is_by_bits(cause)) {
        fixture_run_before(&f, cause->message);
    } else {
        fixture_run(&f, cause_deadline_ms(cause));
    }
    expect_nothing(&f, cause->fault, state);
    fixture_run(&f, 1);
    agv_fault_set_t active = agv_supervisor_active_faults(&f.supervisor);
    agv_fault_set_put(&active, cause->fault, false);
    TEST_ASSERT_EQUAL_INT_MESSAGE(AGV_FAULT_NONE, agv_fault_first(&active), f.what);
}

/* The first good frame ends it; where frames are scored, the last of 2 N. */
static void end(const cause_t *cause) {
    expect_fault_after(&f, is_by_bits(cause) ? 0 : 300, cause->fault, true);
    cause_set(f.traffic, cause, false);
    for (unsigned i = 1; is_by_bits(cause) && cause->count > 1 && i < 2 * cause->count; i++) {
        fixture_run_past(&f, cause->message);
    }
    fixture_run_before(&f, cause->message);
    expect_fault(&f, cause->fault, true);
    expect_fault_after(&f, 1, cause->fault, false);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, fixture_ended(&f, cause->fault), f.what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, fixture_raised(&f, cause->fault), f.what);
}

static void check_trip(const cause_t *cause, agv_state_t state, int32_t hold_raw) {
    raise(cause, state);
    expect_trip(&f, cause->fault, is_by_bits(cause) ? f.traffic[cause->message].call : f.call, hold_raw);
    expect_led(&f, led_of(cause));
    end(cause);
    expect_reason(&f, cause->fault); /* latched */
    expect_led(&f, led_of(cause));
}

static void check_warning(const cause_t *cause, agv_state_t state) {
    raise(cause, state);
    expect_warning(&f, cause->fault, state);
    expect_silence(&f);
    expect_led(&f, led_of(cause));
    end(cause);
    expect_state(&f, state);
    expect_silence(&f);
    expect_led(&f, 0);
}

static void check_manual(const cause_t *cause) {
    begin_case(cause, "manual");
    fixture_standby(&f);
    if (row_of(cause)->trip) {
        check_trip(cause, AGV_STATE_STANDBY, NO_HOLD); /* in manual the steering is not held */
    } else {
        check_warning(cause, AGV_STATE_STANDBY);
    }
}

static void check_engaged(const cause_t *cause) {
    begin_case(cause, "engaged");
    fixture_active(&f);
    if (row_of(cause)->trip) {
        check_trip(cause, AGV_STATE_ACTIVE, cause->steering_held ? ANGLE_CENTRE : NO_HOLD);
    } else {
        check_warning(cause, AGV_STATE_ACTIVE);
    }
}

/* ---- Bits of 167h and 363h ---- */

/* A cause in INIT latches nothing. A cause of a trip keeps INIT while it lasts. */
static void check_bits(const cause_t *cause) {
    check_manual(cause);
    check_engaged(cause);
    begin_case(cause, "INIT");
    fixture_start(&f);
    fixture_run(&f, 100);
    raise(cause, AGV_STATE_INIT);
    expect_fault_after(&f, 2000, cause->fault, true);
    expect_led(&f, led_of(cause));
    expect_reason(&f, AGV_FAULT_NONE);
    if (row_of(cause)->trip) {
        expect_state(&f, AGV_STATE_INIT);
        end(cause);
        fixture_run(&f, 600);
    }
    expect_state(&f, AGV_STATE_STANDBY);
}

/* Shows: SUP-4, FSM-2, EPS_OVER_CURRENT_SHUTDOWN, EPS_TEMP_ABOVE_120, EPS_MOTOR_ENCODER, EPS_POSITION_ENCODER,
   EPS_UNDER_VOLTAGE, EPS_OVER_VOLTAGE, EPS_EXCESSIVE_CURRENT, EPS_TEMP_ABOVE_110, VCU_EPS_HARDWARE_FAULT,
   VCU_EPS_CAN_BUS_FAULT, S_DRIVER_ALARM, REMOTE_SIGNAL_LOST, REMOTE_POWER_LOST, VCU_LEVEL2_ALARM, VCU_AI_CAN_LOST */
void test_each_fault_bit(void) {
    check_all(BY_BITS, check_bits);
    check_all(BY_BITS_ENGAGED, check_engaged);
}

/* The fault bits of a frame with an invalid mode still count. */
/* Shows: SUP-4, SUP-5, P18 */
void test_fault_bits_count_in_a_frame_with_an_invalid_mode(void) {
    fixture_standby(&f);
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    f.traffic[AGV_MSG_EPS_STATUS].data[3] = 0x77;
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0x40;
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    expect_trip(&f, AGV_FAULT_EPS_MOTOR_ENCODER, f.traffic[AGV_MSG_EPS_STATUS].call, NO_HOLD);
}

/* ---- Heartbeats and deadlines of status messages: always ---- */

/* The deadline of a message that was never received runs from the start. */
static void check_silence(const cause_t *cause) {
    check_manual(cause);
    check_engaged(cause);
    begin_case(cause, "never heard");
    cause_set(f.traffic, cause, true);
    fixture_start(&f);
    expect_nothing_after(&f, cause_deadline_ms(cause), cause->fault, AGV_STATE_INIT);
    expect_fault_after(&f, 1, cause->fault, true);
    expect_led(&f, led_of(cause));
    expect_reason_after(&f, 2000, AGV_FAULT_NONE);
    expect_state(&f, row_of(cause)->trip ? AGV_STATE_INIT : AGV_STATE_STANDBY);
}

/* Shows: SUP-1, SUP-2, SUP-3, FSM-2, VCU_HEARTBEAT_LOST, EPS_HEARTBEAT_LOST, EPS_STATUS_TIMEOUT, GEAR_STATUS_TIMEOUT,
   THROTTLE_STATUS_TIMEOUT, WHEEL_SPEED_TIMEOUT, STEERING_POSITION_TIMEOUT */
void test_each_silent_status(void) {
    check_all(BY_SILENCE, check_silence);
}

static void check_freeze(const cause_t *cause) {
    check_manual(cause);
    check_engaged(cause);
}

/* Shows: SUP-1, SUP-2, SUP-8, FSM-2, P13, VCU_HEARTBEAT_STUCK, EPS_HEARTBEAT_STUCK, AI_HEARTBEAT_STUCK */
void test_each_frozen_counter(void) {
    check_all(BY_FREEZE, check_freeze);
    check_all(BY_FREEZE_ENGAGED, check_engaged);
}

/* ---- Commands: while engaged; the deadlines start with the engagement ---- */

static void check_never_in_manual(const cause_t *cause) {
    begin_case(cause, "manual, then afresh at the engagement");
    fixture_standby(&f);
    cause_set(f.traffic, cause, true);
    expect_nothing_after(&f, 5000, cause->fault, AGV_STATE_STANDBY);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, cause->fault));
}

/* Silent for 5 s at the engagement (continued from the previous part: no command has come since). */
static void check_afresh(const cause_t *cause) {
    fixture_wheels(&f, 800, 800);
    walk_engage(&f);
    expect_state(&f, AGV_STATE_ACTIVE);
    expect_nothing_after(&f, cause_deadline_ms(cause), cause->fault, AGV_STATE_ACTIVE);
    fixture_run(&f, 1);
    expect_trip(&f, cause->fault, f.call, ANGLE_CENTRE);
    expect_led(&f, led_of(cause));
    fixture_mode(&f, MODE_MANUAL);
    for (unsigned i = 0; i < 3; i++) {
        expect_fault(&f, cause->fault, true);
        fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    }
    expect_fault(&f, cause->fault, false); /* not engaged: it does not count */
    expect_reason(&f, cause->fault);
}

/* 43Fh is a heartbeat: in manual test_supervision_ai looks at it. */
static void check_command(const cause_t *cause) {
    check_engaged(cause);
    if (cause->message != M_SIGNALS) {
        check_never_in_manual(cause);
        check_afresh(cause);
    }
}

/* Shows: SUP-2, SUP-3, SUP-8, FSM-2, AI_HEARTBEAT_LOST, GEAR_COMMAND_TIMEOUT, THROTTLE_COMMAND_TIMEOUT,
   STEERING_COMMAND_TIMEOUT */
void test_each_silent_command(void) {
    check_all(BY_SILENCE_ENGAGED, check_command);
}

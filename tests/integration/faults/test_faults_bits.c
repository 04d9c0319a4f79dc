/* Faults that a bit of 167h or 363h reports (SUP-4): raised, named, counted, ended, and not latched in INIT. */
#include "expect.h"
#include "one_fixture.h"

typedef struct {
    agv_fault_t fault;
    agv_fault_class_t fault_class;
    int led;
    agv_message_t message;
    unsigned byte;    /* 1..8, as the document counts */
    uint8_t bits;     /* set in it */
    unsigned frames;  /* in a row before it counts (score: N) */
    int32_t hold_raw; /* angle in the 065h at a trip while engaged; an EPS at fault is not commanded */
} row_t;

static void set_bits(const row_t *row, bool on) {
    uint8_t *byte = &f.traffic[row->message].data[row->byte - 1];
    *byte = (uint8_t)(on ? *byte | row->bits : *byte & ~row->bits);
}

/* From the next frame on the bit is set. The frames before the last one do nothing, the last one raises the fault. */
static void raise(const row_t *row, agv_state_t state) {
    fixture_run_past(&f, row->message);
    set_bits(row, true);
    for (unsigned i = 1; i < row->frames; i++) {
        fixture_run_past(&f, row->message);
        expect_nothing(&f, row->fault, state);
    }
    fixture_run_before(&f, row->message);
    expect_nothing(&f, row->fault, state);
    fixture_run(&f, 1);
}

/* The first frame without the bit ends it; where frames are scored, the last of 2 N. */
static void end(const row_t *row) {
    set_bits(row, false);
    for (unsigned i = 1; row->frames > 1 && i < 2 * row->frames; i++) {
        fixture_run_past(&f, row->message);
    }
    fixture_run_before(&f, row->message);
    expect_fault(&f, row->fault, true);
    fixture_run(&f, 1);
    expect_fault(&f, row->fault, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, row->fault));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, row->fault));
}

static void check_trip(const row_t *row, agv_state_t state, int32_t hold_raw) {
    raise(row, state);
    expect_trip(&f, row->fault, f.traffic[row->message].call, hold_raw);
    expect_led(&f, row->led);
    end(row);
    expect_reason(&f, row->fault); /* latched */
    expect_led(&f, row->led);
}

static void check_warning(const row_t *row, agv_state_t state) {
    raise(row, state);
    expect_warning(&f, row->fault, state);
    expect_silence(&f);
    expect_led(&f, row->led);
    end(row);
    expect_state(&f, state);
    expect_silence(&f);
    expect_led(&f, 0);
}

/* A cause in INIT latches nothing, a trip's keeps INIT from being left for as long as it is there. */
static void check_init(const row_t *row) {
    fixture_start(&f);
    fixture_run(&f, 100);
    raise(row, AGV_STATE_INIT);
    fixture_run(&f, 2000);
    expect_fault(&f, row->fault, true);
    expect_led(&f, row->led);
    expect_reason(&f, AGV_FAULT_NONE);
    if (row->fault_class == AGV_CLASS_TRIP) {
        expect_state(&f, AGV_STATE_INIT);
        end(row);
        fixture_run(&f, 600);
    }
    expect_state(&f, AGV_STATE_STANDBY);
}

static void check(const row_t *row) {
    f.what = "manual";
    fixture_standby(&f);
    if (row->fault_class == AGV_CLASS_TRIP) {
        check_trip(row, AGV_STATE_STANDBY, NO_HOLD); /* in manual the steering is not held */
    } else {
        check_warning(row, AGV_STATE_STANDBY);
    }
    fixture_init(&f);
    f.what = "engaged";
    fixture_active(&f);
    if (row->fault_class == AGV_CLASS_TRIP) {
        check_trip(row, AGV_STATE_ACTIVE, row->hold_raw);
    } else {
        check_warning(row, AGV_STATE_ACTIVE);
    }
    fixture_init(&f);
    f.what = "INIT";
    check_init(row);
}

/* Nothing comes of any of them before the last one is there. */
static void send_frames(const row_t *row, unsigned count, uint32_t gap_ms) {
    for (unsigned i = 0; i < count; i++) {
        fixture_run(&f, gap_ms);
        expect_nothing(&f, row->fault, AGV_STATE_STANDBY);
        fixture_send_now(&f, row->message);
    }
}

/* Every second frame is bad: 2, 1, 3, 2, 4, 3, 5, 4, 6: the fifth bad one brings the score to 2 N. */
static void check_every_second(const row_t *row) {
    f.what = "every second frame";
    fixture_standby(&f);
    fixture_run_past(&f, row->message);
    f.traffic[row->message].muted = true;
    for (unsigned i = 0; i < 4; i++) {
        set_bits(row, true);
        send_frames(row, 1, 10);
        set_bits(row, false);
        send_frames(row, 1, 10);
    }
    set_bits(row, true);
    send_frames(row, 1, 10);
    expect_trip(&f, row->fault, f.call, NO_HOLD);
}

/* Gaps between frames change nothing; a third of the frames bad never counts: 2, 1, 0. */
static void check_gaps_and_thirds(const row_t *row) {
    fixture_init(&f);
    fixture_standby(&f);
    fixture_run_past(&f, row->message);
    f.traffic[row->message].muted = true;
    f.what = "every third frame";
    for (unsigned i = 0; i < 30; i++) {
        set_bits(row, i % 3 == 0);
        send_frames(row, 1, 10);
    }
    f.what = "gaps";
    set_bits(row, true);
    send_frames(row, row->frames, 60);
    expect_trip(&f, row->fault, f.call, NO_HOLD);
}

static void check_score(const row_t *row) {
    fixture_init(&f);
    check_every_second(row);
    check_gaps_and_thirds(row);
}

/* ---- EPS: 167h byte 8, bits 1 to 8 of the document ---- */

/* Shows: SUP-4, FSM-2, EPS_UNDER_VOLTAGE */
void test_eps_under_voltage(void) {
    const row_t row = {AGV_FAULT_EPS_UNDER_VOLTAGE, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x01, 3, NO_HOLD};
    check(&row);
    check_score(&row);
}

/* Shows: SUP-4, FSM-2, EPS_OVER_VOLTAGE */
void test_eps_over_voltage(void) {
    const row_t row = {AGV_FAULT_EPS_OVER_VOLTAGE, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x02, 3, NO_HOLD};
    check(&row);
    check_score(&row);
}

/* Shows: SUP-4, FSM-2, EPS_EXCESSIVE_CURRENT */
void test_eps_excessive_current(void) {
    const row_t row = {AGV_FAULT_EPS_EXCESSIVE_CURRENT, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x04, 3, NO_HOLD};
    check(&row);
    check_score(&row);
}

/* Shows: SUP-4, FSM-2, EPS_OVER_CURRENT_SHUTDOWN */
void test_eps_over_current_shutdown(void) {
    check(&(row_t){AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x08, 1, NO_HOLD});
}

/* Shows: SUP-4, EPS_TEMP_ABOVE_110 */
void test_eps_temp_above_110(void) {
    check(&(row_t){AGV_FAULT_EPS_TEMP_ABOVE_110, AGV_CLASS_WARN, 13, AGV_MSG_EPS_STATUS, 8, 0x10, 1, ANGLE_CENTRE});
}

/* Shows: SUP-4, FSM-2, EPS_TEMP_ABOVE_120 */
void test_eps_temp_above_120(void) {
    check(&(row_t){AGV_FAULT_EPS_TEMP_ABOVE_120, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x20, 1, NO_HOLD});
}

/* Shows: SUP-4, FSM-2, EPS_MOTOR_ENCODER */
void test_eps_motor_encoder(void) {
    check(&(row_t){AGV_FAULT_EPS_MOTOR_ENCODER, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x40, 1, NO_HOLD});
}

/* Shows: SUP-4, FSM-2, EPS_POSITION_ENCODER */
void test_eps_position_encoder(void) {
    check(&(row_t){AGV_FAULT_EPS_POSITION_ENCODER, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x80, 1, NO_HOLD});
}

/* The three scores are kept apart: each bit in every third frame is none of them. */
/* Shows: SUP-4 */
void test_scores_of_different_bits_do_not_add_up(void) {
    const row_t under = {AGV_FAULT_EPS_UNDER_VOLTAGE, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x01, 3, NO_HOLD};
    const row_t over = {AGV_FAULT_EPS_OVER_VOLTAGE, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x02, 3, NO_HOLD};
    const row_t current = {
        AGV_FAULT_EPS_EXCESSIVE_CURRENT, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x04, 3, NO_HOLD};
    fixture_standby(&f);
    for (unsigned round = 0; round < 30; round++) {
        set_bits(&under, round % 3 == 0);
        set_bits(&over, round % 3 == 1);
        set_bits(&current, round % 3 == 2);
        fixture_run_past(&f, AGV_MSG_EPS_STATUS);
        expect_nothing(&f, AGV_FAULT_EPS_EXCESSIVE_CURRENT, AGV_STATE_STANDBY);
        expect_nothing(&f, AGV_FAULT_EPS_UNDER_VOLTAGE, AGV_STATE_STANDBY);
        expect_nothing(&f, AGV_FAULT_EPS_OVER_VOLTAGE, AGV_STATE_STANDBY);
    }
}

/* A frame whose mode is unusable still carries good fault bits. */
/* Shows: SUP-4, SUP-5, P18 */
void test_fault_bits_count_in_a_frame_with_an_invalid_mode(void) {
    fixture_standby(&f);
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    f.traffic[AGV_MSG_EPS_STATUS].data[3] = 0x77;
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0x40;
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    expect_trip(&f, AGV_FAULT_EPS_MOTOR_ENCODER, f.traffic[AGV_MSG_EPS_STATUS].call, NO_HOLD);
}

/* ---- VCU: 363h byte 5, Bit0 to Bit7; byte 6 ---- */

/* Shows: SUP-4, FSM-2, REMOTE_SIGNAL_LOST */
void test_remote_signal_lost(void) {
    check(&(row_t){AGV_FAULT_REMOTE_SIGNAL_LOST, AGV_CLASS_TRIP, 17, AGV_MSG_VEHICLE_STATUS, 5, 0x01, 1, ANGLE_CENTRE});
}

/* Shows: SUP-4, FSM-2, REMOTE_POWER_LOST */
void test_remote_power_lost(void) {
    check(&(row_t){AGV_FAULT_REMOTE_POWER_LOST, AGV_CLASS_TRIP, 16, AGV_MSG_VEHICLE_STATUS, 5, 0x02, 1, ANGLE_CENTRE});
}

/* Shows: SUP-4, FSM-2, VCU_EPS_HARDWARE_FAULT */
void test_vcu_eps_hardware_fault(void) {
    check(&(row_t){AGV_FAULT_VCU_EPS_HARDWARE_FAULT, AGV_CLASS_TRIP, 13, AGV_MSG_VEHICLE_STATUS, 5, 0x10, 1, NO_HOLD});
}

/* Shows: SUP-4, FSM-2, VCU_EPS_CAN_BUS_FAULT */
void test_vcu_eps_can_bus_fault(void) {
    check(&(row_t){AGV_FAULT_VCU_EPS_CAN_BUS_FAULT, AGV_CLASS_TRIP, 12, AGV_MSG_VEHICLE_STATUS, 5, 0x20, 1, NO_HOLD});
}

/* Shows: SUP-4, FSM-2, S_DRIVER_ALARM */
void test_s_driver_alarm(void) {
    check(&(row_t){AGV_FAULT_S_DRIVER_ALARM, AGV_CLASS_TRIP, 8, AGV_MSG_VEHICLE_STATUS, 5, 0x80, 1, ANGLE_CENTRE});
}

/* Any bit of the byte. */
/* Shows: SUP-4, VCU_LEVEL2_ALARM */
void test_vcu_level2_alarm(void) {
    static const uint8_t BITS[] = {0x01, 0x80, 0xFF};
    for (unsigned i = 0; i < sizeof BITS; i++) {
        fixture_init(&f);
        check(&(row_t){AGV_FAULT_VCU_LEVEL2_ALARM, AGV_CLASS_WARN, -1, AGV_MSG_VEHICLE_STATUS, 6, BITS[i], 1, NO_HOLD});
    }
}

/* Bit2 and Bit6 are reserved (P14): nothing comes of them. */
/* Shows: SUP-4, P14 */
void test_reserved_alarm_bits_are_ignored(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x44;
    fixture_run(&f, 2000);
    expect_state(&f, AGV_STATE_ACTIVE);
    TEST_ASSERT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_active(&f.supervisor));
}

/* The number of frames is a setting: 1 is at once. */
/* Shows: SUP-4, EPS_OVER_VOLTAGE */
void test_the_count_is_a_setting(void) {
    const row_t row = {AGV_FAULT_EPS_OVER_VOLTAGE, AGV_CLASS_TRIP, 13, AGV_MSG_EPS_STATUS, 8, 0x02, 1, NO_HOLD};
    f.config.eps_supply_fault_frames = 1;
    fixture_standby(&f);
    check_trip(&row, AGV_STATE_STANDBY, NO_HOLD);
}

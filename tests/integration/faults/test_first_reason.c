/* The first reason (FSM-5): of two faults in the same instant the upper row of the table, within a row the left name. The
 * rows below stand in that order, by hand. */
#include "expect.h"
#include "one_fixture.h"

/* ---- Two in one frame ---- */

typedef struct {
    agv_fault_t fault;
    uint8_t bit;
} bit_t;

/* Both bits from one frame on; @p frames of them are needed. */
static void check_bits(agv_message_t message, unsigned byte, const bit_t *upper, const bit_t *lower, unsigned frames) {
    fixture_init(&f);
    fixture_active(&f);
    fixture_run_past(&f, message);
    f.traffic[message].data[byte - 1] |= (uint8_t)(upper->bit | lower->bit);
    for (unsigned i = 0; i < frames; i++) {
        expect_reason(&f, AGV_FAULT_NONE);
        fixture_run_past(&f, message);
    }
    expect_fault(&f, upper->fault, true);
    expect_fault(&f, lower->fault, true);
    expect_reason(&f, upper->fault);
}

static void check_pairs(agv_message_t message, unsigned byte, const bit_t *rows, unsigned count, unsigned frames) {
    for (unsigned upper = 0; upper < count; upper++) {
        for (unsigned lower = upper + 1; lower < count; lower++) {
            check_bits(message, byte, &rows[upper], &rows[lower], frames);
        }
    }
}

/* Shows: FSM-5, SUP-4 */
void test_two_bits_of_167h(void) {
    static const bit_t AT_ONCE[] = {{AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN, 0x08},
                                    {AGV_FAULT_EPS_TEMP_ABOVE_120, 0x20},
                                    {AGV_FAULT_EPS_MOTOR_ENCODER, 0x40},
                                    {AGV_FAULT_EPS_POSITION_ENCODER, 0x80}};
    static const bit_t COUNTED[] = {{AGV_FAULT_EPS_UNDER_VOLTAGE, 0x01},
                                    {AGV_FAULT_EPS_OVER_VOLTAGE, 0x02},
                                    {AGV_FAULT_EPS_EXCESSIVE_CURRENT, 0x04}};
    check_pairs(AGV_MSG_EPS_STATUS, 8, AT_ONCE, 4, 1);
    check_pairs(AGV_MSG_EPS_STATUS, 8, COUNTED, 3, 3);
}

/* Shows: FSM-5, SUP-4 */
void test_two_bits_of_363h(void) {
    static const bit_t ROWS[] = {
        {AGV_FAULT_VCU_EPS_HARDWARE_FAULT, 0x10}, {AGV_FAULT_VCU_EPS_CAN_BUS_FAULT, 0x20},
        {AGV_FAULT_S_DRIVER_ALARM, 0x80},         {AGV_FAULT_REMOTE_SIGNAL_LOST, 0x01},
        {AGV_FAULT_REMOTE_POWER_LOST, 0x02},      {AGV_FAULT_VCU_AI_CAN_LOST, 0x08},
    };
    check_pairs(AGV_MSG_VEHICLE_STATUS, 5, ROWS, 6, 1);
}

/* A warning is no reason, wherever it stands: EPS_TEMP_ABOVE_110 is above what the VCU reports of the EPS. */
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

typedef struct {
    agv_fault_t fault;
    agv_message_t message;
    uint32_t deadline_ms;
    bool engaged_only;
} deadline_t;

/* Rank order, while engaged. */
static const deadline_t DEADLINES[] = {
    {AGV_FAULT_VCU_HEARTBEAT_LOST, AGV_MSG_VEHICLE_STATUS, 50, false},
    {AGV_FAULT_EPS_HEARTBEAT_LOST, AGV_MSG_STEERING_STATUS, 50, false},
    {AGV_FAULT_AI_HEARTBEAT_LOST, AGV_MSG_TURN_SIGNAL_COMMAND, 350, false},
    {AGV_FAULT_EPS_STATUS_TIMEOUT, AGV_MSG_EPS_STATUS, 60, false},
    {AGV_FAULT_GEAR_STATUS_TIMEOUT, AGV_MSG_GEAR_STATUS, 125, false},
    {AGV_FAULT_THROTTLE_STATUS_TIMEOUT, AGV_MSG_THROTTLE_STATUS, 60, false},
    {AGV_FAULT_WHEEL_SPEED_TIMEOUT, AGV_MSG_WHEEL_SPEED, 60, false},
    {AGV_FAULT_GEAR_COMMAND_TIMEOUT, AGV_MSG_GEAR_COMMAND, 350, true},
    {AGV_FAULT_THROTTLE_COMMAND_TIMEOUT, AGV_MSG_THROTTLE_COMMAND, 350, true},
    {AGV_FAULT_STEERING_COMMAND_TIMEOUT, AGV_MSG_STEERING_COMMAND, 125, true},
};
enum { DEADLINE_COUNT = sizeof DEADLINES / sizeof DEADLINES[0] };

/* The last frame comes just so that its deadline has expired at that moment, and not a millisecond earlier. */
static void say_last(const deadline_t *row, uint32_t expires_ms) {
    if (f.now_ms == expires_ms - row->deadline_ms - 1u) {
        fixture_send_now(&f, row->message);
        f.traffic[row->message].muted = true;
    }
}

static void check_tick(const deadline_t *upper, const deadline_t *lower) {
    fixture_init(&f);
    fixture_active(&f);
    const uint32_t expires_ms = f.now_ms + 400u;
    for (unsigned i = 0; i < 400; i++) {
        expect_reason(&f, AGV_FAULT_NONE);
        say_last(upper, expires_ms);
        say_last(lower, expires_ms);
        fixture_run(&f, 1);
    }
    expect_fault(&f, upper->fault, true);
    expect_fault(&f, lower->fault, !(upper->fault == AGV_FAULT_VCU_HEARTBEAT_LOST && lower->engaged_only));
    expect_reason(&f, upper->fault);
}

/* The loss of the VCU ends the engagement: AI commands are not awaited any more. */
/* Shows: FSM-5, SUP-2, SUP-3 */
void test_two_deadlines_in_one_tick(void) {
    for (unsigned upper = 0; upper < DEADLINE_COUNT; upper++) {
        for (unsigned lower = upper + 1; lower < DEADLINE_COUNT; lower++) {
            check_tick(&DEADLINES[upper], &DEADLINES[lower]);
        }
    }
}

/* ---- One after the other ---- */

/* Frames are handled before the tick of their millisecond: a frame's fault is first, whatever its rank. */
/* Shows: FSM-5, SUP-2 */
void test_a_frame_comes_before_the_tick(void) {
    fixture_active(&f);
    fixture_run_past(&f, AGV_MSG_STEERING_STATUS);
    f.traffic[AGV_MSG_STEERING_STATUS].muted = true;
    f.traffic[AGV_MSG_VEHICLE_STATUS].phase_ms = 5; /* 51 ms later */
    fixture_run(&f, 50);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x02;
    expect_reason(&f, AGV_FAULT_NONE);
    fixture_run(&f, 1);
    expect_fault(&f, AGV_FAULT_EPS_HEARTBEAT_LOST, true);
    expect_fault(&f, AGV_FAULT_REMOTE_POWER_LOST, true);
    expect_reason(&f, AGV_FAULT_REMOTE_POWER_LOST);
    expect_led(&f, 12); /* the LED shows the highest-ranking one */
}

/* What comes later is never the first reason, though it ranks higher, and though the first has ended. */
/* Shows: FSM-5 */
void test_later_is_not_first(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x02;
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0;
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0x08;
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    fixture_mute_vcu(&f, true);
    fixture_run(&f, 200);
    expect_fault(&f, AGV_FAULT_VCU_HEARTBEAT_LOST, true);
    expect_reason(&f, AGV_FAULT_REMOTE_POWER_LOST);
}

/* Faults that are judged only while engaged (SUP-5), from 500 ms after the engagement on and while 363h reports
 * autopilot: EPS mode and invalid status values (scores), throttle in park (budget); and commands out of range, which
 * have no grace time. Calculated by hand: a fault that needs N frames is raised when bad frames (+2) and good ones (-1)
 * add up to 2 N, and ends at 0. */
#include "one_fixture.h"
#include "walk.h"

typedef struct {
    agv_fault_t fault;
    int led;
    agv_message_t message;
    unsigned frames; /* N */
    uint8_t bad[8];  /* payload; the alive counter is filled in */
    int32_t hold_raw;
} row_t;

static void set_payload(agv_message_t message, const uint8_t data[8]) {
    for (unsigned i = 0; i < 8; i++) {
        f.traffic[message].data[i] = data[i];
    }
}

static void send_bad_frames(const row_t *row, unsigned count, agv_state_t state) {
    for (unsigned i = 0; i < count; i++) {
        fixture_run_past(&f, row->message);
        expect_nothing(&f, row->fault, state);
    }
}

static void check_trips(const row_t *row) {
    uint8_t good[8];
    fixture_init(&f);
    f.what = "engaged";
    fixture_active(&f);
    fixture_run_past(&f, row->message);
    for (unsigned i = 0; i < 8; i++) {
        good[i] = f.traffic[row->message].data[i];
    }
    set_payload(row->message, row->bad);
    send_bad_frames(row, row->frames - 1, AGV_STATE_ACTIVE);
    fixture_run_past(&f, row->message);
    expect_trip(&f, row->fault, f.traffic[row->message].call, row->hold_raw);
    expect_led(&f, row->led);
    expect_fault_after(&f, 300, row->fault, true);
    set_payload(row->message, good);
    for (unsigned i = 1; i < 2 * row->frames; i++) {
        fixture_run_past(&f, row->message);
        expect_fault(&f, row->fault, true);
    }
    fixture_run_past(&f, row->message);
    expect_fault(&f, row->fault, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, row->fault));
    expect_reason(&f, row->fault);
}

/* Bad all the time, also before the engagement. Only frames from 500 ms after it on count. The message comes in the
 * same millisecond as 363h (phase 1) or one before it, so one frame is exactly 500 ms, or 499 ms, after the
 * engagement. */
static void check_grace(const row_t *row, uint16_t phase_ms, unsigned not_counted) {
    fixture_init(&f);
    f.what = phase_ms == 1 ? "a frame 500 ms after the engagement" : "a frame 499 ms after the engagement";
    fixture_standby(&f);
    f.traffic[row->message].phase_ms = phase_ms;
    set_payload(row->message, row->bad);
    expect_nothing_after(&f, 3000, row->fault, AGV_STATE_STANDBY); /* not engaged: not judged */
    fixture_run(&f, 100 - f.elapsed_ms % 100);
    fixture_mode(&f, MODE_ENGAGED);
    expect_state_after(&f, 1, AGV_STATE_ACTIVE);
    fixture_run(&f, 498);
    send_bad_frames(row, not_counted + row->frames - 1, AGV_STATE_ACTIVE);
    fixture_run_past(&f, row->message);
    expect_trip(&f, row->fault, f.traffic[row->message].call, row->hold_raw);
    fixture_mode(&f, MODE_MANUAL);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_fault(&f, row->fault, false); /* no longer engaged */
}

/* With a fault of the EPS the steering is not held. 18001 = 4651h. */
static const row_t ROWS[] = {
    {AGV_FAULT_EPS_MODE_OFF, 13, AGV_MSG_EPS_STATUS, 5, {0, 0, 0, 0xFF}, NO_HOLD},
    {AGV_FAULT_EPS_MODE_INVALID, 13, AGV_MSG_EPS_STATUS, 5, {0, 0, 0, 0x04}, NO_HOLD},
    {AGV_FAULT_EPS_MODE_NOT_ANGLE, 13, AGV_MSG_EPS_STATUS, 5, {0, 0, 0, 0x00}, NO_HOLD},
    {AGV_FAULT_GEAR_STATUS_INVALID, 8, AGV_MSG_GEAR_STATUS, 3, {0}, ANGLE_CENTRE},
    {AGV_FAULT_THROTTLE_STATUS_INVALID, 7, AGV_MSG_THROTTLE_STATUS, 3, {251}, ANGLE_CENTRE},
    {AGV_FAULT_STEERING_ANGLE_INVALID, 13, AGV_MSG_STEERING_STATUS, 3, {0, 100, 0x51, 0x46}, NO_HOLD},
};

/* Shows: SUP-5, P2, P5, P6, P18, FSM-10, EPS_MODE_OFF, EPS_MODE_INVALID, EPS_MODE_NOT_ANGLE, GEAR_STATUS_INVALID,
   THROTTLE_STATUS_INVALID, STEERING_ANGLE_INVALID */
void test_each_value_that_counts_while_engaged(void) {
    for (unsigned i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        check_trips(&ROWS[i]);
        check_grace(&ROWS[i], 1, 0);
        check_grace(&ROWS[i], 0, 1);
    }
}

/* ---- THROTTLE_IN_PARK ---- */

static void set_throttle(uint8_t counts) {
    f.traffic[AGV_MSG_THROTTLE_STATUS].data[0] = counts;
}

/* Engaged in P. */
static void active_in_park(void) {
    fixture_active(&f);
    fixture_gear(&f, GEAR_P);
    expect_nothing_after(&f, 1000, AGV_FAULT_THROTTLE_IN_PARK, AGV_STATE_ACTIVE); /* P alone is no fault */
}

/* Above idle is more than 2 counts. The budget of 200 ms is used up 200 ms after the frame; then it decreases by 1 ms in
 * each 2. */
/* Shows: SUP-5, FSM-2, THROTTLE_IN_PARK */
void test_throttle_in_park(void) {
    active_in_park();
    set_throttle(2);
    fixture_run(&f, 1000);
    set_throttle(3);
    fixture_run_past(&f, AGV_MSG_THROTTLE_STATUS);
    expect_nothing_after(&f, 199, AGV_FAULT_THROTTLE_IN_PARK, AGV_STATE_ACTIVE);
    expect_trip_after(&f, 1, AGV_FAULT_THROTTLE_IN_PARK, ANGLE_CENTRE);
    expect_led(&f, 7);
    fixture_run(&f, 500); /* never more than 200 */
    set_throttle(2);
    fixture_run_past(&f, AGV_MSG_THROTTLE_STATUS);
    expect_fault_after(&f, 399, AGV_FAULT_THROTTLE_IN_PARK, true);
    expect_fault_after(&f, 1, AGV_FAULT_THROTTLE_IN_PARK, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, AGV_FAULT_THROTTLE_IN_PARK));
}

/* While bit 8 is clear in the last 363h nothing is judged: budgets and scores are paused. */
/* Shows: SUP-5, THROTTLE_IN_PARK, EPS_MODE_OFF */
void test_budgets_are_paused_while_not_judged(void) {
    active_in_park();
    set_throttle(10);
    fixture_run_past(&f, AGV_MSG_THROTTLE_STATUS);
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
    const uint32_t began_ms = f.now_ms; /* 8 ms of the budget */
    fixture_mode(&f, MODE_MANUAL);
    fixture_run(&f, 1);
    f.traffic[AGV_MSG_EPS_STATUS].data[3] = 0xFF;
    fixture_run(&f, 19); /* two 363h without bit 8; two 167h */
    f.traffic[AGV_MSG_EPS_STATUS].data[3] = 1;
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run(&f, 191);
    TEST_ASSERT_EQUAL_UINT32(211, f.now_ms - began_ms);
    expect_nothing(&f, AGV_FAULT_THROTTLE_IN_PARK, AGV_STATE_ACTIVE);
    expect_trip_after(&f, 1, AGV_FAULT_THROTTLE_IN_PARK, ANGLE_CENTRE);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, AGV_FAULT_EPS_MODE_OFF));
}

/* A P that is out of date counts no more, where the silence of 0A3h only warns. A fresh 050h does not help. */
/* Shows: SUP-5, SUP-3, THROTTLE_IN_PARK */
void test_a_p_that_is_out_of_date_is_no_throttle_in_park(void) {
    agv_fault_set_put(&f.config.trips, AGV_FAULT_GEAR_STATUS_TIMEOUT, false);
    active_in_park();
    f.traffic[AGV_MSG_GEAR_STATUS].muted = true;
    expect_fault_after(&f, 200, AGV_FAULT_GEAR_STATUS_TIMEOUT, true);
    set_throttle(3);
    expect_nothing_after(&f, 1000, AGV_FAULT_THROTTLE_IN_PARK, AGV_STATE_ACTIVE);
}

/* A silence of 050h, which only warns here, does not end the comparison with a fresh P. */
/* Shows: SUP-5, SUP-3, THROTTLE_IN_PARK */
void test_a_throttle_that_is_out_of_date_is_still_throttle_in_park(void) {
    agv_fault_set_put(&f.config.trips, AGV_FAULT_THROTTLE_STATUS_TIMEOUT, false);
    f.config.throttle_in_park_ms = 1000;
    active_in_park();
    set_throttle(3);
    fixture_run_past(&f, AGV_MSG_THROTTLE_STATUS);
    f.traffic[AGV_MSG_THROTTLE_STATUS].muted = true;
    expect_nothing_after(&f, 999, AGV_FAULT_THROTTLE_IN_PARK, AGV_STATE_ACTIVE);
    expect_reason_after(&f, 1, AGV_FAULT_THROTTLE_IN_PARK);
}

/* ---- AI_COMMAND_OUT_OF_RANGE ---- */

typedef struct {
    agv_message_t message;
    uint8_t data[8];
} command_t;

static const command_t OUT_OF_RANGE[] = {
    {AGV_MSG_GEAR_COMMAND, {0}},
    {AGV_MSG_THROTTLE_COMMAND, {251}},
    {AGV_MSG_STEERING_COMMAND, {0x51, 0x46}}, /* 18001 */
};
enum { OUT_OF_RANGE_COUNT = sizeof OUT_OF_RANGE / sizeof OUT_OF_RANGE[0] };

static void check_out_of_range(const command_t *command) {
    const agv_fault_t fault = AGV_FAULT_AI_COMMAND_OUT_OF_RANGE;
    fixture_standby(&f);
    fixture_frame(&f, command->message, command->data); /* manual: dropped and counted */
    expect_nothing(&f, fault, AGV_STATE_STANDBY);
    TEST_ASSERT_EQUAL_UINT32(1, agv_supervisor_counters(&f.supervisor)->dropped);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS); /* no grace for it */
    expect_nothing(&f, fault, AGV_STATE_ACTIVE);
    fixture_frame(&f, command->message, command->data);
    expect_trip(&f, fault, f.call, ANGLE_CENTRE);
    TEST_ASSERT_EQUAL_UINT32(2, agv_supervisor_counters(&f.supervisor)->dropped);
    expect_led_after(&f, 999, 14);
    expect_fault(&f, fault, true);
    expect_fault_after(&f, 1, fault, false); /* a transient: ends a second after the last occurrence */
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, fault));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, fault));
}

/* Shows: SUP-5, FSM-2, P2, P5, P6, AI_COMMAND_OUT_OF_RANGE */
void test_commands_out_of_range(void) {
    for (unsigned i = 0; i < OUT_OF_RANGE_COUNT; i++) {
        fixture_init(&f);
        check_out_of_range(&OUT_OF_RANGE[i]);
    }
}

/* ---- Scores and the engagement ---- */

/* The engagement ends with the third 363h without bit 8, and begins again this long after it. */
static void engage_again_after(uint32_t ms) {
    walk_disengage(&f);
    fixture_mode(&f, MODE_ENGAGED);
    f.traffic[AGV_MSG_VEHICLE_STATUS].muted = true; /* no fourth one */
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[6] = MODE_MANUAL;
    for (uint32_t i = 10; i < ms; i += 10) {
        fixture_run(&f, 10);
        fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    }
    f.traffic[AGV_MSG_VEHICLE_STATUS].muted = false;
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run(&f, 10);
}

/* The fault ends with the engagement. The next engagement begins more than 100 ms later, and its grace time ends before
 * the next bad frame: the score starts at 0. */
/* Shows: SUP-5, GEAR_STATUS_INVALID */
void test_every_engagement_scores_anew(void) {
    f.config.engaged_grace_ms = 50;
    fixture_active(&f);
    fixture_gear(&f, 0);
    fixture_run(&f, 300);
    fixture_run_past(&f, AGV_MSG_GEAR_STATUS);
    expect_fault(&f, AGV_FAULT_GEAR_STATUS_INVALID, true);
    f.traffic[AGV_MSG_GEAR_STATUS].muted = true;
    engage_again_after(110);
    expect_fault(&f, AGV_FAULT_GEAR_STATUS_INVALID, false);
    fixture_run(&f, 50); /* the grace */
    for (unsigned i = 1; i <= 3; i++) {
        fixture_send_now(&f, AGV_MSG_GEAR_STATUS);
        expect_fault(&f, AGV_FAULT_GEAR_STATUS_INVALID, i == 3);
        fixture_run(&f, 10);
    }
}

/* 150 of 200 ms in the last engagement do not count in the next one. */
/* Shows: SUP-5, THROTTLE_IN_PARK */
void test_every_engagement_begins_its_budgets_anew(void) {
    f.config.engaged_grace_ms = 50;
    active_in_park();
    set_throttle(3);
    fixture_run_past(&f, AGV_MSG_THROTTLE_STATUS);
    fixture_run(&f, 150);
    set_throttle(0);
    engage_again_after(110);
    fixture_run(&f, 50); /* the grace */
    set_throttle(3);
    fixture_run_past(&f, AGV_MSG_THROTTLE_STATUS);
    expect_nothing_after(&f, 199, AGV_FAULT_THROTTLE_IN_PARK, AGV_STATE_ACTIVE);
    expect_trip_after(&f, 1, AGV_FAULT_THROTTLE_IN_PARK, ANGLE_CENTRE);
}

/* An engagement that begins within 100 ms continues the last one: neither grace time nor scores restart. */
/* Shows: SUP-5, EPS_MODE_OFF */
void test_a_continued_engagement_goes_on_with_its_scores(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_EPS_STATUS].data[3] = 0xFF;
    for (unsigned i = 0; i < 4; i++) {
        fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    }
    f.traffic[AGV_MSG_EPS_STATUS].data[3] = 1;
    engage_again_after(100);
    expect_nothing(&f, AGV_FAULT_EPS_MODE_OFF, AGV_STATE_ACTIVE);
    f.traffic[AGV_MSG_EPS_STATUS].data[3] = 0xFF;
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    expect_trip(&f, AGV_FAULT_EPS_MODE_OFF, f.traffic[AGV_MSG_EPS_STATUS].call, NO_HOLD);
}

/* The bits of 167h count in every mode: the end of an engagement does not clear their scores. */
/* Shows: SUP-4, EPS_UNDER_VOLTAGE */
void test_the_end_of_an_engagement_does_not_end_the_count_of_a_bit(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0x01;
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    fixture_run(&f, 10);
    fixture_mode(&f, MODE_MANUAL);
    expect_fault_after(&f, 9, AGV_FAULT_EPS_UNDER_VOLTAGE, false);
    expect_fault_after(&f, 1, AGV_FAULT_EPS_UNDER_VOLTAGE, true);
}

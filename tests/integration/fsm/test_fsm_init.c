/* INIT: its frames, its end, the conditions that keep it. Nothing latches in INIT. */
#include "expect.h"
#include "fixture.h"
#include "unity.h"
#include "walk.h"

static fixture_t f;
static uint32_t start_ms;

void setUp(void) {
    fixture_init(&f);
    start_ms = f.now_ms;
}

/* The n-th frame with this identifier was sent this many milliseconds after the start. */
static void expect_sent_at(uint32_t id, uint32_t n, uint32_t after_start_ms) {
    TEST_ASSERT_EQUAL_UINT32(after_start_ms, fixture_nth_sent(&f, id, n)->time_ms - start_ms);
}

/* Shows: FSM-2, FSM-6, TIM-1 */
void test_init_sends_the_safe_commands_beginning_as_after_a_trip(void) {
    fixture_mute_ai(&f, true);
    fixture_start(&f);
    expect_state(&f, AGV_STATE_INIT);
    TEST_ASSERT_EQUAL_UINT32(3, f.sent_count);
    fixture_run(&f, 250);
    for (uint32_t n = 0; n < 3; n++) {
        expect_sent_at(0x43F, n, 100 * n);
        expect_sent_at(0x168, n, n == 0 ? 0 : 66 + 100 * (n - 1));
        expect_sent_at(0x075, n, n == 0 ? 0 : 33 + 100 * (n - 1));
    }
    TEST_ASSERT_EQUAL_UINT32(3 + 3 + 4, f.sent_count); /* 075h once more at 233 ms */
}

/*
 * 363h comes at 1 and 11 ms (the second one shows a changed counter), 067h at 4 and 14 ms, 0A3h at 7 ms: from 14 ms on
 * all conditions hold.
 */
/* Shows: FSM-7, FSM-4, TIM-2 */
void test_init_is_left_after_500_ms_of_all_well(void) {
    fixture_start(&f);
    expect_output(&f, false);
    expect_state_after(&f, 513, AGV_STATE_INIT);
    expect_output(&f, false);
    expect_state_after(&f, 1, AGV_STATE_STANDBY);
    expect_output(&f, true);
    expect_reason(&f, AGV_FAULT_NONE);
    fixture_forget_sent(&f);
    fixture_run(&f, 1000);
    expect_silence(&f);
}

/* 43Fh of 500 ms waits when INIT is left at 514 ms. Own commands that are discarded do not count as dropped. */
/* Shows: FSM-2, FSM-7 */
void test_safe_commands_that_wait_do_not_leave_after_init(void) {
    fixture_mute_ai(&f, true);
    fixture_start(&f);
    fixture_run(&f, 490);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    expect_state_after(&f, 24, AGV_STATE_STANDBY);
    fixture_forget_sent(&f);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    fixture_run(&f, 500);
    expect_silence(&f);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->dropped);
}

static void turn_a_wheel(bool spoilt) {
    fixture_wheels(&f, 0, spoilt ? -50 : -49);
}

static void report_speed(bool spoilt) {
    fixture_speed(&f, spoilt ? 181 : 180);
}

static void engage(bool spoilt) {
    fixture_mode(&f, spoilt ? MODE_ENGAGED : MODE_MANUAL);
    fixture_mute_ai(&f, !spoilt); /* engaged without an AI computer would be a trip cause, too */
}

static void no_mode(bool spoilt) {
    fixture_mode(&f, spoilt ? MODE_NEITHER : MODE_MANUAL);
}

static void alarm(bool spoilt) {
    walk_alarm(&f, spoilt ? ALARM_REMOTE_SIGNAL : ALARM_NONE);
}

static void eps_fault(bool spoilt) {
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = spoilt ? 0x40 : 0;
}

static void bus_off(bool spoilt) {
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, spoilt ? HAL_CAN_BUS_OFF : HAL_CAN_ERROR_ACTIVE);
}

/* A fault of the vehicle, and the condition that STARTUP_TIMEOUT reports for it. */
typedef struct {
    const char *what;
    uint16_t missing;
    void (*spoil)(bool spoilt); /* NULL: a message is silent, or its counter stands still */
    agv_message_t message;
    bool freezes;
} obstacle_t;

enum {
    NO_VCU = AGV_MISSING_VCU_HEARTBEAT | AGV_MISSING_TRIP_CAUSE | AGV_MISSING_STANDSTILL,
    NO_EPS = AGV_MISSING_EPS_HEARTBEAT | AGV_MISSING_TRIP_CAUSE,
    NO_STATUS = AGV_MISSING_MESSAGES | AGV_MISSING_TRIP_CAUSE
};

static const obstacle_t OBSTACLES[] = {
    {"VCU counter stands still", NO_VCU, NULL, AGV_MSG_VEHICLE_STATUS, true},
    {"EPS counter stands still", NO_EPS, NULL, AGV_MSG_STEERING_STATUS, true},
    {"no 363h", NO_VCU | AGV_MISSING_MANUAL, NULL, AGV_MSG_VEHICLE_STATUS, false},
    {"no 067h", NO_EPS, NULL, AGV_MSG_STEERING_STATUS, false},
    {"no 167h", NO_STATUS, NULL, AGV_MSG_EPS_STATUS, false},
    {"no 0A3h", NO_STATUS, NULL, AGV_MSG_GEAR_STATUS, false},
    {"no 050h", NO_STATUS, NULL, AGV_MSG_THROTTLE_STATUS, false},
    {"no 101h", NO_STATUS | AGV_MISSING_STANDSTILL, NULL, AGV_MSG_WHEEL_SPEED, false},
    {"a wheel turns", AGV_MISSING_STANDSTILL, turn_a_wheel, AGV_MSG_NONE, false},
    {"the VCU reports a speed", AGV_MISSING_STANDSTILL, report_speed, AGV_MSG_NONE, false},
    {"engaged", AGV_MISSING_MANUAL, engage, AGV_MSG_NONE, false},
    {"neither mode", AGV_MISSING_MANUAL, no_mode, AGV_MSG_NONE, false},
    {"VCU alarm", AGV_MISSING_TRIP_CAUSE, alarm, AGV_MSG_NONE, false},
    {"EPS fault", AGV_MISSING_TRIP_CAUSE, eps_fault, AGV_MSG_NONE, false},
    {"bus-off", AGV_MISSING_TRIP_CAUSE, bus_off, AGV_MSG_NONE, false},
};
enum { OBSTACLE_COUNT = sizeof OBSTACLES / sizeof OBSTACLES[0] };

static void spoil(const obstacle_t *obstacle, bool spoilt) {
    if (obstacle->spoil != NULL) {
        obstacle->spoil(spoilt);
    } else if (obstacle->freezes) {
        f.traffic[obstacle->message].frozen = spoilt;
    } else {
        f.traffic[obstacle->message].muted = spoilt;
    }
}

static void begin(const obstacle_t *obstacle) {
    const uint32_t clock_ms = start_ms;
    fixture_init(&f);
    f.now_ms = clock_ms;
    f.what = obstacle->what;
    f.long_run = true;
    fixture_mute_ai(&f, true);
    fixture_start(&f);
    spoil(obstacle, true);
}

static uint32_t startup_reports(agv_event_t *last) {
    return fixture_events(&f, AGV_EVENT_STARTUP, 0, ANY, last);
}

/* Shows: STARTUP_TIMEOUT, FSM-4 */
void test_each_missing_condition_keeps_init_and_is_named_after_10_s(void) {
    for (unsigned i = 0; i < OBSTACLE_COUNT; i++) {
        agv_event_t report = {0};
        begin(&OBSTACLES[i]);
        expect_state_after(&f, 9999, AGV_STATE_INIT);
        expect_fault(&f, AGV_FAULT_STARTUP_TIMEOUT, false);
        expect_fault_after(&f, 2, AGV_FAULT_STARTUP_TIMEOUT, true);
        expect_state_after(&f, 12000, AGV_STATE_INIT);
        expect_output(&f, false);
        expect_fault(&f, AGV_FAULT_STARTUP_TIMEOUT, true);
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, startup_reports(&report), f.what);
        TEST_ASSERT_EQUAL_HEX16_MESSAGE(OBSTACLES[i].missing, report.missing, f.what);
        const agv_fault_set_t trips = agv_supervisor_active_trips(&f.supervisor);
        TEST_ASSERT_FALSE_MESSAGE(agv_fault_is_in(&trips, AGV_FAULT_STARTUP_TIMEOUT), f.what); /* it warns */
    }
}

/* Shows: STARTUP_TIMEOUT, FSM-7 */
void test_init_is_left_once_the_obstacle_is_gone_and_nothing_has_latched(void) {
    for (unsigned i = 0; i < OBSTACLE_COUNT; i++) {
        begin(&OBSTACLES[i]);
        expect_state_after(&f, 10500, AGV_STATE_INIT);
        expect_reason(&f, AGV_FAULT_NONE);
        spoil(&OBSTACLES[i], false);
        expect_state_after(&f, 500, AGV_STATE_INIT); /* the first good frame or tick came 1 ms later at the earliest */
        expect_state_after(&f, 60, AGV_STATE_STANDBY);
        expect_reason(&f, AGV_FAULT_NONE);
        expect_fault(&f, AGV_FAULT_STARTUP_TIMEOUT, false);
        expect_output(&f, true);
    }
}

/* Shows: SUP-3, SUP-8 */
void test_conditions_that_do_not_keep_init(void) {
    f.traffic[AGV_MSG_STEERING_POSITION].muted = true; /* 267h only warns */
    fixture_mute_ai(&f, true);
    fixture_gear(&f, GEAR_D);
    fixture_throttle(&f, 100);
    fixture_wheels(&f, 49, -49); /* these values count as standstill */
    fixture_speed(&f, 180);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[5] = 0x01; /* level 2 alarm */
    fixture_start(&f);
    expect_state_after(&f, 514, AGV_STATE_STANDBY);
}

/* An AI computer that was received and is lost keeps INIT if its loss is a trip, until it is back. */
/* Shows: SUP-8, FSM-7, AI_HEARTBEAT_LOST */
void test_a_lost_ai_computer_keeps_init_where_it_is_a_trip_in_manual(void) {
    f.config.ai_lost_in_manual = AGV_AI_LOST_TRIP;
    fixture_mute_vcu(&f, true);
    fixture_start(&f);
    fixture_run(&f, 500);
    fixture_mute_ai(&f, true);
    fixture_run(&f, 500);
    fixture_mute_vcu(&f, false);
    expect_state_after(&f, 2000, AGV_STATE_INIT);
    fixture_mute_ai(&f, false);
    expect_state_after(&f, 1000, AGV_STATE_STANDBY);
    expect_reason(&f, AGV_FAULT_NONE);
}

/* A transient lasts for 1 s after the last occurrence. */
/* Shows: FOREIGN_COMMAND_SENDER, FSM-7 */
void test_a_transient_keeps_init_until_it_has_ended(void) {
    static const uint8_t park[8] = {GEAR_P};
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_start(&f);
    fixture_run(&f, 200);
    f.traffic[AGV_MSG_GEAR_COMMAND].side = HAL_CAN_VEHICLE;
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, park);
    f.traffic[AGV_MSG_GEAR_COMMAND].side = HAL_CAN_AI;
    expect_fault(&f, AGV_FAULT_FOREIGN_COMMAND_SENDER, true);
    expect_state(&f, AGV_STATE_INIT);
    expect_state_after(&f, 1499, AGV_STATE_INIT);
    expect_state_after(&f, 2, AGV_STATE_STANDBY);
    expect_reason(&f, AGV_FAULT_NONE);
}

/* Shows: FSM-7 */
void test_a_vehicle_that_is_engaged_at_power_on_is_not_resumed(void) {
    fixture_mode(&f, MODE_ENGAGED);
    fixture_gear(&f, GEAR_D);
    fixture_drive(&f, 1500);
    fixture_start(&f);
    f.long_run = true;
    expect_state_after(&f, 30000, AGV_STATE_INIT);
    expect_output(&f, false);
    fixture_mode(&f, MODE_MANUAL);
    expect_state_after(&f, 2000, AGV_STATE_INIT); /* it still moves */
    fixture_drive(&f, 0);
    expect_state_after(&f, 600, AGV_STATE_STANDBY);
}

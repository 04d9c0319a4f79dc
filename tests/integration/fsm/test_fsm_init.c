/* INIT: its frames, its end, the conditions that keep it. Nothing latches in INIT. */
#include "expect.h"
#include "fixture.h"
#include "spoil.h"
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

static void bus_off(fixture_t *fixture, bool on) {
    sim_hal_set_can_state(&fixture->hal, HAL_CAN_VEHICLE, on ? HAL_CAN_BUS_OFF : HAL_CAN_ERROR_ACTIVE);
}

/* A fault of the vehicle, and the condition that STARTUP_TIMEOUT reports for it. */
typedef struct {
    spoil_t spoil;
    uint16_t missing;
} obstacle_t;

enum {
    NO_VCU = AGV_MISSING_VCU_HEARTBEAT | AGV_MISSING_TRIP_CAUSE | AGV_MISSING_STANDSTILL,
    NO_EPS = AGV_MISSING_EPS_HEARTBEAT | AGV_MISSING_TRIP_CAUSE,
    NO_STATUS = AGV_MISSING_MESSAGES | AGV_MISSING_TRIP_CAUSE
};

static const obstacle_t OBSTACLES[] = {
    {{"VCU counter stands still", M_VEHICLE, .how = FROZEN}, NO_VCU},
    {{"EPS counter stands still", M_STEERING_STATUS, .how = FROZEN}, NO_EPS},
    {{"no 363h", M_VEHICLE, .how = SILENT}, NO_VCU | AGV_MISSING_MANUAL},
    {{"no 067h", M_STEERING_STATUS, .how = SILENT}, NO_EPS},
    {{"no 167h", M_EPS_STATUS, .how = SILENT}, NO_STATUS},
    {{"no 0A3h", M_GEAR_STATUS, .how = SILENT}, NO_STATUS},
    {{"no 050h", M_THROTTLE_STATUS, .how = SILENT}, NO_STATUS},
    {{"no 101h", M_WHEELS, .how = SILENT}, NO_STATUS | AGV_MISSING_STANDSTILL},
    {{"a wheel turns", .by = spoil_wheel}, AGV_MISSING_STANDSTILL},
    {{"the VCU reports a speed", .by = spoil_speed}, AGV_MISSING_STANDSTILL},
    {{"engaged", .by = spoil_mode}, AGV_MISSING_MANUAL},
    {{"neither mode", M_VEHICLE, BYTE, 7, .value = MODE_NEITHER}, AGV_MISSING_MANUAL},
    {{"throttle", M_THROTTLE_STATUS, BYTE, 1, .value = 3}, AGV_MISSING_THROTTLE},
    {{"VCU alarm", M_VEHICLE, BYTE, 5, .value = ALARM_REMOTE_SIGNAL}, AGV_MISSING_TRIP_CAUSE},
    {{"EPS fault", M_EPS_STATUS, BYTE, 8, .value = 0x40}, AGV_MISSING_TRIP_CAUSE},
    {{"bus-off", .by = bus_off}, AGV_MISSING_TRIP_CAUSE},
};
enum { OBSTACLE_COUNT = sizeof OBSTACLES / sizeof OBSTACLES[0] };

static void begin(const obstacle_t *obstacle) {
    const uint32_t clock_ms = start_ms;
    fixture_init(&f);
    f.now_ms = clock_ms;
    f.what = obstacle->spoil.what;
    f.long_run = true;
    fixture_mute_ai(&f, true);
    fixture_start(&f);
    spoil_set(&f, &obstacle->spoil, true);
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
        spoil_set(&f, &OBSTACLES[i].spoil, false);
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
    fixture_throttle(&f, 2);     /* at idle */
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

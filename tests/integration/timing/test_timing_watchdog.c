/* The hardware watchdog, late steps, and a backlog of frames. */
#include "one_fixture.h"
#include "walk.h"

/* Shows: TIM-3 */
void test_the_watchdog_is_fed_in_every_state_while_all_activities_check_in(void) {
    walk_to_safe(&f);
    walk_reset(&f, 1100);
    TEST_ASSERT_EQUAL_UINT32(0, f.hal.bites);
    for (unsigned i = 0; i < 50; i++) {
        const uint32_t feeds = f.hal.feeds;
        fixture_run(&f, 10);
        TEST_ASSERT_TRUE(f.hal.feeds > feeds);
    }
}

/* Frames and ticks still come, but the receive path does not check in. */
/* Shows: TIM-3 */
void test_the_watchdog_is_not_fed_without_the_receive_path(void) {
    fixture_standby(&f);
    f.receive_path_dead = true;
    const uint32_t feeds = f.hal.feeds;
    fixture_run(&f, 100);
    TEST_ASSERT_EQUAL_UINT32(feeds, f.hal.feeds);
    TEST_ASSERT_EQUAL_UINT32(0, f.hal.bites);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1, f.hal.bites);
    TEST_ASSERT_FALSE(f.hal.safety_output.on);
}

/* Never since the start, on a board without a hardware watchdog: STANDBY does not close the output. */
/* Shows: TIM-3, FSM-4 */
void test_the_output_stays_open_without_the_receive_path(void) {
    f.receive_path_dead = true;
    fixture_start(&f);
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    (void)walk_until(&f, AGV_STATE_STANDBY, 1000);
    expect_output(&f, false);
    fixture_run(&f, 500);
    expect_output(&f, false);
    TEST_ASSERT_EQUAL_UINT32(0, f.hal.safety_output.changes);
}

/* Shows: TIM-3 */
void test_the_watchdog_is_not_fed_without_the_step(void) {
    fixture_standby(&f);
    const uint32_t feeds = f.hal.feeds;
    for (unsigned i = 0; i < 101; i++) {
        TEST_ASSERT_FALSE(sim_hal_poll(&f.hal));
        fixture_run_without_ticks(&f, 1);
        agv_supervisor_receive_alive(&f.supervisor);
    }
    TEST_ASSERT_EQUAL_UINT32(feeds, f.hal.feeds);
    TEST_ASSERT_TRUE(sim_hal_poll(&f.hal));
}

/* Shows: TIM-3 */
void test_each_check_in_counts_for_one_feed(void) {
    fixture_standby(&f);
    f.receive_path_dead = true;
    const uint32_t feeds = f.hal.feeds;
    for (unsigned i = 1; i <= 5; i++) {
        agv_supervisor_receive_alive(&f.supervisor);
        agv_supervisor_receive_alive(&f.supervisor);
        fixture_run(&f, 20);
        TEST_ASSERT_EQUAL_UINT32(feeds + i, f.hal.feeds);
    }
}

/* Shows: TIM-3 */
void test_a_receive_path_that_comes_back_in_time_is_in_time(void) {
    fixture_standby(&f);
    f.receive_path_dead = true;
    fixture_run(&f, 99);
    f.receive_path_dead = false;
    fixture_run(&f, 1000);
    TEST_ASSERT_EQUAL_UINT32(0, f.hal.bites);
    expect_state(&f, AGV_STATE_STANDBY);
    expect_output(&f, true);
}

/*
 * A frame whose time stamp is far ahead stops the supervisor's time until that time has come: no deadline would expire, and no
 * command would be sent again, while ticks go on.
 */
/* Shows: TIM-3 */
void test_the_watchdog_is_not_fed_while_the_time_stands_still(void) {
    const hal_can_frame_t ahead = {.id = 0x101, .time_ms = f.now_ms + 100000000, .length = 8};
    fixture_standby(&f);
    agv_supervisor_frame(&f.supervisor, &f.ports, HAL_CAN_VEHICLE, &ahead);
    fixture_run(&f, 1); /* a step that comes late */
    const uint32_t feeds = f.hal.feeds;
    fixture_run(&f, 100);
    TEST_ASSERT_EQUAL_UINT32(feeds, f.hal.feeds);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1, f.hal.bites);
    TEST_ASSERT_FALSE(f.hal.safety_output.on);
}

/* ---- Late steps ---- */

/* Frames are processed in time, but the next step comes this much later than 1 ms after the last one. */
static void step_late_by(uint32_t ms) {
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF; /* "although the watchdog did not expire" */
    fixture_run_without_ticks(&f, ms);
    fixture_run(&f, 1);
}

static void expect_limit(uint16_t period_ms) {
    fixture_init(&f);
    f.config.watchdog_period_ms = period_ms;
    fixture_active(&f);
    step_late_by(period_ms);
    expect_state(&f, AGV_STATE_ACTIVE);
    fixture_run(&f, 10);
    step_late_by(period_ms + 1u);
    expect_reason(&f, AGV_FAULT_STEP_OVERRUN);
}

/* Shows: TIM-4, STEP_OVERRUN */
void test_the_limit_is_the_watchdogs_period(void) {
    expect_limit(10);
    expect_limit(50);
    expect_limit(1000);
}

/* Shows: TIM-4, STEP_OVERRUN */
void test_in_init_a_late_step_is_a_transient_that_keeps_init_for_a_second(void) {
    fixture_start(&f);
    fixture_run(&f, 100);
    step_late_by(300);
    expect_state(&f, AGV_STATE_INIT);
    expect_fault(&f, AGV_FAULT_STEP_OVERRUN, true);
    expect_state_after(&f, 1499, AGV_STATE_INIT);
    expect_state_after(&f, 2, AGV_STATE_STANDBY);
    expect_reason(&f, AGV_FAULT_NONE);
}

/* Shows: TIM-4, STEP_OVERRUN, FSM-3 */
void test_a_second_after_it_has_ended_it_can_be_reset(void) {
    for (unsigned i = 0; i < 2; i++) {
        fixture_init(&f);
        fixture_standby(&f);
        step_late_by(500);
        fixture_run(&f, 100);
        fixture_button(&f, true);
        expect_state_after(&f, i == 0 ? 1850 : 1950,
                           AGV_STATE_SAFE); /* it ends 900 ms after the press, and then a second must pass */
        fixture_button(&f, false);
        expect_state_after(&f, 10, i == 0 ? AGV_STATE_SAFE : AGV_STATE_STANDBY);
    }
}

/* In SAFE no reset is possible meanwhile: each transient trips again. */
/* Shows: TIM-4, FSM-11, STEP_OVERRUN */
void test_each_late_step_trips(void) {
    fixture_standby(&f);
    step_late_by(500);
    fixture_run(&f, 300);
    step_late_by(500);
    expect_fault(&f, AGV_FAULT_STEP_OVERRUN, true);
    expect_fault_after(&f, 999, AGV_FAULT_STEP_OVERRUN, true);
    expect_fault_after(&f, 1, AGV_FAULT_STEP_OVERRUN, false);
}

/* Only ticks check deadlines, so without them alive and fresh are unknown. */
/* Shows: TIM-4, FSM-4 */
void test_init_is_not_left_while_steps_stay_away(void) {
    fixture_start(&f);
    fixture_run(&f, 300);
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    fixture_run_without_ticks(&f, 1500);
    expect_state(&f, AGV_STATE_INIT);
    expect_output(&f, false);
    expect_state_after(&f, 1, AGV_STATE_INIT);
    expect_fault(&f, AGV_FAULT_STEP_OVERRUN, true);
}

/* Only ticks raise faults. But a frame after the deadline of the VCU ends its confirmation, and a press that is released
 * meanwhile does not reset. */
/* Shows: TIM-4, FSM-3, FSM-4 */
void test_no_reset_is_accepted_while_steps_stay_away(void) {
    fixture_standby(&f);
    step_late_by(500);
    expect_state_after(&f, 1200, AGV_STATE_SAFE);
    fixture_button(&f, true);
    fixture_run(&f, 500);
    fixture_run_without_ticks(&f, 1000);
    fixture_button(&f, false);
    fixture_run_without_ticks(&f, 20);
    expect_state(&f, AGV_STATE_SAFE);
    f.traffic[AGV_MSG_VEHICLE_STATUS].muted = true;
    fixture_run_without_ticks(&f, 40);
    expect_state(&f, AGV_STATE_SAFE);
    fixture_run_without_ticks(&f, 20);
    expect_state(&f, AGV_STATE_TRIPPED);
    expect_fault(&f, AGV_FAULT_VCU_HEARTBEAT_LOST, false);
    fixture_run(&f, 1);
    expect_fault(&f, AGV_FAULT_VCU_HEARTBEAT_LOST, true);
}

/* A frame is handled late when the last tick was more than 10 ms ago. The VCU's deadline is over since 50 ms. */
/* Shows: TIM-4, FSM-3 */
void test_a_frame_10_ms_after_a_tick_is_not_late_and_one_after_11_is(void) {
    fixture_standby(&f);
    step_late_by(500);
    expect_state_after(&f, 1200, AGV_STATE_SAFE);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    f.traffic[AGV_MSG_VEHICLE_STATUS].muted = true;
    fixture_run(&f, 45);
    fixture_run_without_ticks(&f, 10);
    fixture_send_now(&f, AGV_MSG_STEERING_STATUS);
    expect_state(&f, AGV_STATE_SAFE);
    fixture_run_without_ticks(&f, 1);
    fixture_send_now(&f, AGV_MSG_STEERING_STATUS);
    expect_state(&f, AGV_STATE_TRIPPED);
}

/* 500 ms of INIT are over among the late frames, and so is the deadline of the EPS. Its other message goes on. */
/* Shows: TIM-4 */
void test_late_frames_do_not_end_init_without_the_eps(void) {
    fixture_start(&f);
    fixture_run(&f, 440);
    f.traffic[AGV_MSG_STEERING_STATUS].muted = true;
    fixture_run_without_ticks(&f, 90);
    expect_state(&f, AGV_STATE_INIT);
    f.traffic[AGV_MSG_STEERING_STATUS].muted = false;
    expect_state_after(&f, 700, AGV_STATE_STANDBY);
}

/* ---- A backlog does not look fresh ---- */

static bool hold_back(fixture_t *fixture, agv_message_t message, hal_can_frame_t *frame) {
    (void)fixture;
    (void)frame;
    return message != AGV_MSG_VEHICLE_STATUS;
}

/* Pass the 363h frames of t + 10 and t + 20 together, 60 ms after t + 10, with their stamps. @return t + 20 */
static uint32_t deliver_backlog(void) {
    fixture_standby(&f);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    const uint32_t last_ms = f.now_ms;
    f.edit = hold_back;
    fixture_run_without_ticks(&f, 69);
    f.traffic[AGV_MSG_VEHICLE_STATUS].muted = true;
    for (uint32_t i = 1; i <= 2; i++) {
        hal_can_frame_t frame = {.id = 0x363, .time_ms = last_ms + 10 * i, .length = 8};
        frame.data[6] = MODE_MANUAL;
        frame.data[7] = (uint8_t)(200 + i);
        agv_supervisor_frame(&f.supervisor, &f.ports, HAL_CAN_VEHICLE, &frame);
    }
    return last_ms + 20;
}

/* Age of the last one at that step: 50 ms, then 51. */
/* Shows: TIM-4, SUP-2 */
void test_a_backlog_is_as_old_as_its_time_stamps(void) {
    const uint32_t newest_ms = deliver_backlog();
    expect_state_after(&f, newest_ms + 50 - f.now_ms, AGV_STATE_STANDBY);
    expect_tripped_after(&f, 1, AGV_FAULT_VCU_HEARTBEAT_LOST);
}

/* Frames from before the last step do not change the time. */
/* Shows: TIM-4 */
void test_an_old_time_stamp_does_not_turn_the_clock_back(void) {
    walk_to_tripped(&f);
    const uint32_t trip_ms = f.now_ms;
    fixture_forget_sent(&f);
    for (unsigned i = 0; i < 20; i++) {
        fixture_run(&f, 5);
        const hal_can_frame_t frame = {.id = 0x123, .time_ms = f.now_ms - 5000, .length = 8};
        agv_supervisor_frame(&f.supervisor, &f.ports, HAL_CAN_VEHICLE, &frame);
    }
    TEST_ASSERT_EQUAL_UINT32(100, fixture_nth_sent(&f, 0x43F, 0)->time_ms - trip_ms);
    expect_fault(&f, AGV_FAULT_STEP_OVERRUN, false);
}

/* The output closes in a late step; its contact follows in 10 ms. The time before that is no time of a wrong contact. */
static void expect_no_wrong_contact(uint16_t feedback_ms, uint32_t late_ms) {
    for (uint32_t at_ms = 400; at_ms < 520; at_ms++) {
        fixture_init(&f);
        f.board.has_feedback = true;
        f.config.output_feedback_ms = feedback_ms;
        fixture_start(&f);
        fixture_run(&f, at_ms);
        fixture_run_without_ticks(&f, late_ms);
        fixture_run(&f, 200);
        TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, AGV_FAULT_OUTPUT_FEEDBACK));
        expect_state(&f, AGV_STATE_STANDBY);
        expect_output(&f, true);
    }
}

/* Shows: HW-1, TIM-4, OUTPUT_FEEDBACK */
void test_a_late_step_makes_no_contact_wrong(void) {
    expect_no_wrong_contact(100, 98);
    expect_no_wrong_contact(20, 15);
}

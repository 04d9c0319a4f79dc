/* The AI computer (SUP-8): required while engaged, a warning in manual, forgotten by a reset; and the VCU's alarm about
 * it. Calculated by hand: the deadline is 350 ms, 43Fh comes each 100 ms, two cycles are 200 ms. */
#include "one_fixture.h"
#include "walk.h"

static const agv_fault_t LOST = AGV_FAULT_AI_HEARTBEAT_LOST;
static const agv_fault_t STUCK = AGV_FAULT_AI_HEARTBEAT_STUCK;
static const agv_message_t AI = AGV_MSG_TURN_SIGNAL_COMMAND;
static const agv_message_t VCU = AGV_MSG_VEHICLE_STATUS;

static void expect_no_fault(agv_state_t state) {
    expect_nothing(&f, LOST, state);
    expect_nothing(&f, STUCK, state);
}

static void expect_no_fault_after(uint32_t ms, agv_state_t state) {
    fixture_run(&f, ms);
    expect_no_fault(state);
}

/* ---- Lost and stuck ---- */

/* In manual; engaged: causes.c. Muted: silent from now on. Frozen: sends on with an unchanged counter. */
static void check_manual(agv_fault_t fault, bool *how) {
    fixture_standby(&f);
    fixture_run_past(&f, AI);
    *how = true;
    expect_no_fault_after(350, AGV_STATE_STANDBY);
    fixture_run(&f, 1);
    expect_warning(&f, fault, AGV_STATE_STANDBY);
    expect_led(&f, 14);
    expect_state_after(&f, 5000,
                       AGV_STATE_STANDBY); /* switching the AI computer off while driving by remote control is normal */
    expect_silence(&f);
    *how = false;
    fixture_run_before(&f, AI);
    expect_fault(&f, fault, true);
    expect_no_fault_after(1, AGV_STATE_STANDBY);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, fault));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, fault));
    expect_led(&f, 0);
}

/* Shows: SUP-1, SUP-2, SUP-8, AI_HEARTBEAT_LOST */
void test_lost(void) {
    check_manual(LOST, &f.traffic[AI].muted);
}

/* Shows: SUP-1, SUP-2, SUP-8, P13, AI_HEARTBEAT_STUCK */
void test_stuck(void) {
    check_manual(STUCK, &f.traffic[AI].frozen);
}

/* ai_lost_in_manual: trip. */
/* Shows: SUP-8, AI_HEARTBEAT_LOST, AI_HEARTBEAT_STUCK */
void test_lost_in_manual_may_be_made_a_trip(void) {
    for (unsigned i = 0; i < 2; i++) {
        fixture_init(&f);
        f.config.ai_lost_in_manual = AGV_AI_LOST_TRIP;
        fixture_standby(&f);
        fixture_run_past(&f, AI);
        f.traffic[AI].muted = i == 0;
        f.traffic[AI].frozen = i == 1;
        expect_no_fault_after(350, AGV_STATE_STANDBY);
        fixture_run(&f, 1);
        expect_trip(&f, i == 0 ? LOST : STUCK, f.call, NO_HOLD);
    }
}

/* ---- At the engagement ---- */

/* Lost or stuck already: the fault changes its class, is raised again, and trips in the call of that 363h. */
static void check_at_engagement(agv_fault_t fault, bool *how) {
    fixture_standby(&f);
    *how = true;
    expect_fault_after(&f, 1000, fault, true);
    expect_state(&f, AGV_STATE_STANDBY);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run_before(&f, VCU);
    expect_reason(&f, AGV_FAULT_NONE);
    fixture_run(&f, 1);
    expect_trip(&f, fault, f.traffic[VCU].call, ANGLE_CENTRE);
    TEST_ASSERT_EQUAL_UINT32(2, fixture_raised(&f, fault));
    TEST_ASSERT_EQUAL_UINT32(0, fixture_ended(&f, fault));
}

/* Shows: SUP-8, FSM-2, FSM-11, AI_HEARTBEAT_LOST, AI_HEARTBEAT_STUCK */
void test_lost_or_stuck_at_the_engagement_trips_at_once(void) {
    check_at_engagement(LOST, &f.traffic[AI].muted);
    fixture_init(&f);
    check_at_engagement(STUCK, &f.traffic[AI].frozen);
}

/* Exactly this fault is active as a trip. */
static void expect_active_trips(agv_fault_t only) {
    const agv_fault_set_t trips = agv_supervisor_active_trips(&f.supervisor);
    agv_fault_set_t expected = {0};
    agv_fault_set_put(&expected, only, true);
    TEST_ASSERT_EQUAL_MEMORY(&expected, &trips, sizeof trips);
}

/* Back to manual: the class changes while the fault is active, so it is raised again, as a warning. */
/* Shows: SUP-8, AI_HEARTBEAT_LOST */
void test_the_class_follows_the_mode(void) {
    agv_event_t event;
    fixture_active(&f);
    f.traffic[AI].muted = true;
    expect_reason_after(&f, 500, LOST);
    expect_active_trips(LOST);
    fixture_vehicle_confirms(&f);
    fixture_run_past(&f, VCU);
    fixture_run_past(&f, VCU);
    expect_active_trips(LOST);
    fixture_run_past(&f, VCU);
    expect_fault(&f, LOST, true);
    expect_active_trips(AGV_FAULT_NONE);
    TEST_ASSERT_TRUE(fixture_last_raised(&f, LOST, &event));
    TEST_ASSERT_EQUAL_INT(AGV_CLASS_WARN, event.b);
    TEST_ASSERT_EQUAL_UINT32(2, fixture_raised(&f, LOST));
    TEST_ASSERT_EQUAL_UINT32(0, fixture_ended(&f, LOST));
    expect_reason(&f, LOST);
    expect_led(&f, 14);
}

/* Never received: no fault in manual, however long. Engaged: a trip 500 ms later; ACTIVE needs the AI. */
/* Shows: SUP-8, AI_HEARTBEAT_LOST */
void test_never_seen(void) {
    f.traffic[AI].muted = true;
    fixture_standby(&f);
    expect_no_fault_after(5000, AGV_STATE_STANDBY);
    expect_led(&f, 0);
    fixture_wheels(&f, 800, 800);
    walk_engage(&f);
    expect_no_fault_after(500, AGV_STATE_STANDBY);
    expect_trip_after(&f, 1, LOST, ANGLE_CENTRE);
    expect_led(&f, 14);
}

/* The 500 ms count from the frame that reported the engagement, not from the tick after it. */
/* Shows: SUP-8, FSM-2, AI_HEARTBEAT_LOST */
void test_never_seen_when_engaged_between_two_ticks(void) {
    f.traffic[AI].muted = true;
    fixture_standby(&f);
    walk_report(&f, MODE_ENGAGED);
    expect_no_fault_after(500, AGV_STATE_STANDBY);
    expect_trip_after(&f, 1, LOST, ANGLE_CENTRE);
}

/* The 500 ms restart with each engagement. */
/* Shows: SUP-8, AI_HEARTBEAT_LOST */
void test_never_seen_and_not_engaged_for_long_enough(void) {
    f.traffic[AI].muted = true;
    fixture_standby(&f);
    for (unsigned i = 0; i < 3; i++) {
        walk_engage(&f);
        fixture_run(&f, 460);
        walk_disengage(&f);
        fixture_run(&f, 110);
    }
    expect_no_fault(AGV_STATE_STANDBY);
}

/* The 500 ms end between the two: the frame that continues the engagement trips, not the tick after it. */
/* Shows: SUP-8, AI_HEARTBEAT_LOST */
void test_never_seen_and_the_time_is_over_before_the_engagement_is_continued(void) {
    f.traffic[AI].muted = true;
    fixture_standby(&f);
    walk_engage(&f);
    const uint32_t began_ms = f.now_ms;
    fixture_run(&f, 450);
    walk_disengage(&f);
    TEST_ASSERT_LESS_THAN_UINT32(500, f.now_ms - began_ms);
    expect_no_fault_after(520 - (f.now_ms - began_ms), AGV_STATE_STANDBY);
    walk_report(&f, MODE_ENGAGED);
    expect_trip(&f, LOST, f.call, ANGLE_CENTRE);
}

/* It starts while engaged: the first 43Fh is the baseline, the second makes it alive. */
/* Shows: SUP-8, P13 */
void test_seen_in_time(void) {
    f.traffic[AI].muted = true;
    fixture_standby(&f);
    walk_engage(&f);
    fixture_run(&f, 390);
    fixture_send_now(&f, AI);
    expect_no_fault_after(200, AGV_STATE_STANDBY);
    fixture_send_now(&f, AI);
    expect_no_fault(AGV_STATE_ACTIVE);
    f.traffic[AI].muted = false;
    expect_no_fault_after(2000, AGV_STATE_ACTIVE);
}

/* Received but never alive. */
/* Shows: SUP-8, AI_HEARTBEAT_STUCK */
void test_seen_while_engaged_but_frozen(void) {
    f.traffic[AI].muted = true;
    f.traffic[AI].frozen = true;
    fixture_standby(&f);
    walk_engage(&f);
    fixture_run(&f, 300);
    fixture_send_now(&f, AI);
    const uint32_t seen_ms = f.now_ms;
    fixture_run(&f, 200);
    fixture_send_now(&f, AI);
    expect_no_fault_after(350 - (f.now_ms - seen_ms), AGV_STATE_STANDBY);
    expect_trip_after(&f, 1, STUCK, ANGLE_CENTRE);
}

/* A cause in INIT latches nothing. */
/* Shows: SUP-8, AI_HEARTBEAT_LOST */
void test_lost_in_init(void) {
    fixture_start(&f);
    fixture_run(&f, 250);
    f.traffic[AI].muted = true;
    expect_fault_after(&f, 400, LOST, true);
    expect_led(&f, 14);
    expect_state_after(&f, 400, AGV_STATE_STANDBY); /* a warning in manual does not keep INIT */
    expect_reason(&f, AGV_FAULT_NONE);
}

/* ---- A reset forgets the AI computer ---- */

/* Raised as a trip, and as a warning when the VCU had switched to manual; ended by the reset. */
static void trip_and_reset(agv_fault_t fault, bool *how) {
    fixture_active(&f);
    *how = true;
    fixture_run(&f, 1000);
    walk_confirm_and_reset(&f); /* the vehicle can be driven away manually with a dead AI computer */
    expect_no_fault(AGV_STATE_STANDBY);
    expect_led(&f, 0);
    expect_no_fault_after(5000, AGV_STATE_STANDBY);
    TEST_ASSERT_EQUAL_UINT32(2, fixture_raised(&f, LOST) + fixture_raised(&f, STUCK));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, fault));
}

/* At the next engagement it counts as lost at once, not 500 ms later. */
static void check_engaged_after_a_reset(agv_fault_t fault, bool *how) {
    fixture_init(&f);
    trip_and_reset(fault, how);
    fixture_wheels(&f, 800, 800);
    fixture_run(&f, 100);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_run_before(&f, VCU);
    expect_no_fault(AGV_STATE_STANDBY);
    fixture_run(&f, 1);
    expect_trip(&f, fault, f.traffic[VCU].call, ANGLE_CENTRE);
}

/* Shows: SUP-8, FSM-3, FSM-11, AI_HEARTBEAT_LOST, AI_HEARTBEAT_STUCK */
void test_a_reset_forgets_a_dead_ai_until_the_next_engagement(void) {
    check_engaged_after_a_reset(LOST, &f.traffic[AI].muted);
    check_engaged_after_a_reset(STUCK, &f.traffic[AI].frozen);
}

/* Alive at the reset and engaged within its cycle: ACTIVE with its next changed counter. The counter from before the
 * reset is the baseline, and its deadline has run on. */
static void check_reset_with_ai_alive(bool goes_on) {
    fixture_init(&f);
    fixture_active(&f);
    walk_trip(&f);
    fixture_vehicle_confirms(&f);
    fixture_run(&f, 300);
    fixture_button(&f, true);
    fixture_run(&f, 1100);
    fixture_run_past(&f, AI);
    const uint32_t beat_ms = f.now_ms;
    expect_state(&f, AGV_STATE_SAFE);
    fixture_button(&f, false);
    f.traffic[AI].muted = !goes_on;
    fixture_run_past(&f, VCU);
    expect_state(&f, AGV_STATE_STANDBY);
    walk_engage(&f);
    expect_no_fault(AGV_STATE_STANDBY);
    if (goes_on) {
        fixture_run_before(&f, AI);
        expect_no_fault(AGV_STATE_STANDBY);
        expect_no_fault_after(1, AGV_STATE_ACTIVE);
    } else {
        expect_no_fault_after(350 - (f.now_ms - beat_ms), AGV_STATE_STANDBY);
        expect_reason_after(&f, 1, LOST);
    }
}

/* Shows: SUP-8, FSM-11, AI_HEARTBEAT_LOST */
void test_an_ai_that_was_alive_at_the_reset(void) {
    check_reset_with_ai_alive(true);
    check_reset_with_ai_alive(false);
}

/* ai_lost_in_manual: trip. A forgotten AI computer does not trip in manual, so that the operator can drive away. */
/* Shows: SUP-8, FSM-3, AI_HEARTBEAT_LOST */
void test_a_reset_forgets_it_also_if_its_loss_trips_in_manual(void) {
    f.config.ai_lost_in_manual = AGV_AI_LOST_TRIP;
    fixture_active(&f);
    f.traffic[AI].muted = true;
    fixture_run(&f, 1000);
    walk_confirm_and_reset(&f);
    expect_no_fault_after(5000, AGV_STATE_STANDBY);
    f.traffic[AI].muted = false;
    fixture_run_past(&f, AI);
    f.traffic[AI].muted = true;
    expect_no_fault_after(350, AGV_STATE_STANDBY);
    expect_reason_after(&f, 1, LOST);
}

/* A changed counter ends the forgetting, frames with the old counter do not. */
/* Shows: SUP-8, FSM-3, AI_HEARTBEAT_STUCK */
void test_a_reset_forgets_a_frozen_ai_until_its_counter_changes(void) {
    trip_and_reset(STUCK, &f.traffic[AI].frozen);
    f.traffic[AI].frozen = false;
    fixture_run_past(&f, AI);
    f.traffic[AI].frozen = true;
    expect_no_fault_after(350, AGV_STATE_STANDBY);
    expect_fault_after(&f, 1, STUCK, true);
    expect_led(&f, 14);
    expect_state(&f, AGV_STATE_STANDBY);
}

/* ---- VCU alarm bit 3, "AI CAN signal lost": 363h byte 5, Bit3 ---- */

static void set_alarm(bool on) {
    f.traffic[VCU].data[4] = on ? 0x08 : 0;
}

/* No longer engaged: the alarm does not count, although the bit is set. */
/* Shows: SUP-8, VCU_AI_CAN_LOST */
void test_the_vcus_ai_alarm_ends_with_the_engagement(void) {
    fixture_active(&f);
    set_alarm(true);
    expect_fault_after(&f, 100, AGV_FAULT_VCU_AI_CAN_LOST, true);
    fixture_mode(&f, MODE_MANUAL);
    for (unsigned i = 0; i < 3; i++) {
        expect_fault(&f, AGV_FAULT_VCU_AI_CAN_LOST, true);
        fixture_run_past(&f, VCU);
    }
    expect_fault(&f, AGV_FAULT_VCU_AI_CAN_LOST, false);
}

/* MODE_INVALID: it is neither mode from that tick on, so it is not engaged. */
/* Shows: SUP-8, VCU_AI_CAN_LOST, MODE_INVALID */
void test_the_vcus_ai_alarm_ends_when_the_mode_is_invalid(void) {
    fixture_active(&f);
    set_alarm(true);
    fixture_mode(&f, MODE_BOTH);
    fixture_run_past(&f, VCU);
    expect_fault_after(&f, 50, AGV_FAULT_VCU_AI_CAN_LOST, true);
    expect_fault_after(&f, 1, AGV_FAULT_MODE_INVALID, true);
    expect_fault(&f, AGV_FAULT_VCU_AI_CAN_LOST, false);
}

/* Clear, then set, then engaged: it trips in the frame of the engagement. */
/* Shows: SUP-8, FSM-2, VCU_AI_CAN_LOST */
void test_the_vcus_ai_alarm_at_the_engagement(void) {
    fixture_standby(&f);
    set_alarm(true);
    expect_nothing_after(&f, 200, AGV_FAULT_VCU_AI_CAN_LOST, AGV_STATE_STANDBY);
    walk_engage(&f);
    expect_trip(&f, AGV_FAULT_VCU_AI_CAN_LOST, f.traffic[VCU].call, ANGLE_CENTRE);
}

/* A reset forgets only that the AI computer was alive: the alarm stays armed, also when the very next 363h reports autopilot. */
/* Shows: SUP-8, FSM-11, VCU_AI_CAN_LOST */
void test_the_vcus_ai_alarm_stays_armed_after_a_reset(void) {
    fixture_active(&f);
    walk_trip(&f);
    walk_confirm_and_reset(&f);
    set_alarm(true);
    walk_report(&f, MODE_ENGAGED);
    expect_reason(&f, AGV_FAULT_VCU_AI_CAN_LOST);
}

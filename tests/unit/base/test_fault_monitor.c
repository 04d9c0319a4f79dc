/* The faults of one supervisor: conditions, transients, and their evaluation. */
#include "base/fault_monitor.h"

#include <string.h>

#include "unity.h"

static agv_fault_monitor_t monitor;
static agv_timers_t timers;
static agv_config_t config; /* the default classes */
static agv_fault_changes_t changes;

void setUp(void) {
    agv_config_defaults(&config);
    agv_timers_start(&timers);
    monitor = (agv_fault_monitor_t){0};
    agv_fault_monitor_start(&monitor);
}

static void set(unsigned fault, bool cause) {
    agv_fault_monitor_set(&monitor, fault, cause);
}

static void event(unsigned fault, uint32_t now_ms) {
    agv_timers_set_time(&timers, now_ms);
    agv_fault_monitor_event(&monitor, &timers, fault);
}

static void tick(uint32_t now_ms) {
    agv_timers_advance(&timers, &config, now_ms, 0);
    agv_fault_monitor_tick(&monitor, &timers);
}

/* Without a change no fault is reported. */
static void evaluate_with(bool ai_loss_warns) {
    agv_fault_monitor_evaluate(&monitor, &config.trips, ai_loss_warns, &changes);
    if (!changes.any) {
        memset(&changes, 0, sizeof changes);
    }
}

static void evaluate(void) {
    evaluate_with(true);
}

static void evaluate_engaged(void) {
    evaluate_with(false);
}

static bool is_active(unsigned fault) {
    return agv_fault_monitor_is_active(&monitor, fault);
}

/* No fault, or just this one. */
static void expect_set(unsigned only, const agv_fault_set_t *actual) {
    agv_fault_set_t expected = {0};
    agv_fault_set_put(&expected, only, true);
    TEST_ASSERT_EQUAL_HEX32_ARRAY(expected.words, actual->words, AGV_FAULT_WORDS);
}

static void expect_summary(unsigned raised, unsigned cause, unsigned ai_cause, unsigned unresettable) {
    TEST_ASSERT_EQUAL_UINT8(raised, monitor.summary.raised);
    TEST_ASSERT_EQUAL_UINT8(cause, monitor.summary.cause);
    TEST_ASSERT_EQUAL_UINT8(ai_cause, monitor.summary.ai_cause);
    TEST_ASSERT_EQUAL_UINT8(unresettable, monitor.summary.unresettable);
}

static void expect_evaluated(unsigned raised, unsigned cause, unsigned ai_cause, unsigned unresettable) {
    evaluate();
    expect_summary(raised, cause, ai_cause, unresettable);
}

enum { NONE = AGV_FAULT_NONE };

/* ---- Conditions and transients ---- */

void test_a_fault_is_active_while_its_cause_is(void) {
    set(AGV_FAULT_MODE_INVALID, true);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_MODE_INVALID));
    expect_set(AGV_FAULT_MODE_INVALID, &monitor.active);
    set(AGV_FAULT_MODE_INVALID, true);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_MODE_INVALID));
    set(AGV_FAULT_MODE_INVALID, false);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_MODE_INVALID));
    expect_set(NONE, &monitor.active);
}

/* Shows: TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFE0C)
void test_a_transient_ends_its_hold_time_after_the_last_occurrence(uint32_t start_ms) {
    event(AGV_FAULT_STEP_OVERRUN, start_ms);
    tick(start_ms + 600);
    event(AGV_FAULT_STEP_OVERRUN, start_ms + 600);
    event(AGV_FAULT_RX_OVERRUN, start_ms + 601);
    tick(start_ms + 1599);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_STEP_OVERRUN));
    tick(start_ms + 1600);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_STEP_OVERRUN));
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_RX_OVERRUN));
    tick(start_ms + 1601);
    expect_set(NONE, &monitor.active);
}

/* The nine transients of the table, by hand. */
void test_nine_faults_are_transients_and_the_others_are_not(void) {
    static const unsigned events[] = {AGV_FAULT_SUPERVISOR_RESET,
                                      AGV_FAULT_TX_GATE_REFUSED,
                                      AGV_FAULT_STEP_OVERRUN,
                                      AGV_FAULT_MODE_FLAPPING,
                                      AGV_FAULT_AI_COMMAND_OUT_OF_RANGE,
                                      AGV_FAULT_FOREIGN_COMMAND_SENDER,
                                      AGV_FAULT_STATUS_ID_IN_USE,
                                      AGV_FAULT_RX_OVERRUN,
                                      AGV_FAULT_STORE_INVALID};
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        bool is_event = false;
        for (unsigned k = 0; k < 9; k++) {
            is_event = is_event || events[k] == i;
        }
        setUp();
        event(i, 0);
        TEST_ASSERT_EQUAL(is_event, is_active(i));
        tick(1000);
        expect_set(NONE, &monitor.active);
    }
}

/* Only its own rule ends a condition. */
void test_a_tick_ends_no_condition(void) {
    set(AGV_FAULT_BUS_OFF, true);
    for (uint32_t day = 0; day < 60; day++) {
        tick(day * 86400000);
    }
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_BUS_OFF));
}

void test_an_invalid_fault_changes_nothing(void) {
    static const unsigned none[] = {AGV_FAULT_NONE, AGV_FAULT_COUNT, 32 * AGV_FAULT_WORDS - 1, 32 * AGV_FAULT_WORDS,
                                    255};
    for (unsigned i = 0; i < 5; i++) {
        set(none[i], true);
        event(none[i], 0);
        agv_fault_monitor_latch_one(&monitor, none[i]);
        TEST_ASSERT_FALSE(is_active(none[i]));
    }
    expect_set(NONE, &monitor.active);
    expect_set(NONE, &monitor.latched);
    TEST_ASSERT_FALSE(monitor.outdated);
}

/* Values beyond the last fault. */
void test_an_invalid_fault_is_never_active(void) {
    memset(&monitor, 0xFF, sizeof monitor);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_COUNT - 1));
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_NONE));
}

/* ---- The evaluation ---- */

/* Shows: FSM-5 */
void test_a_trip_is_raised_once_and_its_cause_stands(void) {
    expect_evaluated(NONE, NONE, NONE, NONE);
    set(AGV_FAULT_S_DRIVER_ALARM, true);
    expect_summary(NONE, NONE, NONE, NONE); /* not yet evaluated */
    expect_evaluated(AGV_FAULT_S_DRIVER_ALARM, AGV_FAULT_S_DRIVER_ALARM, NONE, NONE);
    expect_set(AGV_FAULT_S_DRIVER_ALARM, &changes.changed);
    expect_set(AGV_FAULT_S_DRIVER_ALARM, &monitor.tripping);
    expect_set(NONE, &changes.was_trip);
    expect_evaluated(NONE, AGV_FAULT_S_DRIVER_ALARM, NONE, NONE);
    TEST_ASSERT_FALSE(changes.any);
    set(AGV_FAULT_S_DRIVER_ALARM, false);
    expect_evaluated(NONE, NONE, NONE, NONE);
    expect_set(AGV_FAULT_S_DRIVER_ALARM, &changes.changed);
    expect_set(AGV_FAULT_S_DRIVER_ALARM, &changes.was_trip);
    expect_set(NONE, &monitor.tripping);
}

/* The fault has not ended, so no change is reported, but it trips again. */
/* Shows: FSM-11 */
void test_every_occurrence_of_a_transient_is_raised(void) {
    for (uint32_t ms = 0; ms < 3; ms++) {
        event(AGV_FAULT_FOREIGN_COMMAND_SENDER, ms);
        expect_evaluated(AGV_FAULT_FOREIGN_COMMAND_SENDER, AGV_FAULT_FOREIGN_COMMAND_SENDER, NONE, NONE);
        expect_set((ms == 0) ? (unsigned)AGV_FAULT_FOREIGN_COMMAND_SENDER : (unsigned)NONE, &changes.changed);
        expect_evaluated(NONE, AGV_FAULT_FOREIGN_COMMAND_SENDER, NONE, NONE);
    }
    event(AGV_FAULT_RX_OVERRUN, 3); /* only warns */
    expect_evaluated(NONE, AGV_FAULT_FOREIGN_COMMAND_SENDER, NONE, NONE);
    set(AGV_FAULT_BUS_OFF, true); /* a lasting condition is raised once, whatever else occurs */
    evaluate();
    event(AGV_FAULT_RX_OVERRUN, 4);
    expect_evaluated(NONE, AGV_FAULT_BUS_OFF, NONE, NONE);
}

/* Other faults may change in the meantime. */
/* Shows: FSM-5 */
void test_no_trip_is_raised_again_by_another_fault(void) {
    for (unsigned fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        setUp();
        set(fault, true);
        evaluate();
        set(AGV_FAULT_ERROR_PASSIVE, fault != AGV_FAULT_ERROR_PASSIVE);
        evaluate();
        TEST_ASSERT_EQUAL_UINT8(NONE, monitor.summary.raised);
    }
}

void test_a_warning_changes_but_is_no_trip(void) {
    set(AGV_FAULT_EPS_TEMP_ABOVE_110, true);
    expect_evaluated(NONE, NONE, NONE, NONE);
    expect_set(AGV_FAULT_EPS_TEMP_ABOVE_110, &changes.changed);
    expect_set(NONE, &monitor.tripping);
    set(AGV_FAULT_EPS_TEMP_ABOVE_110, false);
    agv_fault_set_put(&config.trips, AGV_FAULT_EPS_TEMP_ABOVE_110, true);
    evaluate();
    set(AGV_FAULT_EPS_TEMP_ABOVE_110, true);
    expect_evaluated(AGV_FAULT_EPS_TEMP_ABOVE_110, AGV_FAULT_EPS_TEMP_ABOVE_110, NONE, NONE);
}

/* A fault that begins and ends between two evaluations is not reported. */
void test_a_fault_that_has_ended_before_the_evaluation_is_no_change(void) {
    set(AGV_FAULT_BUS_OFF, true);
    set(AGV_FAULT_BUS_OFF, false);
    expect_evaluated(NONE, NONE, NONE, NONE);
    expect_set(NONE, &changes.changed);
}

/* Of several faults at once the highest-ranking one of each kind is reported. */
/* Shows: FSM-5 */
void test_the_highest_ranking_one_of_each_kind(void) {
    set(AGV_FAULT_FOREIGN_COMMAND_SENDER, true);
    set(AGV_FAULT_S_DRIVER_ALARM, true);
    set(AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, true);
    set(AGV_FAULT_VCU_AI_CAN_LOST, true);
    expect_evaluated(AGV_FAULT_S_DRIVER_ALARM, AGV_FAULT_S_DRIVER_ALARM, AGV_FAULT_VCU_AI_CAN_LOST, NONE);
    set(AGV_FAULT_CONFIG_INVALID, true);
    set(AGV_FAULT_MEMORY_CORRUPTED, true);
    evaluate();
    expect_summary(AGV_FAULT_MEMORY_CORRUPTED, AGV_FAULT_MEMORY_CORRUPTED, AGV_FAULT_VCU_AI_CAN_LOST,
                   AGV_FAULT_MEMORY_CORRUPTED);
    set(AGV_FAULT_THROTTLE_IN_PARK, true); /* lower than the active fault, but raised all the same */
    evaluate();
    expect_summary(AGV_FAULT_THROTTLE_IN_PARK, AGV_FAULT_MEMORY_CORRUPTED, AGV_FAULT_VCU_AI_CAN_LOST,
                   AGV_FAULT_MEMORY_CORRUPTED);
}

/* Shows: FSM-10 */
void test_a_fault_of_the_eps_is_reported_whatever_its_class(void) {
    set(AGV_FAULT_EPS_UNDER_VOLTAGE, true);
    evaluate();
    TEST_ASSERT_TRUE(monitor.summary.eps_fault);
    set(AGV_FAULT_EPS_UNDER_VOLTAGE, false);
    set(AGV_FAULT_EPS_MODE_OFF, true);
    set(AGV_FAULT_CONFIG_INVALID, true);
    evaluate();
    TEST_ASSERT_FALSE(monitor.summary.eps_fault);
    set(AGV_FAULT_EPS_HEARTBEAT_LOST, true);
    agv_fault_set_put(&config.trips, AGV_FAULT_EPS_HEARTBEAT_LOST, false);
    evaluate();
    TEST_ASSERT_TRUE(monitor.summary.eps_fault);
}

/* Only for the AI's heartbeat. The class changes while the fault is active, so the fault is raised again. */
/* Shows: SUP-8, AI_HEARTBEAT_LOST, AI_HEARTBEAT_STUCK */
TEST_CASE(AGV_FAULT_AI_HEARTBEAT_LOST)
TEST_CASE(AGV_FAULT_AI_HEARTBEAT_STUCK)
void test_a_lost_ai_computer_warns_while_that_is_asked_for(unsigned fault) {
    set(fault, true);
    expect_evaluated(NONE, NONE, NONE, NONE);
    expect_set((unsigned)fault, &changes.changed);
    evaluate_engaged();
    expect_summary(fault, NONE, fault, NONE);
    expect_set(fault, &changes.changed);
    expect_set(NONE, &changes.was_trip);
    evaluate_engaged();
    expect_summary(NONE, NONE, fault, NONE);
    expect_set(NONE, &changes.changed);
    expect_evaluated(NONE, NONE, NONE, NONE);
    expect_set(fault, &changes.changed);
    expect_set(fault, &changes.was_trip);
}

void test_other_faults_of_the_ai_computer_trip_in_manual_too(void) {
    set(AGV_FAULT_GEAR_COMMAND_TIMEOUT, true);
    expect_evaluated(AGV_FAULT_GEAR_COMMAND_TIMEOUT, NONE, AGV_FAULT_GEAR_COMMAND_TIMEOUT, NONE);
}

/* ---- The latch, and the fault on the LED ---- */

/* Shows: LED-1 */
void test_latched_trips_are_shown_before_warnings(void) {
    TEST_ASSERT_EQUAL_UINT32(NONE, agv_fault_monitor_shown(&monitor));
    set(AGV_FAULT_EPS_TEMP_ABOVE_110, true);
    evaluate();
    TEST_ASSERT_EQUAL_UINT32(AGV_FAULT_EPS_TEMP_ABOVE_110, agv_fault_monitor_shown(&monitor));
    set(AGV_FAULT_THROTTLE_IN_PARK, true);
    evaluate();
    agv_fault_monitor_latch(&monitor);
    expect_set(AGV_FAULT_THROTTLE_IN_PARK, &monitor.latched); /* no warning */
    TEST_ASSERT_EQUAL_UINT32(AGV_FAULT_THROTTLE_IN_PARK, agv_fault_monitor_shown(&monitor));
    set(AGV_FAULT_THROTTLE_IN_PARK, false);
    evaluate();
    agv_fault_monitor_latch(&monitor);
    TEST_ASSERT_EQUAL_UINT32(AGV_FAULT_THROTTLE_IN_PARK, agv_fault_monitor_shown(&monitor));
    set(AGV_FAULT_BUS_OFF, true); /* a trip that is not latched yet */
    evaluate();
    TEST_ASSERT_EQUAL_UINT32(AGV_FAULT_BUS_OFF, agv_fault_monitor_shown(&monitor));
    set(AGV_FAULT_BUS_OFF, false);
    evaluate();
    agv_fault_monitor_forget(&monitor);
    expect_set(NONE, &monitor.latched);
    TEST_ASSERT_EQUAL_UINT32(AGV_FAULT_EPS_TEMP_ABOVE_110, agv_fault_monitor_shown(&monitor));
}

/* Shows: FSM-7, LED-1 */
void test_the_reason_of_an_earlier_run_is_shown(void) {
    agv_fault_monitor_latch_one(&monitor, AGV_FAULT_VCU_HEARTBEAT_LOST);
    expect_evaluated(NONE, NONE, NONE, NONE);
    TEST_ASSERT_EQUAL_UINT32(AGV_FAULT_VCU_HEARTBEAT_LOST, agv_fault_monitor_shown(&monitor));
}

/* Also before the first evaluation. */
void test_at_the_start_the_summary_names_no_fault(void) {
    expect_summary(NONE, NONE, NONE, NONE);
    TEST_ASSERT_FALSE(monitor.summary.eps_fault);
}

/* A tick ends what the hold time has ended, once. What is set afterwards stays. */
void test_a_tick_after_the_hold_time_ends_nothing_more(void) {
    event(AGV_FAULT_STEP_OVERRUN, 0);
    tick(1000);
    TEST_ASSERT_FALSE(is_active(AGV_FAULT_STEP_OVERRUN));
    set(AGV_FAULT_STEP_OVERRUN, true);
    tick(1001);
    TEST_ASSERT_TRUE(is_active(AGV_FAULT_STEP_OVERRUN));
}

/* Without a change of the faults nothing is evaluated, also with other classes. */
void test_without_a_change_nothing_is_evaluated(void) {
    const agv_fault_set_t none = {{0}};
    set(AGV_FAULT_BUS_OFF, true);
    agv_fault_monitor_evaluate(&monitor, &none, true, &changes);
    evaluate();
    TEST_ASSERT_FALSE(changes.any);
    expect_summary(NONE, NONE, NONE, NONE);
}

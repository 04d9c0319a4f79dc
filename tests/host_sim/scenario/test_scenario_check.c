/* The judge of a run: told what happened, it says what was not as expected. */
#include <stdio.h>
#include <string.h>

#include "hal/self_test.h"
#include "scenario/check/scenario_check.h"
#include "scratch.h"
#include "unity.h"

static scenario_t scenario;
static scenario_check_t check;
static agv_counters_t counters;

void setUp(void) {
    scratch_open();
    memset(&counters, 0, sizeof counters);
}

/* Begin with these expectations; the run takes 1000 ms. */
static void expect(const char *text) {
    static char file[4000];
    (void)snprintf(file, sizeof file, "name: n\nshows: [SUP-2]\nduration_ms: 1000\nexpect:\n%s", text);
    TEST_ASSERT_TRUE_MESSAGE(scenario_read_text(&scenario, "s.yaml", file, NULL), scratch_said());
    scenario_check_init(&check, &scenario);
}

static void event(uint64_t t_ms, agv_event_kind_t kind, unsigned a, unsigned b, unsigned c, unsigned missing) {
    const session_event_t news = {
        .t_ms = t_ms,
        .recorded = {
            .kind = (uint8_t)kind, .a = (uint8_t)a, .b = (uint8_t)b, .c = (uint8_t)c, .missing = (uint8_t)missing}};
    scenario_check_event(&check, &news);
}

static void state(uint64_t t_ms, agv_state_t to, agv_fault_t reason) {
    event(t_ms, AGV_EVENT_STATE, 0, (unsigned)to, (unsigned)reason, 0);
}

static void led(uint64_t t_ms, int8_t code) {
    const session_event_t news = {.t_ms = t_ms, .is_led = true, .led_code = code};
    scenario_check_event(&check, &news);
}

static void frame_at(uint64_t t_ms, uint32_t id, uint8_t byte0, uint8_t length) {
    const hal_can_frame_t frame = {.id = id, .length = length, .data = {byte0}};
    scenario_check_frame(&check, (t_ms * 1000) + 999, HAL_CAN_VEHICLE, SCENARIO_FROM_SUPERVISOR, &frame);
}

/* The run is over; this is the one failure (NULL: there is none). Another run with these expectations begins. */
static void expect_failure(const char *failure) {
    scenario_check_finish(&check, &counters);
    TEST_ASSERT_EQUAL_STRING((failure != NULL) ? failure : "", check.failures[0]);
    TEST_ASSERT_EQUAL_size_t((failure != NULL) ? 1 : 0, check.failure_count);
    scenario_check_init(&check, &scenario);
}

#define TWO_STATES "  states: [{to: INIT, at_ms: 0}, {to: TRIPPED, reason: BUS_OFF, at_ms: [5, 9]}]\n"
#define NO_STATES "  states: []\n"

void test_the_second_of_two_states(void) {
    static const struct {
        uint64_t t_ms;
        agv_state_t to;
        agv_fault_t reason;
        const char *seen; /* NULL: as expected */
    } rows[] = {
        {9, AGV_STATE_TRIPPED, AGV_FAULT_BUS_OFF, NULL},
        {10, AGV_STATE_TRIPPED, AGV_FAULT_BUS_OFF, "TRIPPED (BUS_OFF) at 10 ms"},
        {4, AGV_STATE_TRIPPED, AGV_FAULT_BUS_OFF, "TRIPPED (BUS_OFF) at 4 ms"},
        {5, AGV_STATE_TRIPPED, AGV_FAULT_TX_STALLED, "TRIPPED (TX_STALLED) at 5 ms"},
        {5, AGV_STATE_STANDBY, AGV_FAULT_NONE, "STANDBY (no reason) at 5 ms"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char failure[120];
        (void)snprintf(failure, sizeof failure, "line 5: TRIPPED (BUS_OFF) is expected in 5..9 ms, seen: %s",
                       (rows[i].seen != NULL) ? rows[i].seen : "");
        expect(TWO_STATES);
        state(0, AGV_STATE_INIT, AGV_FAULT_NONE);
        state(rows[i].t_ms, rows[i].to, rows[i].reason);
        expect_failure((rows[i].seen != NULL) ? failure : NULL);
    }
}

void test_a_state_that_is_missing(void) {
    expect(TWO_STATES);
    state(0, AGV_STATE_INIT, AGV_FAULT_NONE);
    expect_failure("line 5: TRIPPED (BUS_OFF) is expected in 5..9 ms, not seen");
}

void test_a_state_that_nobody_expects(void) {
    expect(NO_STATES);
    state(0, AGV_STATE_INIT, AGV_FAULT_NONE);
    expect_failure("no further change of state is expected, but at 0 ms: INIT (no reason)");
}

#define GEAR_P "  frames: [{id: 168h, bytes: \"08\", at_ms: [10, 20]}]\n"
#define FIRST "  frames: [{id: 168h, bytes: \"08\", at_ms: [10, 20], first_since_ms: 5}]\n"
#define EVERY "  frames: [{id: 168h, at_ms: [0, 1000], every_ms: 100, jitter_ms: 1}]\n"

void test_frames(void) {
    static const struct {
        const char *expected;
        struct {
            uint32_t t_ms;
            uint32_t id;
            uint8_t byte0;
            uint8_t length; /* 0: no frame */
        } frames[4];
        const char *failure;
    } rows[] = {
        {GEAR_P, {{9, 0x168, 8, 1}, {20, 0x168, 8, 1}}, NULL},
        {GEAR_P, /* too late, with other bytes, of another length */
         {{15, 0x168, 4, 1}, {15, 0x168, 8, 2}, {15, 0x169, 8, 1}, {21, 0x168, 8, 1}},
         "168h [08] is expected at least once in 10..20 ms, seen: 0 (one at 21 ms)"},
        {"  frames: [{id: 168h, bytes: \"\", at_ms: 10}]\n",
         {{10, 0x168, 8, 1}},
         "168h [] is expected at least once at 10 ms, seen: 0"},
        {FIRST, {{4, 0x168, 1, 1}, {10, 0x168, 8, 1}, {11, 0x168, 1, 1}}, NULL},
        {FIRST,
         {{9, 0x168, 8, 1}, {10, 0x168, 8, 1}},
         "168h [08] is expected as the first in 10..20 ms, seen: 168h [08] at 9 ms"},
        {FIRST,
         {{10, 0x168, 1, 1}, {11, 0x168, 8, 1}},
         "168h [08] is expected as the first in 10..20 ms, seen: 168h [01] at 10 ms"},
        {"  frames: [{id: 168h, at_ms: [10, 20], count: [2, 3]}]\n",
         {{15, 0x168, 8, 8}, {15, 0x168, 8, 8}, {15, 0x168, 8, 8}, {15, 0x168, 8, 8}},
         "168h is expected 2..3 times in 10..20 ms, seen: 4"},
        {EVERY,
         {{50, 0x168, 8, 8}, {148, 0x168, 8, 8}},
         "168h is expected every 100 ms, seen: 98 ms after the previous one at 50 ms"},
        {EVERY, {{50, 0x168, 8, 8}}, "168h is expected every 100 ms in 0..1000 ms, the last one was at 50 ms"},
        {"  never: [{id: 168h}]\n",
         {{20, 0x168, 1, 1}},
         "a frame is forbidden in the whole run, seen: 168h [01] at 20 ms"},
        {"  never: [{id: 168h, bytes: \"01 ..\", at_ms: [10, 20]}]\n",
         {{9, 0x168, 1, 2}, {15, 0x168, 8, 2}, {20, 0x168, 1, 2}, {20, 0x168, 1, 2}},
         "a frame is forbidden in 10..20 ms, seen: 168h [01 00] at 20 ms"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        char text[200];
        (void)snprintf(text, sizeof text, NO_STATES "%s", rows[i].expected);
        expect(text);
        for (size_t k = 0; (k < 4) && (rows[i].frames[k].length > 0); k++) {
            frame_at(rows[i].frames[k].t_ms, rows[i].frames[k].id, rows[i].frames[k].byte0, rows[i].frames[k].length);
        }
        (void)snprintf(text, sizeof text, "line 6: %s", (rows[i].failure != NULL) ? rows[i].failure : "");
        expect_failure((rows[i].failure != NULL) ? text : NULL);
    }
}

void test_a_period(void) {
    expect(NO_STATES EVERY);
    for (unsigned t = 50; t <= 1000; t += 101) {
        frame_at(t, 0x168u, 0x08u, 8);
    }
    expect_failure(NULL);
}

static void expect_again_after(uint32_t gap_ms, unsigned times, const char *failure) {
    expect(NO_STATES EVERY);
    scenario.expect.frames.items[0].again_ms = 5;
    scenario.expect.frames.items[0].again_max = 1;
    scenario_check_init(&check, &scenario);
    for (unsigned t = 50; t <= 1000; t += 100) {
        frame_at(t, 0x168u, 0x08u, 8);
        if ((t == 450) || ((t == 550) && (times == 2))) {
            frame_at(t + gap_ms, 0x168u, 0x08u, 8);
        }
    }
    expect_failure(failure);
}

void test_a_frame_of_a_period_that_is_sent_again_at_once(void) {
    expect_again_after(4, 1, NULL);
    expect_again_after(4, 2, "line 6: 168h is expected every 100 ms, seen: 4 ms after the previous one at 550 ms");
    expect_again_after(5, 1, "line 6: 168h is expected every 100 ms, seen: 5 ms after the previous one at 450 ms");
}

void test_frames_of_others_do_not_count(void) {
    const hal_can_frame_t frame = {.id = 0x168u, .length = 8};
    expect(NO_STATES "  never: [{id: 168h}]\n");
    scenario_check_frame(&check, 1000, HAL_CAN_VEHICLE, VEHICLE_AI, &frame);
    expect_failure(NULL);
    expect(NO_STATES "  never: [{id: 168h, from: ai, side: ai}]\n");
    scenario_check_frame(&check, 1000, HAL_CAN_VEHICLE, VEHICLE_AI, &frame);
    expect_failure(NULL);
    expect(NO_STATES "  never: [{from: anybody, at_ms: 1}]\n");
    scenario_check_frame(&check, 1000, HAL_CAN_AI, VEHICLE_EPS, &frame);
    expect_failure("line 6: a frame is forbidden at 1 ms, seen: 168h [00 00 00 00 00 00 00 00] at 1 ms");
}

void test_changes_of_the_safety_output(void) {
    expect(NO_STATES "  safety_output: [{closed: true, at_ms: 5}]\n");
    scenario_check_output(&check, 4, false);
    scenario_check_output(&check, 5, true);
    expect_failure(NULL);
    scenario_check_output(&check, 6, true);
    expect_failure("line 6: safety output closed is expected at 5 ms, seen: closed at 6 ms");
    expect_failure("line 6: safety output closed is expected at 5 ms, not seen");
    expect(NO_STATES);
    scenario_check_output(&check, 6, true);
    expect_failure("no further change of the safety output is expected, but at 6 ms: closed");
}

void test_the_led_all_the_while(void) {
    expect(NO_STATES "  led: [{code: 0, at_ms: [0, 9]}, {code: 13, at_ms: [10, 1000]}]\n");
    led(0, 0);
    led(10, 13);
    expect_failure(NULL);
    expect(NO_STATES "  led: [{code: 13, at_ms: [10, 1000]}]\n");
    led(0, 0);
    led(10, 13);
    led(500, 14);
    led(501, 13);
    expect_failure("line 6: LED code 13 is expected in 10..1000 ms, seen: 14 in 500..500 ms");
}

void test_faults_begin_and_end(void) {
    expect(NO_STATES "  faults: [{name: BUS_OFF, class: trip, raised_ms: 5, ended_ms: [7, 8]}]\n");
    event(5, AGV_EVENT_FAULT, AGV_FAULT_BUS_OFF, AGV_CLASS_TRIP, 1, 0);
    event(8, AGV_EVENT_FAULT, AGV_FAULT_BUS_OFF, AGV_CLASS_TRIP, 0, 0);
    event(9, AGV_EVENT_FAULT, AGV_FAULT_RX_OVERRUN, AGV_CLASS_WARN, 1, 0);
    expect_failure(NULL);
    expect(NO_STATES "  faults: [{name: BUS_OFF, class: trip, raised_ms: 5}]\n");
    event(5, AGV_EVENT_FAULT, AGV_FAULT_BUS_OFF, AGV_CLASS_WARN, 1, 0);
    expect_failure("line 6: BUS_OFF is expected to be raised at 5 ms as a trip, seen at 5 ms");
    expect(NO_STATES "  faults: [{name: BUS_OFF, raised_ms: 5}]\n");
    expect_failure("line 6: BUS_OFF is expected to be raised at 5 ms, not seen");
    expect(NO_STATES "  faults: [{name: BUS_OFF, raised_ms: 5, ended_ms: never}]\n");
    event(5, AGV_EVENT_FAULT, AGV_FAULT_BUS_OFF, AGV_CLASS_TRIP, 1, 0);
    event(8, AGV_EVENT_FAULT, AGV_FAULT_BUS_OFF, AGV_CLASS_TRIP, 0, 0);
    expect_failure("line 6: BUS_OFF is expected to end never, it ended at 8 ms");
    expect(NO_STATES "  faults: [{name: BUS_OFF, raised_ms: 5, ended_ms: 8}]\n");
    event(5, AGV_EVENT_FAULT, AGV_FAULT_BUS_OFF, AGV_CLASS_TRIP, 1, 0);
    expect_failure("line 6: BUS_OFF is expected to end at 8 ms, it did not");
}

void test_the_parts_that_failed_their_test(void) {
    static const char *const line = "  faults: [{name: SELF_TEST_FAILED, parts: [ram, core], raised_ms: 5}]\n";
    char text[400];
    (void)snprintf(text, sizeof text, "%s%s", NO_STATES, line);
    expect(text);
    event(5, AGV_EVENT_FAULT, AGV_FAULT_SELF_TEST_FAILED, AGV_CLASS_TRIP, 1, HAL_SELF_TEST_RAM | HAL_SELF_TEST_CORE);
    expect_failure(NULL);
    event(5, AGV_EVENT_FAULT, AGV_FAULT_SELF_TEST_FAILED, AGV_CLASS_TRIP, 1, HAL_SELF_TEST_RAM);
    expect_failure("line 6: SELF_TEST_FAILED [ram, core] is expected to be raised at 5 ms, seen: [ram] at 5 ms");
}

void test_no_other_faults(void) {
    expect(NO_STATES "  faults: [{name: BUS_OFF, raised_ms: 5}]\n  other_faults: never\n");
    event(5, AGV_EVENT_FAULT, AGV_FAULT_BUS_OFF, AGV_CLASS_TRIP, 1, 0);
    event(6, AGV_EVENT_FAULT, AGV_FAULT_RX_OVERRUN, AGV_CLASS_WARN, 1, 0);
    expect_failure("no other fault is expected, but at 6 ms: RX_OVERRUN (warn)");
    event(5, AGV_EVENT_FAULT, AGV_FAULT_BUS_OFF, AGV_CLASS_TRIP, 1, 0);
    event(6, AGV_EVENT_FAULT, AGV_FAULT_BUS_OFF, AGV_CLASS_TRIP, 1, 0); /* a second time */
    expect_failure("no other fault is expected, but at 6 ms: BUS_OFF (trip)");
}

void test_resets_and_what_is_missing_at_start(void) {
    expect(NO_STATES "  resets: [{accepted: false, why: [button, manual], at_ms: 5}]\n  startup: [{missing: "
                     "[messages], at_ms: 6}]\n");
    event(5, AGV_EVENT_RESET, 0, 0, 0, AGV_MISSING_BUTTON | AGV_MISSING_MANUAL);
    event(6, AGV_EVENT_STARTUP, 0, 0, 0, AGV_MISSING_MESSAGES);
    expect_failure(NULL);
    expect(NO_STATES "  resets: [{accepted: false, why: [button, manual], at_ms: 5}]\n");
    event(5, AGV_EVENT_RESET, 0, 0, 0, AGV_MISSING_BUTTON);
    expect_failure("line 6: reset refused [manual, button] is expected at 5 ms, seen: refused [button] at 5 ms");
    expect(NO_STATES "  resets: [{accepted: true, at_ms: 5}]\n");
    expect_failure("line 6: reset accepted [] is expected at 5 ms, not seen");
    expect(NO_STATES);
    event(5, AGV_EVENT_RESET, 1, 0, 0, 0);
    expect_failure("no further reset is expected, but at 5 ms: accepted []");
    expect(NO_STATES "  startup: [{missing: [messages], at_ms: 6}]\n");
    event(7, AGV_EVENT_STARTUP, 0, 0, 0, AGV_MISSING_MESSAGES);
    expect_failure("line 6: missing at start [messages] is expected at 6 ms, seen: [messages] at 7 ms");
    expect_failure("line 6: missing at start [messages] is expected at 6 ms, not seen");
    expect(NO_STATES);
    event(7, AGV_EVENT_STARTUP, 0, 0, 0, AGV_MISSING_STATE);
    expect_failure("no report of missing conditions at start is expected, but at 7 ms: [state]");
}

void test_the_vehicle_at_a_moment(void) {
    const vehicle_view_t view = {.gear = AGV_GEAR_D, .autopilot = true, .speed_mm_s = 1200};
    expect(NO_STATES "  vehicle: [{at_ms: 7, gear: D, mode: autopilot, speed_mm_s: [1190, 1200]}]\n");
    TEST_ASSERT_FALSE(scenario_check_wants_vehicle(&check, 6));
    TEST_ASSERT_TRUE(scenario_check_wants_vehicle(&check, 7));
    scenario_check_vehicle(&check, 7, &view);
    expect_failure(NULL);
    expect(NO_STATES "  vehicle: [{at_ms: 7, gear: P}]\n");
    scenario_check_vehicle(&check, 7, &view);
    expect_failure("line 6: vehicle at 7 ms: gear (P 8, R 2, N 4, D 1) 8h is expected, seen: 1h");
    expect(NO_STATES "  vehicle: [{at_ms: 7, speed_mm_s: 0}]\n");
    scenario_check_vehicle(&check, 7, &view);
    expect_failure("line 6: vehicle at 7 ms: speed in mm/s 0..0 is expected, seen: 1200");
}

void test_counters_at_the_end(void) {
    expect(NO_STATES "  counters_at_end: {sent: 3, rejected_remote: [1, 2]}\n");
    counters.sent = 3;
    counters.rejected[AGV_REJECTED_REMOTE] = 2;
    expect_failure(NULL);
    counters.rejected[AGV_REJECTED_REMOTE] = 3;
    expect_failure("line 6: counter rejected_remote: 1..2 is expected at the end, seen: 3");
}

void test_more_failures_than_are_kept_are_counted(void) {
    expect(NO_STATES);
    for (unsigned i = 0; i < SCENARIO_FAILURES_MAX + 5; i++) {
        state(i, AGV_STATE_INIT, AGV_FAULT_NONE);
    }
    scenario_check_finish(&check, &counters);
    TEST_ASSERT_EQUAL_size_t(SCENARIO_FAILURES_MAX + 5, check.failure_count);
}

/* Times that count from a step or an event: how they are read, when such steps are due, and how expectations hold. */
#include <stdio.h>
#include <string.h>

#include "scenario/check/scenario_check.h"
#include "scenario/scenario_player.h"
#include "scratch.h"
#include "unity.h"

static scenario_t scenario;
static scenario_check_t check;
static scenario_player_t player;
static scenario_events_t events;
static agv_counters_t counters;

void setUp(void) {
    scratch_open();
    memset(&counters, 0, sizeof counters);
    memset(&events, 0, sizeof events);
}

#define HEAD "name: n\nshows: [SUP-2]\nduration_ms: 1s\n"

static bool read_text(const char *text) {
    static char file[4000];
    (void)snprintf(file, sizeof file, HEAD "%s", text);
    return scenario_read_text(&scenario, "s.yaml", file, NULL);
}

static void begin(const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(read_text(text), scratch_said());
    scenario_check_init(&check, &scenario);
    scenario_player_init(&player, &scenario, &events);
}

static void read_bad(const char *text, const char *expected) {
    TEST_ASSERT_FALSE_MESSAGE(read_text(text), text);
    (void)scratch_said_line(expected);
}

static void change(uint64_t t_ms, agv_state_t from, agv_state_t to) {
    const session_event_t event = {
        .t_ms = t_ms,
        .recorded = {.kind = (uint8_t)AGV_EVENT_STATE, .a = (uint8_t)from, .b = (uint8_t)to, .c = AGV_FAULT_NONE}};
    (void)scenario_events_note(&events, &event);
    scenario_check_event(&check, &event);
}

static void trip(uint64_t t_ms) {
    change(t_ms, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED);
}

static void gear_frame(uint64_t t_ms, uint8_t gear) {
    const hal_can_frame_t frame = {.id = 0x168, .length = 8, .data = {gear}};
    scenario_check_frame(&check, t_ms * 1000, HAL_CAN_VEHICLE, SCENARIO_FROM_SUPERVISOR, &frame);
}

/* The run is over; this is the one failure (NULL: there is none). Another run with these expectations begins. */
static void expect_failure(const char *failure) {
    scenario_check_finish(&check, &counters);
    TEST_ASSERT_EQUAL_STRING((failure != NULL) ? failure : "", check.failures[0]);
    TEST_ASSERT_EQUAL_size_t((failure != NULL) ? 1 : 0, check.failure_count);
    memset(&events, 0, sizeof events);
    scenario_check_init(&check, &scenario);
}

#define ANY "expect:\n  states: any\n"

void test_a_time_after_a_step_is_that_of_the_step_and_so_much_more(void) {
    begin(
        "steps:\n"
        "  - {name: dies, at_ms: 300, ai: stop}\n"
        "  - {name: lives, after: dies, wait: 50ms, ai: start}\n"
        "  - {after: lives, ai: stop}\n"
        "expect:\n  states: [{to: INIT, after: dies, within: 20ms}, {to: STANDBY, after: lives, within: [5ms, 6]}]\n");
    TEST_ASSERT_EQUAL_UINT32(350, scenario.steps[1].at_ms);
    TEST_ASSERT_EQUAL_UINT32(350, scenario.steps[2].at_ms);
    TEST_ASSERT_EQUAL_size_t(0, scenario.waiting_count);
    TEST_ASSERT_EQUAL_UINT32(300, scenario.expect.states.items[0].at_ms.from);
    TEST_ASSERT_EQUAL_UINT32(320, scenario.expect.states.items[0].at_ms.to);
    TEST_ASSERT_EQUAL_UINT32(355, scenario.expect.states.items[1].at_ms.from);
    TEST_ASSERT_EQUAL_UINT32(356, scenario.expect.states.items[1].at_ms.to);
}

void test_a_step_after_an_event_is_due_so_long_after_it_and_once(void) {
    begin("steps:\n"
          "  - {after: trip, wait: 20ms, ai: start}\n"
          "  - {name: early, at_ms: 100, ai: stop}\n"
          "  - {name: again, after: trip 2, operator: press, button: 1}\n"
          "  - {after: again, wait: 7, operator: release, button: 1}\n" ANY);
    TEST_ASSERT_NULL(scenario_player_next(&player, 99));
    TEST_ASSERT_EQUAL_PTR(&scenario.steps[1], scenario_player_next(&player, 100));
    trip(200);
    TEST_ASSERT_NULL(scenario_player_next(&player, 219));
    TEST_ASSERT_EQUAL_PTR(&scenario.steps[0], scenario_player_next(&player, 220));
    TEST_ASSERT_NULL(scenario_player_next(&player, 300));
    change(310, AGV_STATE_SAFE, AGV_STATE_TRIPPED); /* a confirmation withdrawn is no second trip */
    TEST_ASSERT_NULL(scenario_player_next(&player, 399));
    trip(400);
    TEST_ASSERT_EQUAL_PTR(&scenario.steps[2], scenario_player_next(&player, 400));
    TEST_ASSERT_NULL(scenario_player_next(&player, 406));
    TEST_ASSERT_EQUAL_PTR(&scenario.steps[3], scenario_player_next(&player, 407));
    TEST_ASSERT_NULL(scenario_player_next(&player, 1000));
}

void test_every_event_has_its_word(void) {
    static const struct {
        const char *word;
        agv_state_t to;
    } rows[] = {{"standby", AGV_STATE_STANDBY},
                {"active", AGV_STATE_ACTIVE},
                {"trip", AGV_STATE_TRIPPED},
                {"safe", AGV_STATE_SAFE}};
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        scenario_anchor_t anchor;
        uint64_t at_ms = 0;
        TEST_ASSERT_TRUE(scenario_anchor_read(rows[i].word, &anchor));
        TEST_ASSERT_FALSE(scenario_events_find(&events, anchor, &at_ms));
        change(10 + i, AGV_STATE_INIT, rows[i].to);
        TEST_ASSERT_TRUE(scenario_events_find(&events, anchor, &at_ms));
        TEST_ASSERT_EQUAL_UINT64(10 + i, at_ms);
    }
    scenario_anchor_t reset;
    uint64_t at_ms = 0;
    session_event_t event = {.t_ms = 50, .recorded = {.kind = (uint8_t)AGV_EVENT_RESET, .a = 0}};
    TEST_ASSERT_TRUE(scenario_anchor_read("reset", &reset));
    TEST_ASSERT_FALSE(scenario_events_note(&events, &event)); /* refused */
    event.recorded.a = 1;
    TEST_ASSERT_TRUE(scenario_events_note(&events, &event));
    TEST_ASSERT_TRUE(scenario_events_find(&events, reset, &at_ms));
    TEST_ASSERT_EQUAL_UINT64(50, at_ms);
    TEST_ASSERT_TRUE(scenario_anchor_read("trip 9", &reset));
    TEST_ASSERT_FALSE(scenario_anchor_read("trip 10", &reset));
    TEST_ASSERT_FALSE(scenario_anchor_read("trip 0", &reset));
    TEST_ASSERT_FALSE(scenario_anchor_read("trips", &reset));
    TEST_ASSERT_FALSE(scenario_anchor_read("", &reset));
}

#define FRAME "expect:\n  states: any\n  frames: [{id: 168h, after: trip, within: [2, 5]}]\n"

void test_a_frame_within_a_time_after_the_trip(void) {
    begin(FRAME);
    trip(100);
    gear_frame(105, 8);
    expect_failure(NULL);
    trip(100);
    gear_frame(106, 8);
    expect_failure("line 6: 168h is expected at least once in 102..105 ms, seen: 0 (one at 106 ms)");
    gear_frame(3, 8);
    expect_failure("line 6: 168h is expected at least once 2..5 ms after trip, seen: 0 (one at 3 ms)");
}

/* With a tolerance of 50 ms, "within: [2, 5]" is 48 ms before the trip to 55 ms after it. */
static void tolerated(uint32_t sent_ms, const char *failure) {
    begin(FRAME);
    check.expect.frames.items[0].at_ms.from = 0;
    check.expect.frames.items[0].at_ms.to = 55;
    check.expect.frames.items[0].at_ms.early = 48;
    trip(100);
    gear_frame(sent_ms, 8);
    expect_failure(failure);
}

void test_a_tolerance_begins_before_the_trip(void) {
    tolerated(51, "line 6: 168h is expected at least once in 52..155 ms, seen: 0 (one at 51 ms)");
    tolerated(52, NULL);
    tolerated(155, NULL);
    tolerated(156, "line 6: 168h is expected at least once in 52..155 ms, seen: 0 (one at 156 ms)");
}

void test_a_period_that_begins_with_an_event(void) {
    begin("expect:\n  states: any\n  frames: [{id: 168h, after: trip, within: 100ms, every_ms: 40}]\n");
    trip(100);
    gear_frame(130, 8);
    gear_frame(170, 8);
    expect_failure(NULL);
    trip(100);
    gear_frame(143, 8);
    gear_frame(183, 8);
    expect_failure("line 6: 168h is expected every 40 ms, seen: 43 ms after the previous one at 100 ms");
}

#define NEVER "expect:\n  states: any\n  never: [{id: 168h, after: trip 2, within: 50ms}]\n"

void test_a_frame_that_must_not_come_after_an_event(void) {
    begin(NEVER);
    gear_frame(20, 8);
    trip(100);
    gear_frame(110, 8);
    trip(200);
    gear_frame(251, 8);
    expect_failure(NULL);
    trip(100);
    trip(200);
    gear_frame(250, 8);
    expect_failure("line 6: a frame is forbidden in 200..250 ms, seen: 168h [08 00 00 00 00 00 00 00] at 250 ms");
    trip(100);
    expect_failure("line 6: a frame is forbidden after trip 2, which was not seen");
}

void test_a_state_after_a_state(void) {
    begin("expect:\n  states: [{to: TRIPPED, at_ms: [1, 900]}, {to: SAFE, after: trip, within: 300ms}]\n");
    trip(100);
    change(400, AGV_STATE_TRIPPED, AGV_STATE_SAFE);
    expect_failure(NULL);
    trip(100);
    change(401, AGV_STATE_TRIPPED, AGV_STATE_SAFE);
    expect_failure("line 5: SAFE (no reason) is expected in 100..400 ms, seen: SAFE (no reason) at 401 ms");
}

static void led(uint64_t t_ms, int8_t code) {
    const session_event_t event = {.t_ms = t_ms, .is_led = true, .led_code = code};
    scenario_check_event(&check, &event);
}

#define LED "expect:\n  states: any\n  led: [{code: 14, after: trip, within: 50ms}]\n"

void test_the_led_at_some_time(void) {
    begin(LED);
    led(0, 0);
    trip(100);
    led(150, 14);
    led(151, 3);
    expect_failure(NULL);
    led(0, 0);
    trip(100);
    led(151, 14);
    expect_failure("line 6: LED code 14 is expected in 100..150 ms, not seen");
    led(0, 14);
    expect_failure("line 6: LED code 14 is expected 0..50 ms after trip, not seen");
}

static void vehicle(uint32_t t_ms, uint8_t gear) {
    const vehicle_view_t view = {.gear = gear};
    if (scenario_check_wants_vehicle(&check, t_ms)) {
        scenario_check_vehicle(&check, t_ms, &view);
    }
}

#define VEHICLE "expect:\n  states: any\n  vehicle: [{gear: P, after: trip, within: 3ms}]\n"

void test_the_vehicle_at_some_time(void) {
    begin(VEHICLE);
    vehicle(99, 8);
    trip(100);
    vehicle(100, 1);
    vehicle(101, 8);
    vehicle(102, 1);
    vehicle(103, 1);
    expect_failure(NULL);
    trip(100);
    for (uint32_t t_ms = 100; t_ms <= 110; t_ms++) {
        vehicle(t_ms, (t_ms > 103) ? 8 : 1);
    }
    expect_failure("line 6: vehicle in 100..103 ms: gear (P 8, R 2, N 4, D 1) 8h is expected, seen: 1h");
    vehicle(5, 8);
    expect_failure("line 6: vehicle 0..3 ms after trip: the expected values were not seen before the end of the run");
}

void test_what_makes_no_sense_is_refused_with_its_line(void) {
    static const struct {
        const char *text;
        const char *said;
    } rows[] = {
        {"steps:\n  - {after: dawn, ai: stop}\n" ANY, "s.yaml:5: after: 'dawn' is neither the name of a step before"},
        {"steps:\n  - {after: b, ai: stop}\n  - {name: b, at_ms: 1, ai: stop}\n" ANY,
         "s.yaml:5: after: 'b' is neither"},
        {"steps:\n  - {name: b, after: b, ai: stop}\n" ANY, "s.yaml:5: after: 'b' is neither"},
        {"steps:\n  - {name: b, at_ms: 1, ai: stop}\n  - {name: b, at_ms: 2, ai: stop}\n" ANY,
         "s.yaml:6: name: the step on line 5 has this name, too"},
        {"steps:\n  - {name: trip 2, at_ms: 1, ai: stop}\n" ANY, "s.yaml:5: name: 'trip 2' is the name of an event"},
        {"steps:\n  - {name: a-name-that-is-longer-than-it-may-be, at_ms: 1, ai: stop}\n" ANY,
         "s.yaml:5: name: longer than 31 bytes"},
        {"steps:\n  - {at_ms: 1, after: trip, ai: stop}\n" ANY, "s.yaml:5: a step: either 'at_ms' or 'after'"},
        {"steps:\n  - {after: trip, after: trip, ai: stop}\n" ANY, "s.yaml:5: 'after' is given twice"},
        {"steps:\n  - {at_ms: 1, wait: 5ms, ai: stop}\n" ANY, "s.yaml:5: a step: 'wait' needs 'after'"},
        {"steps:\n  - {after: trip, wait: 2s, ai: stop}\n" ANY, "s.yaml:5: 2000 ms is after the end"},
        {"steps:\n  - {after: [trip], ai: stop}\n" ANY, "s.yaml:5: after: a word or a text is missing"},
        {"expect:\n  states: [{to: INIT, after: trip}]\n", "s.yaml:5: a state: 'within' is missing"},
        {"expect:\n  states: [{to: INIT, within: 5}]\n", "s.yaml:5: a state: 'within' needs 'after'"},
        {"expect:\n  states: [{to: INIT, at_ms: 0, after: trip, within: 5}]\n",
         "s.yaml:5: a state: either 'at_ms' or 'after'"},
        {"expect:\n  states: [{to: INIT, after: nobody, within: 5}]\n", "s.yaml:5: after: 'nobody' is neither"},
        {"expect:\n  states: [{to: INIT, after: trip, within: [6, 5]}]\n",
         "s.yaml:5: within: the lowest value is above"},
        {"expect:\n  states: []\n  faults: [{name: BUS_OFF, after: trip}]\n", "s.yaml:6: a fault: 'within' is missing"},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        read_bad(rows[i].text, rows[i].said);
    }
}

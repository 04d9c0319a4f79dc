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
    const hal_can_frame_t frame = {.id = 0x168, .length = 8u, .data = {gear}};
    scenario_check_frame(&check, t_ms * 1000u, HAL_CAN_VEHICLE, SCENARIO_FROM_SUPERVISOR, &frame);
}

/* The run is over; this is the one failure (NULL: there is none). Another run with these expectations begins. */
static void expect_failure(const char *failure) {
    scenario_check_finish(&check, &counters);
    TEST_ASSERT_EQUAL_STRING((failure != NULL) ? failure : "", check.failures[0]);
    TEST_ASSERT_EQUAL_size_t((failure != NULL) ? 1u : 0u, check.failure_count);
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
    TEST_ASSERT_EQUAL_UINT32(350u, scenario.steps[1].at_ms);
    TEST_ASSERT_EQUAL_UINT32(350u, scenario.steps[2].at_ms);
    TEST_ASSERT_EQUAL_size_t(0u, scenario.waiting_count);
    TEST_ASSERT_EQUAL_UINT32(300u, scenario.expect.states.items[0].at_ms.from);
    TEST_ASSERT_EQUAL_UINT32(320u, scenario.expect.states.items[0].at_ms.to);
    TEST_ASSERT_EQUAL_UINT32(355u, scenario.expect.states.items[1].at_ms.from);
    TEST_ASSERT_EQUAL_UINT32(356u, scenario.expect.states.items[1].at_ms.to);
}

void test_a_step_after_an_event_is_due_so_long_after_it_and_once(void) {
    begin("steps:\n"
          "  - {after: trip, wait: 20ms, ai: start}\n"
          "  - {name: early, at_ms: 100, ai: stop}\n"
          "  - {name: again, after: trip 2, operator: press, button: 1}\n"
          "  - {after: again, wait: 7, operator: release, button: 1}\n" ANY);
    TEST_ASSERT_NULL(scenario_player_next(&player, 99u));
    TEST_ASSERT_EQUAL_PTR(&scenario.steps[1], scenario_player_next(&player, 100u));
    trip(200u);
    TEST_ASSERT_NULL(scenario_player_next(&player, 219u));
    TEST_ASSERT_EQUAL_PTR(&scenario.steps[0], scenario_player_next(&player, 220u));
    TEST_ASSERT_NULL(scenario_player_next(&player, 300u));
    change(310u, AGV_STATE_SAFE, AGV_STATE_TRIPPED); /* a confirmation withdrawn is no second trip */
    TEST_ASSERT_NULL(scenario_player_next(&player, 399u));
    trip(400u);
    TEST_ASSERT_EQUAL_PTR(&scenario.steps[2], scenario_player_next(&player, 400u));
    TEST_ASSERT_NULL(scenario_player_next(&player, 406u));
    TEST_ASSERT_EQUAL_PTR(&scenario.steps[3], scenario_player_next(&player, 407u));
    TEST_ASSERT_NULL(scenario_player_next(&player, 1000u));
}

void test_every_event_has_its_word(void) {
    static const struct {
        const char *word;
        agv_state_t to;
    } rows[] = {{"standby", AGV_STATE_STANDBY},
                {"active", AGV_STATE_ACTIVE},
                {"trip", AGV_STATE_TRIPPED},
                {"safe", AGV_STATE_SAFE}};
    for (size_t i = 0u; i < sizeof rows / sizeof rows[0]; i++) {
        scenario_anchor_t anchor;
        uint64_t at_ms = 0u;
        TEST_ASSERT_TRUE(scenario_anchor_read(rows[i].word, &anchor));
        TEST_ASSERT_FALSE(scenario_events_find(&events, anchor, &at_ms));
        change(10u + i, AGV_STATE_INIT, rows[i].to);
        TEST_ASSERT_TRUE(scenario_events_find(&events, anchor, &at_ms));
        TEST_ASSERT_EQUAL_UINT64(10u + i, at_ms);
    }
    scenario_anchor_t reset;
    uint64_t at_ms = 0u;
    session_event_t event = {.t_ms = 50u, .recorded = {.kind = (uint8_t)AGV_EVENT_RESET, .a = 0u}};
    TEST_ASSERT_TRUE(scenario_anchor_read("reset", &reset));
    TEST_ASSERT_FALSE(scenario_events_note(&events, &event)); /* refused */
    event.recorded.a = 1u;
    TEST_ASSERT_TRUE(scenario_events_note(&events, &event));
    TEST_ASSERT_TRUE(scenario_events_find(&events, reset, &at_ms));
    TEST_ASSERT_EQUAL_UINT64(50u, at_ms);
    TEST_ASSERT_TRUE(scenario_anchor_read("trip 9", &reset));
    TEST_ASSERT_FALSE(scenario_anchor_read("trip 10", &reset));
    TEST_ASSERT_FALSE(scenario_anchor_read("trip 0", &reset));
    TEST_ASSERT_FALSE(scenario_anchor_read("trips", &reset));
    TEST_ASSERT_FALSE(scenario_anchor_read("", &reset));
}

#define FRAME "expect:\n  states: any\n  frames: [{id: 168h, after: trip, within: [2, 5]}]\n"

void test_a_frame_within_a_time_after_the_trip(void) {
    begin(FRAME);
    trip(100u);
    gear_frame(105u, 8u);
    expect_failure(NULL);
    trip(100u);
    gear_frame(106u, 8u);
    expect_failure("line 6: 168h is expected at least once in 102..105 ms, seen: 0 (one at 106 ms)");
    gear_frame(3u, 8u);
    expect_failure("line 6: 168h is expected at least once 2..5 ms after trip, seen: 0 (one at 3 ms)");
}

/* With a tolerance of 50 ms, "within: [2, 5]" is 48 ms before the trip to 55 ms after it. */
static void tolerated(uint32_t sent_ms, const char *failure) {
    begin(FRAME);
    check.expect.frames.items[0].at_ms.from = 0u;
    check.expect.frames.items[0].at_ms.to = 55u;
    check.expect.frames.items[0].at_ms.early = 48u;
    trip(100u);
    gear_frame(sent_ms, 8u);
    expect_failure(failure);
}

void test_a_tolerance_begins_before_the_trip(void) {
    tolerated(51u, "line 6: 168h is expected at least once in 52..155 ms, seen: 0 (one at 51 ms)");
    tolerated(52u, NULL);
    tolerated(155u, NULL);
    tolerated(156u, "line 6: 168h is expected at least once in 52..155 ms, seen: 0 (one at 156 ms)");
}

void test_a_period_that_begins_with_an_event(void) {
    begin("expect:\n  states: any\n  frames: [{id: 168h, after: trip, within: 100ms, every_ms: 40}]\n");
    trip(100u);
    gear_frame(130u, 8u);
    gear_frame(170u, 8u);
    expect_failure(NULL);
    trip(100u);
    gear_frame(143u, 8u);
    gear_frame(183u, 8u);
    expect_failure("line 6: 168h is expected every 40 ms, seen: 43 ms after the previous one at 100 ms");
}

#define NEVER "expect:\n  states: any\n  never: [{id: 168h, after: trip 2, within: 50ms}]\n"

void test_a_frame_that_must_not_come_after_an_event(void) {
    begin(NEVER);
    gear_frame(20u, 8u);
    trip(100u);
    gear_frame(110u, 8u);
    trip(200u);
    gear_frame(251u, 8u);
    expect_failure(NULL);
    trip(100u);
    trip(200u);
    gear_frame(250u, 8u);
    expect_failure("line 6: a frame is forbidden in 200..250 ms, seen: 168h [08 00 00 00 00 00 00 00] at 250 ms");
    trip(100u);
    expect_failure("line 6: a frame is forbidden after trip 2, which was not seen");
}

void test_a_state_after_a_state(void) {
    begin("expect:\n  states: [{to: TRIPPED, at_ms: [1, 900]}, {to: SAFE, after: trip, within: 300ms}]\n");
    trip(100u);
    change(400u, AGV_STATE_TRIPPED, AGV_STATE_SAFE);
    expect_failure(NULL);
    trip(100u);
    change(401u, AGV_STATE_TRIPPED, AGV_STATE_SAFE);
    expect_failure("line 5: SAFE (no reason) is expected in 100..400 ms, seen: SAFE (no reason) at 401 ms");
}

static void led(uint64_t t_ms, int8_t code) {
    const session_event_t event = {.t_ms = t_ms, .is_led = true, .led_code = code};
    scenario_check_event(&check, &event);
}

#define LED "expect:\n  states: any\n  led: [{code: 14, after: trip, within: 50ms}]\n"

void test_the_led_at_some_time(void) {
    begin(LED);
    led(0u, 0);
    trip(100u);
    led(150u, 14);
    led(151u, 3);
    expect_failure(NULL);
    led(0u, 0);
    trip(100u);
    led(151u, 14);
    expect_failure("line 6: LED code 14 is expected in 100..150 ms, not seen");
    led(0u, 14);
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
    vehicle(99u, 8u);
    trip(100u);
    vehicle(100u, 1u);
    vehicle(101u, 8u);
    vehicle(102u, 1u);
    vehicle(103u, 1u);
    expect_failure(NULL);
    trip(100u);
    for (uint32_t t_ms = 100u; t_ms <= 110u; t_ms++) {
        vehicle(t_ms, (t_ms > 103u) ? 8u : 1u);
    }
    expect_failure("line 6: vehicle in 100..103 ms: gear (P 8, R 2, N 4, D 1) 8h is expected, seen: 1h");
    vehicle(5u, 8u);
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
    for (size_t i = 0u; i < sizeof rows / sizeof rows[0]; i++) {
        read_bad(rows[i].text, rows[i].said);
    }
}

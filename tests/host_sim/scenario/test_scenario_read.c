/* Scenario files: what they may say, and what is refused with its line. */
#include <stdio.h>
#include <string.h>

#include "hal/self_test.h"
#include "scenario/scenario.h"
#include "scratch.h"
#include "unity.h"

static scenario_t scenario;
static scenario_options_t options;

void setUp(void) {
    scratch_open();
    agv_config_defaults(&options.config);
    options.topology = -1;
    options.id_set = -1;
}

static bool read_text(const char *text) {
    return scenario_read_text(&scenario, "s.yaml", text, &options);
}

static void read_good(const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(read_text(text), scratch_said());
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
}

/* It is refused with one line, which names the file and holds this. */
static void read_bad(const char *text, const char *expected) {
    TEST_ASSERT_FALSE_MESSAGE(read_text(text), text);
    const char *place = scratch_said_line("s.yaml");
    TEST_ASSERT_NOT_NULL_MESSAGE(strstr(place, expected), place);
}

#define HEAD "name: n\nshows: [SUP-2]\nduration_ms: 1000\n"
#define STATES "expect: {states: []}\n"
/* A file with this step (on line 5) or expectation (on line 6). */
#define STEP(text) HEAD "steps:\n  - {" text "}\n" STATES
#define EXPECT(text) HEAD "expect:\n  states: []\n  " text "\n"

void test_the_least_that_a_file_needs(void) {
    read_good(HEAD STATES);
    TEST_ASSERT_EQUAL_STRING("n", scenario.name);
    TEST_ASSERT_EQUAL_UINT32(1000, scenario.duration_ms);
    TEST_ASSERT_EQUAL_UINT32(500000, scenario.bitrate);
    TEST_ASSERT_EQUAL(HAL_RESET_POWER_ON, scenario.reset_cause);
    TEST_ASSERT_EQUAL_HEX32(0, scenario.board.failed);
    TEST_ASSERT_TRUE(scenario.vehicle.park_guard);
    TEST_ASSERT_FALSE(scenario.fixes_topology);
    TEST_ASSERT_EQUAL_size_t(1, scenario.shows_count);
}

void test_everything_about_the_beginning(void) {
    read_good("steps: []\nname: n\nshows: [P15, FSM-10, HW-4, LED-1, BUS_OFF]\n"
              "description: d\ntopology: gateway\nid_set: table\n"
              "config: {park: at_standstill, vcu_heartbeat_timeout_ms: 60}\nself_test: failed\nbitrate: 250000\n"
              "clock_start_ms: 4294967295\nhardware_watchdog: none\nreset_cause: brown-out\nduration_ms: 86400000\n"
              "vehicle: {park_guard: false, obeys_short_frames: true, vcu_starts_ms: 5, eps_starts_ms: never, "
              "ai_starts_ms: 0, seed: 7, top_speed_mm_s: 3000, eps_lost_ms: 9, id_set: heading}\n" STATES);
    TEST_ASSERT_EQUAL_UINT16(AGV_TOPOLOGY_GATEWAY, scenario.config.topology);
    TEST_ASSERT_EQUAL_UINT16(AGV_ID_SET_TABLE, scenario.config.id_set);
    TEST_ASSERT_EQUAL_UINT16(AGV_PARK_AT_STANDSTILL, scenario.config.park);
    TEST_ASSERT_EQUAL_UINT16(60, scenario.config.vcu_heartbeat_timeout_ms);
    TEST_ASSERT_EQUAL_HEX32(HAL_SELF_TEST_PROCESSOR, scenario.board.failed);
    TEST_ASSERT_EQUAL_UINT32(250000, scenario.bitrate);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, scenario.clock_start_ms);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, scenario.watchdog_ms);
    TEST_ASSERT_EQUAL(HAL_RESET_BROWN_OUT, scenario.reset_cause);
    TEST_ASSERT_TRUE(scenario.vehicle.gateway);
    TEST_ASSERT_EQUAL_HEX16(0x43F, scenario.vehicle.ids.of[AGV_MSG_TURN_SIGNAL_COMMAND]);
    TEST_ASSERT_FALSE(scenario.vehicle.park_guard);
    TEST_ASSERT_TRUE(scenario.vehicle.obeys_short_frames);
    TEST_ASSERT_EQUAL_UINT32(5, scenario.vehicle.start_ms[VEHICLE_VCU]);
    TEST_ASSERT_EQUAL_UINT32(VEHICLE_NEVER, scenario.vehicle.start_ms[VEHICLE_EPS]);
    TEST_ASSERT_EQUAL_UINT32(7, scenario.vehicle.seed);
    TEST_ASSERT_EQUAL_UINT16(3000, scenario.vehicle.top_speed_mm_s);
}

void test_times_with_units_and_identifiers_in_any_notation(void) {
    read_good(
        "name: n\nshows: [SUP-2]\nduration_ms: 1.5min\ntick_phase_us: 0.5ms\nclock_start_ms: 1min\n"
        "vehicle: {vcu_starts_ms: 2 s, eps_lost_ms: 0.09s, gear_change_ms: 120ms, phases_ms: {gear_status: 3ms}}\n"
        "steps:\n"
        "  - {at_ms: 2s, ai: lag, by_ms: 0.25s}\n"
        "  - {at_ms: 2001, bus: send, id: 0x168, bytes: \"01\"}\n"
        "  - {at_ms: 3s, bus: send, id: 360, bytes: \"01\"}\n"
        "expect:\n  states: []\n  frames: [{id: 168h, at_ms: [1s, 1500], jitter_ms: 3000us}]\n"
        "  faults: [{name: BUS_OFF, raised_ms: 1s, ended_ms: [1s, 2s]}]\n");
    TEST_ASSERT_EQUAL_UINT32(90000, scenario.duration_ms);
    TEST_ASSERT_EQUAL_UINT32(500, scenario.tick_phase_us);
    TEST_ASSERT_EQUAL_UINT32(60000, scenario.clock_start_ms);
    TEST_ASSERT_EQUAL_UINT32(2000, scenario.vehicle.start_ms[VEHICLE_VCU]);
    TEST_ASSERT_EQUAL_UINT16(120, scenario.vehicle.gear_change_ms);
    TEST_ASSERT_EQUAL_UINT16(3, scenario.vehicle.phase_ms[AGV_MSG_GEAR_STATUS]);
    TEST_ASSERT_EQUAL_UINT16(90, scenario.vehicle.eps_lost_ms);
    TEST_ASSERT_EQUAL_UINT32(2000, scenario.steps[0].at_ms);
    TEST_ASSERT_EQUAL_UINT32(250, scenario.steps[0].vehicle.ms);
    TEST_ASSERT_EQUAL_HEX32(0x168, scenario.steps[1].vehicle.frame.id);
    TEST_ASSERT_EQUAL_HEX32(0x168, scenario.steps[2].vehicle.frame.id);
    TEST_ASSERT_EQUAL_HEX32(0x168, scenario.expect.frames.items[0].id);
    TEST_ASSERT_EQUAL_UINT32(1000, scenario.expect.frames.items[0].at_ms.from);
    TEST_ASSERT_EQUAL_UINT32(1500, scenario.expect.frames.items[0].at_ms.to);
    TEST_ASSERT_EQUAL_UINT32(3, scenario.expect.frames.items[0].jitter_ms);
    TEST_ASSERT_EQUAL_UINT32(2000, scenario.expect.faults.items[0].ended_ms.to);
}

/* Shows: HW-1, HW-2, HW-3, HW-4 */
void test_the_board_and_what_happens_to_it(void) {
    read_good(HEAD "self_test: [flash, devices]\nboard: [second_clock, output_feedback, reset_button, emergency_stop]\n"
                   "steps:\n"
                   "  - {at_ms: 1, board: weld_contact}\n"
                   "  - {at_ms: 2, board: stick_contact}\n"
                   "  - {at_ms: 3, board: repair_contact}\n"
                   "  - {at_ms: 4, board: invert_feedback}\n"
                   "  - {at_ms: 5, board: open_emergency_stop}\n"
                   "  - {at_ms: 6, board: close_emergency_stop}\n"
                   "  - {at_ms: 7, board: press}\n"
                   "  - {at_ms: 8, board: release}\n"
                   "  - {at_ms: 9, board: bounce, pattern_ms: [1, 10000]}\n"
                   "  - {at_ms: 10, board: slow_clock, permille: 900}\n"
                   "  - {at_ms: 11, board: fast_clock, permille: 60}\n"
                   "  - {at_ms: 12, board: right_clock}\n"
                   "  - {at_ms: 13, board: fail_test, part: ram}\n" STATES);
    TEST_ASSERT_TRUE(scenario.board.has_feedback && scenario.board.has_emergency_stop);
    TEST_ASSERT_TRUE(scenario.board.has_reset_button && scenario.board.has_second_clock);
    TEST_ASSERT_EQUAL_HEX32(HAL_SELF_TEST_FLASH | HAL_SELF_TEST_DEVICES, scenario.board.failed);
    static const scenario_do_t expected[] = {
        SCENARIO_CONTACT_WELDED, SCENARIO_CONTACT_STUCK, SCENARIO_CONTACT_WORKS, SCENARIO_FEEDBACK_INVERTED,
        SCENARIO_STOP_OPEN,      SCENARIO_STOP_OPEN,     SCENARIO_BUTTON,        SCENARIO_BUTTON,
        SCENARIO_BUTTON_BOUNCES, SCENARIO_CLOCK,         SCENARIO_CLOCK,         SCENARIO_CLOCK,
        SCENARIO_TEST_FAILS};
    TEST_ASSERT_EQUAL_size_t(13, scenario.step_count);
    for (size_t i = 0; i < 13; i++) {
        TEST_ASSERT_FALSE(scenario.steps[i].of_vehicle);
        TEST_ASSERT_EQUAL(expected[i], scenario.steps[i].supervisor.what);
    }
    TEST_ASSERT_TRUE(scenario.steps[4].supervisor.on);
    TEST_ASSERT_FALSE(scenario.steps[5].supervisor.on);
    TEST_ASSERT_TRUE(scenario.steps[6].supervisor.on);
    TEST_ASSERT_FALSE(scenario.steps[7].supervisor.on);
    TEST_ASSERT_EQUAL_UINT8(2, scenario.steps[8].supervisor.bounce_count);
    TEST_ASSERT_EQUAL_UINT16(10000, scenario.steps[8].supervisor.bounce_ms[1]);
    TEST_ASSERT_EQUAL_INT16(900, scenario.steps[9].supervisor.permille);
    TEST_ASSERT_EQUAL_INT16(-60, scenario.steps[10].supervisor.permille);
    TEST_ASSERT_EQUAL_INT16(0, scenario.steps[11].supervisor.permille);
    TEST_ASSERT_EQUAL_HEX32(HAL_SELF_TEST_RAM, scenario.steps[12].supervisor.parts);
}

void test_steps_become_actions(void) {
    read_good(HEAD "steps:\n"
                   "  - {at_ms: 1, ai: drive, gear: R, throttle_pct: 25, steer_deg: -90}\n"
                   "  - {at_ms: 2, eps: set, field: angle, value: 4651h, frames: 3}\n"
                   "  - {at_ms: 3, vcu: set, field: mode_bits, value: 3h}\n"
                   "  - {at_ms: 4, ai: set_bytes, message: gear_command, bytes: \"01 .. .. .. .. .. .. FF\"}\n"
                   "  - {at_ms: 5, bus: send, id: 1ABCDEFFh, kind: extended, bytes: \"01 02\", every_ms: 5}\n"
                   "  - {at_ms: 6, supervisor: restart, cause: lock-up, off_ms: 20}\n"
                   "  - {at_ms: 7, bus: destroy, frames: 3}\n"
                   "  - {at_ms: 8, operator: press, button: 2}\n"
                   "  - {at_ms: 9, bus: deliver, kind: fd, message: vehicle_status, bytes: \"\"}\n" STATES);
    TEST_ASSERT_EQUAL_size_t(9, scenario.step_count);
    const scenario_step_t *step = scenario.steps;
    TEST_ASSERT_EQUAL(VEHICLE_DO_AI_DRIVE, step[0].vehicle.what);
    TEST_ASSERT_EQUAL_UINT8(AGV_GEAR_R, step[0].vehicle.gear);
    TEST_ASSERT_EQUAL_UINT16(250, step[0].vehicle.throttle_permille);
    TEST_ASSERT_EQUAL_INT32(-900, step[0].vehicle.angle_ddeg);
    TEST_ASSERT_EQUAL_HEX8(0x51u, step[1].vehicle.value[2]);
    TEST_ASSERT_EQUAL_HEX8(0x46u, step[1].vehicle.value[3]);
    TEST_ASSERT_EQUAL_HEX8(0xFFu, step[1].vehicle.keep[1]);
    TEST_ASSERT_EQUAL_HEX8(0x00u, step[1].vehicle.keep[2]);
    TEST_ASSERT_EQUAL_UINT16(3, step[1].vehicle.count);
    TEST_ASSERT_EQUAL_HEX8(0xC0u, step[2].vehicle.value[6]);
    TEST_ASSERT_EQUAL_HEX8(0x3Fu, step[2].vehicle.keep[6]);
    TEST_ASSERT_EQUAL_UINT16(VEHICLE_FOREVER, step[2].vehicle.count);
    TEST_ASSERT_EQUAL_HEX8(0xFFu, step[3].vehicle.keep[1]);
    TEST_ASSERT_EQUAL_HEX8(0x00u, step[3].vehicle.keep[7]);
    TEST_ASSERT_EQUAL_HEX32(0x1ABCDEFFu, step[4].vehicle.frame.id);
    TEST_ASSERT_EQUAL_UINT8(2, step[4].vehicle.frame.length);
    TEST_ASSERT_EQUAL_UINT16(VEHICLE_FOREVER, step[4].vehicle.count);
    TEST_ASSERT_EQUAL(HAL_RESET_LOCK_UP, step[5].supervisor.cause);
    TEST_ASSERT_EQUAL_UINT32(20, step[5].supervisor.ms);
    TEST_ASSERT_FALSE(step[5].of_vehicle);
    TEST_ASSERT_EQUAL_UINT32(3, step[6].supervisor.ms);
    TEST_ASSERT_EQUAL_UINT16(2, step[7].vehicle.count);
    TEST_ASSERT_EQUAL_HEX32(0x363u, step[8].supervisor.frame.id);
    TEST_ASSERT_EQUAL_STRING("bus", step[8].actor);
}

void test_expectations_are_read(void) {
    read_good(HEAD
              "expect:\n"
              "  states: [{to: INIT, at_ms: 0}, {to: TRIPPED, reason: BUS_OFF, at_ms: [5, 9]}]\n"
              "  frames: [{id: 168h, bytes: \"08 .. 00\", at_ms: [1, 2], first_since_ms: 1, count: 3, every_ms: 9, "
              "jitter_ms: 0, side: ai, from: ai}]\n"
              "  never: [{}]\n"
              "  safety_output: [{closed: true, at_ms: 7}]\n"
              "  led: [{code: -1, at_ms: [3, 4]}]\n"
              "  faults: [{name: BUS_OFF, class: trip, raised_ms: 3, ended_ms: never}, {name: BUS_OFF, raised_ms: 3, "
              "ended_ms: 4}]\n"
              "  other_faults: never\n"
              "  resets: [{accepted: true, at_ms: 3}, {accepted: false, why: [button, manual], at_ms: 4}]\n"
              "  startup: [{missing: [messages], at_ms: 4}]\n"
              "  vehicle: [{at_ms: 9, gear: N, mode: autopilot, speed_mm_s: [-5, 5], throttle_pct: 0, eps_mode: angle, "
              "angle_deg: -3, park_taken_at_mm_s: 0, alarms: 0x18}]\n"
              "  counters_at_end: {sent: 0, rejected_fd: [1, 2]}\n");
    const scenario_expect_t *expect = &scenario.expect;
    TEST_ASSERT_EQUAL_size_t(2, expect->states.count);
    TEST_ASSERT_EQUAL(AGV_FAULT_BUS_OFF, expect->states.items[1].reason);
    TEST_ASSERT_EQUAL_UINT32(9, expect->states.items[1].at_ms.to);
    TEST_ASSERT_EQUAL_UINT8(3, expect->frames.items[0].length);
    TEST_ASSERT_EQUAL_HEX8(0, expect->frames.items[0].mask[1]);
    TEST_ASSERT_EQUAL(VEHICLE_AI, expect->frames.items[0].from);
    TEST_ASSERT_EQUAL_UINT32(3, expect->frames.items[0].count.to);
    TEST_ASSERT_EQUAL_HEX32(0x168u, scenario_frame_id(&scenario, &expect->frames.items[0]));
    TEST_ASSERT_EQUAL_HEX32(SCENARIO_NO_ID, scenario_frame_id(&scenario, &expect->never.items[0]));
    TEST_ASSERT_EQUAL_INT8(-1, expect->leds.items[0].code);
    TEST_ASSERT_TRUE(expect->faults.items[0].never_ends);
    TEST_ASSERT_FALSE(expect->faults.items[1].has_class);
    TEST_ASSERT_TRUE(expect->no_other_faults);
    TEST_ASSERT_EQUAL_HEX8(0x60u, expect->resets.items[1].missing);
    TEST_ASSERT_EQUAL_HEX8(0x80u, expect->startups.items[0].missing);
    TEST_ASSERT_EQUAL_HEX8(0x18u, expect->vehicle.items[0].alarms);
    TEST_ASSERT_EQUAL_INT32(-5, expect->vehicle.items[0].speed_mm_s[0]);
    TEST_ASSERT_EQUAL_size_t(2, expect->counters.count);
}

void test_the_command_line_chooses_what_the_file_leaves_open(void) {
    options.topology = AGV_TOPOLOGY_GATEWAY;
    options.id_set = AGV_ID_SET_TABLE;
    read_good(HEAD STATES);
    TEST_ASSERT_TRUE(scenario.vehicle.gateway);
    TEST_ASSERT_EQUAL_HEX16(0x201, scenario.vehicle.ids.of[AGV_MSG_TURN_SIGNAL_COMMAND]);
    read_good("topology: gateway\nid_set: table\n" HEAD STATES);
    read_bad("topology: shared\n" HEAD STATES, "the file fixes the topology");
    read_bad("id_set: heading\n" HEAD STATES, "the file fixes the ID set");
}

/* A file that is wrong, and what is said about it. */
typedef struct {
    const char *text;
    const char *said;
} bad_t;

static void read_all_bad(const bad_t *rows, size_t count) {
    for (size_t i = 0; i < count; i++) {
        read_bad(rows[i].text, rows[i].said);
    }
}
#define READ_ALL_BAD(rows) read_all_bad((rows), sizeof(rows) / sizeof(rows)[0])

/* Shows: INT-2 */
void test_what_is_wrong_at_the_top_is_refused_with_its_line(void) {
    static const bad_t rows[] = {
        {"", "contains no scenario"},
        {"# nothing\n", "contains no scenario"},
        {"- a list\n", "s.yaml:1: a scenario must be lines of 'key: value'"},
        {"name: [\n", "s.yaml:2: not YAML"},
        {"name: x\n---\nname: y\n", "s.yaml:2: a second YAML document"},
        {"name: x\n", "s.yaml:1: a scenario: 'shows' is missing"},
        {HEAD, "s.yaml:1: a scenario: 'expect' is missing"},
        {HEAD STATES "nmae: x\n", "s.yaml:5: unknown key 'nmae' in a scenario"},
        {HEAD STATES "name: x\n", "s.yaml:5: 'name' is given twice in a scenario"},
        {HEAD STATES "[a]: x\n", "s.yaml:5: a key of a scenario must be a word"},
        {"name:\nshows: [SUP-2]\n", "s.yaml:1: name: a word or a text is missing"},
        {"name: {}\nshows: [SUP-2]\n", "s.yaml:1: name: a word or a text is missing"},
        {"name: n\nshows: SUP-2\n", "s.yaml:2: shows must be a list"},
        {"name: n\nshows: [sup-2]\n", "s.yaml:2: shows: 'sup-2' is neither a requirement"},
        {"name: n\nshows: [BUS_ON]\n", "s.yaml:2: shows: 'BUS_ON' is neither"},
        {"name: n\nshows: [SUP-99]\n", "s.yaml:2: shows: 'SUP-99' is neither"},
        {"name: n\nshows: [SUP-0]\n", "s.yaml:2: shows: 'SUP-0' is neither"},
        {"name: n\nshows: [P999]\n", "s.yaml:2: shows: 'P999' is neither"},
        {"name: n\nshows: [SUP]\n", "s.yaml:2: shows: 'SUP' is neither"},
        {"name: n\nshows: [ABC-1]\n", "s.yaml:2: shows: 'ABC-1' is neither"},
        {"name: n\nshows: [SUP-2]\nduration_ms: 0\n", "s.yaml:3: duration_ms: 0 is not within 1 to 86400000"},
        {"name: n\nshows: [SUP-2]\nduration_ms: 1.5\n", "s.yaml:3: duration_ms: '1.5' is not a time"},
        {"name: n\nshows: [SUP-2]\nduration_ms: 99999999999999999999\n",
         "s.yaml:3: duration_ms: 99999999999999999999 is not"},
        {HEAD STATES "topology: star\n", "s.yaml:5: topology: 'star' is not one of shared, gateway"},
        {HEAD STATES "id_set: new\n", "s.yaml:5: id_set: 'new' is not one of heading, table"},
        {HEAD STATES "bitrate: 300000\n", "s.yaml:5: bitrate: '300000' is not one of 125000"},
        {HEAD STATES "reset_cause: boredom\n", "s.yaml:5: reset_cause: 'boredom' is not one of power-on"},
        {HEAD STATES "clock_start_ms: 4294967296\n", "s.yaml:5: clock_start_ms: 4294967296 is not within"},
        {HEAD STATES "clock_start_ms: -1\n", "s.yaml:5: clock_start_ms: -1 is not within"},
        {HEAD STATES "hardware_watchdog: maybe\n", "s.yaml:5: hardware_watchdog: 'maybe' is not one of fitted, none"},
        {HEAD STATES "self_test: perhaps\n",
         "s.yaml:5: self_test (or a list of parts): 'perhaps' is not one of passed, failed"},
        {HEAD STATES "self_test: [flash, core]\n",
         "s.yaml:5: a part of the self-test: 'core' is not one of flash, ram"},
        {HEAD STATES "board: output_feedback\n", "s.yaml:5: board must be a list"},
        {HEAD STATES "board: [horn]\n", "s.yaml:5: board: 'horn' is not one of output_feedback, emergency_stop"},
        {HEAD STATES "board: [reset_button, reset_button]\n", "s.yaml:5: board: 'reset_button' is given twice"},
        {HEAD STATES "config_unchecked: yes\n", "s.yaml:5: config_unchecked: 'yes' is not one of true, false"},
        {HEAD STATES "description:\n", "s.yaml:5: description: a word"},
        {HEAD STATES "config: 5\n", "s.yaml:5: not a list of settings"},
        {HEAD STATES "config:\n  park: somewhere\n", "s.yaml:6: park: 'somewhere' is not one of"},
        {HEAD STATES "config:\n  vcu_heartbeat_timeout_ms: 29\n",
         "s.yaml:6: vcu_heartbeat_timeout_ms: 29 is not within"},
        {HEAD STATES "config:\n  bogus: 1\n", "s.yaml:6: bogus: unknown setting"},
        {HEAD STATES "config:\n  topology: gateway\n", "s.yaml:6: topology: belongs to the top level"},
        {HEAD STATES "config:\n  own_heartbeat: frozen\n",
         "s.yaml:6: own_heartbeat: has no effect on a shared bus; this value needs the gateway"},
        {HEAD STATES "vehicle: {wings: 2}\n", "s.yaml:5: unknown key 'wings' in vehicle"},
        {HEAD STATES "vehicle: {park_guard: 1}\n", "s.yaml:5: park_guard: '1' is not one of true, false"},
        {HEAD STATES "vehicle: {vcu_starts_ms: soon}\n", "s.yaml:5: start (a time in ms, or never): 'soon' is no"},
        {HEAD STATES "vehicle: {top_speed_mm_s: 65536}\n", "s.yaml:5: top_speed_mm_s: 65536 is not within 1 to 65535"},
        {HEAD STATES "vehicle: {seed: 0}\n", "s.yaml:5: seed: 0 is not within"},
        {HEAD STATES "vehicle: {id_set: x}\n", "s.yaml:5: id_set: 'x' is not one of"},
        {HEAD "expect: {}\n", "s.yaml:4: expect: 'states' is missing"},
    };
    READ_ALL_BAD(rows);
    static char text[400];
    (void)snprintf(text, sizeof text, "name: %0200d\nshows: [SUP-2]\n", 1);
    read_bad(text, "s.yaml:1: name: longer than 95 bytes");
    read_bad("name: \"a\\nb\"\nshows: [SUP-2]\n", "s.yaml:1: name: must be one line of text");
    read_bad("name: \"a\\e[2J\"\nshows: [SUP-2]\n", "s.yaml:1: name: must be one line of text");
}

void test_what_is_wrong_in_a_step_is_refused_with_its_line(void) {
    static const bad_t rows[] = {
        {HEAD "steps: 5\n" STATES, "s.yaml:4: steps must be a list"},
        {HEAD "steps: [5]\n" STATES, "s.yaml:4: a step must be like"},
        {STEP("ai: stop"), "s.yaml:5: a step: 'at_ms' is missing"},
        {STEP("at_ms: 1"), "s.yaml:5: a step: the actor is missing"},
        {STEP("at_ms: 1, at_ms: 2, ai: stop"), "s.yaml:5: 'at_ms' is given twice"},
        {STEP("at_ms: 1, ai: stop, eps: stop"), "s.yaml:5: a step has one actor; 'eps' is the second"},
        {STEP("at_ms: 1, ai: dance"), "s.yaml:5: ai: unknown action 'dance'"},
        {STEP("at_ms: 1, vcu: stick"), "s.yaml:5: vcu: unknown action 'stick'"},
        {STEP("at_ms: {after: x}, ai: stop"), "s.yaml:5: at_ms: a time is missing"},
        {STEP("at_ms: 1, ai: ''"), "s.yaml:5: a step: a word or a text is missing"},
        {STEP("at_ms: 1, ai: stop, speed: 3"), "s.yaml:5: unknown key 'speed' in a step"},
        {STEP("at_ms: 1, ai: stop, frames: 3"), "s.yaml:5: 'stop' takes no 'frames'"},
        {STEP("at_ms: 1, ai: mute"), "s.yaml:5: 'mute' needs 'message'"},
        {STEP("at_ms: 1, ai: mute, message: x"), "s.yaml:5: message: unknown message 'x'"},
        {STEP("at_ms: 1, ai: mute, message: eps_status"), "s.yaml:5: message: another node sends eps_status"},
        {STEP("at_ms: 1, ai: mute, message: gear_command, message: gear_command"),
         "s.yaml:5: 'message' is given twice"},
        {STEP("at_ms: 1, ai: mute, message: gear_command, frames: 0"), "s.yaml:5: frames: 0 is not within 1"},
        {STEP("at_ms: 1, ai: lag, by_ms: 60001"), "s.yaml:5: by_ms: 60001 is not within"},
        {STEP("at_ms: 1, ai: drive, gear: X, throttle_pct: 1"), "s.yaml:5: gear: 'X' is not one of P, R, N, D"},
        {STEP("at_ms: 1, ai: drive, gear: D, throttle_pct: 101"), "s.yaml:5: throttle_pct: 101 is not within 0 to 100"},
        {STEP("at_ms: 1, ai: drive, gear: D, throttle_pct: 1, steer_deg: 901"), "s.yaml:5: steer_deg: 901"},
        {STEP("at_ms: 1, eps: garbage, kind: stinking"), "s.yaml:5: kind: 'stinking' is not one of random"},
        {STEP("at_ms: 1, eps: set, field: colour, value: 1h"), "s.yaml:5: field: this node has no field 'colour'"},
        {STEP("at_ms: 1, eps: set, field: mode, value: 100h"), "s.yaml:5: value: 100h is above FFh"},
        {STEP("at_ms: 1, vcu: set, field: mode_bits, value: 4h"), "s.yaml:5: value: 4h is above 3h"},
        {STEP("at_ms: 1, eps: set, field: mode, value: 12"), "s.yaml:5: value: '12' is not a hexadecimal number"},
        {STEP("at_ms: 1, eps: set, field: mode, value: xh"), "s.yaml:5: value: 'xh' is not a hexadecimal number"},
        {STEP("at_ms: 1, eps: set_bytes, message: eps_status, bytes: \"01\""), "s.yaml:5: bytes: all 8 are needed"},
        {STEP("at_ms: 1, eps: set_bytes, message: eps_status, bytes: \"1 2\""),
         "s.yaml:5: bytes: '1 2' is not a list of up to 8"},
        {STEP("at_ms: 1, bus: send, id: 168h, bytes: \"..\""), "s.yaml:5: bytes: '..' is not a list of up to 8 bytes"},
        {STEP("at_ms: 1, bus: send, id: 168h, bytes: \"1 2 3 4 5 6 7 8 9\""), "s.yaml:5: bytes:"},
        {STEP("at_ms: 1, bus: send, id: 168h, bytes: [1]"), "s.yaml:5: bytes: bytes are missing"},
        {STEP("at_ms: 1, bus: send, bytes: \"01\""), "s.yaml:5: either 'id' or 'message' is needed"},
        {STEP("at_ms: 1, bus: send, id: 1h, message: eps_status, bytes: \"01\""), "s.yaml:5: either 'id' or 'message'"},
        {STEP("at_ms: 1, bus: send, id: 800h, bytes: \"01\""), "s.yaml:5: id: 800h is above 7FFh"},
        {STEP("at_ms: 1, bus: send, id: 1h, kind: odd, bytes: \"01\""), "s.yaml:5: kind: 'odd' is not one of data"},
        {STEP("at_ms: 1, bus: send, side: ai, id: 1h, bytes: \"01\""),
         "s.yaml:5: side: only topology: gateway has an AI side"},
        {STEP("at_ms: 1, bus: send, side: left, id: 1h, bytes: \"01\""),
         "s.yaml:5: side: 'left' is not one of vehicle, ai"},
        {STEP("at_ms: 1, supervisor: restart, cause: x"), "s.yaml:5: cause: 'x' is not one of power-on"},
        {STEP("at_ms: 1, operator: press, button: 3"), "s.yaml:5: button: 3 is not within 1 to 2"},
        {STEP("at_ms: 1001, ai: stop"), "s.yaml:5: 1001 ms is after the end (duration_ms: 1000)"},
        {STEP("at_ms: 1, board: explode"), "s.yaml:5: board: unknown action 'explode'"},
        {STEP("at_ms: 1, board: invert_feedback"), "s.yaml:5: 'invert_feedback' needs a board with 'output_feedback'"},
        {STEP("at_ms: 1, board: open_emergency_stop"), "s.yaml:5: 'open_emergency_stop' needs a board with 'emerg"},
        {STEP("at_ms: 1, board: press"), "s.yaml:5: 'press' needs a board with 'reset_button'"},
        {STEP("at_ms: 1, board: press, button: 1"), "s.yaml:5: 'press' takes no 'button'"},
        {STEP("at_ms: 1, board: right_clock"), "s.yaml:5: 'right_clock' needs a board with 'second_clock'"},
        {STEP("at_ms: 1, board: bounce"), "s.yaml:5: 'bounce' needs 'pattern_ms'"},
        {STEP("at_ms: 1, board: bounce, pattern_ms: 3"), "s.yaml:5: pattern_ms must be a list"},
        {STEP("at_ms: 1, board: bounce, pattern_ms: []"), "s.yaml:5: pattern_ms: is empty"},
        {STEP("at_ms: 1, board: bounce, pattern_ms: [0]"), "s.yaml:5: pattern_ms: 0 is not within 1 to 10000"},
        {STEP("at_ms: 1, board: bounce, pattern_ms: [1,2,3,4,5,6,7,8,9,10,11,12,13,14,15,16,17]"),
         "s.yaml:5: pattern_ms: more than 16 durations"},
        {STEP("at_ms: 1, board: slow_clock"), "s.yaml:5: 'slow_clock' needs 'permille'"},
        {STEP("at_ms: 1, board: slow_clock, permille: 0"), "s.yaml:5: permille: 0 is not within 1 to 900"},
        {STEP("at_ms: 1, board: fast_clock, permille: 901"), "s.yaml:5: permille: 901 is not within 1 to 900"},
        {STEP("at_ms: 1, board: fail_test, part: core"), "s.yaml:5: a part of the self-test: 'core' is not one of"},
        {STEP("at_ms: never, ai: stop"), "s.yaml:5: at_ms: 'never' is not a time"},
        {STEP("at_ms: 10 parsecs, ai: stop"), "s.yaml:5: at_ms: '10 parsecs' is not a time"},
        {STEP("at_ms: 25h, ai: stop"), "s.yaml:5: at_ms: '25h' is not within 0ms to 1d"},
        {STEP("[1]: 1, ai: stop"), "s.yaml:5: a key of a step must be a word"},
        {HEAD "steps:\n  - {at_ms: 9, ai: stop}\n  - {at_ms: 8, ai: start}\n" STATES, "s.yaml:6: the step is earlier"},
    };
    READ_ALL_BAD(rows);
}

void test_what_is_wrong_in_an_expectation_is_refused_with_its_line(void) {
    static const bad_t rows[] = {
        {EXPECT("wishes: []"), "s.yaml:6: unknown key 'wishes' in expect"},
        {HEAD "expect:\n  states: [{to: IDLE, at_ms: 0}]\n", "s.yaml:5: to: 'IDLE' is not one of INIT, STANDBY"},
        {HEAD "expect:\n  states: [{to: INIT}]\n", "s.yaml:5: a state: 'at_ms' is missing"},
        {HEAD "expect:\n  states: [{to: INIT, reason: BAD, at_ms: 0}]\n", "s.yaml:5: unknown fault 'BAD'"},
        {HEAD "expect:\n  states: any\n  resets: [{accepted: true, at_ms: 1}]\n",
         "resets cannot be expected together with 'states: any'"},
        {HEAD "expect:\n  states: any\n  safety_output: [{closed: true, at_ms: 1}]\n",
         "safety_output cannot be expected together with 'states: any'"},
        {HEAD "expect:\n  states: [{to: INIT, at_ms: [2, 1]}]\n",
         "s.yaml:5: at_ms: the lowest value is above the highest"},
        {HEAD "expect:\n  states: [{to: INIT, at_ms: [1]}]\n", "s.yaml:5: at_ms must be a time or a range, [lowest"},
        {HEAD "expect:\n  states: [{to: INIT, at_ms: {after: x}}]\n", "s.yaml:5: at_ms must be a time or a range, ["},
        {EXPECT("vehicle: [{at_ms: 1, speed_mm_s: {}}]"), "s.yaml:6: speed_mm_s must be a number or a range, ["},
        {HEAD "expect:\n  states: [{to: INIT, at_ms: [1, x]}]\n", "s.yaml:5: at_ms: 'x' is not a time: 250ms"},
        {EXPECT("frames: [{at_ms: 1}]"), "s.yaml:6: an expected frame: 'id' or 'message' is missing"},
        {EXPECT("frames: [{id: 0x800, at_ms: 1}]"), "s.yaml:6: id: 0x800 is above 7FFh"},
        {EXPECT("never: [{id: 20000000h}]"), "s.yaml:6: id: 20000000h is above 1FFFFFFFh"},
        {EXPECT("frames: [{id: 168h}]"), "s.yaml:6: an expected frame: 'at_ms' is missing"},
        {EXPECT("frames: [{id: 168h, message: gear_command, at_ms: 1}]"),
         "s.yaml:6: either 'id' or 'message', not both"},
        {EXPECT("frames: [{id: 168h, at_ms: 1, bytes: \"0\"}]"), "s.yaml:6: bytes: '0' is not a list of up to 8 bytes"},
        {EXPECT("frames: [{id: 168h, at_ms: 1, from: god}]"), "s.yaml:6: from: 'god' is not one of supervisor"},
        {EXPECT("frames: [{id: 168h, at_ms: 1, side: x}]"), "s.yaml:6: side: 'x' is not one of"},
        {EXPECT("frames: [{id: 168h, at_ms: 1, first_since_ms: 2}]"), "s.yaml:6: first_since_ms is after at_ms"},
        {EXPECT("frames: [{id: 168h, at_ms: 1, every_ms: 0}]"), "s.yaml:6: every_ms: 0 is not within"},
        {EXPECT("frames: [{id: 168h, at_ms: [1, 1001]}]"), "s.yaml:6: 1001 ms is after the end"},
        {EXPECT("never: [{at_ms: 1001}]"), "s.yaml:6: 1001 ms is after the end"},
        {EXPECT("never: [{count: 3}]"), "s.yaml:6: unknown key 'count' in a forbidden frame"},
        {EXPECT("safety_output: [{closed: maybe, at_ms: 1}]"), "s.yaml:6: closed: 'maybe' is not one of true, false"},
        {EXPECT("led: [{code: 18, at_ms: 1}]"), "s.yaml:6: code: 18 is not within -1 to 17"},
        {EXPECT("led: [{code: 1, at_ms: 1001}]"), "s.yaml:6: 1001 ms is after the end"},
        {EXPECT("faults: [{name: NO, raised_ms: 1}]"), "s.yaml:6: unknown fault 'NO'"},
        {EXPECT("faults: [{name: BUS_OFF, class: bad, raised_ms: 1}]"),
         "s.yaml:6: class: 'bad' is not one of trip, warn"},
        {EXPECT("faults: [{name: BUS_OFF, raised_ms: 1, ended_ms: x}]"), "s.yaml:6: ended_ms (a time, or never): 'x'"},
        {EXPECT("faults: [{name: SELF_TEST_FAILED, parts: [wheels], raised_ms: 1}]"),
         "s.yaml:6: 'wheels' is not one of flash, ram, processor, watchdog, devices, core, supply"},
        {EXPECT("faults: [{name: BUS_OFF, parts: [ram], raised_ms: 1}]"), "s.yaml:6: a fault: only SELF_TEST_FAILED"},
        {EXPECT("other_faults: some"), "s.yaml:6: other_faults: 'some' is not one of allowed, never"},
        {EXPECT("resets: [{accepted: true, why: [button], at_ms: 1}]"), "s.yaml:6: a reset: 'why' is needed"},
        {EXPECT("resets: [{accepted: false, at_ms: 1}]"), "s.yaml:6: a reset: 'why' is needed"},
        {EXPECT("resets: [{accepted: false, why: [luck], at_ms: 1}]"), "s.yaml:6: 'luck' is not one of state"},
        {EXPECT("startup: [{missing: [{}], at_ms: 1}]"), "s.yaml:6: what is missing: a word"},
        {EXPECT("vehicle: [{at_ms: 1001, gear: P}]"), "s.yaml:6: 1001 ms is after the end"},
        {EXPECT("vehicle: [{at_ms: 1, gear: 1}]"), "s.yaml:6: gear: '1' is not one of P, R, N, D"},
        {EXPECT("vehicle: [{at_ms: 1, mode: x}]"), "s.yaml:6: mode: 'x' is not one of manual, autopilot"},
        {EXPECT("vehicle: [{at_ms: 1, eps_mode: x}]"), "s.yaml:6: eps_mode: 'x' is not one of assist, angle"},
        {EXPECT("vehicle: [{at_ms: 1, speed_mm_s: fast}]"), "s.yaml:6: speed_mm_s: 'fast' is not a whole number"},
        {EXPECT("vehicle: [{at_ms: 1, alarms: 100h}]"), "s.yaml:6: alarms: 100h is above FFh"},
        {EXPECT("vehicle: [{gear: P}]"), "s.yaml:6: the vehicle at a time: 'at_ms' is missing"},
        {EXPECT("counters_at_end: {tea: 1}"), "s.yaml:6: unknown key 'tea' in counters_at_end"},
        {EXPECT("counters_at_end: {sent: -1}"), "s.yaml:6: sent: -1 is not within"},
    };
    READ_ALL_BAD(rows);
}

void test_there_is_room_for_so_many_and_no_more(void) {
    static char text[40000];
    size_t used = (size_t)snprintf(text, sizeof text, "%s", HEAD STATES "steps:\n");
    for (unsigned i = 0; i <= SCENARIO_STEPS_MAX; i++) {
        used += (size_t)snprintf(&text[used], sizeof text - used, "  - {at_ms: 1, ai: stop}\n");
    }
    read_bad(text, "s.yaml:262: more than 256 steps");
    used = (size_t)snprintf(text, sizeof text, "%s", HEAD "expect:\n  states:\n");
    for (unsigned i = 0; i <= SCENARIO_EXPECT_MAX; i++) {
        used += (size_t)snprintf(&text[used], sizeof text - used, "    - {to: INIT, at_ms: 0}\n");
    }
    read_bad(text, "s.yaml:70: more than 64 of them");
    used = (size_t)snprintf(text, sizeof text, "name: n\nshows: [");
    for (unsigned i = 0; i <= SCENARIO_SHOWS_MAX; i++) {
        used += (size_t)snprintf(&text[used], sizeof text - used, "SUP-1, ");
    }
    (void)snprintf(&text[used], sizeof text - used, "]\n");
    read_bad(text, "s.yaml:2: shows: more than 24 entries");
}

void test_a_file_that_is_not_there(void) {
    TEST_ASSERT_FALSE(scenario_read(&scenario, "/nowhere/s.yaml", &options));
    (void)scratch_said_line("/nowhere/s.yaml: No such file or directory");
}

void test_aliases_that_lead_back_are_refused_and_do_no_harm(void) {
    read_bad("&a\nname: n\nshows: [SUP-2]\nduration_ms: 9\nexpect: *a\n", "unknown key 'name' in expect");
}

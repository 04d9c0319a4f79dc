/* Scenarios on a real bus: what is left out, and how far times may be off. What needs CAN: tests/vcan/test_run.py. */
#include <stdio.h>
#include <string.h>

#include "live/scenario_bus.h"
#include "scratch.h"
#include "unity.h"

#define BEGIN "name: n\nshows: [SUP-2]\nduration_ms: 1000\n"
#define NO_STATES "expect:\n  states: []\n"

static scenario_t scenario;
/* The interface is a virtual one. */
static const scenario_bus_t virtual_bus = {.interfaces = {[HAL_CAN_VEHICLE] = "lo"}, .tolerance_ms = 50};

void setUp(void) {
    scratch_open();
}

static void read_scenario(const char *text) {
    TEST_ASSERT_TRUE_MESSAGE(scenario_read_text(&scenario, "s.yaml", text, NULL), scratch_said());
}

/* A scenario with this in it is left out, and the reason begins so; NULL: it is not. */
static void is_left_out(const char *text, const char *reason) {
    read_scenario(text);
    const char *why = scenario_bus_leaves_out(&virtual_bus, &scenario);
    if (reason == NULL) {
        TEST_ASSERT_NULL_MESSAGE(why, text);
    } else {
        TEST_ASSERT_NOT_NULL_MESSAGE(why, text);
        TEST_ASSERT_EQUAL_STRING_LEN(reason, why, strlen(reason));
    }
}

void test_what_a_real_bus_cannot_show_is_left_out(void) {
    is_left_out(BEGIN NO_STATES, NULL);
    is_left_out(BEGIN "bitrate: 125000\n" NO_STATES, "bitrate: ");
    is_left_out(BEGIN "clock_start_ms: 1\n" NO_STATES, "clock_start_ms: ");
    is_left_out(BEGIN "reset_cause: watchdog\n" NO_STATES, "reset_cause: ");
    is_left_out(BEGIN "self_test: failed\n" NO_STATES, "self_test: ");
    is_left_out(BEGIN "board: [output_feedback]\n" NO_STATES, "board: ");
    is_left_out(BEGIN "board: [emergency_stop]\n" NO_STATES, "board: ");
    is_left_out(BEGIN "board: [reset_button]\n" NO_STATES, "board: ");
    is_left_out(BEGIN "board: [second_clock]\n" NO_STATES, "board: ");
}

void test_steps(void) {
#define STEP(step) BEGIN "steps:\n  - {at_ms: 5, " step "}\n" NO_STATES
    is_left_out(STEP("ai: stop"), NULL);
    is_left_out(STEP("supervisor: restart, cause: power-on, off_ms: 100"), NULL);
    is_left_out(STEP("supervisor: restart, cause: watchdog"), "restart: ");
    is_left_out(STEP("supervisor: hang, for_ms: 99"), NULL);
    is_left_out(STEP("supervisor: hang, for_ms: 100"), "hang: ");
    is_left_out(STEP("supervisor: stall_tx"), "stall_tx: ");
    is_left_out(STEP("supervisor: fill_queue"), "fill_queue: ");
    is_left_out(STEP("supervisor: corrupt_latch"), "corrupt_latch: ");
    is_left_out(STEP("supervisor: flip_bit, bit: 1"), "flip_bit: ");
    is_left_out(STEP("board: weld_contact"), "board: ");
    is_left_out(STEP("board: fail_test, part: flash"), "board: ");
    is_left_out(STEP("bus: destroy, frames: 1"), "destroy: ");
    is_left_out(STEP("bus: send, kind: fd, id: 363h, bytes: \"00\""), "send, kind: fd: ");
    is_left_out(STEP("supervisor: swallow_tx"), "swallow_tx: ");
    is_left_out(STEP("bus: deliver, kind: data, id: 363h, bytes: \"00\""), "deliver: ");
    is_left_out(BEGIN "hardware_watchdog: none\nsteps:\n  - {at_ms: 5, supervisor: hang, for_ms: 500}\n" NO_STATES,
                NULL);
}

void test_the_controller_is_played_on_a_virtual_interface_only(void) {
    static const char *const steps[] = {STEP("supervisor: bus_off"), STEP("supervisor: overrun"),
                                        STEP("supervisor: error_passive"), STEP("supervisor: error_active")};
    const scenario_bus_t real = {.interfaces = {[HAL_CAN_VEHICLE] = "no-such-one"}};
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        is_left_out(steps[i], NULL);
        TEST_ASSERT_NOT_NULL(scenario_bus_leaves_out(&real, &scenario));
    }
}

void test_what_a_virtual_interface_never_does(void) {
    is_left_out(BEGIN NO_STATES "  faults: [{name: TX_STALLED, raised_ms: 5}]\n", "TX_STALLED: ");
    is_left_out(BEGIN "topology: gateway\n" NO_STATES "  faults: [{name: AI_BUS_OFF, raised_ms: 5}]\n", "AI_BUS_OFF: ");
#define AI_BUS_OFF "steps:\n  - {at_ms: 5, supervisor: bus_off, side: ai}\n"
    is_left_out(BEGIN "topology: gateway\n" AI_BUS_OFF NO_STATES "  faults: [{name: AI_BUS_OFF, raised_ms: 5}]\n",
                NULL);
    is_left_out(BEGIN NO_STATES "  faults: [{name: ERROR_PASSIVE, raised_ms: 5}]\n", "ERROR_PASSIVE: ");
    is_left_out(BEGIN "steps:\n  - {at_ms: 5, supervisor: error_passive}\n" NO_STATES
                      "  faults: [{name: ERROR_PASSIVE, raised_ms: 5}]\n",
                NULL);
    is_left_out(BEGIN "topology: gateway\nconfig: {bus_off_recovery_ms: 125}\n" AI_BUS_OFF NO_STATES, "bus_off: ");
}

void test_what_the_kernel_keeps_to_itself_is_not_counted(void) {
#define COUNTED(id, counter) STEP("bus: send, id: " id ", bytes: \"00\"") "  counters_at_end: {" counter "}\n"
    is_left_out(COUNTED("123h", "dropped: 1"), "counters_at_end: ");
    is_left_out(COUNTED("123h", "dropped: 0"), NULL);
    is_left_out(COUNTED("123h", "sent: 1"), NULL);
    is_left_out(COUNTED("203h", "received: 1"), NULL); /* of the other ID set */
}

static void is_window(scenario_window_t window, uint32_t from, uint32_t to) {
    TEST_ASSERT_EQUAL_UINT32(from, window.from);
    TEST_ASSERT_EQUAL_UINT32(to, window.to);
}

void test_moments_are_widened(void) {
    read_scenario(BEGIN "expect:\n  states: [{to: INIT, at_ms: 0}, {to: STANDBY, at_ms: [510, 513]}]\n"
                        "  frames: [{id: 168h, at_ms: [100, 200]}]\n"
                        "  safety_output: [{closed: true, at_ms: 500}]\n"
                        "  faults: [{name: BUS_OFF, raised_ms: 300, ended_ms: [400, 401]}]\n"
                        "  resets: [{accepted: true, at_ms: 600}]\n"
                        "  startup: [{missing: [messages], at_ms: 700}]\n");
    scenario_bus_tolerate(&virtual_bus, &scenario);
    const scenario_expect_t *expect = &scenario.expect;
    is_window(expect->states.items[0].at_ms, 0, 50);
    is_window(expect->states.items[1].at_ms, 460, 563);
    is_window(expect->frames.items[0].at_ms, 50, 250);
    is_window(expect->outputs.items[0].at_ms, 450, 550);
    is_window(expect->faults.items[0].raised_ms, 250, 350);
    is_window(expect->faults.items[0].ended_ms, 350, 451);
    is_window(expect->resets.items[0].at_ms, 550, 650);
    is_window(expect->startups.items[0].at_ms, 650, 750);
}

/* The event of another program is read after the frames that come with it. */
void test_moments_after_an_event_are_widened_to_before_it(void) {
    read_scenario(BEGIN "expect:\n  states: [{to: INIT, at_ms: 0}, {to: SAFE, after: trip, within: [40, 60]}]\n"
                        "  frames: [{id: 168h, after: trip, within: 2}, {id: 43Fh, after: trip, within: [70, 90]}]\n");
    scenario_bus_tolerate(&virtual_bus, &scenario);
    const scenario_expect_t *expect = &scenario.expect;
    is_window(expect->states.items[1].at_ms, 0, 110);
    TEST_ASSERT_EQUAL_UINT32(10, expect->states.items[1].at_ms.early);
    is_window(expect->frames.items[0].at_ms, 0, 52);
    TEST_ASSERT_EQUAL_UINT32(50, expect->frames.items[0].at_ms.early);
    is_window(expect->frames.items[1].at_ms, 20, 140);
    TEST_ASSERT_EQUAL_UINT32(0, expect->frames.items[1].at_ms.early);
}

void test_what_lasts_after_an_event_is_narrowed_on_both_sides(void) {
    read_scenario(BEGIN "expect:\n  states: any\n  never: [{id: 168h, after: trip, within: 200}]\n");
    scenario_bus_tolerate(&virtual_bus, &scenario);
    is_window(scenario.expect.never.items[0].at_ms, 50, 150);
}

void test_what_lasts_is_narrowed_but_for_the_ends_of_the_run(void) {
    read_scenario(
        BEGIN "expect:\n  states: []\n  led:\n    - {code: 0, at_ms: [0, 1000]}\n    - {code: 1, at_ms: [100, 300]}\n"
              "    - {code: 2, at_ms: [400, 480]}\n  never: [{at_ms: [600, 800]}, {id: 168h}]\n"
              "  frames: [{id: 43Fh, at_ms: [100, 900], every_ms: 100}]\n");
    scenario_bus_tolerate(&virtual_bus, &scenario);
    const scenario_expect_t *expect = &scenario.expect;
    is_window(expect->leds.items[0].at_ms, 0, 1000);
    is_window(expect->leds.items[1].at_ms, 150, 250);
    is_window(expect->leds.items[2].at_ms, UINT32_MAX, 0); /* nothing is left of it */
    is_window(expect->never.items[0].at_ms, 650, 750);
    TEST_ASSERT_EQUAL_UINT32(0, expect->never.items[1].at_ms.from);
    TEST_ASSERT_GREATER_OR_EQUAL_UINT32(1000, expect->never.items[1].at_ms.to);
    is_window(expect->frames.items[0].at_ms, 150, 850);
    TEST_ASSERT_EQUAL_UINT32(52, expect->frames.items[0].jitter_ms);
}

/* It may have been sent before the trip discards it. */
void test_only_a_status_frame_may_come_again_at_once(void) {
    read_scenario(BEGIN "expect:\n  states: [{to: INIT, at_ms: 0}, {to: TRIPPED, at_ms: 5}]\n  frames:\n    - {id: "
                        "7F0h, at_ms: [100, 900], every_ms: 100}\n"
                        "    - {id: 43Fh, at_ms: [100, 900], every_ms: 100}\n");
    TEST_ASSERT_EQUAL_UINT32(0, scenario.expect.frames.items[0].again_ms);
    scenario_bus_tolerate(&virtual_bus, &scenario);
    TEST_ASSERT_EQUAL_UINT32(5, scenario.expect.frames.items[0].again_ms);
    TEST_ASSERT_EQUAL_size_t(1, scenario.expect.frames.items[0].again_max); /* once at each trip */
    TEST_ASSERT_EQUAL_UINT32(0, scenario.expect.frames.items[1].again_ms);
}

void test_counts_hold_in_the_time_as_it_stands(void) {
    read_scenario(BEGIN "expect:\n  states: []\n  frames: [{id: 168h, at_ms: [100, 200], count: [3, 4]}]\n");
    scenario_bus_tolerate(&virtual_bus, &scenario);
    is_window(scenario.expect.frames.items[0].at_ms, 100, 200);
    is_window(scenario.expect.frames.items[0].count, 3, 4);
}

void test_of_another_program_more_is_left_out_and_its_counters_are_not_judged(void) {
    const scenario_bus_t outside = {.interfaces = {[HAL_CAN_VEHICLE] = "lo"}, .tolerance_ms = 50, .command = "true"};
    static const char *const steps[] = {STEP("supervisor: bus_off"), STEP("supervisor: overrun"),
                                        STEP("supervisor: error_passive"), STEP("supervisor: hang, for_ms: 20"),
                                        STEP("supervisor: restart, cause: power-on")};
    for (size_t i = 0; i < sizeof steps / sizeof steps[0]; i++) {
        read_scenario(steps[i]);
        TEST_ASSERT_NULL_MESSAGE(scenario_bus_leaves_out(&virtual_bus, &scenario), steps[i]);
        TEST_ASSERT_NOT_NULL_MESSAGE(scenario_bus_leaves_out(&outside, &scenario), steps[i]);
    }
    read_scenario(BEGIN NO_STATES "  counters_at_end: {sent: 0}\n");
    TEST_ASSERT_EQUAL_size_t(1, scenario.expect.counters.count);
    scenario_bus_tolerate(&outside, &scenario);
    TEST_ASSERT_EQUAL_size_t(0, scenario.expect.counters.count);
}

/* Judging: states, faults, resets, outputs, the vehicle. */
#include "scenario/check/scenario_check.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "agv/names.h"
#include "common/missing.h"

enum { NOT_YET = -128 };

void scenario_check_fail(scenario_check_t *check, size_t line, const char *format, ...) {
    if (check->failure_count < SCENARIO_FAILURES_MAX) {
        char *text = check->failures[check->failure_count];
        const int used = (line != 0) ? snprintf(text, SCENARIO_FAILURE_SIZE, "line %zu: ", line) : 0;
        va_list arguments;
        va_start(arguments, format);
        (void)vsnprintf(&text[used], SCENARIO_FAILURE_SIZE - (size_t)used, format, arguments);
        va_end(arguments);
    }
    check->failure_count++;
    check->expectation_count += (line == 0) ? 1 : 0; /* that nothing else happens is no line, and expected, too */
}

static const char *name_of(agv_fault_t fault) {
    const char *name = agv_fault_name(fault);
    return (name != NULL) ? name : "no reason";
}

static const char *state_of(uint8_t state) {
    const char *name = agv_state_name((agv_state_t)state);
    return (name != NULL) ? name : "?";
}

void scenario_check_init(scenario_check_t *check, const scenario_t *scenario) {
    const scenario_expect_t *expect = &scenario->expect;

    memset(check, 0, sizeof *check);
    check->scenario = scenario;
    check->expect = scenario->expect;
    check->led_code = NOT_YET;
    check->expectation_count = expect->states.count + expect->frames.count + expect->never.count +
                               expect->outputs.count + expect->leds.count + expect->faults.count +
                               expect->resets.count + expect->startups.count + expect->vehicle.count +
                               expect->counters.count + ((expect->no_hazards != 0) ? 1 : 0);
    scenario_check_frames_init(check);
}

static void check_state(scenario_check_t *check, uint32_t t_ms, const agv_event_t *event) {
    const size_t index = check->next_state;
    char window[SCENARIO_WINDOW_TEXT_SIZE];

    check->next_state++;
    if (index >= check->expect.states.count) {
        scenario_check_fail(check, 0, "no further change of state is expected, but at %u ms: %s (%s)", (unsigned)t_ms,
                            state_of(event->b), name_of((agv_fault_t)event->c));
        return;
    }
    const scenario_state_t *state = &check->expect.states.items[index];
    scenario_check_window_text(state->at_ms, window);
    if ((event->b != (uint8_t)state->to) || (event->c != (uint8_t)state->reason) ||
        !scenario_check_is_in(t_ms, state->at_ms)) {
        scenario_check_fail(check, state->line, "%s (%s) is expected %s, seen: %s (%s) at %u ms",
                            state_of((uint8_t)state->to), name_of(state->reason), window, state_of(event->b),
                            name_of((agv_fault_t)event->c), (unsigned)t_ms);
    }
}

static bool is_as_expected(const scenario_fault_t *fault, uint32_t t_ms, const agv_event_t *event) {
    return scenario_check_is_in(t_ms, fault->raised_ms) &&
           (!fault->has_class || ((uint8_t)fault->fault_class == event->b)) &&
           ((fault->parts == 0) || (fault->parts == event->missing));
}

static void raise_fault(scenario_check_t *check, uint32_t t_ms, const agv_event_t *event) {
    const scenario_expect_t *expect = &check->expect;
    bool named = false;

    for (size_t i = 0; i < expect->faults.count; i++) {
        const scenario_fault_t *fault = &expect->faults.items[i];
        scenario_fault_seen_t *seen = &check->faults[i];
        if ((fault->fault != (agv_fault_t)event->a) || seen->raised) {
            continue;
        }
        named = true;
        if (is_as_expected(fault, t_ms, event)) {
            seen->raised = true;
            return;
        }
        seen->early_or_late = true;
        seen->seen_ms = t_ms;
        seen->parts = event->missing;
    }
    if (expect->no_other_faults && !named) {
        scenario_check_fail(check, 0, "no other fault is expected, but at %u ms: %s (%s)", (unsigned)t_ms,
                            name_of((agv_fault_t)event->a), agv_class_name((agv_fault_class_t)event->b));
    }
}

static void end_fault(scenario_check_t *check, uint32_t t_ms, const agv_event_t *event) {
    const scenario_expect_t *expect = &check->expect;

    for (size_t i = 0; i < expect->faults.count; i++) {
        const scenario_fault_t *fault = &expect->faults.items[i];
        scenario_fault_seen_t *seen = &check->faults[i];
        if ((fault->fault != (agv_fault_t)event->a) || !seen->raised || seen->ended) {
            continue;
        }
        seen->ended = true;
        if (fault->has_end && (fault->never_ends || !scenario_check_is_in(t_ms, fault->ended_ms))) {
            char window[SCENARIO_WINDOW_TEXT_SIZE] = "never";
            if (!fault->never_ends) {
                scenario_check_window_text(fault->ended_ms, window);
            }
            scenario_check_fail(check, fault->line, "%s is expected to end %s, it ended at %u ms",
                                name_of(fault->fault), window, (unsigned)t_ms);
        }
        return;
    }
}

static void check_reset(scenario_check_t *check, uint32_t t_ms, const agv_event_t *event) {
    const size_t index = check->next_reset;
    char seen_text[MISSING_TEXT_SIZE];
    char text[MISSING_TEXT_SIZE];
    char window[SCENARIO_WINDOW_TEXT_SIZE];

    check->next_reset++;
    (void)missing_text(event->missing, seen_text);
    if (index >= check->expect.resets.count) {
        scenario_check_fail(check, 0, "no further reset is expected, but at %u ms: %s [%s]", (unsigned)t_ms,
                            (event->a != 0) ? "accepted" : "refused", seen_text);
        return;
    }
    const scenario_reset_t *reset = &check->expect.resets.items[index];
    scenario_check_window_text(reset->at_ms, window);
    if ((reset->accepted != (event->a != 0)) || (reset->missing != event->missing) ||
        !scenario_check_is_in(t_ms, reset->at_ms)) {
        scenario_check_fail(check, reset->line, "reset %s [%s] is expected %s, seen: %s [%s] at %u ms",
                            reset->accepted ? "accepted" : "refused", missing_text(reset->missing, text), window,
                            (event->a != 0) ? "accepted" : "refused", seen_text, (unsigned)t_ms);
    }
}

static void check_startup(scenario_check_t *check, uint32_t t_ms, const agv_event_t *event) {
    const size_t index = check->next_startup;
    char seen_text[MISSING_TEXT_SIZE];
    char text[MISSING_TEXT_SIZE];
    char window[SCENARIO_WINDOW_TEXT_SIZE];

    check->next_startup++;
    (void)missing_text(event->missing, seen_text);
    if (index >= check->expect.startups.count) {
        scenario_check_fail(check, 0, "no report of missing conditions at start is expected, but at %u ms: [%s]",
                            (unsigned)t_ms, seen_text);
        return;
    }
    const scenario_reset_t *startup = &check->expect.startups.items[index];
    scenario_check_window_text(startup->at_ms, window);
    if ((startup->missing != event->missing) || !scenario_check_is_in(t_ms, startup->at_ms)) {
        scenario_check_fail(check, startup->line, "missing at start [%s] is expected %s, seen: [%s] at %u ms",
                            missing_text(startup->missing, text), window, seen_text, (unsigned)t_ms);
    }
}

/** The LED showed `led_code` from `led_since_ms` up to and with @p last_ms. */
static void check_led(scenario_check_t *check, uint32_t last_ms) {
    const scenario_expect_t *expect = &check->expect;

    for (size_t i = 0; i < expect->leds.count; i++) {
        const scenario_led_t *led = &expect->leds.items[i];
        const bool overlap =
            !scenario_check_waits(led->at_ms) && (led->at_ms.from <= last_ms) && (led->at_ms.to >= check->led_since_ms);
        check->led_seen[i] = check->led_seen[i] || (overlap && (led->code == check->led_code));
        if (overlap && !led->at_some_time && (led->code != check->led_code) && !check->led_broken[i]) {
            char window[SCENARIO_WINDOW_TEXT_SIZE];
            check->led_broken[i] = true;
            scenario_check_window_text(led->at_ms, window);
            scenario_check_fail(check, led->line, "LED code %d is expected %s, seen: %d in %u..%u ms", led->code,
                                window, check->led_code, (unsigned)check->led_since_ms, (unsigned)last_ms);
        }
    }
}

static void change_led(scenario_check_t *check, uint32_t t_ms, int8_t code) {
    if ((check->led_code != NOT_YET) && (t_ms > check->led_since_ms)) {
        check_led(check, t_ms - 1);
    }
    check->led_code = code;
    check->led_since_ms = t_ms;
}

void scenario_check_event(scenario_check_t *check, const session_event_t *event) {
    const uint32_t t_ms = (uint32_t)event->t_ms;
    const agv_event_t *recorded = &event->recorded;

    if (event->is_led) {
        change_led(check, t_ms, event->led_code);
        return;
    }
    if (scenario_events_note(&check->events, event)) {
        scenario_check_resolve(check);
    }
    if (check->expect.any_states && ((recorded->kind == AGV_EVENT_STATE) || (recorded->kind == AGV_EVENT_RESET) ||
                                     (recorded->kind == AGV_EVENT_STARTUP))) {
        return;
    }
    switch ((agv_event_kind_t)recorded->kind) {
    case AGV_EVENT_STATE:
        check_state(check, t_ms, recorded);
        break;
    case AGV_EVENT_FAULT:
        if (recorded->c != 0) {
            raise_fault(check, t_ms, recorded);
        } else {
            end_fault(check, t_ms, recorded);
        }
        break;
    case AGV_EVENT_RESET:
        check_reset(check, t_ms, recorded);
        break;
    case AGV_EVENT_STARTUP:
        check_startup(check, t_ms, recorded);
        break;
    case AGV_EVENT_OUTPUT: /* evaluated at the pin itself */
    default:
        break;
    }
}

void scenario_check_output(scenario_check_t *check, uint32_t t_ms, bool closed) {
    const scenario_expect_t *expect = &check->expect;
    const size_t index = check->next_output;
    char window[SCENARIO_WINDOW_TEXT_SIZE];

    if ((closed == check->closed) || expect->any_states) {
        return;
    }
    check->closed = closed;
    check->next_output++;
    if (index >= expect->outputs.count) {
        scenario_check_fail(check, 0, "no further change of the safety output is expected, but at %u ms: %s",
                            (unsigned)t_ms, closed ? "closed" : "open");
        return;
    }
    const scenario_output_t *output = &expect->outputs.items[index];
    scenario_check_window_text(output->at_ms, window);
    if ((closed != output->closed) || !scenario_check_is_in(t_ms, output->at_ms)) {
        scenario_check_fail(check, output->line, "safety output %s is expected %s, seen: %s at %u ms",
                            output->closed ? "closed" : "open", window, closed ? "closed" : "open", (unsigned)t_ms);
    }
}

static void finish_lists(scenario_check_t *check) {
    const scenario_expect_t *expect = &check->expect;
    char window[SCENARIO_WINDOW_TEXT_SIZE];
    char text[MISSING_TEXT_SIZE];

    for (size_t i = check->next_state; i < expect->states.count; i++) {
        const scenario_state_t *state = &expect->states.items[i];
        scenario_check_window_text(state->at_ms, window);
        scenario_check_fail(check, state->line, "%s (%s) is expected %s, not seen", state_of((uint8_t)state->to),
                            name_of(state->reason), window);
    }
    for (size_t i = check->next_output; i < expect->outputs.count; i++) {
        const scenario_output_t *output = &expect->outputs.items[i];
        scenario_check_window_text(output->at_ms, window);
        scenario_check_fail(check, output->line, "safety output %s is expected %s, not seen",
                            output->closed ? "closed" : "open", window);
    }
    for (size_t i = check->next_reset; i < expect->resets.count; i++) {
        const scenario_reset_t *reset = &expect->resets.items[i];
        scenario_check_window_text(reset->at_ms, window);
        scenario_check_fail(check, reset->line, "reset %s [%s] is expected %s, not seen",
                            reset->accepted ? "accepted" : "refused", missing_text(reset->missing, text), window);
    }
    for (size_t i = check->next_startup; i < expect->startups.count; i++) {
        const scenario_reset_t *startup = &expect->startups.items[i];
        scenario_check_window_text(startup->at_ms, window);
        scenario_check_fail(check, startup->line, "missing at start [%s] is expected %s, not seen",
                            missing_text(startup->missing, text), window);
    }
}

static void finish_leds(scenario_check_t *check) {
    for (size_t i = 0; i < check->expect.leds.count; i++) {
        const scenario_led_t *led = &check->expect.leds.items[i];
        char window[SCENARIO_WINDOW_TEXT_SIZE];
        if ((led->at_some_time || scenario_check_waits(led->at_ms)) && !check->led_seen[i]) {
            scenario_check_window_text(led->at_ms, window);
            scenario_check_fail(check, led->line, "LED code %d is expected %s, not seen", led->code, window);
        }
    }
}

/** A fault came at another time, with another class or with other parts. */
static void fail_otherwise(scenario_check_t *check, const scenario_fault_t *fault, const scenario_fault_seen_t *seen,
                           const char *window) {
    char expected[MISSING_TEXT_SIZE];
    char parts[MISSING_TEXT_SIZE];
    const char *as_class = (fault->fault_class == AGV_CLASS_TRIP) ? " as a trip" : " as a warning";

    if (fault->parts != 0) {
        scenario_check_fail(check, fault->line, "%s [%s] is expected to be raised %s, seen: [%s] at %u ms",
                            name_of(fault->fault), parts_text(fault->parts, expected), window,
                            parts_text(seen->parts, parts), (unsigned)seen->seen_ms);
    } else {
        scenario_check_fail(check, fault->line, "%s is expected to be raised %s%s, seen at %u ms",
                            name_of(fault->fault), window, fault->has_class ? as_class : "", (unsigned)seen->seen_ms);
    }
}

static void finish_faults(scenario_check_t *check) {
    const scenario_expect_t *expect = &check->expect;
    char window[SCENARIO_WINDOW_TEXT_SIZE];

    for (size_t i = 0; i < expect->faults.count; i++) {
        const scenario_fault_t *fault = &expect->faults.items[i];
        const scenario_fault_seen_t *seen = &check->faults[i];
        if (!seen->raised) {
            scenario_check_window_text(fault->raised_ms, window);
            if (seen->early_or_late) {
                fail_otherwise(check, fault, seen, window);
            } else {
                scenario_check_fail(check, fault->line, "%s is expected to be raised %s, not seen",
                                    name_of(fault->fault), window);
            }
        } else if (fault->has_end && !fault->never_ends && !seen->ended) {
            scenario_check_window_text(fault->ended_ms, window);
            scenario_check_fail(check, fault->line, "%s is expected to end %s, it did not", name_of(fault->fault),
                                window);
        } else {
            continue;
        }
    }
}

static void finish_counters(scenario_check_t *check, const agv_counters_t *counters) {
    const scenario_expect_t *expect = &check->expect;

    for (size_t i = 0; i < expect->counters.count; i++) {
        const scenario_counter_t *counter = &expect->counters.items[i];
        uint32_t seen = 0;
        if (counters != NULL) {
            memcpy(&seen, (const uint8_t *)counters + counter->offset, sizeof seen);
        }
        if ((counters == NULL) || !scenario_check_is_in(seen, counter->value)) {
            scenario_check_fail(check, counter->line, "counter %s: %u..%u is expected at the end, seen: %u",
                                counter->name, (unsigned)counter->value.from, (unsigned)counter->value.to,
                                (unsigned)seen);
        }
    }
}

void scenario_check_finish(scenario_check_t *check, const agv_counters_t *counters) {
    check_led(check, check->scenario->duration_ms);
    finish_lists(check);
    finish_leds(check);
    finish_faults(check);
    scenario_check_vehicle_finish(check);
    scenario_check_frames_finish(check);
    finish_counters(check, counters);
}

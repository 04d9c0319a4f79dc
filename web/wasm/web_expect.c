/*
 * The expectations of the run's scenario. An object: `items`, an array of [line, kind, standing] in the order of the
 * file, and `failures`, the texts of those that failed. Standings: "open" (not seen yet), "holds" (so far; its time is
 * not over), "passed", "failed".
 */
#include <stdlib.h>

#include "common/json_build.h"
#include "web_run.h"
#include "web_sim.h"

/** How the first of these expectations stands, from what was seen of it. */
typedef enum { OPEN, HOLDS, PASSED } standing_t;

static const scenario_check_t *check(void) {
    return &web_run()->run.check;
}

/** The last millisecond that was played; -1: none. */
static int64_t now_ms(void) {
    return (int64_t)web_run()->next_ms - 1;
}

static bool is_over(uint32_t ms) {
    return web_run()->has_ended || (now_ms() >= (int64_t)ms);
}

/** The number in "line 12: ..."; 0: none. */
static size_t line_of(const char *failure) {
    enum { DIGITS_AT = 5, DECIMAL = 10 };
    return (failure[0] == 'l') ? (size_t)strtoul(&failure[DIGITS_AT], NULL, DECIMAL) : 0u;
}

static size_t failures(void) {
    return (check()->failure_count < SCENARIO_FAILURES_MAX) ? check()->failure_count : SCENARIO_FAILURES_MAX;
}

static bool has_failed(size_t line) {
    for (size_t i = 0u; i < failures(); i++) {
        if (line_of(check()->failures[i]) == line) {
            return true;
        }
    }
    return false;
}

static void add(json_t *items, size_t line, const char *kind, standing_t standing) {
    static const char *const names[] = {[OPEN] = "open", [HOLDS] = "holds", [PASSED] = "passed"};
    const char *name = has_failed(line) ? "failed" : names[standing];
    json_t *item = json_array();
    json_add(item, json_uint(line));
    json_add(item, json_text(kind));
    json_add(item, json_text(name));
    json_add(items, item);
}

/** Of a list of which each entry happens once, in order: the first @p next are done. */
#define ADD_ORDERED(list, kind, next)                                                                                  \
    for (size_t i = 0u; i < expect->list.count; i++) {                                                                 \
        add(items, expect->list.items[i].line, (kind), (i < (next)) ? PASSED : OPEN);                                  \
    }

/** Of what must hold, or must not happen, during a time. */
static standing_t of_time(scenario_window_t window) {
    if (scenario_check_waits(window) || (now_ms() < (int64_t)window.from)) {
        return OPEN;
    }
    return is_over(window.to) ? PASSED : HOLDS;
}

static standing_t of_frame(const scenario_frame_t *frame, const scenario_frame_seen_t *seen) {
    const bool goes_on = (frame->count.to != UINT32_MAX) || (frame->every_ms != 0u);
    if (seen->count < frame->count.from) {
        return OPEN;
    }
    return (goes_on && !is_over(frame->at_ms.to)) ? HOLDS : PASSED;
}

static standing_t of_fault(const scenario_fault_t *fault, const scenario_fault_seen_t *seen) {
    if (!seen->raised || (fault->has_end && !fault->never_ends && !seen->ended)) {
        return OPEN;
    }
    return (fault->never_ends && !web_run()->has_ended) ? HOLDS : PASSED;
}

static void add_timed(json_t *items, const scenario_expect_t *expect) {
    for (size_t i = 0u; i < expect->frames.count; i++) {
        add(items, expect->frames.items[i].line, "frame", of_frame(&expect->frames.items[i], &check()->frames[i]));
    }
    for (size_t i = 0u; i < expect->never.count; i++) {
        const scenario_frame_t *never = &expect->never.items[i];
        add(items, never->line, "never", of_time(never->at_ms));
    }
    for (size_t i = 0u; i < expect->leds.count; i++) {
        const scenario_led_t *led = &expect->leds.items[i];
        const standing_t seen = check()->led_seen[i] ? PASSED : OPEN;
        add(items, led->line, "LED", led->at_some_time ? seen : of_time(led->at_ms));
    }
    for (size_t i = 0u; i < expect->faults.count; i++) {
        add(items, expect->faults.items[i].line, "fault", of_fault(&expect->faults.items[i], &check()->faults[i]));
    }
    for (size_t i = 0u; i < expect->vehicle.count; i++) {
        add(items, expect->vehicle.items[i].line, "vehicle", check()->vehicle_seen[i] ? PASSED : OPEN);
    }
}

static void add_final(json_t *items, const scenario_expect_t *expect) {
    const bool has_ended = web_run()->has_ended;
    for (size_t i = 0u; i < expect->counters.count; i++) {
        add(items, expect->counters.items[i].line, "counter", has_ended ? PASSED : OPEN);
    }
    if (expect->no_hazards != 0u) {
        add(items, expect->no_hazards, "hazards", has_ended ? PASSED : HOLDS);
    }
}

const char *web_expectations(void) {
    static char *text;
    json_t *items = json_array();
    json_t *failed = json_array();
    if (web_run()->is_there) {
        const scenario_expect_t *expect = &check()->expect;
        ADD_ORDERED(states, "state", check()->next_state)
        ADD_ORDERED(outputs, "output", check()->next_output)
        ADD_ORDERED(resets, "reset", check()->next_reset)
        ADD_ORDERED(startups, "startup", check()->next_startup)
        add_timed(items, expect);
        add_final(items, expect);
    }
    for (size_t i = 0u; i < failures(); i++) {
        json_add(failed, json_text(check()->failures[i]));
    }
    json_t *object = json_object();
    json_put(object, "items", items);
    json_put(object, "failures", failed);
    free(text);
    text = json_dumps(object, JSON_COMPACT);
    json_decref(object);
    return text;
}

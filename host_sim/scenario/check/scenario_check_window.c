/* Judging: the times at which something is expected. */
#include <stdio.h>

#include "scenario/check/scenario_check.h"

bool scenario_check_waits(scenario_window_t window) {
    return window.after.kind != SCENARIO_FROM_START;
}

bool scenario_check_is_in(uint32_t t_ms, scenario_window_t window) {
    return !scenario_check_waits(window) && (t_ms >= window.from) && (t_ms <= window.to);
}

void scenario_check_window_text(scenario_window_t window, char text[SCENARIO_WINDOW_TEXT_SIZE]) {
    char anchor[SCENARIO_ANCHOR_TEXT_SIZE];

    if (scenario_check_waits(window)) {
        (void)scenario_anchor_text(window.after, anchor);
        (void)snprintf(text, SCENARIO_WINDOW_TEXT_SIZE, "%u..%u ms after %s", (unsigned)window.from,
                       (unsigned)window.to, anchor);
    } else if (window.to == UINT32_MAX) {
        (void)snprintf(text, SCENARIO_WINDOW_TEXT_SIZE, "in the whole run");
    } else if (window.from == window.to) {
        (void)snprintf(text, SCENARIO_WINDOW_TEXT_SIZE, "at %u ms", (unsigned)window.from);
    } else {
        (void)snprintf(text, SCENARIO_WINDOW_TEXT_SIZE, "in %u..%u ms", (unsigned)window.from, (unsigned)window.to);
    }
}

/** Count a window from the start of the run if its event has come. */
static void resolve(const scenario_events_t *events, scenario_window_t *window) {
    uint64_t event_ms = 0;

    if (scenario_check_waits(*window) && scenario_events_find(events, window->after, &event_ms)) {
        window->from += (uint32_t)event_ms;
        window->from -= (window->early < window->from) ? window->early : window->from;
        window->to = (window->to < UINT32_MAX - (uint32_t)event_ms) ? window->to + (uint32_t)event_ms : UINT32_MAX;
        window->after = (scenario_anchor_t){0};
    }
}

static void resolve_frames(scenario_check_t *check) {
    for (size_t i = 0; i < check->expect.frames.count; i++) {
        scenario_window_t *window = &check->expect.frames.items[i].at_ms;
        if (scenario_check_waits(*window)) {
            resolve(&check->events, window);
            check->frames[i].last_ms = window->from;
        }
    }
}

#define RESOLVE_ALL(list, member)                                                                                      \
    for (size_t i = 0; i < check->expect.list.count; i++) {                                                            \
        resolve(&check->events, &check->expect.list.items[i].member);                                                  \
    }

void scenario_check_resolve(scenario_check_t *check) {
    resolve_frames(check);
    RESOLVE_ALL(states, at_ms)
    RESOLVE_ALL(never, at_ms)
    RESOLVE_ALL(outputs, at_ms)
    RESOLVE_ALL(leds, at_ms)
    RESOLVE_ALL(faults, raised_ms)
    RESOLVE_ALL(resets, at_ms)
    RESOLVE_ALL(startups, at_ms)
    RESOLVE_ALL(vehicle, at_ms)
}

/*
 * The reader of scenarios. A refusal is reported in one line, with the line of the file. In an accepted scenario every
 * list is within its limit, and every step within the duration.
 */
#include <stdlib.h>
#include <string.h>

#include "capture.h"
#include "input.h"
#include "scenario/scenario.h"

static void check_rooms(const scenario_t *scenario) {
    const scenario_expect_t *expect = &scenario->expect;
    const size_t counts[] = {expect->states.count,  expect->frames.count,  expect->never.count,  expect->outputs.count,
                             expect->leds.count,    expect->faults.count,  expect->resets.count, expect->startups.count,
                             expect->vehicle.count, expect->counters.count};
    for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++) {
        if (counts[i] > SCENARIO_EXPECT_MAX) {
            capture_fail("more expectations than there is room for", scenario->name);
        }
    }
    if ((scenario->step_count > SCENARIO_STEPS_MAX) || (scenario->shows_count > SCENARIO_SHOWS_MAX) ||
        (memchr(scenario->name, '\0', sizeof scenario->name) == NULL)) {
        capture_fail("more than there is room for", "steps, shows or name");
    }
}

static void check_times(const scenario_t *scenario) {
    uint32_t before_ms = 0;
    for (size_t i = 0; i < scenario->step_count; i++) {
        const uint32_t at_ms = scenario->steps[i].at_ms;
        const bool waits = scenario->steps[i].after.kind != SCENARIO_FROM_START;
        if ((!waits && (at_ms < before_ms)) || (at_ms > scenario->duration_ms)) {
            capture_fail("a step out of its time", scenario->name);
        }
        before_ms = waits ? before_ms : at_ms;
    }
    if (scenario->duration_ms > SCENARIO_DURATION_MAX_MS) {
        capture_fail("it lasts too long", scenario->name);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char EMPTY[] = "contains no scenario\n";
    const char *path = capture_file(data, size);
    /* Allocated for each input, so that the sanitizers detect reads beyond it and uses of unset memory. */
    scenario_t *scenario = malloc(sizeof *scenario);
    if (scenario == NULL) {
        return 0;
    }
    capture_begin();
    const bool good = scenario_read(scenario, path, NULL);
    const char *printed = capture_end();
    if (!good) {
        capture_one_line(printed);
        if (strstr(printed, EMPTY) == NULL) {
            (void)capture_line(printed, path, capture_yaml_lines(data, size));
        }
    } else if (printed[0] != '\0') {
        capture_fail("accepted, and something was printed", printed);
    } else {
        check_rooms(scenario);
        check_times(scenario);
    }
    free(scenario);
    return 0;
}

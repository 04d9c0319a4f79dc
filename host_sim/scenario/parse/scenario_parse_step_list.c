/* Scenario files: the list of the steps, their names, and what their times count from. */
#include <string.h>

#include "scenario/parse/scenario_parse.h"

/** Check that there is room for all repeated steps. */
static bool again_fits(const yaml_reader_t *reader, const yaml_node_t *node, const scenario_t *scenario) {
    size_t count = 0;

    for (size_t i = 0; i < scenario->step_count; i++) {
        count += (scenario->steps[i].again_every_ms != 0) ? 1 : 0;
    }
    return (count <= SCENARIO_AGAIN_MAX) ||
           yaml_reader_fail(reader, node, "more than %u steps with again_every_ms", SCENARIO_AGAIN_MAX);
}

/** `name` of a step. */
static bool take_name(const yaml_reader_t *reader, const yaml_node_t *node, const scenario_t *scenario,
                      scenario_step_t *step) {
    const yaml_node_t *name = yaml_reader_value(reader, node, "name");
    scenario_anchor_t anchor;

    if (name == NULL) {
        return true;
    }
    const char *text = yaml_reader_text(reader, name, "name");
    if (text == NULL) {
        return false;
    }
    if (strlen(text) >= sizeof step->name) {
        return yaml_reader_fail(reader, name, "name: longer than %u bytes", SCENARIO_NAME_MAX - 1);
    }
    if (scenario_anchor_read(text, &anchor)) {
        return yaml_reader_fail(reader, name, "name: '%s' is the name of an event", text);
    }
    for (const scenario_step_t *other = scenario->steps; other < step; other++) {
        if (strcmp(other->name, text) == 0) {
            return yaml_reader_fail(reader, name, "name: the step on line %zu has this name, too", other->line);
        }
    }
    (void)strcpy(step->name, text);
    return true;
}

/** `after` and `wait` of a step. */
static bool take_after(const yaml_reader_t *reader, const yaml_node_t *node, scenario_t *scenario,
                       scenario_step_t *step) {
    const yaml_node_t *after = yaml_reader_value(reader, node, "after");
    uint32_t offset_ms = 0;

    if (after == NULL) {
        return true;
    }
    if (!scenario_parse_after(reader, after, scenario, &step->after, &offset_ms)) {
        return false;
    }
    step->at_ms += offset_ms; /* both are at most SCENARIO_DURATION_MAX_MS */
    if (step->at_ms > SCENARIO_DURATION_MAX_MS) {
        return yaml_reader_fail(reader, node, "a step: %u ms is above the longest scenario, %u ms",
                                (unsigned)step->at_ms, (unsigned)SCENARIO_DURATION_MAX_MS);
    }
    scenario->waiting_count += (step->after.kind != SCENARIO_FROM_START) ? 1 : 0;
    return true;
}

static bool read_step(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_t *scenario = target;

    if (scenario->step_count == SCENARIO_STEPS_MAX) {
        return yaml_reader_fail(reader, node, "more than %u steps", SCENARIO_STEPS_MAX);
    }
    scenario_step_t *step = &scenario->steps[scenario->step_count];
    if (!scenario_parse_step(reader, node, &scenario->config, step) || !take_after(reader, node, scenario, step) ||
        !take_name(reader, node, scenario, step)) {
        return false;
    }
    scenario->step_count++;
    return scenario_parse_board_fits(reader, node, scenario, step) && again_fits(reader, node, scenario);
}

bool scenario_parse_steps(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_list(reader, node, "steps", read_step, target);
}

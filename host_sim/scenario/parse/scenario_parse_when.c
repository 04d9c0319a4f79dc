/* Scenario files: times, which count from the start of the run, from a step or from an event. */
#include <string.h>

#include "scenario/parse/scenario_parse.h"

const yaml_shape_t SCENARIO_TEXT_SHAPE = {.kind = YAML_KIND_TEXT};

/** The step with a name; NULL: there is none. */
static const scenario_step_t *find_step(const scenario_t *scenario, const char *name) {
    for (size_t i = 0; i < scenario->step_count; i++) {
        if (strcmp(scenario->steps[i].name, name) == 0) {
            return &scenario->steps[i];
        }
    }
    return NULL;
}

bool scenario_parse_after(const yaml_reader_t *reader, const yaml_node_t *node, const scenario_t *scenario,
                          scenario_anchor_t *anchor, uint32_t *offset_ms) {
    const char *text = yaml_reader_text(reader, node, "after");

    if (text == NULL) {
        return false;
    }
    *offset_ms = 0;
    if (scenario_anchor_read(text, anchor)) {
        return true;
    }
    const scenario_step_t *step = find_step(scenario, text);
    if (step == NULL) {
        return yaml_reader_fail(reader, node,
                                "after: '%.40s' is neither the name of a step before nor one of standby, active, trip, "
                                "safe, reset ('trip 2': the second)",
                                text);
    }
    *anchor = step->after;
    *offset_ms = step->at_ms;
    return true;
}

/** `after` and `within`: from the anchor on. */
static bool read_relative(const yaml_reader_t *reader, const yaml_node_t *node, const scenario_when_t *when,
                          scenario_window_t *window) {
    const yaml_node_t *within = yaml_reader_value(reader, node, "within");
    uint32_t offset_ms = 0;

    if (within == NULL) {
        return yaml_reader_fail(reader, node, "%s: 'within' is missing", when->what);
    }
    if (!scenario_parse_after(reader, yaml_reader_value(reader, node, "after"), when->scenario, &window->after,
                              &offset_ms)) {
        return false;
    }
    if (within->type == YAML_SCALAR_NODE) {
        window->from = 0;
    }
    window->from += offset_ms;
    window->to += offset_ms;
    return true;
}

bool scenario_parse_when(const yaml_reader_t *reader, const yaml_node_t *node, const scenario_when_t *when,
                         scenario_window_t *window) {
    const bool is_absolute = yaml_reader_value(reader, node, when->key) != NULL;
    const bool is_relative = yaml_reader_value(reader, node, "after") != NULL;

    if (is_absolute && is_relative) {
        return yaml_reader_fail(reader, node, "%s: either '%s' or 'after'", when->what, when->key);
    }
    if (is_relative) {
        return read_relative(reader, node, when, window);
    }
    if (yaml_reader_value(reader, node, "within") != NULL) {
        return yaml_reader_fail(reader, node, "%s: 'within' needs 'after'", when->what);
    }
    return is_absolute || when->is_optional ||
           yaml_reader_fail(reader, node, "%s: '%s' is missing", when->what, when->key);
}

bool scenario_parse_any_text(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    (void)target;
    return yaml_reader_text(reader, node, "after") != NULL;
}

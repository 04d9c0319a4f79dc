/* Scenario files: what is expected. */
#include <string.h>

#include "agv/names.h"
#include "common/missing.h"
#include "io/yaml_file.h"
#include "scenario/parse/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static const yaml_word_t STATES[] = {{"INIT", AGV_STATE_INIT},     {"STANDBY", AGV_STATE_STANDBY},
                                     {"ACTIVE", AGV_STATE_ACTIVE}, {"TRIPPED", AGV_STATE_TRIPPED},
                                     {"SAFE", AGV_STATE_SAFE},     {NULL, 0}};
static const yaml_word_t CLASSES[] = {{"trip", AGV_CLASS_TRIP}, {"warn", AGV_CLASS_WARN}, {NULL, 0}};
static const yaml_word_t OTHERS[] = {{"allowed", 0}, {"never", 1}, {NULL, 0}};
static const yaml_word_t NEVER_WORDS[] = {{"never", 1}, {NULL, 0}};
static const yaml_word_t ANY_WORDS[] = {{"any", 1}, {NULL, 0}};

static const char *missing_name(size_t index) {
    return agv_missing_name((uint8_t)index);
}

static const char *part_name(size_t index) {
    return agv_self_test_part_name((uint8_t)index);
}

static const yaml_shape_t NEVER = {.kind = YAML_KIND_WORD, .words = NEVER_WORDS};
static const yaml_shape_t FAILED_PART = {.kind = YAML_KIND_NAMES, .name = part_name};
static const yaml_shape_t MISSING_WORD = {.kind = YAML_KIND_NAMES, .name = missing_name};
static const yaml_shape_t MISSING = {.kind = YAML_KIND_LIST, .items = &MISSING_WORD};
static const yaml_shape_t ENDED = {
    .kind = YAML_KIND_TIME_RANGE, .unit = DURATION_MS, .highest = SCENARIO_DURATION_MAX_MS, .other = &NEVER};

/* --- states --- */

static bool read_state_reason(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_fault(reader, node, &((scenario_state_t *)target)->reason);
}

static const yaml_key_t STATE[] = {YAML_REQUIRED(YAML_WORD("to", scenario_state_t, to, STATES)),
                                   YAML_OPTIONAL(YAML_CALL("reason", read_state_reason, &SCENARIO_FAULT_SHAPE)),
                                   SCENARIO_WHEN(scenario_state_t, "at_ms", at_ms)};
static const yaml_shape_t STATE_SHAPE = {YAML_MAP_SHAPE(STATE), .rules = {SCENARIO_WHEN_RULES("at_ms")}};

static bool read_state(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_state_t *state = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.states);
    const scenario_when_t when = {.scenario = target, .what = "a state", .key = "at_ms"};

    if (state == NULL) {
        return false;
    }
    state->line = yaml_node_line(node);
    state->reason = AGV_FAULT_NONE;
    return yaml_reader_map(reader, node, when.what, STATE, COUNT(STATE), state) &&
           scenario_parse_when(reader, node, &when, &state->at_ms);
}

/* --- safety output, LED --- */

static const yaml_key_t OUTPUT[] = {YAML_REQUIRED(YAML_FLAG("closed", scenario_output_t, closed)),
                                    SCENARIO_WHEN(scenario_output_t, "at_ms", at_ms)};
static const yaml_shape_t OUTPUT_SHAPE = {YAML_MAP_SHAPE(OUTPUT), .rules = {SCENARIO_WHEN_RULES("at_ms")}};

static bool read_output(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_output_t *output = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.outputs);
    const scenario_when_t when = {.scenario = target, .what = "a change of the safety output", .key = "at_ms"};

    if (output == NULL) {
        return false;
    }
    output->line = yaml_node_line(node);
    return yaml_reader_map(reader, node, when.what, OUTPUT, COUNT(OUTPUT), output) &&
           scenario_parse_when(reader, node, &when, &output->at_ms);
}

static const yaml_key_t LED[] = {YAML_REQUIRED(YAML_NUMBER("code", scenario_led_t, code, -1, 17)),
                                 SCENARIO_WHEN(scenario_led_t, "at_ms", at_ms)};
static const yaml_shape_t LED_SHAPE = {YAML_MAP_SHAPE(LED), .rules = {SCENARIO_WHEN_RULES("at_ms")}};

static bool read_led(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_led_t *led = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.leds);
    const scenario_when_t when = {.scenario = target, .what = "a code of the LED", .key = "at_ms"};

    if (led == NULL) {
        return false;
    }
    led->line = yaml_node_line(node);
    if (!yaml_reader_map(reader, node, when.what, LED, COUNT(LED), led)) {
        return false;
    }
    led->at_some_time = yaml_reader_value(reader, node, "within") != NULL;
    return scenario_parse_when(reader, node, &when, &led->at_ms);
}

/* --- faults --- */

static bool read_fault_name(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_fault(reader, node, &((scenario_fault_t *)target)->fault);
}

static bool read_failed_part(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    const char *text = yaml_reader_text(reader, node, "parts");

    if (text == NULL) {
        return false;
    }
    const uint16_t bit = part_bit(text);
    ((scenario_fault_t *)target)->parts |= bit;
    return (bit != 0) ||
           yaml_reader_fail(reader, node,
                            "'%.40s' is not one of flash, ram, processor, watchdog, devices, core, supply", text);
}

static bool read_fault_ended(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_fault_t *fault = target;
    const char *text = yaml_node_text(node);

    fault->has_end = true;
    fault->never_ends = (text != NULL) && (strcmp(text, "never") == 0);
    if (fault->never_ends) {
        return true;
    }
    int64_t range[2];
    if (!yaml_reader_time_range(reader, node, "ended_ms (a time, or never)", 0, SCENARIO_DURATION_MAX_MS, range)) {
        return false;
    }
    fault->ended_ms = (scenario_window_t){.from = (uint32_t)range[0], .to = (uint32_t)range[1]};
    return true;
}

static const yaml_key_t FAULT[] = {
    YAML_REQUIRED(YAML_CALL("name", read_fault_name, &SCENARIO_FAULT_SHAPE)),
    YAML_OPTIONAL(YAML_WORD("class", scenario_fault_t, fault_class, CLASSES), YAML_GIVEN(scenario_fault_t, has_class)),
    YAML_OPTIONAL(YAML_LIST("parts", read_failed_part, &FAILED_PART)),
    SCENARIO_WHEN(scenario_fault_t, "raised_ms", raised_ms),
    YAML_OPTIONAL(YAML_CALL("ended_ms", read_fault_ended, &ENDED))};
static const yaml_shape_t FAULT_SHAPE = {YAML_MAP_SHAPE(FAULT), .rules = {SCENARIO_WHEN_RULES("raised_ms")}};

static bool read_fault(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_fault_t *fault = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.faults);
    const scenario_when_t when = {.scenario = target, .what = "a fault", .key = "raised_ms"};

    if (fault == NULL) {
        return false;
    }
    fault->line = yaml_node_line(node);
    if (!yaml_reader_map(reader, node, when.what, FAULT, COUNT(FAULT), fault) ||
        !scenario_parse_when(reader, node, &when, &fault->raised_ms)) {
        return false;
    }
    return (fault->parts == 0) || (fault->fault == AGV_FAULT_SELF_TEST_FAILED) ||
           yaml_reader_fail(reader, node, "a fault: only SELF_TEST_FAILED has 'parts'");
}

/* --- resets and reports at start --- */

static bool read_missing_word(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    const char *text = yaml_reader_text(reader, node, "what is missing");

    if (text == NULL) {
        return false;
    }
    const uint16_t bit = missing_bit(text);
    if (bit != 0) {
        ((scenario_reset_t *)target)->missing |= bit;
        return true;
    }
    return yaml_reader_fail(
        reader, node,
        "'%.40s' is not one of state, vcu_heartbeat, eps_heartbeat, trip_cause, standstill, manual, "
        "button, messages, throttle, released, output_feedback",
        text);
}

static bool read_missing(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_list(reader, node, "what is missing", read_missing_word, target);
}

static const yaml_key_t RESET[] = {YAML_REQUIRED(YAML_FLAG("accepted", scenario_reset_t, accepted)),
                                   YAML_OPTIONAL(YAML_CALL("why", read_missing, &MISSING)),
                                   SCENARIO_WHEN(scenario_reset_t, "at_ms", at_ms)};
static const yaml_shape_t RESET_SHAPE = {YAML_MAP_SHAPE(RESET), .rules = {SCENARIO_WHEN_RULES("at_ms")}};

static bool read_reset(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_reset_t *reset = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.resets);
    const scenario_when_t when = {.scenario = target, .what = "a reset", .key = "at_ms"};

    if (reset == NULL) {
        return false;
    }
    reset->line = yaml_node_line(node);
    if (!yaml_reader_map(reader, node, when.what, RESET, COUNT(RESET), reset) ||
        !scenario_parse_when(reader, node, &when, &reset->at_ms)) {
        return false;
    }
    return (reset->accepted == (reset->missing == 0)) ||
           yaml_reader_fail(reader, node, "a reset: 'why' is needed for a refused reset, and only for that");
}

static const yaml_key_t STARTUP[] = {YAML_REQUIRED(YAML_CALL("missing", read_missing, &MISSING)),
                                     SCENARIO_WHEN(scenario_reset_t, "at_ms", at_ms)};
static const yaml_shape_t STARTUP_SHAPE = {YAML_MAP_SHAPE(STARTUP), .rules = {SCENARIO_WHEN_RULES("at_ms")}};

static bool read_startup(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_reset_t *startup = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.startups);
    const scenario_when_t when = {.scenario = target, .what = "a report at start", .key = "at_ms"};

    if (startup == NULL) {
        return false;
    }
    startup->line = yaml_node_line(node);
    return yaml_reader_map(reader, node, when.what, STARTUP, COUNT(STARTUP), startup) &&
           scenario_parse_when(reader, node, &when, &startup->at_ms);
}

/* --- all of it --- */

static const yaml_shape_t ANY = {.kind = YAML_KIND_WORD, .words = ANY_WORDS};
static const yaml_shape_t STATES_SHAPE = {
    .kind = YAML_KIND_LIST, .items = &STATE_SHAPE, .highest = SCENARIO_EXPECT_MAX, .other = &ANY};

/** A list of all changes of state, or `any`. */
static bool read_list_states(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    const char *text = yaml_node_text(node);

    if ((text != NULL) && (strcmp(text, "any") == 0)) {
        ((scenario_t *)target)->expect.any_states = true;
        return true;
    }
    return yaml_reader_list(reader, node, "states", read_state, target);
}

static bool read_hazards(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    int value = 0;

    if (!yaml_reader_word(reader, node, "hazards", NEVER_WORDS, &value)) {
        return false;
    }
    ((scenario_t *)target)->expect.no_hazards = yaml_node_line(node);
    return true;
}

static const yaml_key_t EXPECT[] = {
    YAML_REQUIRED(YAML_CALL("states", read_list_states, &STATES_SHAPE)),
    YAML_OPTIONAL(YAML_LIST("frames", scenario_parse_frame, &SCENARIO_FRAME_SHAPE), .highest = SCENARIO_EXPECT_MAX),
    YAML_OPTIONAL(YAML_LIST("never", scenario_parse_never, &SCENARIO_NEVER_SHAPE), .highest = SCENARIO_EXPECT_MAX),
    YAML_OPTIONAL(YAML_LIST("safety_output", read_output, &OUTPUT_SHAPE), .highest = SCENARIO_EXPECT_MAX),
    YAML_OPTIONAL(YAML_LIST("led", read_led, &LED_SHAPE), .highest = SCENARIO_EXPECT_MAX),
    YAML_OPTIONAL(YAML_LIST("faults", read_fault, &FAULT_SHAPE), .highest = SCENARIO_EXPECT_MAX),
    YAML_OPTIONAL(YAML_WORD("other_faults", scenario_t, expect.no_other_faults, OTHERS)),
    YAML_OPTIONAL(YAML_LIST("resets", read_reset, &RESET_SHAPE), .highest = SCENARIO_EXPECT_MAX),
    YAML_OPTIONAL(YAML_LIST("startup", read_startup, &STARTUP_SHAPE), .highest = SCENARIO_EXPECT_MAX),
    YAML_OPTIONAL(YAML_LIST("vehicle", scenario_parse_vehicle, &SCENARIO_SEEN_SHAPE), .highest = SCENARIO_EXPECT_MAX),
    YAML_OPTIONAL(YAML_CALL("counters_at_end", scenario_parse_counters, &SCENARIO_COUNTERS_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("hazards", read_hazards, &NEVER)),
};
const yaml_shape_t SCENARIO_EXPECT_SHAPE = {YAML_MAP_SHAPE(EXPECT)};

/** What is not checked with `states: any` must not be expected. */
static const char *unchecked(const scenario_expect_t *expect) {
    if (!expect->any_states) {
        return NULL;
    }
    if (expect->outputs.count > 0) {
        return "safety_output";
    }
    if (expect->resets.count > 0) {
        return "resets";
    }
    return (expect->startups.count > 0) ? "startup" : NULL;
}

bool scenario_parse_expect(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    if (!yaml_reader_map(reader, node, "expect", EXPECT, COUNT(EXPECT), target)) {
        return false;
    }
    const char *what = unchecked(&((const scenario_t *)target)->expect);
    return (what == NULL) || yaml_reader_fail(reader, node, "%s cannot be expected together with 'states: any'", what);
}

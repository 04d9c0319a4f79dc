/* Scenario files: what is expected. */
#include <string.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "io/yaml_file.h"
#include "scenario/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])
#define MISSING_KINDS 10u

bool scenario_parse_window(const yaml_reader_t *reader, const yaml_node_t *node, const char *what,
                           scenario_window_t *window) {
    int64_t range[2];

    if (!yaml_reader_range(reader, node, what, 0, SCENARIO_DURATION_MAX_MS, range)) {
        return false;
    }
    *window = (scenario_window_t){(uint32_t)range[0], (uint32_t)range[1]};
    return true;
}

/* --- states --- */

static bool read_state_to(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_word_t words[] = {{"INIT", AGV_STATE_INIT},     {"STANDBY", AGV_STATE_STANDBY},
                                        {"ACTIVE", AGV_STATE_ACTIVE}, {"TRIPPED", AGV_STATE_TRIPPED},
                                        {"SAFE", AGV_STATE_SAFE},     {NULL, 0}};
    int value = 0;

    if (!yaml_reader_word(reader, node, "to", words, &value)) {
        return false;
    }
    ((scenario_state_t *)target)->to = (agv_state_t)value;
    return true;
}

static bool read_state_reason(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_fault(reader, node, &((scenario_state_t *)target)->reason);
}

static bool read_state_time(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_window(reader, node, "at_ms", &((scenario_state_t *)target)->at_ms);
}

static bool read_state(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {
        {"to", read_state_to, true}, {"reason", read_state_reason, false}, {"at_ms", read_state_time, true}};
    scenario_state_t *state = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.states);

    if (state == NULL) {
        return false;
    }
    state->line = yaml_node_line(node);
    state->reason = AGV_FAULT_NONE;
    return yaml_reader_map(reader, node, "a state", keys, COUNT(keys), state);
}

/* --- safety output, LED --- */

static bool read_output_closed(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_bool(reader, node, "closed", &((scenario_output_t *)target)->closed);
}

static bool read_output_time(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_window(reader, node, "at_ms", &((scenario_output_t *)target)->at_ms);
}

static bool read_output(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {{"closed", read_output_closed, true}, {"at_ms", read_output_time, true}};
    scenario_output_t *output = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.outputs);

    if (output == NULL) {
        return false;
    }
    output->line = yaml_node_line(node);
    return yaml_reader_map(reader, node, "a change of the safety output", keys, COUNT(keys), output);
}

static bool read_led_code(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    int64_t code = 0;

    if (!yaml_reader_number(reader, node, "code", -1, 17, &code)) {
        return false;
    }
    ((scenario_led_t *)target)->code = (int8_t)code;
    return true;
}

static bool read_led_time(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_window(reader, node, "at_ms", &((scenario_led_t *)target)->at_ms);
}

static bool read_led(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {{"code", read_led_code, true}, {"at_ms", read_led_time, true}};
    scenario_led_t *led = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.leds);

    if (led == NULL) {
        return false;
    }
    led->line = yaml_node_line(node);
    return yaml_reader_map(reader, node, "a code of the LED", keys, COUNT(keys), led);
}

/* --- faults --- */

static bool read_fault_name(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_fault(reader, node, &((scenario_fault_t *)target)->fault);
}

static bool read_fault_class(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_word_t words[] = {{"trip", AGV_CLASS_TRIP}, {"warn", AGV_CLASS_WARN}, {NULL, 0}};
    scenario_fault_t *fault = target;
    int value = 0;

    if (!yaml_reader_word(reader, node, "class", words, &value)) {
        return false;
    }
    fault->fault_class = (agv_fault_class_t)value;
    fault->has_class = true;
    return true;
}

static bool read_fault_raised(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_window(reader, node, "raised_ms", &((scenario_fault_t *)target)->raised_ms);
}

static bool read_fault_ended(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_fault_t *fault = target;
    const char *text = yaml_node_text(node);

    fault->has_end = true;
    fault->never_ends = (text != NULL) && (strcmp(text, "never") == 0);
    return fault->never_ends || scenario_parse_window(reader, node, "ended_ms (a time, or never)", &fault->ended_ms);
}

static bool read_fault(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {{"name", read_fault_name, true},
                                      {"class", read_fault_class, false},
                                      {"raised_ms", read_fault_raised, true},
                                      {"ended_ms", read_fault_ended, false}};
    scenario_fault_t *fault = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.faults);

    if (fault == NULL) {
        return false;
    }
    fault->line = yaml_node_line(node);
    return yaml_reader_map(reader, node, "a fault", keys, COUNT(keys), fault);
}

static bool read_other_faults(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_word_t words[] = {{"allowed", 0}, {"never", 1}, {NULL, 0}};
    int value = 0;

    if (!yaml_reader_word(reader, node, "other_faults", words, &value)) {
        return false;
    }
    ((scenario_t *)target)->expect.no_other_faults = value != 0;
    return true;
}

/* --- resets and reports at start --- */

static bool read_missing_word(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    const char *text = yaml_reader_text(reader, node, "what is missing");

    if (text == NULL) {
        return false;
    }
    for (uint8_t i = 0u; i < MISSING_KINDS; i++) {
        if (strcmp(agv_missing_name(i), text) == 0) {
            ((scenario_reset_t *)target)->missing |= (uint16_t)(1u << i);
            return true;
        }
    }
    return yaml_reader_fail(reader, node,
                            "'%.40s' is none of state, vcu_heartbeat, eps_heartbeat, trip_cause, standstill, manual, "
                            "button, messages, throttle, released",
                            text);
}

static bool read_reset_missing(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_list(reader, node, "what is missing", read_missing_word, target);
}

static bool read_reset_accepted(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_bool(reader, node, "accepted", &((scenario_reset_t *)target)->accepted);
}

static bool read_reset_time(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_window(reader, node, "at_ms", &((scenario_reset_t *)target)->at_ms);
}

static bool read_reset(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {
        {"accepted", read_reset_accepted, true}, {"why", read_reset_missing, false}, {"at_ms", read_reset_time, true}};
    scenario_reset_t *reset = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.resets);

    if (reset == NULL) {
        return false;
    }
    reset->line = yaml_node_line(node);
    if (!yaml_reader_map(reader, node, "a reset", keys, COUNT(keys), reset)) {
        return false;
    }
    return (reset->accepted == (reset->missing == 0u)) ||
           yaml_reader_fail(reader, node, "a reset: 'why' belongs to one that is refused, and to each of those");
}

static bool read_startup(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {{"missing", read_reset_missing, true}, {"at_ms", read_reset_time, true}};
    scenario_reset_t *startup = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.startups);

    if (startup == NULL) {
        return false;
    }
    startup->line = yaml_node_line(node);
    return yaml_reader_map(reader, node, "a report at start", keys, COUNT(keys), startup);
}

/* --- all of it --- */

#define LIST(name, item)                                                                                               \
    static bool read_list_##name(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {                 \
        return yaml_reader_list(reader, node, #name, (item), target);                                                  \
    }
LIST(frames, scenario_parse_frame)
LIST(never, scenario_parse_never)
LIST(safety_output, read_output)
LIST(led, read_led)
LIST(faults, read_fault)
LIST(resets, read_reset)
LIST(startup, read_startup)
LIST(vehicle, scenario_parse_vehicle)

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
    static const yaml_word_t words[] = {{"never", 1}, {NULL, 0}};
    int value = 0;

    if (!yaml_reader_word(reader, node, "hazards", words, &value)) {
        return false;
    }
    ((scenario_t *)target)->expect.no_hazards = yaml_node_line(node);
    return true;
}

bool scenario_parse_expect(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {
        {"states", read_list_states, true},
        {"frames", read_list_frames, false},
        {"never", read_list_never, false},
        {"safety_output", read_list_safety_output, false},
        {"led", read_list_led, false},
        {"faults", read_list_faults, false},
        {"other_faults", read_other_faults, false},
        {"resets", read_list_resets, false},
        {"startup", read_list_startup, false},
        {"vehicle", read_list_vehicle, false},
        {"counters_at_end", scenario_parse_counters, false},
        {"hazards", read_hazards, false},
    };
    return yaml_reader_map(reader, node, "expect", keys, COUNT(keys), target);
}

/* Scenario files: what the vehicle is expected to do, and the counters of the supervisor. */
#include <stddef.h>

#include "agv/counters.h"
#include "io/yaml_file.h"
#include "scenario/parse/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static const yaml_word_t MODES[] = {{"manual", 0}, {"autopilot", 1}, {NULL, 0}};
static const yaml_word_t EPS_MODES[] = {{"assist", AGV_EPS_MODE_ASSIST}, {"angle", AGV_EPS_MODE_ANGLE}, {NULL, 0}};

#define SEEN(row, has) YAML_OPTIONAL(row, YAML_GIVEN(scenario_vehicle_t, has))
#define SEEN_RANGE(name, member, has) SEEN(YAML_RANGE(name, scenario_vehicle_t, member, -RANGE_MAX, RANGE_MAX), has)

enum { RANGE_MAX = 100000 };

static const yaml_key_t SEEN_KEYS[] = {
    YAML_OPTIONAL(YAML_TIME("at_ms", scenario_vehicle_t, at_ms.from, 0, SCENARIO_DURATION_MAX_MS)),
    SCENARIO_AFTER(scenario_vehicle_t, at_ms),
    SEEN(YAML_WORD("gear", scenario_vehicle_t, gear, SCENARIO_GEARS), has_gear),
    SEEN(YAML_WORD("mode", scenario_vehicle_t, autopilot, MODES), has_mode),
    SEEN_RANGE("speed_mm_s", speed_mm_s, has_speed),
    SEEN_RANGE("throttle_pct", throttle_pct, has_throttle),
    SEEN(YAML_WORD("eps_mode", scenario_vehicle_t, eps_mode, EPS_MODES), has_eps_mode),
    SEEN_RANGE("angle_deg", angle_deg, has_angle),
    SEEN_RANGE("park_taken_at_mm_s", fastest_park_mm_s, has_fastest_park),
    SEEN(YAML_HEX("alarms", scenario_vehicle_t, alarms, UINT8_MAX), has_alarms),
};
const yaml_shape_t SCENARIO_SEEN_SHAPE = {YAML_MAP_SHAPE(SEEN_KEYS), .rules = {SCENARIO_WHEN_RULES("at_ms")}};

bool scenario_parse_vehicle(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_vehicle_t *vehicle = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.vehicle);

    if (vehicle == NULL) {
        return false;
    }
    vehicle->line = yaml_node_line(node);
    const scenario_when_t when = {.scenario = target, .what = "the vehicle at a time", .key = "at_ms"};
    if (!yaml_reader_map(reader, node, when.what, SEEN_KEYS, COUNT(SEEN_KEYS), vehicle)) {
        return false;
    }
    if (!vehicle->has_gear && !vehicle->has_mode && !vehicle->has_speed && !vehicle->has_throttle &&
        !vehicle->has_eps_mode && !vehicle->has_angle && !vehicle->has_fastest_park && !vehicle->has_alarms) {
        return yaml_reader_fail(reader, node, "the vehicle at a time: give at least one value, such as gear");
    }
    vehicle->at_ms.to = (vehicle->at_ms.to < vehicle->at_ms.from) ? vehicle->at_ms.from : vehicle->at_ms.to;
    return scenario_parse_when(reader, node, &when, &vehicle->at_ms);
}

/* --- counters at the end --- */

#define COUNTER(name)                                                                                                  \
    static bool read_counter_##name(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {              \
        return read_counter(reader, node, target, #name, offsetof(agv_counters_t, name));                              \
    }
#define REJECTED(name, kind)                                                                                           \
    static bool read_counter_##name(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {              \
        return read_counter(reader, node, target, #name,                                                               \
                            offsetof(agv_counters_t, rejected) + ((size_t)(kind) * sizeof(uint32_t)));                 \
    }

static bool read_counter(const yaml_reader_t *reader, const yaml_node_t *node, void *target, const char *name,
                         size_t offset) {
    int64_t range[2];
    scenario_counter_t *counter = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.counters);

    if ((counter == NULL) || !yaml_reader_range(reader, node, name, 0, UINT32_MAX, range)) {
        return false;
    }
    *counter = (scenario_counter_t){.line = yaml_node_line(node),
                                    .name = name,
                                    .offset = offset,
                                    .value = {.from = (uint32_t)range[0], .to = (uint32_t)range[1]}};
    return true;
}

COUNTER(received)
COUNTER(dropped)
COUNTER(sent)
COUNTER(shadowed)
COUNTER(gate_refused)
COUNTER(skipped_slots)
COUNTER(warnings)
REJECTED(rejected_length, AGV_REJECTED_LENGTH)
REJECTED(rejected_fd, AGV_REJECTED_FD)
REJECTED(rejected_remote, AGV_REJECTED_REMOTE)
REJECTED(rejected_extended, AGV_REJECTED_EXTENDED)
REJECTED(rejected_error, AGV_REJECTED_ERROR)

static const yaml_shape_t COUNT_SHAPE = {.kind = YAML_KIND_RANGE, .highest = UINT32_MAX};

static const yaml_key_t COUNTERS[] = {
    YAML_OPTIONAL(YAML_CALL("received", read_counter_received, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("dropped", read_counter_dropped, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("sent", read_counter_sent, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("shadowed", read_counter_shadowed, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("gate_refused", read_counter_gate_refused, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("skipped_slots", read_counter_skipped_slots, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("warnings", read_counter_warnings, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("rejected_length", read_counter_rejected_length, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("rejected_fd", read_counter_rejected_fd, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("rejected_remote", read_counter_rejected_remote, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("rejected_extended", read_counter_rejected_extended, &COUNT_SHAPE)),
    YAML_OPTIONAL(YAML_CALL("rejected_error", read_counter_rejected_error, &COUNT_SHAPE)),
};
const yaml_shape_t SCENARIO_COUNTERS_SHAPE = {YAML_MAP_SHAPE(COUNTERS)};

bool scenario_parse_counters(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_map(reader, node, "counters_at_end", COUNTERS, COUNT(COUNTERS), target);
}

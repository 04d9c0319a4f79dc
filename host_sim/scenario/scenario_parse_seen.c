/* Scenario files: what the vehicle is expected to do, and the counters of the supervisor. */
#include <stddef.h>

#include "agv/counters.h"
#include "io/yaml_file.h"
#include "scenario/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static bool read_vehicle_time(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_time(reader, node, "at_ms", &((scenario_vehicle_t *)target)->at_ms);
}

static bool read_vehicle_gear(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_vehicle_t *vehicle = target;
    int value = 0;

    vehicle->has_gear = true;
    if (!yaml_reader_word(reader, node, "gear", SCENARIO_GEARS, &value)) {
        return false;
    }
    vehicle->gear = (uint8_t)value;
    return true;
}

static bool read_vehicle_mode(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_word_t words[] = {{"manual", 0}, {"autopilot", 1}, {NULL, 0}};
    scenario_vehicle_t *vehicle = target;
    int value = 0;

    vehicle->has_mode = true;
    if (!yaml_reader_word(reader, node, "mode", words, &value)) {
        return false;
    }
    vehicle->autopilot = value != 0;
    return true;
}

static bool read_vehicle_eps_mode(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_word_t words[] = {{"assist", AGV_EPS_MODE_ASSIST}, {"angle", AGV_EPS_MODE_ANGLE}, {NULL, 0}};
    scenario_vehicle_t *vehicle = target;
    int value = 0;

    vehicle->has_eps_mode = true;
    if (!yaml_reader_word(reader, node, "eps_mode", words, &value)) {
        return false;
    }
    vehicle->eps_mode = (uint8_t)value;
    return true;
}

static bool read_vehicle_range(const yaml_reader_t *reader, const yaml_node_t *node, const char *what, int32_t range[2],
                               bool *has) {
    int64_t value[2];

    *has = true;
    if (!yaml_reader_range(reader, node, what, -100000, 100000, value)) {
        return false;
    }
    range[0] = (int32_t)value[0];
    range[1] = (int32_t)value[1];
    return true;
}

static bool read_vehicle_speed(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_vehicle_t *vehicle = target;
    return read_vehicle_range(reader, node, "speed_mm_s", vehicle->speed_mm_s, &vehicle->has_speed);
}

static bool read_vehicle_throttle(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_vehicle_t *vehicle = target;
    return read_vehicle_range(reader, node, "throttle_pct", vehicle->throttle_pct, &vehicle->has_throttle);
}

static bool read_vehicle_angle(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_vehicle_t *vehicle = target;
    return read_vehicle_range(reader, node, "angle_deg", vehicle->angle_deg, &vehicle->has_angle);
}

static bool read_vehicle_park(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_vehicle_t *vehicle = target;
    return read_vehicle_range(reader, node, "park_taken_at_mm_s", vehicle->fastest_park_mm_s,
                              &vehicle->has_fastest_park);
}

static bool read_vehicle_alarms(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    scenario_vehicle_t *vehicle = target;
    uint32_t value = 0u;

    vehicle->has_alarms = true;
    if (!yaml_reader_hex(reader, node, "alarms", UINT8_MAX, &value)) {
        return false;
    }
    vehicle->alarms = (uint8_t)value;
    return true;
}

bool scenario_parse_vehicle(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {
        {"at_ms", read_vehicle_time, true},
        {"gear", read_vehicle_gear, false},
        {"mode", read_vehicle_mode, false},
        {"speed_mm_s", read_vehicle_speed, false},
        {"throttle_pct", read_vehicle_throttle, false},
        {"eps_mode", read_vehicle_eps_mode, false},
        {"angle_deg", read_vehicle_angle, false},
        {"park_taken_at_mm_s", read_vehicle_park, false},
        {"alarms", read_vehicle_alarms, false},
    };
    scenario_vehicle_t *vehicle = SCENARIO_NEXT(reader, node, ((scenario_t *)target)->expect.vehicle);

    if (vehicle == NULL) {
        return false;
    }
    vehicle->line = yaml_node_line(node);
    return yaml_reader_map(reader, node, "the vehicle at a moment", keys, COUNT(keys), vehicle);
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
    *counter = (scenario_counter_t){yaml_node_line(node), name, offset, {(uint32_t)range[0], (uint32_t)range[1]}};
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

bool scenario_parse_counters(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {
        {"received", read_counter_received, false},
        {"dropped", read_counter_dropped, false},
        {"sent", read_counter_sent, false},
        {"shadowed", read_counter_shadowed, false},
        {"gate_refused", read_counter_gate_refused, false},
        {"skipped_slots", read_counter_skipped_slots, false},
        {"warnings", read_counter_warnings, false},
        {"rejected_length", read_counter_rejected_length, false},
        {"rejected_fd", read_counter_rejected_fd, false},
        {"rejected_remote", read_counter_rejected_remote, false},
        {"rejected_extended", read_counter_rejected_extended, false},
        {"rejected_error", read_counter_rejected_error, false},
    };
    return yaml_reader_map(reader, node, "counters_at_end", keys, COUNT(keys), target);
}

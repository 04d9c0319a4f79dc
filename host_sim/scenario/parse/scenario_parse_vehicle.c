/* Scenario files: how the vehicle is built. */
#include <string.h>

#include "io/yaml_file.h"
#include "scenario/parse/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

static const yaml_word_t NO_START_WORDS[] = {{"never", 0}, {NULL, 0}};
static const yaml_shape_t NO_START = {.kind = YAML_KIND_WORD, .words = NO_START_WORDS};
static const yaml_shape_t START = {
    .kind = YAML_KIND_TIME, .unit = DURATION_MS, .highest = SCENARIO_DURATION_MAX_MS, .other = &NO_START};
static const yaml_shape_t ID_SET = {.kind = YAML_KIND_WORD, .words = SCENARIO_ID_SETS};

static bool read_start(const yaml_reader_t *reader, const yaml_node_t *node, uint32_t *start_ms) {
    const char *text = yaml_node_text(node);

    if ((text != NULL) && (strcmp(text, "never") == 0)) {
        *start_ms = VEHICLE_NEVER;
        return true;
    }
    return scenario_parse_time(reader, node, "start (a time in ms, or never)", start_ms);
}

static bool read_start_vcu(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return read_start(reader, node, &((vehicle_config_t *)target)->start_ms[VEHICLE_VCU]);
}

static bool read_start_eps(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return read_start(reader, node, &((vehicle_config_t *)target)->start_ms[VEHICLE_EPS]);
}

static bool read_start_ai(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return read_start(reader, node, &((vehicle_config_t *)target)->start_ms[VEHICLE_AI]);
}

/* The phase of each message, by its name. */
static const yaml_key_t PHASES[] = {
#define AGV_COMMAND(NAME, name, heading, table, cycle, deadline, fault, counter)                                       \
    YAML_OPTIONAL(YAML_TIME(#name, vehicle_config_t, phase_ms[AGV_MSG_##NAME], 0, UINT16_MAX)),
#define AGV_STATUS AGV_COMMAND
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
};
static const yaml_shape_t PHASES_SHAPE = {YAML_MAP_SHAPE(PHASES)};

static bool read_phases(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_map(reader, node, "phases_ms", PHASES, COUNT(PHASES), target);
}

static bool read_vehicle_id_set(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    int value = 0;

    if (!yaml_reader_word(reader, node, "id_set", SCENARIO_ID_SETS, &value)) {
        return false;
    }
    for (uint32_t m = 0; m < AGV_MSG_COUNT; m++) {
        ((vehicle_config_t *)target)->ids.of[m] = agv_message_id(m, (uint32_t)value);
    }
    return true;
}

/* A figure of the vehicle, a 16-bit number; a time. */
#define FIGURE(name, lowest) YAML_OPTIONAL(YAML_NUMBER(#name, vehicle_config_t, name, lowest, UINT16_MAX))
#define FIGURE_MS(name, lowest) YAML_OPTIONAL(YAML_TIME(#name, vehicle_config_t, name, lowest, UINT16_MAX))

static const yaml_key_t VEHICLE[] = {
    YAML_OPTIONAL(YAML_CALL("id_set", read_vehicle_id_set, &ID_SET)),
    YAML_OPTIONAL(YAML_FLAG("park_guard", vehicle_config_t, park_guard)),
    YAML_OPTIONAL(YAML_FLAG("obeys_short_frames", vehicle_config_t, obeys_short_frames)),
    YAML_OPTIONAL(YAML_CALL("vcu_starts_ms", read_start_vcu, &START)),
    YAML_OPTIONAL(YAML_CALL("eps_starts_ms", read_start_eps, &START)),
    YAML_OPTIONAL(YAML_CALL("ai_starts_ms", read_start_ai, &START)),
    YAML_OPTIONAL(YAML_NUMBER("seed", vehicle_config_t, seed, 1, UINT32_MAX)),
    FIGURE_MS(gear_change_ms, 0),
    FIGURE(walking_pace_mm_s, 1),
    FIGURE(top_speed_mm_s, 1),
    FIGURE(acceleration_mm_s2, 1),
    FIGURE(coasting_mm_s2, 1),
    FIGURE(braking_mm_s2, 1),
    FIGURE(locked_mm_s2, 1),
    FIGURE(steering_rate_ddeg_s, 0),
    FIGURE_MS(eps_mode_change_ms, 0),
    FIGURE(throttle_rise_pct_s, 0),
    FIGURE(throttle_fall_pct_s, 0),
    FIGURE(reported_speed_pct, 0),
    FIGURE_MS(ai_lost_ms, 1),
    FIGURE_MS(eps_lost_ms, 1),
    YAML_OPTIONAL(YAML_CALL("phases_ms", read_phases, &PHASES_SHAPE)),
};
const yaml_shape_t SCENARIO_VEHICLE_SHAPE = {YAML_MAP_SHAPE(VEHICLE)};

bool scenario_parse_vehicle_config(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_map(reader, node, "vehicle", VEHICLE, COUNT(VEHICLE), target);
}

/* Scenario files: how the vehicle is built. */
#include <string.h>

#include "io/yaml_file.h"
#include "scenario/scenario_parse.h"

#define COUNT(array) (sizeof(array) / sizeof(array)[0])

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

static bool read_guard(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_bool(reader, node, "park_guard", &((vehicle_config_t *)target)->park_guard);
}

static bool read_short(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return yaml_reader_bool(reader, node, "obeys_short_frames", &((vehicle_config_t *)target)->obeys_short_frames);
}

static bool read_seed(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    return scenario_parse_u32(reader, node, "seed", 1u, UINT32_MAX, &((vehicle_config_t *)target)->seed);
}

/* The figures of the vehicle, each a 16-bit number. */
#define FIGURE(name, lowest)                                                                                           \
    static bool read_##name(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {                      \
        uint32_t value = 0u;                                                                                           \
        if (!scenario_parse_u32(reader, node, #name, (lowest), UINT16_MAX, &value)) {                                  \
            return false;                                                                                              \
        }                                                                                                              \
        ((vehicle_config_t *)target)->name = (uint16_t)value;                                                          \
        return true;                                                                                                   \
    }
FIGURE(gear_change_ms, 0u)
FIGURE(walking_pace_mm_s, 1u)
FIGURE(top_speed_mm_s, 1u)
FIGURE(acceleration_mm_s2, 1u)
FIGURE(coasting_mm_s2, 1u)
FIGURE(braking_mm_s2, 1u)
FIGURE(locked_mm_s2, 1u)
FIGURE(steering_rate_ddeg_s, 0u)
FIGURE(eps_mode_change_ms, 0u)
FIGURE(throttle_rise_pct_s, 0u)
FIGURE(throttle_fall_pct_s, 0u)
FIGURE(reported_speed_pct, 0u)
FIGURE(ai_lost_ms, 1u)
FIGURE(eps_lost_ms, 1u)

/* The phase of each message, by its name. */
#define PHASE(name, message)                                                                                           \
    static bool read_phase_##name(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {                \
        uint32_t value = 0u;                                                                                           \
        if (!scenario_parse_u32(reader, node, #name, 0u, UINT16_MAX, &value)) {                                        \
            return false;                                                                                              \
        }                                                                                                              \
        ((vehicle_config_t *)target)->phase_ms[(message)] = (uint16_t)value;                                           \
        return true;                                                                                                   \
    }
PHASE(turn_signal_command, AGV_MSG_TURN_SIGNAL_COMMAND)
PHASE(gear_command, AGV_MSG_GEAR_COMMAND)
PHASE(throttle_command, AGV_MSG_THROTTLE_COMMAND)
PHASE(steering_command, AGV_MSG_STEERING_COMMAND)
PHASE(vehicle_status, AGV_MSG_VEHICLE_STATUS)
PHASE(gear_status, AGV_MSG_GEAR_STATUS)
PHASE(throttle_status, AGV_MSG_THROTTLE_STATUS)
PHASE(steering_status, AGV_MSG_STEERING_STATUS)
PHASE(eps_status, AGV_MSG_EPS_STATUS)
PHASE(steering_position, AGV_MSG_STEERING_POSITION)
PHASE(wheel_speed, AGV_MSG_WHEEL_SPEED)

static bool read_phases(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {
        {"turn_signal_command", read_phase_turn_signal_command, false},
        {"gear_command", read_phase_gear_command, false},
        {"throttle_command", read_phase_throttle_command, false},
        {"steering_command", read_phase_steering_command, false},
        {"vehicle_status", read_phase_vehicle_status, false},
        {"gear_status", read_phase_gear_status, false},
        {"throttle_status", read_phase_throttle_status, false},
        {"steering_status", read_phase_steering_status, false},
        {"eps_status", read_phase_eps_status, false},
        {"steering_position", read_phase_steering_position, false},
        {"wheel_speed", read_phase_wheel_speed, false},
    };
    return yaml_reader_map(reader, node, "phases_ms", keys, COUNT(keys), target);
}

static bool read_vehicle_id_set(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    int value = 0;

    if (!yaml_reader_word(reader, node, "id_set", SCENARIO_ID_SETS, &value)) {
        return false;
    }
    for (uint32_t m = 0u; m < (uint32_t)AGV_MSG_COUNT; m++) {
        ((vehicle_config_t *)target)->ids.of[m] = agv_message_id(m, (uint32_t)value);
    }
    return true;
}

bool scenario_parse_vehicle_config(const yaml_reader_t *reader, const yaml_node_t *node, void *target) {
    static const yaml_key_t keys[] = {
        {"id_set", read_vehicle_id_set, false},
        {"park_guard", read_guard, false},
        {"obeys_short_frames", read_short, false},
        {"vcu_starts_ms", read_start_vcu, false},
        {"eps_starts_ms", read_start_eps, false},
        {"ai_starts_ms", read_start_ai, false},
        {"seed", read_seed, false},
        {"gear_change_ms", read_gear_change_ms, false},
        {"walking_pace_mm_s", read_walking_pace_mm_s, false},
        {"top_speed_mm_s", read_top_speed_mm_s, false},
        {"acceleration_mm_s2", read_acceleration_mm_s2, false},
        {"coasting_mm_s2", read_coasting_mm_s2, false},
        {"braking_mm_s2", read_braking_mm_s2, false},
        {"locked_mm_s2", read_locked_mm_s2, false},
        {"steering_rate_ddeg_s", read_steering_rate_ddeg_s, false},
        {"eps_mode_change_ms", read_eps_mode_change_ms, false},
        {"throttle_rise_pct_s", read_throttle_rise_pct_s, false},
        {"throttle_fall_pct_s", read_throttle_fall_pct_s, false},
        {"reported_speed_pct", read_reported_speed_pct, false},
        {"ai_lost_ms", read_ai_lost_ms, false},
        {"eps_lost_ms", read_eps_lost_ms, false},
        {"phases_ms", read_phases, false},
    };
    return yaml_reader_map(reader, node, "vehicle", keys, COUNT(keys), target);
}

/* The vehicle: its nodes, their messages and when these are due. */
#include "vehicle/vehicle.h"

#include <string.h>

#include "vehicle/vehicle_internal.h"

/* Phases: at most two frames start in one millisecond. */
const vehicle_row_t VEHICLE_ROWS[AGV_MSG_COUNT] = {
    [AGV_MSG_TURN_SIGNAL_COMMAND] = {VEHICLE_AI, 9, vehicle_ai_turn_signal_command},
    [AGV_MSG_GEAR_COMMAND] = {VEHICLE_AI, 37, vehicle_ai_gear_command},
    [AGV_MSG_THROTTLE_COMMAND] = {VEHICLE_AI, 67, vehicle_ai_throttle_command},
    [AGV_MSG_STEERING_COMMAND] = {VEHICLE_AI, 8, vehicle_ai_steering_command},
    [AGV_MSG_VEHICLE_STATUS] = {VEHICLE_VCU, 0, vehicle_vcu_vehicle_status},
    [AGV_MSG_GEAR_STATUS] = {VEHICLE_VCU, 6, vehicle_vcu_gear_status},
    [AGV_MSG_THROTTLE_STATUS] = {VEHICLE_VCU, 4, vehicle_vcu_throttle_status},
    [AGV_MSG_STEERING_STATUS] = {VEHICLE_EPS, 1, vehicle_eps_steering_status},
    [AGV_MSG_EPS_STATUS] = {VEHICLE_EPS, 3, vehicle_eps_eps_status},
    [AGV_MSG_STEERING_POSITION] = {VEHICLE_EPS, 5, vehicle_eps_steering_position},
    [AGV_MSG_WHEEL_SPEED] = {VEHICLE_VCU, 2, vehicle_vcu_wheel_speed},
};

void vehicle_defaults(vehicle_config_t *config) {
    *config = (vehicle_config_t){
        .park_guard = true,
        .seed = 1,
        .gear_change_ms = 120,
        .walking_pace_mm_s = 800,
        .top_speed_mm_s = 4000,
        .acceleration_mm_s2 = 1000,
        .coasting_mm_s2 = 400,
        .braking_mm_s2 = 3000,
        .locked_mm_s2 = 5000,
        .steering_rate_ddeg_s = 3000,
        .eps_mode_change_ms = 200,
        .throttle_rise_pct_s = 500,
        .throttle_fall_pct_s = 500,
        .reported_speed_pct = 100,
        .ai_lost_ms = 1000,
        .eps_lost_ms = 100,
    };
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        config->phase_ms[m] = VEHICLE_ROWS[m].phase_ms;
        config->ids.of[m] = agv_message_id((uint32_t)m, AGV_ID_SET_HEADING);
    }
}

void vehicle_init(vehicle_t *vehicle, const vehicle_config_t *config, vehicle_send_fn *send, void *ctx) {
    memset(vehicle, 0, sizeof *vehicle);
    vehicle->config = *config;
    vehicle->send = send;
    vehicle->send_ctx = ctx;
    vehicle->random = (config->seed != 0) ? config->seed : 1;
    vehicle->dynamics.gear = AGV_GEAR_P;
    vehicle->dynamics.target = AGV_GEAR_P;
    vehicle->eps.mode = AGV_EPS_MODE_ASSIST;
    vehicle->eps.wanted = AGV_EPS_MODE_ASSIST;
    vehicle->operator.remote_gear = AGV_GEAR_P;
    vehicle->operator.ai_gear = AGV_GEAR_N;
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        vehicle->message_ms[m] = UINT64_MAX;
        vehicle->id[m] = config->ids.of[m];
    }
    for (int n = 0; n < VEHICLE_NODES; n++) {
        const uint32_t start_ms = config->start_ms[n];
        vehicle->nodes[n].start_ms = (start_ms == VEHICLE_NEVER) ? UINT64_MAX : start_ms;
    }
}

const char *vehicle_node_name(vehicle_node_t node) {
    static const char *const names[] = {"vcu", "eps", "ai", "stranger"};
    return names[node];
}

vehicle_node_t vehicle_sender_of(agv_message_t message) {
    return VEHICLE_ROWS[message].node;
}

vehicle_node_t vehicle_receiver_of(agv_message_t message) {
    if (VEHICLE_ROWS[message].node != VEHICLE_AI) {
        return VEHICLE_NODES;
    }
    return (message == AGV_MSG_STEERING_COMMAND) ? VEHICLE_EPS : VEHICLE_VCU;
}

hal_can_side_t vehicle_side_of(const vehicle_t *vehicle, vehicle_node_t node) {
    return (vehicle->config.gateway && (node == VEHICLE_AI)) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
}

int32_t vehicle_limit_angle(int32_t angle_ddeg) {
    if (angle_ddeg > AGV_ANGLE_MAX_DDEG) {
        return AGV_ANGLE_MAX_DDEG;
    }
    return (angle_ddeg < -AGV_ANGLE_MAX_DDEG) ? -AGV_ANGLE_MAX_DDEG : angle_ddeg;
}

int32_t vehicle_swing_ddeg(const vehicle_swing_t *swing, uint64_t now_ms) {
    if (swing->period_ms == 0) {
        return 0;
    }
    const int64_t period_ms = swing->period_ms;
    const int64_t phase_ms = (int64_t)((now_ms - swing->from_ms) % swing->period_ms);
    int64_t quarters = 4 * phase_ms; /* of the period, as a part of it: 0 .. 4 */
    if (quarters > 3 * period_ms) {
        quarters -= 4 * period_ms;
    } else if (quarters > period_ms) {
        quarters = (2 * period_ms) - quarters;
    }
    return (int32_t)(swing->amplitude_ddeg * quarters / period_ms);
}

uint8_t vehicle_count(vehicle_t *vehicle, vehicle_node_t node) {
    vehicle_node_state_t *state = &vehicle->nodes[node];
    if (!state->frozen) {
        state->counter++;
    }
    return state->counter;
}

static void schedule_messages(vehicle_t *vehicle, vehicle_node_t node, bool on, uint64_t now_ms) {
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        if (VEHICLE_ROWS[m].node == node) {
            vehicle->message_ms[m] = on ? now_ms + vehicle->config.phase_ms[m] : UINT64_MAX;
        }
    }
}

void vehicle_look_again(vehicle_t *vehicle, uint64_t now_ms) {
    vehicle->seldom_ms = now_ms;
    vehicle->due_ms = now_ms;
}

void vehicle_power(vehicle_t *vehicle, vehicle_node_t node, bool on, uint64_t now_ms) {
    vehicle_node_state_t *state = &vehicle->nodes[node];

    vehicle_look_again(vehicle, now_ms);
    state->start_ms = UINT64_MAX;
    if (state->running == on) {
        return;
    }
    if (node == VEHICLE_VCU) {
        vehicle_dynamics_move(vehicle, now_ms);
    }
    state->running = on;
    vehicle->power_changes++;
    state->counter = UINT8_MAX; /* the first frame carries 0 */
    schedule_messages(vehicle, node, on, now_ms);
    if (!on) {
        if (node == VEHICLE_VCU) {
            vehicle_vcu_stop(vehicle, now_ms);
        }
        return;
    }
    switch (node) {
    case VEHICLE_VCU:
        vehicle_vcu_start(vehicle, now_ms);
        break;
    case VEHICLE_EPS:
        vehicle_eps_start(vehicle, now_ms);
        break;
    default:
        vehicle_ai_start(vehicle, now_ms);
        break;
    }
}

static inline uint64_t earlier(uint64_t a, uint64_t b) {
    return (a < b) ? a : b;
}

/** What happens seldom: nodes that start, rogue nodes that send. */
static void run_seldom(vehicle_t *vehicle, uint64_t now_ms) {
    uint64_t next = vehicle_send_rogues(vehicle, now_ms);

    for (int n = 0; n < VEHICLE_NODES; n++) {
        if (now_ms >= vehicle->nodes[n].start_ms) {
            vehicle_power(vehicle, (vehicle_node_t)n, true, now_ms);
        }
        next = earlier(next, vehicle->nodes[n].start_ms);
    }
    vehicle->seldom_ms = next;
}

void vehicle_run(vehicle_t *vehicle, uint64_t now_ms) {
    if (now_ms >= vehicle->seldom_ms) {
        run_seldom(vehicle, now_ms);
    }
    uint64_t next = vehicle->seldom_ms;
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        if (now_ms >= vehicle->message_ms[m]) {
            vehicle_send_message(vehicle, (agv_message_t)m, now_ms);
        }
        next = earlier(next, vehicle->message_ms[m]);
    }
    vehicle->due_ms = next;
}

void vehicle_receive(vehicle_t *vehicle, vehicle_node_t node, uint64_t now_ms, const hal_can_frame_t *frame) {
    if (((unsigned)node >= VEHICLE_NODES) || !vehicle->nodes[node].running) {
        return;
    }
    const bool is_fd_for_vcu = (frame->flags == HAL_CAN_FD) && (node == VEHICLE_VCU);
    if ((frame->flags != 0) && !is_fd_for_vcu) {
        return;
    }
    switch (node) {
    case VEHICLE_VCU:
        vehicle_vcu_receive(vehicle, now_ms, frame);
        break;
    case VEHICLE_EPS:
        vehicle_eps_receive(vehicle, now_ms, frame);
        break;
    default:
        vehicle_ai_receive(vehicle, now_ms, frame);
        break;
    }
}

void vehicle_view(vehicle_t *vehicle, uint64_t now_ms, vehicle_view_t *view) {
    vehicle_dynamics_move(vehicle, now_ms);
    vehicle_eps_move(vehicle, now_ms);
    *view = (vehicle_view_t){
        .gear = vehicle->dynamics.gear,
        .autopilot = vehicle->vcu.autopilot,
        .speed_mm_s = vehicle->dynamics.speed_um_s / 1000,
        .throttle_permille = vehicle_dynamics_throttle_permille(vehicle),
        .eps_mode = vehicle->eps.mode,
        .angle_ddeg = vehicle_eps_angle_ddeg(vehicle, now_ms),
        .alarms = vehicle_vcu_alarms(vehicle, now_ms),
        .fastest_park_mm_s = vehicle->dynamics.fastest_park_mm_s,
    };
    for (int n = 0; n < VEHICLE_NODES; n++) {
        view->running[n] = vehicle->nodes[n].running;
    }
}

void vehicle_state(const vehicle_t *vehicle, vehicle_state_t *state) {
    *state = (vehicle_state_t){
        .gear = vehicle->dynamics.gear,
        .autopilot = vehicle->vcu.autopilot,
        .button_1 = vehicle->operator.button_1,
        .speed_mm_s = vehicle->dynamics.speed_um_s / 1000,
        .angle_ddeg = vehicle->eps.angle_mddeg / 1000,
    };
}

bool vehicle_is_running(const vehicle_t *vehicle, vehicle_node_t node) {
    return vehicle->nodes[node].running;
}

void vehicle_set_send(vehicle_t *vehicle, vehicle_send_fn *send, void *ctx) {
    vehicle->send = send;
    vehicle->send_ctx = ctx;
}

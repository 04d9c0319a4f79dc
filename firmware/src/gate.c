#include "agv/gate.h"

#include "agv/protocol.h"
#include "agv/state.h"

/* Written out in raw bytes, not through the codec: the gate must not share a mistake with who asks. */
enum {
    GEAR_D = 1,
    GEAR_R = 2,
    GEAR_N = 4,
    GEAR_P = 8,
    SAFE_SIGNALS = 0x70, /* left on, right on, autopilot off; bit 8 clear: headlight on */
    SIGNAL_BITS = 0xF0,
    ANGLE_MAX = 18000
};

static bool zero_from(const uint8_t data[AGV_DLC], uint32_t first) {
    uint32_t any = 0u;
    for (uint32_t i = first; i < AGV_DLC; i++) {
        any |= data[i];
    }
    return any == 0u;
}

static bool signals_shaped(const uint8_t data[AGV_DLC]) {
    return (data[0] | data[1] | data[2] | data[3] | (data[4] & (uint8_t)~SIGNAL_BITS) | data[5] | data[6]) == 0;
}

static uint32_t first_two(const uint8_t data[AGV_DLC]) {
    return (uint32_t)data[0] | ((uint32_t)data[1] << 8u);
}

static bool is_held_angle(const agv_gate_t *gate, const uint8_t data[AGV_DLC]) {
    const uint16_t complement = (uint16_t)~gate->hold_raw;
    return (gate->state != (uint8_t)AGV_STATE_INIT) && (gate->hold_check == complement) &&
           (first_two(data) == gate->hold_raw) && (first_two(data) <= (uint32_t)ANGLE_MAX) && zero_from(data, 2u);
}

static bool is_safe_command(const agv_gate_t *gate, agv_message_t message, const uint8_t data[AGV_DLC]) {
    switch (message) {
    case AGV_MSG_TURN_SIGNAL_COMMAND:
        return signals_shaped(data) && (data[4] == (uint8_t)SAFE_SIGNALS);
    case AGV_MSG_GEAR_COMMAND:
        return (data[0] == (uint8_t)GEAR_P) && zero_from(data, 1u);
    case AGV_MSG_THROTTLE_COMMAND:
        return zero_from(data, 0u);
    case AGV_MSG_STEERING_COMMAND:
        return is_held_angle(gate, data);
    default:
        return false;
    }
}

static bool is_gear(uint8_t gear) {
    return (gear == (uint8_t)GEAR_D) || (gear == (uint8_t)GEAR_R) || (gear == (uint8_t)GEAR_N) ||
           (gear == (uint8_t)GEAR_P);
}

static bool is_passed_command(const agv_gate_t *gate, agv_message_t message, const uint8_t data[AGV_DLC]) {
    const bool active = gate->state == (uint8_t)AGV_STATE_ACTIVE;
    const bool all = active || gate->pass_all_in_manual;
    const uint8_t throttle_max = active ? gate->throttle_max_counts : 0u;
    switch (message) {
    case AGV_MSG_TURN_SIGNAL_COMMAND:
        return signals_shaped(data);
    case AGV_MSG_GEAR_COMMAND:
        return all && is_gear(data[0]) && zero_from(data, 1u);
    case AGV_MSG_THROTTLE_COMMAND:
        return all && (data[0] <= throttle_max) && zero_from(data, 1u);
    case AGV_MSG_STEERING_COMMAND:
        return all && (first_two(data) <= (uint32_t)ANGLE_MAX) && zero_from(data, 2u);
    default:
        return false;
    }
}

static bool vehicle_side_allows(const agv_gate_t *gate, agv_message_t message, const hal_can_frame_t *frame) {
    if ((gate->status_id != 0u) && (frame->id == gate->status_id)) {
        return message == AGV_MSG_NONE;
    }
    if (agv_state_commands_safe((agv_state_t)gate->state)) {
        return is_safe_command(gate, message, frame->data);
    }
    return gate->gateway && is_passed_command(gate, message, frame->data);
}

bool agv_gate_allows(const agv_gate_t *gate, hal_can_side_t side, const hal_can_frame_t *frame) {
    const agv_message_t message = agv_message_from_id(frame->id, (agv_id_set_t)gate->id_set);
    if ((frame->flags != 0u) || (frame->length != AGV_DLC) || (frame->id > AGV_ID_MAX)) {
        return false;
    }
    if (side == HAL_CAN_VEHICLE) {
        return vehicle_side_allows(gate, message, frame);
    }
    return (side == HAL_CAN_AI) && gate->gateway && ((uint32_t)message >= AGV_COMMAND_COUNT) &&
           (message != AGV_MSG_NONE);
}

agv_gate_result_t agv_gate_send(const agv_gate_t *gate, hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    if (!agv_gate_allows(gate, side, frame)) {
        return AGV_GATE_REFUSED;
    }
    if (gate->shadow) {
        return AGV_GATE_SHADOWED;
    }
    return hal_can_send(hal, side, frame) ? AGV_GATE_SENT : AGV_GATE_BUSY;
}

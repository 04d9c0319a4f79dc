#include "transmit/gate.h"

#include "agv/state.h"

/* In raw bytes, without the codec: the gate must not share a defect with its callers. */
enum {
    GEAR_D = 1,
    GEAR_R = 2,
    GEAR_N = 4,
    GEAR_P = 8,
    SAFE_SIGNALS = 0x70, /* left on, right on, autopilot off; bit 8 clear: headlight on */
    ANGLE_MAX = 18000
};

/* Bits that must be 0 in each command. */
static const uint8_t reserved[AGV_COMMAND_COUNT][AGV_DLC] = {
    [AGV_MSG_TURN_SIGNAL_COMMAND] = {0xFFu, 0xFFu, 0xFFu, 0xFFu, 0x0Fu, 0xFFu, 0xFFu, 0x00u},
    [AGV_MSG_GEAR_COMMAND] = {0x00u, 0xFFu, 0xFFu, 0xFFu, 0xFFu, 0xFFu, 0xFFu, 0xFFu},
    [AGV_MSG_THROTTLE_COMMAND] = {0x00u, 0xFFu, 0xFFu, 0xFFu, 0xFFu, 0xFFu, 0xFFu, 0xFFu},
    [AGV_MSG_STEERING_COMMAND] = {0x00u, 0x00u, 0xFFu, 0xFFu, 0xFFu, 0xFFu, 0xFFu, 0xFFu}};

static bool reserved_are_zero(uint32_t command, const uint8_t data[AGV_DLC]) {
    uint32_t any = 0u;
    /* for tests/proofs/gate/run */
    /*@ loop invariant 0 <= i <= 8;
        loop invariant any == 0 <==> \forall integer j; 0 <= j < i ==> (data[j] & reserved[command][j]) == 0;
        loop assigns i, any;
        loop variant 8 - i; */
    for (uint32_t i = 0u; i < AGV_DLC; i++) {
        any |= (uint32_t)data[i] & reserved[command][i];
    }
    return any == 0u;
}

static uint32_t first_two(const uint8_t data[AGV_DLC]) {
    return (uint32_t)data[0] | ((uint32_t)data[1] << 8u);
}

static bool is_held_angle(const agv_gate_t *gate, uint32_t raw) {
    const uint16_t complement = (uint16_t)~gate->hold_raw;
    return (gate->state != (uint8_t)AGV_STATE_INIT) && (gate->hold_check == complement) && (raw == gate->hold_raw);
}

static bool is_gear(uint8_t gear) {
    return (gear == (uint8_t)GEAR_D) || (gear == (uint8_t)GEAR_R) || (gear == (uint8_t)GEAR_N) ||
           (gear == (uint8_t)GEAR_P);
}

static uint32_t throttle_max_counts(const agv_gate_t *gate) {
    return (gate->state == (uint8_t)AGV_STATE_ACTIVE) ? (((uint32_t)gate->config->throttle_ceiling_pct * 5u) / 2u) : 0u;
}

/* safe: only the safe commands; otherwise the commands that the gateway may forward. */
static bool value_allowed(const agv_gate_t *gate, uint32_t message, const uint8_t data[AGV_DLC], bool safe) {
    switch (message) {
    case AGV_MSG_TURN_SIGNAL_COMMAND:
        return !safe || (data[4] == (uint8_t)SAFE_SIGNALS);
    case AGV_MSG_GEAR_COMMAND:
        return safe ? (data[0] == (uint8_t)GEAR_P) : is_gear(data[0]);
    case AGV_MSG_THROTTLE_COMMAND:
        return data[0] <= throttle_max_counts(gate);
    default: {
        const uint32_t raw = first_two(data);
        return (raw <= (uint32_t)ANGLE_MAX) && (!safe || is_held_angle(gate, raw));
    }
    }
}

/* Whether the gateway may forward a command in this state. */
static bool may_pass(const agv_gate_t *gate, uint32_t message) {
    return (gate->config->topology == (uint16_t)AGV_TOPOLOGY_GATEWAY) &&
           ((gate->state == (uint8_t)AGV_STATE_ACTIVE) || (message == (uint32_t)AGV_MSG_TURN_SIGNAL_COMMAND) ||
            (message == (uint32_t)AGV_MSG_THROTTLE_COMMAND) || /* up to throttle_max_counts: 0 */
            (gate->config->gateway_in_manual == (uint16_t)AGV_IN_MANUAL_ALL));
}

static bool vehicle_side_allows(const agv_gate_t *gate, uint32_t message, const hal_can_frame_t *frame) {
    const bool safe = agv_state_commands_safe((agv_state_t)gate->state);
    if (message < AGV_COMMAND_COUNT) {
        return (safe || may_pass(gate, message)) && reserved_are_zero(message, frame->data) &&
               value_allowed(gate, message, frame->data, safe);
    }
    return (message == (uint32_t)AGV_MSG_NONE) && (frame->id == gate->config->status_frame_id) && (frame->id != 0u);
}

bool agv_gate_allows(const agv_gate_t *gate, hal_can_side_t side, const hal_can_frame_t *frame) {
    const uint32_t message = agv_ids_find(gate->ids, frame->id);
    if ((frame->flags != 0u) || (frame->length != AGV_DLC)) {
        return false;
    }
    if (side == HAL_CAN_VEHICLE) {
        return vehicle_side_allows(gate, message, frame);
    }
    return (side == HAL_CAN_AI) && (gate->config->topology == (uint16_t)AGV_TOPOLOGY_GATEWAY) &&
           (message >= AGV_COMMAND_COUNT) && (message != (uint32_t)AGV_MSG_NONE);
}

agv_gate_result_t agv_gate_send(const agv_gate_t *gate, hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    if (!agv_gate_allows(gate, side, frame)) {
        return AGV_GATE_REFUSED;
    }
    if (gate->config->shadow == (uint16_t)AGV_SHADOW_ON) {
        return AGV_GATE_SHADOWED;
    }
    return hal_can_send(hal, side, frame) ? AGV_GATE_SENT : AGV_GATE_BUSY;
}

#include "gate_oracle.h"

#include "frame_bytes.h"

oracle_t gate_oracle(const agv_gate_t *gate) {
    const agv_state_t state = (agv_state_t)gate->state;
    const bool latched = is_latched(state);
    oracle_t oracle = {.mode_bits = 0x80,
                       .before = state,
                       .ending = state == AGV_STATE_STANDBY,
                       .latched = latched,
                       .held = latched && ((unsigned)gate->hold_check + gate->hold_raw == 0xFFFFu) &&
                               (gate->hold_raw <= 18000),
                       .held_raw = gate->hold_raw};
    oracle_configure(&oracle, gate->config);
    return oracle;
}

bool gate_oracle_allows(const oracle_t *oracle, const agv_gate_t *gate, hal_can_side_t side,
                        const hal_can_frame_t *frame) {
    oracle_t judge = *oracle;
    const uint32_t most = gate->config->throttle_ceiling_pct * 250u / 100u;
    const bool throttle = (side == HAL_CAN_VEHICLE) && (frame->id == 0x075u);
    oracle_sent(&judge, side, frame, (agv_state_t)gate->state);
    return (judge.forbidden == 0) && !(throttle && (gate->state == AGV_STATE_ACTIVE) && (frame->data[0] > most));
}

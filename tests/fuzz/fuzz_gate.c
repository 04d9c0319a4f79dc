/*
 * The gate alone: any state code, configuration, held angle and frame. Its decision must be that of oracle.h, which is
 * written by hand from FSM-6, TOP-1 and TOP-2, for every frame.
 */
#include <stdio.h>
#include <stdlib.h>

#include "agv/protocol.h"
#include "gate_oracle.h"
#include "input.h"

static const uint16_t IDS[16] = {0x43F, 0x168, 0x075, 0x065, 0x363, 0x0A3, 0x050, 0x067,
                                 0x167, 0x267, 0x101, 0x201, 0x203, 0x700, 0x7FF, 0x000};
static const uint8_t STATES[5] = {AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED,
                                  AGV_STATE_SAFE};

static void read_config(input_t *input, agv_config_t *config) {
    const uint8_t bits = input_byte(input);
    agv_config_defaults(config);
    config->topology = bits & 1;
    config->id_set = (bits >> 1) & 1;
    config->gateway_in_manual = (bits >> 2) & 1;
    config->throttle_ceiling_pct = ((bits & 8) != 0) ? (uint16_t)(input_byte(input) % 101) : 100;
    config->status_frame_id = ((bits & 16) != 0) ? 0x700u : 0;
}

static void read_frame(input_t *input, hal_can_frame_t *frame) {
    const uint8_t which = input_byte(input);
    *frame = (hal_can_frame_t){.id = IDS[which & 15], .length = 8};
    if ((which & 0x10u) != 0) {
        frame->id = input_word(input);
    }
    if ((which & 0x20u) != 0) {
        frame->length = input_byte(input) % 65;
        frame->flags = input_byte(input) & 15;
    }
    input_bytes(input, frame->data, sizeof frame->data);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    input_t input = {.at = data, .left = size};
    agv_config_t config;
    agv_ids_t ids;
    hal_can_frame_t frame;
    const uint8_t state = input_byte(&input);
    const uint8_t more = input_byte(&input);
    const hal_can_side_t side = (hal_can_side_t)(more & 1u);
    read_config(&input, &config);
    agv_config_ids(&config, &ids);
    agv_gate_t gate = {.config = &config, .ids = &ids, .state = (state < 200) ? STATES[state % 5] : state};
    gate.hold_raw = input_word(&input);
    gate.hold_check = ((more & 2) != 0) ? input_word(&input) : (uint16_t)~gate.hold_raw;
    read_frame(&input, &frame);
    if ((more & 4) != 0) {
        frame.data[0] = (uint8_t)gate.hold_raw;
        frame.data[1] = (uint8_t)(gate.hold_raw >> 8);
    }
    const bool allows = agv_gate_allows(&gate, side, &frame);
    const oracle_t oracle = gate_oracle(&gate);
    if (allows != gate_oracle_allows(&oracle, &gate, side, &frame)) {
        (void)fprintf(stderr, "the gate %s in state %02Xh to side %d: %03X, length %u, flags %X, %02X %02X .. %02X\n",
                      allows ? "allows" : "refuses", gate.state, (int)side, (unsigned)frame.id, frame.length,
                      frame.flags, frame.data[0], frame.data[1], frame.data[4]);
        abort();
    }
    return 0;
}

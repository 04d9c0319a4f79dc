#include "traffic.h"

#include <string.h>

const traffic_row_t TRAFFIC[TRAFFIC_MESSAGES] = {
    [M_SIGNALS] = {0x43F, 0x201, 100, 8, 7, {0, 0, 0, 0, 0x80}},
    [M_GEAR] = {0x168, 0x168, 100, 18, -1, {GEAR_P}},
    [M_THROTTLE] = {0x075, 0x075, 100, 28, -1, {0}},
    [M_STEERING] = {0x065, 0x065, 25, 9, -1, {0x28, 0x23}},
    [M_VEHICLE] = {0x363, 0x203, 10, 1, 7, {0, 0, 0, 0, 0, 0, MODE_MANUAL}},
    [M_GEAR_STATUS] = {0x0A3, 0x0A3, 25, 7, -1, {GEAR_P}},
    [M_THROTTLE_STATUS] = {0x050, 0x050, 10, 2, -1, {0}},
    [M_STEERING_STATUS] = {0x067, 0x067, 10, 4, 0, {0, 100, 0x28, 0x23}},
    [M_EPS_STATUS] = {0x167, 0x167, 10, 5, -1, {0, 0, 0, 0x01}},
    [M_POSITION] = {0x267, 0x267, 10, 6, -1, {0x23, 0x28, 0, 0, 0x46, 0x50}},
    [M_WHEELS] = {0x101, 0x101, 10, 3, -1, {0}},
};

void traffic_heal(traffic_message_t traffic[TRAFFIC_MESSAGES]) {
    for (unsigned i = 0; i < TRAFFIC_MESSAGES; i++) {
        traffic_message_t *m = &traffic[i];
        m->muted = false;
        m->frozen = false;
        m->flags = 0;
        m->length = 8;
        m->counter_at = TRAFFIC[i].counter_at;
        m->cycle_ms = TRAFFIC[i].cycle_ms;
        m->phase_ms = TRAFFIC[i].phase_ms;
        memcpy(m->data, TRAFFIC[i].data, sizeof m->data);
    }
}

uint16_t traffic_id(const agv_config_t *config, unsigned message) {
    return (config->id_set == AGV_ID_SET_TABLE) ? TRAFFIC[message].table_id : TRAFFIC[message].id;
}

void traffic_address(traffic_message_t traffic[TRAFFIC_MESSAGES], const agv_config_t *config) {
    const bool gateway = config->topology == AGV_TOPOLOGY_GATEWAY;
    for (unsigned i = 0; i < TRAFFIC_MESSAGES; i++) {
        traffic[i].id = traffic_id(config, i);
        traffic[i].side = (gateway && (i < TRAFFIC_COMMANDS)) ? HAL_CAN_AI : HAL_CAN_VEHICLE;
    }
}

bool traffic_is_due(const traffic_message_t *m, uint64_t elapsed_ms) {
    return !m->muted && (elapsed_ms % m->cycle_ms == m->phase_ms);
}

hal_can_frame_t traffic_next(traffic_message_t *m) {
    hal_can_frame_t frame = {.id = m->id, .flags = m->flags, .length = m->length};
    m->counter = (uint8_t)(m->counter + (m->frozen ? 0 : 1));
    if (m->counter_at >= 0) {
        m->data[m->counter_at] = m->counter;
    }
    m->sent++;
    memcpy(frame.data, m->data, sizeof frame.data);
    return frame;
}

void traffic_mode(traffic_message_t traffic[TRAFFIC_MESSAGES], uint8_t mode) {
    uint8_t *byte = &traffic[M_VEHICLE].data[6];
    *byte = (uint8_t)((*byte & 0x3Fu) | (mode & (uint8_t)MODE_BOTH));
}

void traffic_button(traffic_message_t traffic[TRAFFIC_MESSAGES], bool down) {
    uint8_t *byte = &traffic[M_VEHICLE].data[6];
    *byte = (uint8_t)((*byte & 0xFEu) | (down ? (uint8_t)BUTTON_1 : 0));
}

void traffic_gear(traffic_message_t traffic[TRAFFIC_MESSAGES], uint8_t gear) {
    traffic[M_GEAR_STATUS].data[0] = gear;
}

void traffic_put_word(uint8_t *data, uint16_t value) {
    data[0] = (uint8_t)value;
    data[1] = (uint8_t)(value >> 8);
}

void traffic_wheels(traffic_message_t traffic[TRAFFIC_MESSAGES], int32_t left_mm_s, int32_t right_mm_s) {
    uint8_t *data = traffic[M_WHEELS].data;
    traffic_put_word(&data[0], (uint16_t)(uint32_t)left_mm_s);
    traffic_put_word(&data[2], (uint16_t)((uint32_t)left_mm_s >> 16));
    traffic_put_word(&data[4], (uint16_t)(uint32_t)right_mm_s);
    traffic_put_word(&data[6], (uint16_t)((uint32_t)right_mm_s >> 16));
}

void traffic_ai_drives(traffic_message_t traffic[TRAFFIC_MESSAGES]) {
    traffic[M_GEAR].data[0] = GEAR_D;
    traffic[M_THROTTLE].data[0] = 100;
    traffic[M_STEERING].data[0] = 0x64;
}

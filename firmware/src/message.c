/**
 * @file message.c
 * Identifiers and cycle times of the 11 messages (docs/protocol.md, P1 and P16).
 */
#include "agv/protocol.h"

#include <stdbool.h>

/* Identifier in the heading set and in the table set, cycle; in the order of agv_message_t. */
static const struct {
    uint16_t id[2];
    uint16_t cycle_ms;
} messages[AGV_MSG_COUNT] = {
    {{0x43Fu, 0x201u}, 100u}, {{0x168u, 0x168u}, 100u}, {{0x075u, 0x075u}, 100u}, {{0x065u, 0x065u}, 25u},
    {{0x363u, 0x203u}, 10u},  {{0x0A3u, 0x0A3u}, 25u},  {{0x050u, 0x050u}, 10u},  {{0x067u, 0x067u}, 10u},
    {{0x167u, 0x167u}, 10u},  {{0x267u, 0x267u}, 10u},  {{0x101u, 0x101u}, 10u},
};

static bool is_id_set(agv_id_set_t id_set) {
    return (uint32_t)id_set <= (uint32_t)AGV_ID_SET_TABLE;
}

uint16_t agv_message_id(agv_message_t message, agv_id_set_t id_set) {
    const bool known = ((uint32_t)message < (uint32_t)AGV_MSG_COUNT) && is_id_set(id_set);
    return known ? messages[message].id[id_set] : UINT16_MAX;
}

agv_message_t agv_message_from_id(uint32_t id, agv_id_set_t id_set) {
    uint32_t message = is_id_set(id_set) ? 0u : (uint32_t)AGV_MSG_NONE;
    while ((message < (uint32_t)AGV_MSG_COUNT) && (messages[message].id[id_set] != id)) {
        message++;
    }
    return (agv_message_t)message;
}

uint16_t agv_message_cycle_ms(agv_message_t message) {
    return ((uint32_t)message < (uint32_t)AGV_MSG_COUNT) ? messages[message].cycle_ms : 0u;
}

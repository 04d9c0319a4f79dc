/**
 * @file message.c
 * Identifiers and cycle times of the 11 messages (docs/protocol.md, P1 and P16).
 */
#include "agv/protocol.h"

#include <stdbool.h>

/* In the order of agv_message_t, with a last one for AGV_MSG_NONE. */
static const uint16_t ids[2][AGV_MSG_COUNT + 1] = {
    {0x43Fu, 0x168u, 0x075u, 0x065u, 0x363u, 0x0A3u, 0x050u, 0x067u, 0x167u, 0x267u, 0x101u, UINT16_MAX},
    {0x201u, 0x168u, 0x075u, 0x065u, 0x203u, 0x0A3u, 0x050u, 0x067u, 0x167u, 0x267u, 0x101u, UINT16_MAX},
};
static const uint8_t cycles_ms[AGV_MSG_COUNT + 1] = {100u, 100u, 100u, 25u, 10u, 25u, 10u, 10u, 10u, 10u, 10u, 0u};

static bool is_id_set(uint32_t id_set) {
    return id_set <= (uint32_t)AGV_ID_SET_TABLE;
}

uint16_t agv_message_id(uint32_t message, uint32_t id_set) {
    return is_id_set(id_set) ? ids[id_set][message] : UINT16_MAX;
}

uint32_t agv_message_from_id(uint32_t id, uint32_t id_set) {
    uint32_t message = is_id_set(id_set) ? 0u : (uint32_t)AGV_MSG_NONE;
    /* for scripts/proofs/gate */
    /*@ loop invariant message <= 11 && (id_set > 1 ==> message == 11);
        loop invariant id_set <= 1 ==> \forall integer m; 0 <= m < message ==> ids[id_set][m] != id;
        loop assigns message;
        loop variant 11 - message; */
    while ((message < (uint32_t)AGV_MSG_COUNT) && (ids[id_set][message] != id)) {
        message++;
    }
    return message;
}

uint32_t agv_message_cycle_ms(uint32_t message) {
    return cycles_ms[message];
}

/**
 * @file message.c
 * Identifiers and cycle times of the 11 messages (docs/protocol.md, P1 and P16).
 */
#include "agv/protocol.h"

#include <stdbool.h>

#define AGV_COMMAND AGV_STATUS

static const uint16_t preset_ids[2][AGV_MSG_COUNT] = {
    [AGV_ID_SET_HEADING] =
        {
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) [AGV_MSG_##NAME] = (heading),
#include "agv/message_table.def"
#undef AGV_STATUS
        },
    [AGV_ID_SET_TABLE] =
        {
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) [AGV_MSG_##NAME] = (table),
#include "agv/message_table.def"
#undef AGV_STATUS
        },
};

static const uint8_t cycles_ms[AGV_MSG_COUNT] = {
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) [AGV_MSG_##NAME] = (cycle),
#include "agv/message_table.def"
#undef AGV_STATUS
};

_Static_assert(AGV_COMMAND_COUNT == (uint32_t)AGV_MSG_VEHICLE_STATUS, "commands come first");

static bool is_message(uint32_t message) {
    return message < (uint32_t)AGV_MSG_COUNT;
}

/* The index of an identifier among those of all messages. */
static uint32_t find(const uint16_t ids[AGV_MSG_COUNT], uint32_t id) {
    uint32_t message = 0u;
    /* for tests/proofs/gate/run */
    /*@ loop invariant message <= 11;
        loop invariant \forall integer m; 0 <= m < message ==> ids[m] != id;
        loop assigns message;
        loop variant 11 - message; */
    while ((message < (uint32_t)AGV_MSG_COUNT) && (ids[message] != id)) {
        message++;
    }
    return message;
}

uint16_t agv_message_id(uint32_t message, uint32_t id_set) {
    return (is_message(message) && (id_set <= (uint32_t)AGV_ID_SET_TABLE)) ? preset_ids[id_set][message] : UINT16_MAX;
}

uint32_t agv_message_from_id(uint32_t id, uint32_t id_set) {
    return (id_set <= (uint32_t)AGV_ID_SET_TABLE) ? find(preset_ids[id_set], id) : (uint32_t)AGV_MSG_NONE;
}

uint32_t agv_ids_find(const agv_ids_t *ids, uint32_t id) {
    return find(ids->of, id);
}

uint32_t agv_message_cycle_ms(uint32_t message) {
    return is_message(message) ? cycles_ms[message] : 0u;
}

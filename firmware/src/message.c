/**
 * @file message.c
 * Identifiers and cycle times of the 11 messages (docs/protocol.md, P1 and P16).
 */
#include "agv/protocol.h"

/* One name for each identifier: the table (message -> identifier) and the switch (identifier -> message) share them. */
#define ID_TURN_SIGNAL_COMMAND_HEADING 0x43Fu
#define ID_TURN_SIGNAL_COMMAND_TABLE 0x201u
#define ID_GEAR_COMMAND 0x168u
#define ID_THROTTLE_COMMAND 0x075u
#define ID_STEERING_COMMAND 0x065u
#define ID_VEHICLE_STATUS_HEADING 0x363u
#define ID_VEHICLE_STATUS_TABLE 0x203u
#define ID_GEAR_STATUS 0x0A3u
#define ID_THROTTLE_STATUS 0x050u
#define ID_STEERING_STATUS 0x067u
#define ID_EPS_STATUS 0x167u
#define ID_STEERING_POSITION 0x267u
#define ID_WHEEL_SPEED 0x101u

/** Answer of agv_message_id() for what is no message; above AGV_ID_MAX, so no frame can carry it. */
#define ID_NONE 0xFFFFu

typedef struct {
    uint16_t id[2]; /* by agv_id_set_t */
    uint16_t cycle_ms;
} message_row_t;

static const message_row_t MESSAGES[AGV_MSG_COUNT] = {
    [AGV_MSG_TURN_SIGNAL_COMMAND] = {{ID_TURN_SIGNAL_COMMAND_HEADING, ID_TURN_SIGNAL_COMMAND_TABLE}, 100u},
    [AGV_MSG_GEAR_COMMAND] = {{ID_GEAR_COMMAND, ID_GEAR_COMMAND}, 100u},
    [AGV_MSG_THROTTLE_COMMAND] = {{ID_THROTTLE_COMMAND, ID_THROTTLE_COMMAND}, 100u},
    [AGV_MSG_STEERING_COMMAND] = {{ID_STEERING_COMMAND, ID_STEERING_COMMAND}, 25u},
    [AGV_MSG_VEHICLE_STATUS] = {{ID_VEHICLE_STATUS_HEADING, ID_VEHICLE_STATUS_TABLE}, 10u},
    [AGV_MSG_GEAR_STATUS] = {{ID_GEAR_STATUS, ID_GEAR_STATUS}, 25u},
    [AGV_MSG_THROTTLE_STATUS] = {{ID_THROTTLE_STATUS, ID_THROTTLE_STATUS}, 10u},
    [AGV_MSG_STEERING_STATUS] = {{ID_STEERING_STATUS, ID_STEERING_STATUS}, 10u},
    [AGV_MSG_EPS_STATUS] = {{ID_EPS_STATUS, ID_EPS_STATUS}, 10u},
    [AGV_MSG_STEERING_POSITION] = {{ID_STEERING_POSITION, ID_STEERING_POSITION}, 10u},
    [AGV_MSG_WHEEL_SPEED] = {{ID_WHEEL_SPEED, ID_WHEEL_SPEED}, 10u},
};

/* The casts below also catch negative values: an enum may be signed or unsigned, the compiler chooses. */

uint16_t agv_message_id(agv_message_t message, agv_id_set_t id_set) {
    const uint32_t row = (uint32_t)message;
    const uint32_t set = (uint32_t)id_set;

    if ((row >= (uint32_t)AGV_MSG_COUNT) || (set > (uint32_t)AGV_ID_SET_TABLE)) {
        return ID_NONE;
    }
    return MESSAGES[row].id[set];
}

/* A switch, not a search of the table: it runs for every frame on the bus, and compilers make about four comparisons
 * of it. */
agv_message_t agv_message_from_id(uint32_t id, agv_id_set_t id_set) {
    switch (id) {
    case ID_TURN_SIGNAL_COMMAND_HEADING:
        return (id_set == AGV_ID_SET_HEADING) ? AGV_MSG_TURN_SIGNAL_COMMAND : AGV_MSG_NONE;
    case ID_TURN_SIGNAL_COMMAND_TABLE:
        return (id_set == AGV_ID_SET_TABLE) ? AGV_MSG_TURN_SIGNAL_COMMAND : AGV_MSG_NONE;
    case ID_VEHICLE_STATUS_HEADING:
        return (id_set == AGV_ID_SET_HEADING) ? AGV_MSG_VEHICLE_STATUS : AGV_MSG_NONE;
    case ID_VEHICLE_STATUS_TABLE:
        return (id_set == AGV_ID_SET_TABLE) ? AGV_MSG_VEHICLE_STATUS : AGV_MSG_NONE;
    case ID_GEAR_COMMAND:
        return AGV_MSG_GEAR_COMMAND;
    case ID_THROTTLE_COMMAND:
        return AGV_MSG_THROTTLE_COMMAND;
    case ID_STEERING_COMMAND:
        return AGV_MSG_STEERING_COMMAND;
    case ID_GEAR_STATUS:
        return AGV_MSG_GEAR_STATUS;
    case ID_THROTTLE_STATUS:
        return AGV_MSG_THROTTLE_STATUS;
    case ID_STEERING_STATUS:
        return AGV_MSG_STEERING_STATUS;
    case ID_EPS_STATUS:
        return AGV_MSG_EPS_STATUS;
    case ID_STEERING_POSITION:
        return AGV_MSG_STEERING_POSITION;
    case ID_WHEEL_SPEED:
        return AGV_MSG_WHEEL_SPEED;
    default:
        return AGV_MSG_NONE;
    }
}

uint16_t agv_message_cycle_ms(agv_message_t message) {
    const uint32_t row = (uint32_t)message;

    return (row < (uint32_t)AGV_MSG_COUNT) ? MESSAGES[row].cycle_ms : 0u;
}

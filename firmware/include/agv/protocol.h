/**
 * @file protocol.h
 * The 11 messages of the AGV CAN protocol: names, identifiers, cycle times. They are defined in message_table.def.
 *
 * Messages are named by their content, because the section labels of the protocol document are not unique. All of them
 * are classic CAN data frames with an 11-bit identifier and DLC 8. Byte n of the document is `data[n - 1]`; bit 1 is the
 * least significant one. docs/protocol.md lists every interpretation of the document, with its reason.
 */
#ifndef AGV_PROTOCOL_H
#define AGV_PROTOCOL_H

#include <stdint.h>

/** DLC of every message. Frames with any other DLC are rejected and counted (P15). */
#define AGV_DLC 8u

/** Largest 11-bit identifier. */
#define AGV_ID_MAX 0x7FFu

/** The messages, AGV_MSG_TURN_SIGNAL_COMMAND to AGV_MSG_WHEEL_SPEED; the commands come first. */
typedef enum {
#define AGV_COMMAND(NAME, name, heading, table, cycle, deadline, fault, counter) AGV_MSG_##NAME,
#define AGV_STATUS(NAME, name, heading, table, cycle, deadline, fault, counter) AGV_MSG_##NAME,
#include "agv/message_table.def"
#undef AGV_COMMAND
#undef AGV_STATUS
    AGV_MSG_COUNT,
    AGV_MSG_NONE = AGV_MSG_COUNT /**< no message */
} agv_message_t;

/** Number of AI commands: the messages before AGV_MSG_VEHICLE_STATUS. */
#define AGV_COMMAND_COUNT 4u

/**
 * The two sets of identifiers (P1). The protocol document contradicts itself: its headings say 43Fh and 363h, its table
 * says 201h and 203h. All other messages have the same identifier in both sets. Besides, each identifier is a setting of
 * its own (config.h).
 */
typedef enum {
    AGV_ID_SET_HEADING = 0, /**< 43Fh and 363h, the default */
    AGV_ID_SET_TABLE = 1    /**< 201h and 203h */
} agv_id_set_t;

/** The identifiers that a supervisor uses, by message. agv_config_ids derives them from a configuration. */
typedef struct {
    uint16_t of[AGV_MSG_COUNT];
} agv_ids_t;

/** The bit of a message in a set of messages. @param message agv_message_t, at most 31 */
static inline uint32_t agv_message_bit(uint32_t message) {
    return (uint32_t)1u << message;
}

/**
 * The identifier of a message in one of the two sets.
 * @return the 11-bit identifier; a value above AGV_ID_MAX if @p message or @p id_set is invalid.
 */
uint16_t agv_message_id(uint32_t message, uint32_t id_set);

/**
 * The message with this identifier in one of the two sets.
 * @return the message; AGV_MSG_NONE if no message of this set has the identifier.
 */
uint32_t agv_message_from_id(uint32_t id, uint32_t id_set);

/**
 * The message that has this identifier. The caller checks whether the frame is extended, remote, FD or of another length
 * (P15).
 * @return the message; AGV_MSG_NONE if no message has the identifier.
 */
uint32_t agv_ids_find(const agv_ids_t *ids, uint32_t id);

/**
 * The cycle time of a message in milliseconds (P16).
 * @return 10, 25 or 100; 0 for AGV_MSG_NONE and values above.
 */
uint32_t agv_message_cycle_ms(uint32_t message);

#endif

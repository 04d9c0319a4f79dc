/**
 * @file protocol.h
 * The 11 messages of the AGV CAN protocol: names, identifiers, cycle times.
 *
 * Messages are named by what they carry (the section labels of the protocol document repeat). All of them are classic
 * CAN data frames with an 11-bit identifier and DLC 8. Byte n of the document is `data[n - 1]`, bit 1 is the least
 * significant one. docs/protocol.md lists every decision on how the document is read, with its reason.
 *
 * To add a message: a row here (enumerator), its identifiers and cycle in message.c, its codec in codec.h/.c, its
 * deadline in config_settings.def, watch.c and monitor_timed.c, its handler in monitor_frames.c.
 */
#ifndef AGV_PROTOCOL_H
#define AGV_PROTOCOL_H

#include <stdint.h>

/** DLC of every message, sent and accepted (P15: any other DLC is rejected and counted). */
#define AGV_DLC 8u

/** Largest 11-bit identifier. */
#define AGV_ID_MAX 0x7FFu

/** The messages, commands first, in the order of the protocol document. */
typedef enum {
    AGV_MSG_TURN_SIGNAL_COMMAND, /**< 43Fh (table: 201h), AI, 100 ms: lights, autopilot off, AI alive counter */
    AGV_MSG_GEAR_COMMAND,        /**< 168h, AI, 100 ms */
    AGV_MSG_THROTTLE_COMMAND,    /**< 075h, AI, 100 ms */
    AGV_MSG_STEERING_COMMAND,    /**< 065h, AI, 25 ms */
    AGV_MSG_VEHICLE_STATUS,      /**< 363h (table: 203h), VCU, 10 ms: speed, alarms, mode, button, VCU alive counter */
    AGV_MSG_GEAR_STATUS,         /**< 0A3h, VCU, 25 ms */
    AGV_MSG_THROTTLE_STATUS,     /**< 050h, VCU, 10 ms */
    AGV_MSG_STEERING_STATUS,     /**< 067h, EPS, 10 ms: measured angle, EPS alive counter */
    AGV_MSG_EPS_STATUS,          /**< 167h, EPS, 10 ms: mode and fault bits */
    AGV_MSG_STEERING_POSITION,   /**< 267h, EPS, 10 ms, big-endian */
    AGV_MSG_WHEEL_SPEED,         /**< 101h, VCU, 10 ms */
    AGV_MSG_COUNT,
    AGV_MSG_NONE = AGV_MSG_COUNT /**< "no such message" */
} agv_message_t;

/** Number of AI commands: the messages before AGV_MSG_VEHICLE_STATUS. */
#define AGV_COMMAND_COUNT 4u

/**
 * Which identifiers 43Fh/363h have (P1). The document contradicts itself: its headings say 43Fh and 363h, its table
 * cells 201h and 203h. All other messages have the same identifier in both sets.
 */
typedef enum {
    AGV_ID_SET_HEADING = 0, /**< 43Fh and 363h, the default */
    AGV_ID_SET_TABLE = 1    /**< 201h and 203h */
} agv_id_set_t;

/**
 * The identifier of a message, or of AGV_MSG_NONE.
 * @return the 11-bit identifier; a value above AGV_ID_MAX for AGV_MSG_NONE, or when @p id_set is no set.
 */
uint16_t agv_message_id(uint32_t message, uint32_t id_set);

/**
 * The message with this identifier in the chosen set. Whether a frame is extended, remote, FD or of another length is
 * the caller's to check (P15).
 * @return the message, or AGV_MSG_NONE (also for identifiers that only the other set knows).
 */
uint32_t agv_message_from_id(uint32_t id, uint32_t id_set);

/**
 * The cycle time of a message, or of AGV_MSG_NONE, in milliseconds (P16).
 * @return 10, 25 or 100; 0 for AGV_MSG_NONE.
 */
uint32_t agv_message_cycle_ms(uint32_t message);

#endif

/*
 * Healthy traffic of a vehicle, written by hand from docs/protocol.md and never taken from the product's own tables. The
 * only such table in C: integration tests, fuzz targets and proofs all send these frames. No Unity, no heap.
 */
#ifndef TRAFFIC_H
#define TRAFFIC_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"

/* The messages, in the order of agv_message_t. */
enum {
    M_SIGNALS,
    M_GEAR,
    M_THROTTLE,
    M_STEERING,
    M_VEHICLE,
    M_GEAR_STATUS,
    M_THROTTLE_STATUS,
    M_STEERING_STATUS,
    M_EPS_STATUS,
    M_POSITION,
    M_WHEELS,
    TRAFFIC_MESSAGES,
    TRAFFIC_COMMANDS = M_VEHICLE
};

/* Values of 363h byte 7, of gears, and the raw angle of the centre. */
enum { MODE_NEITHER = 0x00, MODE_MANUAL = 0x40, MODE_ENGAGED = 0x80, MODE_BOTH = 0xC0, BUTTON_1 = 0x01 };
enum { GEAR_D = 1, GEAR_R = 2, GEAR_N = 4, GEAR_P = 8 };
enum { ANGLE_CENTRE = 9000 };

/* One message of the protocol. */
typedef struct {
    uint16_t id;       /* of the heading set */
    uint16_t table_id; /* of the table set */
    uint16_t cycle_ms;
    uint16_t phase_ms;
    int8_t counter_at; /* index of its alive counter; -1: none */
    uint8_t data[8];   /* in manual mode, gear P, at standstill */
} traffic_row_t;
extern const traffic_row_t TRAFFIC[TRAFFIC_MESSAGES];

/* State of one message. Initially healthy; a test may change all members. */
typedef struct {
    bool muted;        /* is not sent */
    bool frozen;       /* its alive counter is frozen */
    uint8_t flags;     /* HAL_CAN_* bits it is sent with */
    uint8_t length;    /* DLC; 8 */
    uint8_t data[8];   /* payload; byte `counter_at` is filled in */
    int8_t counter_at; /* index of its alive counter; -1: none */
    uint8_t counter;   /* value that was sent last */
    uint16_t cycle_ms; /* sent when (elapsed time % cycle_ms) == phase_ms */
    uint16_t phase_ms;
    uint32_t id;         /* identifier */
    hal_can_side_t side; /* side on which it arrives */
    uint32_t sent;       /* frames so far */
    uint32_t last_ms;    /* clock at the last one */
    uint32_t call;       /* number of the call that passed on the last one */
} traffic_message_t;

/* Make all messages healthy; alive counters, identifiers and sides stay. */
void traffic_heal(traffic_message_t traffic[TRAFFIC_MESSAGES]);

/* The identifier of a message in the set of the configuration; then all identifiers and sides as the configuration has them. */
uint16_t traffic_id(const agv_config_t *config, unsigned message);
void traffic_address(traffic_message_t traffic[TRAFFIC_MESSAGES], const agv_config_t *config);

/* Whether a message is due at this time after the start; its next frame, without a time stamp. */
bool traffic_is_due(const traffic_message_t *m, uint64_t elapsed_ms);
hal_can_frame_t traffic_next(traffic_message_t *m);

/* Mode bits (MODE_*) and button 1 of 363h, gear status, wheel speeds. */
void traffic_mode(traffic_message_t traffic[TRAFFIC_MESSAGES], uint8_t mode);
void traffic_button(traffic_message_t traffic[TRAFFIC_MESSAGES], bool down);
void traffic_gear(traffic_message_t traffic[TRAFFIC_MESSAGES], uint8_t gear);
void traffic_wheels(traffic_message_t traffic[TRAFFIC_MESSAGES], int32_t left_mm_s, int32_t right_mm_s);

/* Make the AI computer send driving commands in every state, which the supervisor must override or block. */
void traffic_ai_drives(traffic_message_t traffic[TRAFFIC_MESSAGES]);

/* A little-endian word of a payload. */
void traffic_put_word(uint8_t *data, uint16_t value);

#endif

/*
 * What may leave in which state (FSM-6, and nothing of its own in STANDBY and ACTIVE on the shared bus), stated once more
 * in raw identifiers and bytes. It shares nothing with the gate: tests hand it every frame in and every frame out.
 */
#ifndef ORACLE_H
#define ORACLE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/state.h"
#include "hal/can.h"

typedef struct {
    /* what the vehicle is */
    bool gateway;
    bool pass_all_in_manual;
    uint32_t signal_id;     /* 43Fh or 201h */
    uint32_t vehicle_id;    /* 363h or 203h */
    uint32_t own_status_id; /* 0 = none */
    uint32_t hold_age_ms;
    uint32_t mode_invalid_ms;
    uint32_t now_ms; /* to be kept up with the clock */

    /* what is known of the mode: the bits of the last 363h, and the mode that stands */
    uint8_t mode_bits;
    bool manual;
    uint32_t both_since_ms;
    uint32_t both_halves; /* half milliseconds of both bits that are left, while they are not both set */

    /* an engagement has ended: one throttle 0 may go to the vehicle */
    agv_state_t before;
    bool ending;

    /* what is known of the steering */
    bool angle_known;
    uint16_t angle_raw;
    uint32_t angle_ms;
    bool latched;
    bool held;
    uint16_t held_raw;

    /* what was seen */
    uint32_t judged;    /* frames sent in INIT, TRIPPED, SAFE */
    uint32_t others;    /* frames sent in STANDBY, ACTIVE */
    uint32_t forbidden; /* of all of them */
    hal_can_frame_t first_forbidden;
    hal_can_side_t first_side;
    agv_state_t first_state;
} oracle_t;

/* What the vehicle is, by the configuration. */
void oracle_configure(oracle_t *oracle, const agv_config_t *config);

/* A supervisor starts: nothing is known. The counts go on. */
void oracle_restart(oracle_t *oracle);

/* A frame is about to be handed in. */
void oracle_heard(oracle_t *oracle, hal_can_side_t side, const hal_can_frame_t *frame);

/* A frame leaves in this state. */
void oracle_sent(oracle_t *oracle, hal_can_side_t side, const hal_can_frame_t *frame, agv_state_t state);

/* An entry point has returned in this state. */
void oracle_returned(oracle_t *oracle, agv_state_t state);

/* The safe commands, byte for byte: hazard lights and headlight (byte 8 is the alive counter), gear P, no throttle. */
enum { SAFE_SIGNALS_BYTES = 7 };
extern const uint8_t SAFE_SIGNALS[SAFE_SIGNALS_BYTES];
extern const uint8_t SAFE_PARK[8];
extern const uint8_t SAFE_THROTTLE[8];

/* "" when nothing forbidden was seen, else one line about the first such frame. */
const char *oracle_verdict(const oracle_t *oracle);

#endif

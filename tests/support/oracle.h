/*
 * Independent rules on which frame may be sent in which state (FSM-6; and in STANDBY and ACTIVE on the shared bus no frame
 * of the supervisor's own), written in raw identifiers and bytes. They share no code with the gate. Tests pass every
 * received and every sent frame to the oracle.
 */
#ifndef ORACLE_H
#define ORACLE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "agv/state.h"
#include "hal/can.h"

enum { ORACLE_ANGLES = 4 };

typedef struct {
    /* configuration */
    bool gateway;
    bool pass_all_in_manual;
    uint32_t signal_id;     /* 43Fh or 201h */
    uint32_t vehicle_id;    /* 363h or 203h */
    uint32_t own_status_id; /* 0 = none */
    uint32_t hold_age_ms;
    uint32_t mode_invalid_ms;
    uint32_t now_ms;    /* clock of the supervisor, set by the test */
    uint32_t ticked_ms; /* last tick */
    bool in_tick;       /* no frame was heard since then */

    /* mode: the bits of the last 363h, and the mode that counts */
    uint8_t mode_bits;
    bool manual;
    uint32_t both_since_ms;
    uint32_t both_halves; /* remaining half milliseconds of the budget for both bits, while not both are set */

    /* end of an engagement: one throttle 0 may be sent to the vehicle */
    agv_state_t before;
    bool ending;

    /* steering */
    bool angle_known;
    uint16_t angle_raw;
    uint32_t angle_ms;
    bool latched;
    bool held;
    bool held_since_tick; /* it is held since a frame that came after the last tick */
    uint16_t held_raw;
    uint32_t held_sent_ms; /* last own 065h; the trip before the first one */
    uint16_t recent_raw[ORACLE_ANGLES];
    uint32_t recent_ms[ORACLE_ANGLES];
    uint32_t angles;       /* valid ones received */
    uint32_t angle_frames; /* for a score */
    uint32_t angle_score;
    bool angle_unusable; /* invalid by its score */
    bool eps_was_unfit;  /* since the last 065h: a fault, another mode, or a gap, so that the angle may be taken anew */
    uint8_t eps_counter; /* of the last 067h */
    uint32_t eps_ms;     /* last 067h with a changed counter */
    uint32_t eps_status_ms; /* last 167h */

    /* result */
    uint32_t judged;    /* frames sent in INIT, TRIPPED, SAFE */
    uint32_t others;    /* frames sent in STANDBY, ACTIVE */
    uint32_t forbidden; /* forbidden frames in all states */
    hal_can_frame_t first_forbidden;
    hal_can_side_t first_side;
    agv_state_t first_state;
} oracle_t;

/* Set the oracle up for a configuration. */
void oracle_configure(oracle_t *oracle, const agv_config_t *config);

/* A supervisor starts: clears what was received, keeps the counts. */
void oracle_restart(oracle_t *oracle);

/* Call before each tick of the supervisor. */
void oracle_tick(oracle_t *oracle, uint32_t now_ms);

/* Call before a frame is passed to the supervisor. */
void oracle_heard(oracle_t *oracle, hal_can_side_t side, const hal_can_frame_t *frame);

/* Call for each frame that is sent in this state. */
void oracle_sent(oracle_t *oracle, hal_can_side_t side, const hal_can_frame_t *frame, agv_state_t state);

/* Call after each call of the supervisor, with its state. */
void oracle_returned(oracle_t *oracle, agv_state_t state);

/* The safe commands, byte for byte: hazard lights and headlight (byte 8 is the alive counter), gear P, no throttle. */
enum { SAFE_SIGNALS_BYTES = 7 };
extern const uint8_t SAFE_SIGNALS[SAFE_SIGNALS_BYTES];
extern const uint8_t SAFE_PARK[8];
extern const uint8_t SAFE_THROTTLE[8];

/* One line about the first forbidden frame; "" if there was none. */
const char *oracle_verdict(const oracle_t *oracle);

#endif

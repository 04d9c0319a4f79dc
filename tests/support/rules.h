/*
 * Independent rules on what a supervisor must and must not do, written in raw identifiers and bytes from
 * docs/requirements.md and docs/protocol.md, not from the code. They share only the names of the states with it.
 *
 * oracle.h checks single frames (FSM-6, TOP-1, TOP-2). These rules check sequences:
 *   - Silence trips (SUP-2, SUP-3). Alarm bits trip in the same call (SUP-4), with all safe commands (FSM-2).
 *   - Only a reset under its conditions ends the latch (FSM-3). The first reason is kept (FSM-5).
 *   - The safety output closes only on entry to STANDBY, and opens when it must, also for a confirmation that comes and
 *     goes (FSM-4). A start follows FSM-7. No trip cause is active in ACTIVE (FSM-11).
 *   - Safe commands are sent at once and on their cycles, and other senders' commands are overridden (TOP-1, TIM-1).
 *   - A gateway passes on only what it received (TOP-2). In shadow mode no frame is sent (TOP-4).
 *   - The gate never refuses a frame, and no memory corruption is detected.
 *
 * Times are 64-bit here and never wrap, unlike the supervisor's clock (TIM-2).
 */
#ifndef RULES_H
#define RULES_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/supervisor.h"
#include "hal/reset.h"
#include "oracle.h"

enum { RULES_COMMANDS = 4, RULES_STATUS = 7 };

/* A heartbeat (SUP-1). */
typedef struct {
    bool heard;
    uint8_t counter;
    uint64_t changed_ms; /* stamp of the last frame with a changed counter; initially the start */
} rules_beat_t;

/* What a supervisor reports, its safety output, and its hardware watchdog. */
typedef struct {
    agv_state_t state;
    agv_fault_t first_reason;
    agv_fault_set_t active;
    agv_fault_set_t trips; /* those of class trip */
    bool output_closed;
    uint32_t gate_refused;
    uint32_t watchdog_feeds; /* feeds that reached the hardware watchdog */
} rules_seen_t;

/* State of the supervisor's controller on the vehicle side. */
typedef struct {
    bool takes_frames;
    bool is_bus_off;
    bool is_passive;
    uint32_t tx_pending_ms; /* age of the oldest accepted frame that is not sent yet; 0: none */
} rules_bus_t;

typedef struct {
    oracle_t oracle;
    bool park_at_once;
    bool shadow;
    bool running_heartbeat;
    bool limits_commands; /* throttle ceiling or steering slew is on */
    uint8_t throttle_max;
    uint16_t tx_stalled_ms;
    uint16_t watchdog_period_ms;

    uint64_t now_ms;
    rules_seen_t last; /* after the previous call */
    rules_bus_t bus;

    rules_beat_t vcu;
    rules_beat_t eps;
    uint64_t status_ms[RULES_STATUS]; /* stamps of the last well-formed frames; initially the start */
    uint8_t status_data[RULES_STATUS][8];
    bool status_heard[RULES_STATUS];
    uint8_t command_data[RULES_COMMANDS][8]; /* last frames with values in range */
    uint8_t gears_heard;                     /* all received gears, one bit each, as on the bus */
    bool command_heard[RULES_COMMANDS];

    /* for the reset */
    bool button_was_up; /* since the trip */
    bool button_down;
    bool released; /* in the frame of this call */
    uint64_t pressed_ms;
    uint64_t press_ms; /* length of the released press */
    bool manual;
    uint64_t manual_ms;
    uint64_t fast_ms;     /* when a wheel or the VCU's speed was last above standstill */
    bool throttle_high;   /* 050h is above idle */
    uint64_t throttle_ms; /* when it was last above idle */
    uint64_t safe_ms;     /* start of SAFE */

    /* for the safety output */
    uint8_t mode_bits;       /* of the last 363h */
    bool was_engaged;        /* autopilot was reported at the last tick */
    bool was_out_of_park;    /* P was sent and not reported at the last tick */
    uint64_t engaged_sum_ms; /* sum of the time since the trip in which the first was certainly true (FSM-4) */
    uint64_t no_park_sum_ms; /* the same for the second */
    uint64_t unconfirmed_ms; /* when one of them was last true */
    bool park_sent;          /* a 168h with P was sent since the trip */
    uint64_t ticked_ms;      /* the last tick */
    uint64_t fed_ms;         /* when the hardware watchdog was last fed; initially the start */

    /* for the sending */
    uint8_t sent_now;       /* bits of the commands sent in this call, safe ones or forwarded ones */
    uint64_t commanding_ms; /* since when the state sends safe commands and the bus accepts them */
    uint64_t sent_ms[RULES_COMMANDS];
    bool answer_owed[RULES_COMMANDS];
    uint64_t answer_owed_ms[RULES_COMMANDS];
    uint64_t passive_ms; /**< the controller was error-passive */
    bool own_counter_known;
    uint8_t own_counter;

    bool alarm; /* the frame of this call has an alarm that trips at once */

    /* statistics and result */
    uint64_t calls;
    uint64_t sent;
    uint64_t trips;
    uint64_t resets;
    char broken[200]; /* the first broken rule, in one line; "" = none */
} rules_t;

/* Begin with a configuration, before the start of the supervisor. */
void rules_init(rules_t *rules, const agv_config_t *config);

/* The supervisor has started. @param before its last values before this start; NULL: it is the first start */
void rules_started(rules_t *rules, hal_reset_cause_t cause, const rules_seen_t *before, const rules_seen_t *seen,
                   uint64_t now_ms);

/* Call before a frame with this stamp is passed to the supervisor. */
void rules_heard(rules_t *rules, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t stamp_ms);

/* Call before a tick. */
void rules_ticks(rules_t *rules, uint64_t now_ms, rules_bus_t bus);

/* Call for each frame that is sent in this state. */
void rules_sent(rules_t *rules, hal_can_side_t side, const hal_can_frame_t *frame, agv_state_t state);

/* Call after each call of the supervisor. @param tick true: it was a tick, tick_gap_ms after the previous one; false: a
 * frame */
void rules_returned(rules_t *rules, const rules_seen_t *seen, bool tick, uint64_t tick_gap_ms);

#endif

/*
 * What a supervisor must do and must never do, stated once more in raw identifiers and bytes, from docs/requirements.md and
 * docs/protocol.md and not from the code. It shares nothing with what it judges but the names of the states.
 *
 * The frames themselves are judged by oracle.h (FSM-6, TOP-1, TOP-2). Here stands what needs a memory:
 *   silence trips (SUP-2, SUP-3), so do alarm bits, in the very call (SUP-4, FSM-2), and all safe commands go with it;
 *   the latch is left by a reset only, under its conditions (FSM-3); the first reason is kept (FSM-5);
 *   the safety output closes on entering STANDBY only, and opens when it has to, also for a confirmation that comes and goes
 *   (FSM-4); a start follows FSM-7;
 *   while the safe commands are sent, they are sent often enough, and commands of others are answered (TOP-1, TIM-1);
 *   a gateway passes on what was heard, and nothing else (TOP-2); in shadow mode nothing leaves (TOP-4);
 *   the gate never has to refuse, and no memory is found corrupt.
 *
 * Time is 64 bit here: it does not wrap, whatever the supervisor's clock does (TIM-2).
 */
#ifndef RULES_H
#define RULES_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/supervisor.h"
#include "hal/reset.h"
#include "oracle.h"

enum { RULES_COMMANDS = 4, RULES_STATUS = 7 };

/* A heartbeat, as SUP-1 has it. */
typedef struct {
    bool heard;
    uint8_t counter;
    uint64_t changed_ms; /* stamp of the last frame with another counter; at first the start */
} rules_beat_t;

/* What a supervisor reports, its safety output, and its hardware watchdog. */
typedef struct {
    agv_state_t state;
    agv_fault_t first_reason;
    agv_fault_set_t active;
    bool output_closed;
    uint32_t gate_refused;
    uint32_t watchdog_feeds; /* that the hardware watchdog has seen */
} rules_seen_t;

/* What its controller on the vehicle side is like at the moment. */
typedef struct {
    bool takes_frames;
    bool is_bus_off;
    uint32_t tx_pending_ms; /* age of the oldest frame that it has taken and not sent; 0: none */
} rules_bus_t;

typedef struct {
    oracle_t oracle;
    bool park_at_once;
    bool shadow;
    bool running_heartbeat;
    bool limits_commands; /* throttle ceiling or steering slew are on */
    uint8_t throttle_max;
    uint16_t tx_stalled_ms;
    uint16_t watchdog_period_ms;

    uint64_t now_ms;
    rules_seen_t last; /* what was seen after the call before */
    rules_bus_t bus;

    rules_beat_t vcu;
    rules_beat_t eps;
    uint64_t status_ms[RULES_STATUS]; /* stamps of the last well-formed ones; at first the start */
    uint8_t status_data[RULES_STATUS][8];
    bool status_heard[RULES_STATUS];
    uint8_t command_data[RULES_COMMANDS][8]; /* the last ones in range */
    uint8_t gears_heard;                     /* all of them, one bit each, as on the wire */
    bool command_heard[RULES_COMMANDS];

    /* for the reset */
    bool button_was_up; /* since the trip */
    bool button_down;
    bool released; /* by the frame of this call */
    uint64_t pressed_ms;
    uint64_t press_ms; /* how long the press took that was released */
    bool manual;
    uint64_t manual_ms;
    uint64_t fast_ms;     /* when a wheel, or the VCU's speed, was last seen above standstill */
    bool throttle_high;   /* 050h is above idle */
    uint64_t throttle_ms; /* when it last was */
    uint64_t safe_ms;     /* SAFE since */

    /* for the safety output */
    uint8_t mode_bits;       /* of the last 363h */
    bool was_engaged;        /* the last tick found autopilot reported */
    bool was_out_of_park;    /* the last tick found P sent and not reported */
    uint64_t engaged_sum_ms; /* in which that was surely so since the trip, in all (FSM-4) */
    uint64_t no_park_sum_ms; /* and that */
    uint64_t unconfirmed_ms; /* when one of them last was */
    bool park_sent;          /* since the trip a 168h with P has left */
    uint64_t ticked_ms;      /* the last tick */
    uint64_t fed_ms;         /* when the hardware watchdog was last fed; at first the start */

    /* for the sending */
    uint8_t sent_now;       /* bits of the commands that left in this call, safe or passed */
    uint64_t commanding_ms; /* the state sends safe commands, and the bus takes them, since */
    uint64_t sent_ms[RULES_COMMANDS];
    bool answer_owed[RULES_COMMANDS];
    uint64_t answer_owed_ms[RULES_COMMANDS];
    bool own_counter_known;
    uint8_t own_counter;

    bool alarm; /* the frame of this call carries a fault that trips at once */

    /* how much was judged */
    uint64_t calls;
    uint64_t sent;
    uint64_t trips;
    uint64_t resets;
    char broken[200]; /* "" = no rule was broken; else the first one, in a line */
} rules_t;

/* A supervisor with this configuration; nothing is known yet. */
void rules_init(rules_t *rules, const agv_config_t *config);

/* It has started. @param before what it was before this start; NULL: this is its first one */
void rules_started(rules_t *rules, hal_reset_cause_t cause, const rules_seen_t *before, const rules_seen_t *seen,
                   uint64_t now_ms);

/* A frame with this stamp is about to be handed in. */
void rules_heard(rules_t *rules, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t stamp_ms);

/* A tick is about to come. */
void rules_ticks(rules_t *rules, uint64_t now_ms, rules_bus_t bus);

/* A frame leaves in this state. */
void rules_sent(rules_t *rules, hal_can_side_t side, const hal_can_frame_t *frame, agv_state_t state);

/* The call has returned. @param tick it was one, this long after the one before; else it was a frame */
void rules_returned(rules_t *rules, const rules_seen_t *seen, bool tick, uint64_t tick_gap_ms);

#endif

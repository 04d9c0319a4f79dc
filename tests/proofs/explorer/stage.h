/*
 * What the explorer plays on: one supervisor and its vehicle (world.h), a millisecond at a time, with the vehicle put
 * together from few values: mode, button, gear, wheels, and at most one thing that is wrong with it at a time (an
 * illness). From these the traffic follows, so that a stage is saved and compared by few bytes.
 *
 * A millisecond is as in host_sim: what is done to the stage, the tick, then the frames that are due.
 */
#ifndef STAGE_H
#define STAGE_H

#include <stdbool.h>
#include <stdint.h>

#include "moment.h"

/* What is wrong with the vehicle. Names, and the fault that has to come of each, stand in illness.c. */
typedef enum {
    ILL_NOTHING,
    ILL_VCU_SILENT,
    ILL_VCU_FROZEN,
    ILL_VCU_SHORT,
    ILL_EPS_SILENT,
    ILL_EPS_FROZEN,
    ILL_AI_SILENT,
    ILL_AI_FROZEN,
    ILL_AI_SHORT,
    ILL_ALL_SILENT,
    ILL_GEAR_STATUS_SILENT,
    ILL_THROTTLE_STATUS_SILENT,
    ILL_WHEELS_SILENT,
    ILL_EPS_STATUS_SILENT,
    ILL_GEAR_COMMAND_SILENT,
    ILL_STEERING_COMMAND_SILENT,
    ILL_EPS_FAULT,
    ILL_EPS_SUPPLY,
    ILL_VCU_ALARM,
    ILL_VCU_AI_ALARM,
    ILL_AI_OUT_OF_RANGE,
    ILL_AI_BABBLES,
    ILL_GEAR_INVALID,
    ILL_ANGLE_INVALID,
    ILL_EPS_MODE_OFF,
    ILL_STEERING_OFF,
    ILL_THROTTLE,
    ILL_THROTTLE_ABOVE,
    ILL_GEAR_AGAINST,
    ILL_AUTOPILOT_STAYS,
    ILL_MODE_FLAPS,
    ILL_FOREIGN,
    ILL_RECEIVE_DEAD,
    ILLNESSES
} illness_t;

/* The controller on the vehicle side. One that is off recovers when asked to, one that is dead does not. */
typedef enum { BUS_FINE, BUS_PASSIVE, BUS_OFF, BUS_DEAD } stage_bus_t;

enum { STAGE_MANUAL = 0x40, STAGE_ENGAGED = 0x80, STAGE_BOTH = 0xC0, STAGE_NEITHER = 0 };
enum { STAGE_D = 1, STAGE_P = 8 };

/* One variant of the configuration. */
typedef struct {
    const char *name;
    unsigned world;    /* of world_load() */
    uint32_t clock_ms; /* what the clock reads at the start */
    bool wraps;        /* it wraps, or passes the middle of its range, while states are found */
} stage_variant_t;

enum { STAGE_VARIANTS = 7 };
extern const stage_variant_t STAGE_VARIANT[STAGE_VARIANTS];

typedef struct {
    uint64_t root_ms;
    uint64_t foreign_ms; /* since when a foreign sender sends */
    uint64_t ill_ms;     /* since when the vehicle is ill, and while that reaches the supervisor at all */
    uint64_t mode_ms;    /* since when it reports its mode */
    uint64_t wheels_ms;  /* since when its wheels turn, or stand */
    uint64_t latched_ms; /* since when it is TRIPPED or SAFE */
    uint64_t taken_ms;   /* when the oldest frame that does not leave was taken */
    uint32_t frames;     /* that left since the last start */
    uint32_t recover_requests;
    uint8_t recover_in_ms;
    uint8_t bus;     /* stage_bus_t */
    uint8_t illness; /* illness_t */
    uint8_t mode;
    uint8_t gear;
    bool button;
    bool wheels_turn;
    bool stood;   /* the wheels have stood since the trip, and that was seen */
    bool stalled; /* what was handed over does not leave */
    bool ai_off;  /* bus-off of the AI side */
    bool bad_latch;
} stage_t;

extern stage_t stage;
extern const stage_variant_t *stage_variant;

/* A stage to come back to. */
typedef struct {
    moment_t world;
    stage_t stage;
} stage_saved_t;

/* The first moment of a variant: the supervisor has just started from a power-on. */
void stage_root(const stage_variant_t *variant);

void stage_save(stage_saved_t *saved);
void stage_restore(const stage_saved_t *saved);

/* Milliseconds since the root; and whether the clock has wrapped, or passed the middle of its range, since then. */
uint32_t stage_now_ms(void);
bool stage_wrapped(void);

/* The traffic, as the values of the stage have it; then milliseconds, with all checks. */
void stage_dress(void);
void stage_run(uint32_t ms);
void stage_run_past(unsigned message);

/* What takes a millisecond: frames, or a restart, before its tick. */
void stage_deliver(hal_can_side_t side, const hal_can_frame_t *frames, unsigned count);
void stage_speak(void);
void stage_restart(hal_reset_cause_t cause);

/* Frames come, the tick does not, for so long; or nothing at all comes. */
void stage_late(uint32_t ms);
void stage_sleep(uint32_t ms);

void stage_set_bus(stage_bus_t bus);
void stage_set_ai_off(bool off);

/* Whether the message's own frames reach the supervisor as they should; whether something is mute that could speak. */
bool stage_flows(unsigned message);
bool stage_can_speak(void);

/* The first rule that was broken; "" = none. */
const char *stage_broken(void);

/* The last frame that left. */
extern hal_can_frame_t stage_last_frame;
extern hal_can_side_t stage_last_side;

/* Who is told what happens, to write it down. A millisecond begins with `before`, then comes what is done in it. */
typedef struct {
    void (*before)(uint32_t at_ms);
    void (*after)(void);
    void (*delivered)(hal_can_side_t side, const hal_can_frame_t *frame);
    void (*spoke)(unsigned message);
    void (*restarted)(hal_reset_cause_t cause);
    void (*without_ticks)(uint32_t ms, bool frames_come);
} stage_teller_t;
extern const stage_teller_t *stage_teller; /* NULL: nobody */

/* When each message is sent within its cycle. */
extern const uint8_t STAGE_PHASE_MS[TRAFFIC_MESSAGES];

/* illness.c */
typedef enum { TRIPS_NEVER, TRIPS_ALWAYS, TRIPS_FLAPPING, TRIPS_ENGAGED, TRIPS_FOLLOWED } illness_trips_t;

typedef struct {
    const char *name;
    const char *fault;        /* that is the reason of a trip, when it trips */
    const char *frozen_fault; /* NULL, or the other one it may be */
    uint8_t like;             /* illness that has the same effect where no autopilot is supervised (abstract.h) */
    uint8_t trips;            /* when it trips: illness_trips_t */
} illness_row_t;
extern const illness_row_t ILLNESS[ILLNESSES];
void illness_dress(illness_t illness);

#endif

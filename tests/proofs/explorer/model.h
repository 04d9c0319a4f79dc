/*
 * The model that the explorer runs: one supervisor and its vehicle (testbed.h), in steps of a millisecond. The vehicle
 * consists of few values: mode, button, gear, wheels, and at most one fault at a time (a defect). The traffic is derived
 * from them, so a model can be saved and compared as a few bytes.
 *
 * The order within a millisecond is that of host_sim: changes of the model, the tick, then the frames that are due.
 */
#ifndef MODEL_H
#define MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "testbed_state.h"

/* Defects of the vehicle. Their names, and when each must trip, are in defect.c. */
typedef enum {
    DEFECT_NONE,
    DEFECT_VCU_SILENT,
    DEFECT_VCU_FROZEN,
    DEFECT_VCU_SHORT,
    DEFECT_EPS_SILENT,
    DEFECT_EPS_FROZEN,
    DEFECT_AI_SILENT,
    DEFECT_AI_FROZEN,
    DEFECT_AI_SHORT,
    DEFECT_ALL_SILENT,
    DEFECT_GEAR_STATUS_SILENT,
    DEFECT_THROTTLE_STATUS_SILENT,
    DEFECT_WHEELS_SILENT,
    DEFECT_EPS_STATUS_SILENT,
    DEFECT_GEAR_COMMAND_SILENT,
    DEFECT_STEERING_COMMAND_SILENT,
    DEFECT_EPS_FAULT,
    DEFECT_EPS_SUPPLY,
    DEFECT_VCU_ALARM,
    DEFECT_VCU_AI_ALARM,
    DEFECT_AI_OUT_OF_RANGE,
    DEFECT_AI_BABBLES,
    DEFECT_GEAR_INVALID,
    DEFECT_ANGLE_INVALID,
    DEFECT_EPS_MODE_OFF,
    DEFECT_STEERING_OFF,
    DEFECT_THROTTLE,
    DEFECT_THROTTLE_ABOVE,
    DEFECT_GEAR_AGAINST,
    DEFECT_AUTOPILOT_STAYS,
    DEFECT_MODE_FLAPS,
    DEFECT_FOREIGN,
    DEFECT_RECEIVE_DEAD,
    DEFECTS
} defect_t;

/* The controller on the vehicle side. After BUS_OFF it recovers on request, after BUS_DEAD it never does. */
typedef enum { BUS_FINE, BUS_PASSIVE, BUS_OFF, BUS_DEAD } model_bus_t;

enum { MODEL_MANUAL = 0x40, MODEL_ENGAGED = 0x80, MODEL_BOTH = 0xC0, MODEL_NEITHER = 0 };
enum { MODEL_D = 1, MODEL_P = 8 };

/* One variant of the configuration. */
typedef struct {
    const char *name;
    unsigned testbed;  /* number for testbed_load() */
    uint32_t clock_ms; /* clock at the start */
    bool wraps;        /* the clock wraps, or passes the middle of its range, during the search */
} model_variant_t;

enum { MODEL_VARIANTS = 7 };
extern const model_variant_t MODEL_VARIANT[MODEL_VARIANTS];

typedef struct {
    uint64_t root_ms;
    uint64_t foreign_ms; /* start of a foreign sender's frames */
    uint64_t defect_ms;  /* start of the defect, or of the time in which its frames reach the supervisor */
    uint64_t mode_ms;    /* start of the reported mode */
    uint64_t wheels_ms;  /* last time that the wheels began to turn or to stand */
    uint64_t latched_ms; /* start of TRIPPED or SAFE */
    uint64_t taken_ms;   /* when the oldest unsent frame was accepted */
    uint32_t frames;     /* sent since the last start */
    uint32_t recover_requests;
    uint8_t recover_in_ms;
    uint8_t bus;    /* model_bus_t */
    uint8_t defect; /* defect_t */
    uint8_t mode;
    uint8_t gear;
    bool button;
    bool wheels_turn;
    bool stood;   /* the wheels have stood since the trip, and the supervisor could see it */
    bool stalled; /* accepted frames are not sent */
    bool ai_off;  /* bus-off of the AI side */
    bool bad_latch;
} model_t;

extern model_t model;
extern const model_variant_t *model_variant;

/* A saved model. */
typedef struct {
    testbed_state_t testbed;
    model_t model;
} model_saved_t;

/* The first moment of a variant: the supervisor has just started from a power-on. */
void model_root(const model_variant_t *variant);

void model_save(model_saved_t *saved);
void model_restore(const model_saved_t *saved);

/* Milliseconds since the root; and whether the clock has wrapped, or passed the middle of its range, since then. */
uint32_t model_now_ms(void);
bool model_wrapped(void);

/* Derive the traffic from the values of the model; run milliseconds, with all checks. */
void model_apply_defect(void);
void model_run(uint32_t ms);
void model_run_past(unsigned message);

/* Inputs that take a millisecond: frames, or a restart, before its tick. */
void model_deliver(hal_can_side_t side, const hal_can_frame_t *frames, unsigned count);
void model_speak(void);
void model_restart(hal_reset_cause_t cause);

/* A late tick: frames come in the meantime. Sleep: nothing comes. */
void model_late(uint32_t ms);
void model_sleep(uint32_t ms);

void model_set_bus(model_bus_t bus);
void model_set_ai_off(bool off);

/* Whether frames of a message reach the supervisor complete; whether a silent node could send. */
bool model_flows(unsigned message);
bool model_can_speak(void);

/* The first rule that was broken; "" = none. */
const char *model_broken(void);

/* defect.c */
typedef enum { TRIPS_NEVER, TRIPS_ALWAYS, TRIPS_FLAPPING, TRIPS_ENGAGED, TRIPS_FOLLOWED } defect_trips_t;

typedef struct {
    const char *name;
    uint8_t like;  /* defect with the same effect while not engaged (abstract.h) */
    uint8_t trips; /* when it trips: defect_trips_t */
} defect_row_t;
extern const defect_row_t DEFECT_ROWS[DEFECTS];
void defect_apply(defect_t defect);

#endif

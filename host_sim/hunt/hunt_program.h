/**
 * @file hunt_program.h
 * One run of a hunt: a vehicle, a configuration and a short list of attacks. It is drawn from random numbers or is a
 * mutation of others, and is written as the text of a scenario.
 */
#ifndef HOST_SIM_HUNT_PROGRAM_H
#define HOST_SIM_HUNT_PROGRAM_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hunt/hunt_attacks.h"
#include "text/text.h"

enum { HUNT_ACTIONS_MAX = 6, HUNT_SETTINGS_MAX = 4, HUNT_CLASSES_MAX = 2 };

/** An attack with its times and parameters. */
typedef struct {
    uint16_t attack; /**< row of HUNT_ATTACKS */
    uint32_t begin_ms;
    uint32_t end_ms; /**< that of the run: it never ends */
    uint32_t parameters[HUNT_PARAMETERS];
} hunt_action_t;

/** A setting with another value than its preset. */
typedef struct {
    uint16_t setting;
    uint16_t value;
} hunt_setting_t;

typedef struct {
    bool gateway;
    bool park_guard;
    bool rolls;       /**< the brakes do not work */
    bool obeys_short; /**< the VCU obeys commands of any length */
    uint16_t tick_phase_us;
    uint16_t steering_rate_ddeg_s;
    uint32_t throttle_pct;
    int32_t steer_deg;
    uint32_t duration_ms;
    uint32_t setting_count;
    hunt_setting_t settings[HUNT_SETTINGS_MAX];
    uint32_t class_count;
    uint8_t classes[HUNT_CLASSES_MAX]; /**< faults whose class is the other one */
    uint32_t action_count;
    hunt_action_t actions[HUNT_ACTIONS_MAX];
} hunt_program_t;

/** Draw one. @param state of prng.h */
void hunt_program_make(hunt_program_t *program, uint64_t *state);

/** Change one a little. @param other gives an action now and then */
void hunt_program_mutate(hunt_program_t *program, const hunt_program_t *other, uint64_t *state);

/** Its configuration. */
void hunt_program_config(const hunt_program_t *program, agv_config_t *config);

/** Write it as the head of a scenario: all but what is expected. */
void hunt_program_write(const hunt_program_t *program, const char *name, text_t *text);

/** The message that an action is about; AGV_MSG_NONE. */
agv_message_t hunt_action_message(const hunt_action_t *action);

/** Write its attacks, as steps. */
void hunt_steps_write(const hunt_program_t *program, text_t *text);

/** List its attacks and settings in one line. */
void hunt_program_describe(const hunt_program_t *program, text_t *text);

#endif

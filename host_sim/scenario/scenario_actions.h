/**
 * @file scenario_actions.h
 * The words of steps: actors, their actions and the parameters of these. For scenario_parse*.c, scenario_schema*.c
 * and vehicle_words.c only.
 */
#ifndef HOST_SIM_SCENARIO_ACTIONS_H
#define HOST_SIM_SCENARIO_ACTIONS_H

#include "io/yaml_reader.h"
#include "scenario/scenario.h"

/** Actors. */
typedef enum {
    ACTOR_VCU,
    ACTOR_EPS,
    ACTOR_AI,
    ACTOR_OPERATOR,
    ACTOR_BUS,
    ACTOR_SUPERVISOR,
    ACTOR_BOARD,
    ACTOR_NONE
} scenario_actor_t;

/* The parameters of steps, as bits. */
#define P_MESSAGE (1u << 0)
#define P_FRAMES (1u << 1)
#define P_BY_MS (1u << 2)
#define P_TIMES (1u << 3)
#define P_KIND (1u << 4)
#define P_EVERY_MS (1u << 5)
#define P_BYTES (1u << 6)
#define P_FIELD (1u << 7)
#define P_VALUE (1u << 8)
#define P_GEAR (1u << 9)
#define P_THROTTLE (1u << 10)
#define P_STEER (1u << 11)
#define P_BUTTON (1u << 12)
#define P_SIDE (1u << 13)
#define P_ID (1u << 14)
#define P_CAUSE (1u << 15)
#define P_OFF_MS (1u << 16)
#define P_FOR_MS (1u << 17)
#define P_BIT (1u << 18)
#define P_EVERY_FRAMES (1u << 19)
#define P_PCT_S (1u << 20)
#define P_SPEED (1u << 21)
#define P_PATTERN (1u << 22)
#define P_PERMILLE (1u << 23)
#define P_PART (1u << 24)

/** What an actor can do. */
typedef struct {
    scenario_actor_t actor; /* ACTOR_NONE: any node of the vehicle */
    const char *word;
    bool of_vehicle;
    bool on;  /* for actions that switch something */
    int what; /* vehicle_do_t or scenario_do_t */
    uint32_t needs;
    uint32_t takes;
} scenario_action_row_t;

/** A field of a message that `set` can hold at a value. */
typedef struct {
    const char *name;
    scenario_actor_t actor;
    agv_message_t message;
    uint8_t byte;
    uint8_t size;
    uint8_t mask; /* of each byte */
    uint8_t shift;
} scenario_field_row_t;

#define SCENARIO_PARAMETERS 25u

extern const yaml_word_t SCENARIO_ACTORS[];
/** The parameters, in the order of their bits: name and limits. What they hold in a step is for its action to say. */
extern const yaml_key_t SCENARIO_PARAMETER_ROWS[SCENARIO_PARAMETERS];

/** @name Words of `kind` @{ */
extern const yaml_word_t SCENARIO_GARBAGE[];
extern const yaml_word_t SCENARIO_FRAME_KINDS[];
/** @} */

/** The row of a parameter, P_*. */
const yaml_key_t *scenario_parameter(uint32_t parameter);

/** Whether an actor can do this. */
bool scenario_action_is_of(const scenario_action_row_t *row, scenario_actor_t actor);

/** The largest value of a field. */
uint32_t scenario_field_highest(const scenario_field_row_t *row);

/** All actions, and all fields: those with the numbers from 0 on; NULL: no more. */
const scenario_action_row_t *scenario_action(size_t number);
const scenario_field_row_t *scenario_field(size_t number);

/** What an actor can do by this word; NULL: nothing. */
const scenario_action_row_t *scenario_find_action(scenario_actor_t actor, const char *word);

/** The field of a node's messages with this name; NULL: it has none. */
const scenario_field_row_t *scenario_find_field(scenario_actor_t actor, const char *name);

#endif

/**
 * @file vehicle_words.h
 * Steps of a scenario (docs/scenarios.md) written as a line: what is typed while the vehicle runs, and `--fault`.
 * Words, parameters and their ranges are those of scenario files, read by the same code.
 */
#ifndef HOST_SIM_VEHICLE_WORDS_H
#define HOST_SIM_VEHICLE_WORDS_H

#include <stdbool.h>

#include "agv/config.h"
#include "scenario/scenario.h"

/** The longest line. */
#define VEHICLE_WORDS_MAX 256u

/** A step of the vehicle, and how it was written. */
typedef struct {
    scenario_step_t step;
    char what[VEHICLE_WORDS_MAX]; /**< "set field=faults value=08h" */
} vehicle_words_t;

/** What a typed line is beside a step. */
typedef enum {
    VEHICLE_COMMAND_NONE, /**< a step, if anything */
    VEHICLE_COMMAND_HELP,
    VEHICLE_COMMAND_STATUS,
    VEHICLE_COMMAND_QUIT,
    VEHICLE_COMMAND_BAD /**< a command with more words behind it; was reported */
} vehicle_command_t;

/** Whether a typed line is a command. Blanks around it do not matter. */
vehicle_command_t vehicle_words_command(const char *line);

/**
 * Read a typed line: `eps set field=faults value=08h`. A value with blanks stands in quotes.
 * @param config its ID set and topology decide what may be named
 * @return false: it makes no sense; was reported in one line
 */
bool vehicle_words_typed(const char *line, const agv_config_t *config, vehicle_words_t *words);

/** Read what follows `--fault`: `eps-set,field=faults,value=08h@3000`. @return as vehicle_words_typed() */
bool vehicle_words_fault(const char *text, const agv_config_t *config, vehicle_words_t *words);

/** Print the actors, their actions and parameters. */
void vehicle_words_help(void);

#endif

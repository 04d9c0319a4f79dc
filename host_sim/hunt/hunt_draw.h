/**
 * @file hunt_draw.h
 * The parts of a program of a hunt, drawn from random numbers: attacks with their times and parameters, settings,
 * classes.
 *
 * Nothing is added to a full list.
 */
#ifndef HOST_SIM_HUNT_DRAW_H
#define HOST_SIM_HUNT_DRAW_H

#include <stdint.h>

#include "hunt/hunt_program.h"

uint32_t hunt_draw_parameter(const hunt_attack_t *attack, unsigned i, uint64_t *state);
void hunt_draw_times(const hunt_program_t *program, hunt_action_t *action, uint64_t *state);

/** Add an attack of any kind. */
void hunt_add_action(hunt_program_t *program, uint64_t *state);

/** Add an operator who resets and drives off again. */
void hunt_add_reset(hunt_program_t *program, uint64_t *state);

void hunt_add_setting(hunt_program_t *program, uint64_t *state);

/** Give a fault the other class, and add the attack that raises it if there is exactly one. */
void hunt_add_class(hunt_program_t *program, uint64_t *state);

#endif

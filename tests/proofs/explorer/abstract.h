/*
 * The key of an abstract state: two models with the same key are explored as one. The key is made from the supervisor's
 * memory, but only to distinguish states; behaviour is checked from outside (rules.h, oracle.h).
 *
 *   always      state, safety output, defect of the vehicle, mode (both bits set is a value of its own), button, gear in
 *               P or not, VCU, EPS and AI computer alive or not, status messages fresh, controller of each side, queue
 *               full, frames that wait, answers that wait, watchdog not fed, stored latch damaged, clock wrapped
 *   INIT        progress of the 500 ms of the start-up check and of its 10 s, a trip cause, P released
 *   STANDBY, ACTIVE   engagement: grace time, end, number of recent ones, AI computer awaited; commands fresh; the highest
 *               score and the highest budget as zero, in between, or full; the VCU's alarm armed; the AI computer lost, or
 *               never received
 *   TRIPPED, SAFE     press (began after the trip; in SAFE: long enough, answered), all conditions of a reset held for
 *               long enough, the wheels have stood, the higher confirmation sum (zero, in between, at its limit), P
 *               released, steering can be held, a trip cause of the vehicle or of the AI computer, an unresettable fault
 *   eve         the first of these times that expires with the next tick. So each state is also explored one millisecond
 *               before a time expires
 *
 * A value that the supervisor does not use in a state is not in the key of that state: one frame sets it again in every
 * state that uses it.
 */
#ifndef ABSTRACT_H
#define ABSTRACT_H

#include <stdbool.h>
#include <stdint.h>

/*
 * For the quick search: the key does not contain the wrap of the clock, nor whether the vehicle has stood since the trip.
 */
extern bool abstract_coarse;

enum { ABSTRACT_BYTES = 12 };

typedef struct {
    uint8_t byte[ABSTRACT_BYTES];
} abstract_t;

/* The key of the current model. */
void abstract_now(abstract_t *key);

/* Milliseconds after which all running times of the key have expired, and all periodic frames were sent. */
uint32_t abstract_horizon_ms(void);

#endif

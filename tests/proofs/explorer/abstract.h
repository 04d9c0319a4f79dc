/*
 * What the explorer takes for one state: two models with the same key are explored as one. The key is made of what the
 * supervisor's memory says, but only to tell states apart; what it does is judged from outside (rules.h, oracle.h).
 *
 *   always      state, safety output, illness of the vehicle, mode (both bits at once apart), button, gear in P or not,
 *               VCU, EPS, AI computer alive or not, status messages fresh, controller of each side, queue full, frames
 *               that wait, answers that wait, watchdog starved, the stored latch damaged, before or after the wrap
 *   INIT        how far the 500 ms of all well and the 10 s are, a trip cause, P released
 *   STANDBY, ACTIVE   engagement: grace, end, how many lately, AI computer awaited; commands fresh; the worst of the scores
 *               and of the budgets as nothing, on the way, or full; the VCU's alarm armed; the AI computer lost, or never
 *               seen
 *   TRIPPED, SAFE     press (began after the trip; in SAFE: long enough, answered), whether all conditions of a reset have
 *               held for long enough, whether the wheels stood, the worse of the confirmation sums (nothing, some, at its
 *               limit), P released, the steering holdable, a trip cause of the vehicle or of the AI computer, what only a
 *               power-on ends
 *   eve         the first of these times that will be over with the next tick; so each time is met a millisecond before
 *               it is over, and everything is tried there
 *
 * What is left out can be had again at once: a value that the supervisor does not go by in a state is set again by one
 * frame, in the state in which it does.
 */
#ifndef ABSTRACT_H
#define ABSTRACT_H

#include <stdbool.h>
#include <stdint.h>

/*
 * For the quick search: before and after the wrap of the clock is one state, and so are a vehicle that stands since the trip
 * and one that does not yet.
 */
extern bool abstract_coarse;

enum { ABSTRACT_BYTES = 12 };

typedef struct {
    uint8_t byte[ABSTRACT_BYTES];
} abstract_t;

/* The key of the model as it is. */
void abstract_now(abstract_t *key);

/* After so many milliseconds all the times of the key that run now are over, and what is periodic has come. */
uint32_t abstract_horizon_ms(void);

#endif

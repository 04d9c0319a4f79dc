/*
 * The abstract inputs that the explorer tries in each state (alphabet.c has the table). Each is a change of the model and
 * the least time in which the supervisor hears of it:
 *
 *   time        on, until the abstract state changes or all its times are over; so it also stops a millisecond before
 *   frames      the vehicle's own with another value (mode, button, gear, wheels); what is ill falls silent, freezes,
 *               sends faults, values out of range, short frames; it speaks again for one frame; rogue nodes' frames, and
 *               malformed ones
 *   controller  error-passive, bus-off (it recovers when asked to, or not), overrun, queue full, frames do not leave
 *   supervisor  a late tick, a sleep, restarts by each kind of cause, with the latch as stored or damaged
 */
#ifndef ALPHABET_H
#define ALPHABET_H

#include <stdbool.h>

/* Whether an illness of the vehicle and a trouble of a controller or of the stored latch may be there together. */
extern bool alphabet_pairs;

/* Whether only what a scenario can say is tried: a counterexample that is found so can be played. */
extern bool alphabet_tellable;

/*
 * Whether late ticks are tried with these, in STANDBY and ACTIVE. In a pause of host_sim frames wait until its end, with
 * their own stamps: what their handling leads to is seen later, and INIT or a reset would end at another time.
 */
extern bool alphabet_hangs;

/* How many symbols there are; the short run has those below the second. */
unsigned alphabet_size(bool quick);

const char *alphabet_name(unsigned symbol);

/* Whether it does anything here. */
bool alphabet_enabled(unsigned symbol);

void alphabet_apply(unsigned symbol);

/* Whether it may begin something that no key shows: an answer that is owed, say. */
bool alphabet_leaves_no_trace(unsigned symbol);

#endif

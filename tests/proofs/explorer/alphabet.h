/*
 * The abstract inputs that the explorer tries in each state (alphabet.c has the table). Each changes the model, and lasts
 * until the supervisor has received the change:
 *
 *   time        passes until the abstract state changes or all times of the key have expired; so there is also a stop one
 *               millisecond before each
 *   frames      the vehicle's own frames with another value (mode, button, gear, wheels); a defective node falls silent,
 *               freezes, or sends faults, values out of range or short frames; a silent node sends one frame; frames of
 *               rogue nodes, and malformed ones
 *   controller  error-passive, bus-off (with or without recovery), overrun, queue full, frames that are not sent
 *   supervisor  a late tick, days without a tick, restarts with each kind of cause, the stored latch damaged
 */
#ifndef ALPHABET_H
#define ALPHABET_H

#include <stdbool.h>

/* Whether a defect of the vehicle and a trouble of a controller or of the stored latch may exist at the same time. */
extern bool alphabet_pairs;

/* Number of symbols of the full or the short alphabet, which is the beginning of the full one. */
unsigned alphabet_size(bool quick);

const char *alphabet_name(unsigned symbol);

/* Whether the symbol has an effect in the current state. */
bool alphabet_enabled(unsigned symbol);

void alphabet_apply(unsigned symbol);

/* Whether the symbol may have a consequence that is not in the key, such as an answer that is still due. */
bool alphabet_leaves_no_trace(unsigned symbol);

#endif

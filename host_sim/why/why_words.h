/**
 * @file why_words.h
 * Causes as sentences for people.
 */
#ifndef HOST_SIM_WHY_WORDS_H
#define HOST_SIM_WHY_WORDS_H

#include "text/text.h"
#include "why/why.h"

/** Add the cause of a trip: "065h steering_command was silent: last at 61.984 s, deadline 125 ms, next at 63.002 s". */
void why_words_cause(text_t *text, const why_t *why, const why_trip_t *trip);

/** Add what came during a silence: "5 came with a length of 7, the first at 2.000 s". Only if anything did. */
void why_words_refused(text_t *text, const why_trip_t *trip);

/** Add why a condition for leaving INIT was missing: "363h reports autopilot from its first frame". @param bit 0..10 */
void why_words_missing(text_t *text, const why_t *why, uint8_t bit);

/**
 * Add what had begun and was not decided when the run ended: "065h steering_command was silent for 90 ms, deadline 125 ms".
 * @return false: nothing of this fault had begun
 */
bool why_words_pending(text_t *text, const why_t *why, agv_fault_t fault);

/** Add a time: "61.984 s". */
void why_words_time(text_t *text, uint64_t t_us);

#endif

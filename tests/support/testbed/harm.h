/*
 * What bit_flips and hal_failures share: the harm of one run on the testbed, and its report.
 */
#ifndef HARM_H
#define HARM_H

#include <stdbool.h>
#include <stdint.h>

/* Runs that did harm so far. */
extern uint64_t harm_count;

/* A run begins: no harm yet. */
void harm_begin(void);

/* Harm in this run; only the first is kept. */
void harm_note(const char *what);
bool harm_is_noted(void);

/* Whether the rule that was just broken begins with this text; then take it, as harm unless it is to be expected. */
bool harm_rule_is(const char *text);
void harm_take_rule(bool expected);

/* The run is over: count its harm, if any, and print the first 20, with where it came from. */
__attribute__((format(printf, 1, 2))) void harm_report(const char *format, ...);

#endif

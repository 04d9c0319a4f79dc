/*
 * Broken rules of one run on the testbed ("harm"), and their report, for bit_flips and hal_failures.
 */
#ifndef HARM_H
#define HARM_H

#include <stdbool.h>
#include <stdint.h>

/* Number of runs with a broken rule so far. */
extern uint64_t harm_count;

/* Begin a run. */
void harm_begin(void);

/* Note a broken rule of this run; only the first is kept. */
void harm_note(const char *what);
bool harm_is_noted(void);

/* Whether the text of the last broken rule begins like this. Clear that rule, and note it unless it is expected. */
bool harm_rule_is(const char *text);
void harm_take_rule(bool expected);

/* End a run: if a rule was broken, count the run. The first 20 are printed, with their situation. */
__attribute__((format(printf, 1, 2))) void harm_report(const char *format, ...);

#endif

/*
 * A counterexample as a scenario file of host_sim: its steps say what the model did, its expectations what was seen
 * before the rule was broken, and what the rule asked for. So it fails with the supervisor that broke the rule, and holds
 * with one that does not.
 *
 * The vehicle of host_sim sends all messages at the times of the model, with bytes that the file sets. What a scenario
 * cannot say stands in it as a comment: a receive path that does not check in, a controller that never recovers, days
 * without a tick. In such a case the file describes the trace, and proves nothing.
 */
#ifndef TRACE_H
#define TRACE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* From now on all that happens is noted, from the root of the model on. */
void trace_begin(void);

/* The name of the symbol that comes now. */
void trace_says(const char *comment);

/* It is complete. Writes the file; the rule that was broken is model_broken(). */
void trace_write(FILE *file);

/* ---- trace_expect.c: what is expected, by what was seen ---- */

/* The supervisor starts, or has just started again. */
void trace_expect_begin(void);
void trace_expect_restarted(void);

/* A millisecond is over. */
void trace_expect_ms(uint32_t t_ms);

/* Whether the file needs a status frame that the configuration has not; this one. */
enum { TRACE_STATUS_ID = 0x7FF, TRACE_STATUS_MS = 10 };
bool trace_expect_needs_status(void);

/* How long the file runs; and its expectations. */
uint32_t trace_expect_duration_ms(void);
void trace_expect_write(FILE *file);

#endif

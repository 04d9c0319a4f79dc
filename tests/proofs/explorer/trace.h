/*
 * A counterexample as a scenario file of host_sim. Its steps repeat what the model did. Its expectations are what was
 * observed before the rule was broken, and what the rule demands. So it fails with the supervisor that broke the rule, and
 * passes with a correct one.
 *
 * The vehicle of host_sim sends all messages at the times of the model, with bytes that the file sets. A scenario cannot
 * express some inputs: a receive path that does not check in, a controller that never recovers, days without a tick. They
 * are comments in the file, which then only describes the trace and shows nothing.
 */
#ifndef TRACE_H
#define TRACE_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

/* Start recording, at the root of the model. */
void trace_begin(void);

/* Name of the next symbol. */
void trace_says(const char *comment);

/* Write the file. model_broken() is the broken rule. */
void trace_write(FILE *file);

/* ---- trace_expect.c: expectations, from the observed behaviour ---- */

/* The supervisor starts, or has just restarted. */
void trace_expect_begin(void);
void trace_expect_restarted(void);

/* Called at the end of each millisecond. */
void trace_expect_ms(uint32_t t_ms);

/* Whether the file needs a status frame that the configuration does not have; its identifier and period. */
enum { TRACE_STATUS_ID = 0x7FF, TRACE_STATUS_MS = 10 };
bool trace_expect_needs_status(void);

/* Duration of the scenario; its expectations. */
uint32_t trace_expect_duration_ms(void);
void trace_expect_write(FILE *file);

#endif

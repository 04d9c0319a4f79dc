/**
 * @file summary.h
 * The summary of a run, as text on standard output.
 */
#ifndef HOST_SIM_SUMMARY_H
#define HOST_SIM_SUMMARY_H

#include <stdbool.h>

#include "io/events.h"

/** Print "NAME: SECONDS s". @param name of the log, or of the interface @param more ", " and another one, or "" */
void summary_print_time(const events_summary_t *summary, const char *name, const char *more);

/** Print the line of the frames. @param shadow what was held back is among it */
void summary_print_frames(const events_summary_t *summary, bool shadow);

/** Print the line of the final state and the first reason. */
void summary_print_state(const events_summary_t *summary);

#endif

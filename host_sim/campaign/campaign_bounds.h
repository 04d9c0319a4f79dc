/**
 * @file campaign_bounds.h
 * The tables that the bounds of reaction times follow from, for scripts/tools/reaction-time.py.
 */
#ifndef HOST_SIM_CAMPAIGN_BOUNDS_H
#define HOST_SIM_CAMPAIGN_BOUNDS_H

#include <stdbool.h>

#include "io/output.h"

/** Print them as JSON: rows, messages, settings, frame lengths. @return false: could not be written; was reported */
bool campaign_print_tables(output_t *output);

#endif

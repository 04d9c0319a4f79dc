/**
 * @file series_lines.h
 * The lines of a series as JSON: signals and gaps of the whole run, and around each trip.
 */
#ifndef HOST_SIM_SERIES_LINES_H
#define HOST_SIM_SERIES_LINES_H

#include <jansson.h>
#include <stdint.h>

#include "report/series.h"

#define SERIES_UNIT_US 100u /**< the unit of times */

/** A time in units. */
json_t *series_units(uint64_t t_us);

/** Append a time, in units, as the difference to the one before. */
void series_append_time(json_t *array, uint64_t *last, uint64_t t_us);

/** The object `overview` of series_json(). */
json_t *series_overview_json(const series_t *series);

/** The array `details` of series_json(). */
json_t *series_details_json(const series_t *series);

#endif

/**
 * @file series_overview.h
 * The whole run in a bounded number of steps. When they are used up, each two become one.
 */
#ifndef HOST_SIM_SERIES_OVERVIEW_H
#define HOST_SIM_SERIES_OVERVIEW_H

#include <stddef.h>
#include <stdint.h>

#include "report/series.h"
#include "report/series_read.h"

#define SERIES_NO_VALUE INT32_MIN

/** A step. */
typedef struct {
    int32_t lowest[SERIES_SIGNALS]; /**< SERIES_NO_VALUE: there was none in this step */
    int32_t highest[SERIES_SIGNALS];
    uint32_t gap[AGV_MSG_COUNT]; /**< longest one that ended here, in units of 100 us; 0: none */
} series_step_t;

/** The steps. */
typedef struct {
    uint64_t step_us;
    uint64_t end_us; /**< of the last step in use */
    size_t count;
    series_step_t steps[SERIES_OVERVIEW_STEPS];
} series_overview_t;

void series_overview_init(series_overview_t *overview);

/** The step of a time; times come in their order. */
series_step_t *series_overview_at(series_overview_t *overview, uint64_t t_us);

/** Count values in. */
void series_overview_values(series_step_t *step, const series_values_t *values);

/** Count a gap in. */
void series_overview_gap(series_step_t *step, agv_message_t message, uint64_t gap_us);

#endif

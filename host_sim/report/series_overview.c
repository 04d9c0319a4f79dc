#include "report/series_overview.h"

#include <string.h>

enum { FIRST_STEP_US = 1000, UNIT_US = 100 };

static void clear(series_step_t *step) {
    for (size_t i = 0; i < SERIES_SIGNALS; i++) {
        step->lowest[i] = SERIES_NO_VALUE;
        step->highest[i] = SERIES_NO_VALUE;
    }
    memset(step->gap, 0, sizeof step->gap);
}

void series_overview_init(series_overview_t *overview) {
    overview->step_us = FIRST_STEP_US;
    overview->end_us = FIRST_STEP_US;
    overview->count = 1;
    clear(&overview->steps[0]);
}

static void widen(series_step_t *step, size_t signal, int32_t lowest, int32_t highest) {
    if (lowest == SERIES_NO_VALUE) {
        return;
    }
    if ((step->lowest[signal] == SERIES_NO_VALUE) || (lowest < step->lowest[signal])) {
        step->lowest[signal] = lowest;
    }
    if (highest > step->highest[signal]) {
        step->highest[signal] = highest;
    }
}

/** Make one step of two. */
static void merge(series_step_t *into, const series_step_t *later) {
    for (size_t i = 0; i < SERIES_SIGNALS; i++) {
        widen(into, i, later->lowest[i], later->highest[i]);
    }
    for (size_t i = 0; i < AGV_MSG_COUNT; i++) {
        into->gap[i] = (later->gap[i] > into->gap[i]) ? later->gap[i] : into->gap[i];
    }
}

static void coarsen(series_overview_t *overview) {
    const size_t half = SERIES_OVERVIEW_STEPS / 2;
    for (size_t i = 0; i < half; i++) {
        overview->steps[i] = overview->steps[2 * i];
        merge(&overview->steps[i], &overview->steps[(2 * i) + 1]);
    }
    overview->count = half;
    overview->step_us *= 2;
}

series_step_t *series_overview_at(series_overview_t *overview, uint64_t t_us) {
    while (t_us >= overview->end_us) {
        if (overview->count == SERIES_OVERVIEW_STEPS) {
            coarsen(overview);
        }
        clear(&overview->steps[overview->count]);
        overview->count++;
        overview->end_us = overview->count * overview->step_us;
    }
    return &overview->steps[overview->count - 1];
}

void series_overview_values(series_step_t *step, const series_values_t *values) {
    for (uint8_t i = 0; i < values->count; i++) {
        widen(step, values->signal[i], values->value[i], values->value[i]);
    }
}

void series_overview_gap(series_step_t *step, agv_message_t message, uint64_t gap_us) {
    const uint64_t units = (gap_us + (UNIT_US / 2)) / UNIT_US;
    const uint32_t gap = (units < UINT32_MAX) ? (uint32_t)units : UINT32_MAX;
    if (gap > step->gap[message]) {
        step->gap[message] = gap;
    }
}

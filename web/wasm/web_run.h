/**
 * @file web_run.h
 * The run of the page, shared by the sources of web/wasm.
 */
#ifndef WEB_RUN_H
#define WEB_RUN_H

#include <stdbool.h>
#include <stdint.h>

#include "analysis/analysis.h"
#include "io/output.h"
#include "scenario/run/scenario_run.h"
#include "web_bus.h"

/** The outputs in memory. */
#define WEB_EVENTS "events"
#define WEB_REPORT "report"

/** Steps that the page can add to a run. */
#define WEB_STEPS_MAX 1024u

/** The run. There is none while `is_there` is false. */
typedef struct {
    bool is_there;
    bool has_ended;
    uint32_t next_ms; /**< the next millisecond to play */
    int32_t event_count;
    output_t events;
    analysis_t *analysis; /**< NULL: no report */
    web_bus_t bus;
    scenario_step_t injected[WEB_STEPS_MAX]; /**< in the order of their times */
    size_t injected_count;
    size_t next_injected; /**< the first that was not done yet */
    scenario_run_t run;
} web_run_t;

/** The one run. */
const web_run_t *web_run(void);

#endif

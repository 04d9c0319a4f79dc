/**
 * @file scenario_run.h
 * A scenario file played on the simulated bus and evaluated.
 */
#ifndef HOST_SIM_SCENARIO_RUN_H
#define HOST_SIM_SCENARIO_RUN_H

#include <stddef.h>

#include "hunt/hazard/hazard.h"
#include "scenario/scenario.h"
#include "scenario/scenario_check.h"
#include "scenario/scenario_testbed.h"

/** Called for every step before it is done. */
typedef void scenario_step_fn(void *ctx, uint64_t t_ms, const scenario_step_t *step);

/** All that one run needs; some 300 KiB: allocate it. */
typedef struct {
    scenario_t scenario;
    scenario_testbed_t testbed;
    scenario_check_t check;
    hazard_t hazard;
    bool was_interrupted; /**< by a signal that is held back (interrupt.h): not played to its end */
} scenario_run_t;

/**
 * Play run->scenario, which was read.
 * @param watches more callbacks for events and frames: @p count of them
 * @param on_step called with the ctx of the first of them; or NULL
 * @return whether every expectation passed; run->check lists the failures. false also if it was interrupted
 */
bool scenario_run(scenario_run_t *run, const scenario_watch_t watches[], size_t count, scenario_step_fn *on_step);

#endif

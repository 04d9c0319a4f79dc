/**
 * @file scenario_run.h
 * A scenario file played on the simulated bus and judged.
 */
#ifndef HOST_SIM_SCENARIO_RUN_H
#define HOST_SIM_SCENARIO_RUN_H

#include "scenario.h"
#include "scenario_check.h"
#include "scenario_world.h"

/** Told of every step before it is done. */
typedef void scenario_step_fn(void *ctx, const scenario_step_t *step);

/** All that one run needs; some 300 KiB: allocate it. */
typedef struct {
    scenario_t scenario;
    scenario_world_t world;
    scenario_check_t check;
    bool was_interrupted; /**< by a signal that is held back (interrupt.h): not played to its end */
} scenario_run_t;

/**
 * Play run->scenario, which was read.
 * @param watch told of what happens, beside the judgement; NULL: nobody
 * @param on_step likewise, with watch->ctx; may be NULL
 * @return whether every expectation held; run->check says which did not. false too when it was interrupted
 */
bool scenario_run(scenario_run_t *run, scenario_planted_t planted, const scenario_watch_t *watch,
                  scenario_step_fn *on_step);

#endif

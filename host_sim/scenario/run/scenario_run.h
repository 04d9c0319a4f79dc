/**
 * @file scenario_run.h
 * A scenario file played on the simulated bus and evaluated.
 */
#ifndef HOST_SIM_SCENARIO_RUN_H
#define HOST_SIM_SCENARIO_RUN_H

#include <stddef.h>

#include "scenario/check/scenario_check.h"
#include "scenario/hazard/hazard.h"
#include "scenario/scenario.h"
#include "scenario/scenario_play.h"
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
    scenario_player_t player;
    scenario_step_fn *on_step;
    void *step_ctx;                    /**< of on_step */
    bool was_done[SCENARIO_STEPS_MAX]; /**< a repeated step is told of once */
} scenario_run_t;

/**
 * Play run->scenario, which was read.
 * @param watches more callbacks for events and frames: @p count of them
 * @param on_step called with the ctx of the first of them; or NULL
 * @return whether every expectation passed; run->check lists the failures. false also if it was interrupted
 */
bool scenario_run(scenario_run_t *run, const scenario_watch_t watches[], size_t count, scenario_step_fn *on_step);

/**
 * @name The same in parts, for a caller that has a loop of its own: start, then each millisecond from 0 to
 * scenario.duration_ms, then end. @{
 */
/** @return false: the testbed could not be built; is a failure of the check */
bool scenario_run_start(scenario_run_t *run, const scenario_watch_t watches[], size_t count, scenario_step_fn *on_step);
/** @return false: interrupted */
bool scenario_run_ms(scenario_run_t *run, uint64_t t_ms);
/** Do a step that is not in the file, before the millisecond @p t_ms is played. */
void scenario_run_do(scenario_run_t *run, uint64_t t_ms, const scenario_step_t *step);
/** @return as scenario_run() */
bool scenario_run_end(scenario_run_t *run);
/** @} */

#endif

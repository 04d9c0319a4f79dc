/**
 * @file scenario_play.h
 * The loop over the milliseconds of a run on the simulated bus: steps, tick, and what the caller does in between.
 */
#ifndef HOST_SIM_SCENARIO_PLAY_H
#define HOST_SIM_SCENARIO_PLAY_H

#include <stdbool.h>
#include <stdint.h>

#include "scenario/scenario.h"
#include "scenario/scenario_player.h"
#include "scenario/scenario_testbed.h"

/** A run. The functions may be NULL. */
typedef struct {
    const scenario_t *scenario; /**< whose steps are done; NULL: no steps */
    uint64_t from_ms;
    uint64_t until_ms; /**< the last millisecond */
    /** A step is about to be done. */
    void (*before_step)(void *ctx, uint64_t t_ms, const scenario_step_t *step);
    /** The steps of this millisecond are done. */
    void (*before_tick)(void *ctx, uint64_t t_ms);
    /** The millisecond is over. @return false: the run ends here */
    bool (*after_tick)(void *ctx, uint64_t t_ms);
    void *ctx; /**< of the functions */
} scenario_play_t;

/** Run a testbed that was started. */
void scenario_play(scenario_testbed_t *testbed, const scenario_play_t *play);

/**
 * Run one millisecond of it, for a caller with a loop of its own: from `from_ms` on, each once.
 * @param player was made with scenario_player_init() for play->scenario
 * @return false: the run ends here
 */
bool scenario_play_ms(scenario_testbed_t *testbed, const scenario_play_t *play, scenario_player_t *player,
                      uint64_t t_ms);

#endif

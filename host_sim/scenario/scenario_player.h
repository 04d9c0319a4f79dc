/**
 * @file scenario_player.h
 * When the steps of a scenario are due: each at its time, and those with `again_every_ms` again and again.
 */
#ifndef HOST_SIM_SCENARIO_PLAYER_H
#define HOST_SIM_SCENARIO_PLAYER_H

#include "scenario/scenario.h"

/** Where a run is. */
typedef struct {
    const scenario_t *scenario;
    size_t next; /**< the first step that was not due yet */
    size_t again_count;
    struct {
        size_t step;
        uint64_t due_ms;
    } again[SCENARIO_AGAIN_MAX];
} scenario_player_t;

/** Begin. @param scenario must outlive the player */
void scenario_player_init(scenario_player_t *player, const scenario_t *scenario);

/** The next step that is due at @p t_ms; NULL: no more now. Call it until then, with times that never go back. */
const scenario_step_t *scenario_player_next(scenario_player_t *player, uint64_t t_ms);

#endif

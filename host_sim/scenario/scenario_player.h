/**
 * @file scenario_player.h
 * When the steps of a scenario are due: each at its time or so long after an event, and those with `again_every_ms`
 * again and again.
 */
#ifndef HOST_SIM_SCENARIO_PLAYER_H
#define HOST_SIM_SCENARIO_PLAYER_H

#include "scenario/scenario.h"

/** Where a run is. */
typedef struct {
    const scenario_t *scenario;
    const scenario_events_t *events;
    size_t next; /**< the first step that was not due yet, of those that wait for no event */
    size_t waiting_count;
    bool is_done[SCENARIO_STEPS_MAX]; /**< of those that wait for an event */
    size_t again_count;
    struct {
        size_t step;
        uint64_t due_ms;
    } again[SCENARIO_AGAIN_MAX];
} scenario_player_t;

/**
 * Begin. @param scenario must outlive the player
 * @param events of the run, which the caller notes; must outlive the player
 */
void scenario_player_init(scenario_player_t *player, const scenario_t *scenario, const scenario_events_t *events);

/** The next step that is due at @p t_ms; NULL: no more now. Call it until then, with times that never go back. */
const scenario_step_t *scenario_player_next(scenario_player_t *player, uint64_t t_ms);

#endif

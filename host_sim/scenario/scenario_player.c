#include "scenario/scenario_player.h"

#include <string.h>

void scenario_player_init(scenario_player_t *player, const scenario_t *scenario, const scenario_events_t *events) {
    memset(player, 0, sizeof *player);
    player->scenario = scenario;
    player->events = events;
    player->waiting_count = (scenario != NULL) ? scenario->waiting_count : 0;
}

/** A step that repeats is due again one period later; one whose end is reached is dropped. */
static void plan_again(scenario_player_t *player, size_t step, uint64_t t_ms) {
    const scenario_step_t *repeated = &player->scenario->steps[step];

    if ((repeated->again_every_ms == 0) || (player->again_count == SCENARIO_AGAIN_MAX)) {
        return;
    }
    player->again[player->again_count].step = step;
    player->again[player->again_count].due_ms = t_ms + repeated->again_every_ms;
    player->again_count++;
}

/** The first repeated step that is due. */
static const scenario_step_t *next_again(scenario_player_t *player, uint64_t t_ms) {
    for (size_t i = 0; i < player->again_count; i++) {
        const scenario_step_t *step = &player->scenario->steps[player->again[i].step];
        if (player->again[i].due_ms > t_ms) {
            continue;
        }
        player->again[i].due_ms += step->again_every_ms;
        if (t_ms > step->again_until_ms) {
            player->again_count--;
            player->again[i] = player->again[player->again_count];
            i--;
            continue;
        }
        return step;
    }
    return NULL;
}

static bool waits(const scenario_step_t *step) {
    return step->after.kind != SCENARIO_FROM_START;
}

/** The first step that is due because its event has come. */
static const scenario_step_t *next_waiting(scenario_player_t *player, uint64_t t_ms) {
    for (size_t i = 0; (player->waiting_count > 0) && (i < player->scenario->step_count); i++) {
        const scenario_step_t *step = &player->scenario->steps[i];
        uint64_t event_ms = 0;
        if (waits(step) && !player->is_done[i] && scenario_events_find(player->events, step->after, &event_ms) &&
            (event_ms + step->at_ms <= t_ms)) {
            player->is_done[i] = true;
            player->waiting_count--;
            plan_again(player, i, t_ms);
            return step;
        }
    }
    return NULL;
}

const scenario_step_t *scenario_player_next(scenario_player_t *player, uint64_t t_ms) {
    const scenario_step_t *step = next_again(player, t_ms);

    if (step == NULL) {
        step = next_waiting(player, t_ms);
    }
    if (step != NULL) {
        return step;
    }
    while ((player->next < player->scenario->step_count) && waits(&player->scenario->steps[player->next])) {
        player->next++;
    }
    if ((player->next < player->scenario->step_count) && (player->scenario->steps[player->next].at_ms <= t_ms)) {
        player->next++;
        plan_again(player, player->next - 1, t_ms);
        return &player->scenario->steps[player->next - 1];
    }
    return NULL;
}

#include "scenario/scenario_player.h"

#include <string.h>

void scenario_player_init(scenario_player_t *player, const scenario_t *scenario) {
    memset(player, 0, sizeof *player);
    player->scenario = scenario;
}

/** A step that repeats is due again one period later; one whose end is reached is dropped. */
static void plan_again(scenario_player_t *player, size_t step, uint64_t t_ms) {
    const scenario_step_t *repeated = &player->scenario->steps[step];

    if ((repeated->again_every_ms == 0u) || (player->again_count == SCENARIO_AGAIN_MAX)) {
        return;
    }
    player->again[player->again_count].step = step;
    player->again[player->again_count].due_ms = t_ms + repeated->again_every_ms;
    player->again_count++;
}

/** The first repeated step that is due. */
static const scenario_step_t *next_again(scenario_player_t *player, uint64_t t_ms) {
    for (size_t i = 0u; i < player->again_count; i++) {
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

const scenario_step_t *scenario_player_next(scenario_player_t *player, uint64_t t_ms) {
    const scenario_step_t *again = next_again(player, t_ms);

    if (again != NULL) {
        return again;
    }
    if ((player->next < player->scenario->step_count) && (player->scenario->steps[player->next].at_ms <= t_ms)) {
        player->next++;
        plan_again(player, player->next - 1u, t_ms);
        return &player->scenario->steps[player->next - 1u];
    }
    return NULL;
}

#include "scenario/scenario_play.h"

#include <stddef.h>

static void do_steps(scenario_testbed_t *testbed, const scenario_play_t *play, scenario_player_t *player,
                     uint64_t t_ms) {
    const scenario_step_t *step = scenario_player_next(player, t_ms);

    for (; step != NULL; step = scenario_player_next(player, t_ms)) {
        if (play->before_step != NULL) {
            play->before_step(play->ctx, t_ms, step);
        }
        scenario_testbed_act(testbed, t_ms, step);
    }
}

bool scenario_play_ms(scenario_testbed_t *testbed, const scenario_play_t *play, scenario_player_t *player,
                      uint64_t t_ms) {
    if (play->scenario != NULL) {
        do_steps(testbed, play, player, t_ms);
    }
    if (play->before_tick != NULL) {
        play->before_tick(play->ctx, t_ms);
    }
    scenario_testbed_tick(testbed, t_ms);
    return (play->after_tick == NULL) || play->after_tick(play->ctx, t_ms);
}

void scenario_play(scenario_testbed_t *testbed, const scenario_play_t *play) {
    scenario_player_t player;
    bool goes_on = true;

    scenario_player_init(&player, play->scenario, scenario_testbed_events(testbed));
    for (uint64_t t_ms = play->from_ms; goes_on && (t_ms <= play->until_ms); t_ms++) {
        goes_on = scenario_play_ms(testbed, play, &player, t_ms);
    }
}

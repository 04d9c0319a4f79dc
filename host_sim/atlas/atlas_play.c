#include "atlas/atlas_play.h"

#include <stdlib.h>

#include "agv/recorder.h"
#include "agv/state.h"
#include "atlas/atlas_scenario.h"
#include "campaign/campaign_check.h"
#include "common/report.h"
#include "text/units.h"

enum { STANDS_MM_S = 50 };

static scenario_testbed_view_t look(const atlas_play_t *play) {
    scenario_testbed_view_t view;
    scenario_testbed_view(&play->testbed, &view);
    return view;
}

/** Time after the first fault. */
static int32_t after(const atlas_play_t *play, uint64_t t_us) {
    return (int32_t)(t_us - play->first_us);
}

static void on_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    atlas_play_t *play = ctx;
    const bool own = (from == SCENARIO_FROM_SUPERVISOR) && (side == HAL_CAN_VEHICLE);
    const bool commands_safe = play->tripped || (play->outcome.state == AGV_STATE_INIT);

    if (own && commands_safe && (t_us >= play->first_us) && (play->outcome.safe_us == ATLAS_NEVER) &&
        campaign_is_safe_command(scenario_testbed_message(&play->testbed, frame->id), frame)) {
        play->outcome.safe_us = after(play, t_us);
    }
}

static void on_event(void *ctx, const session_event_t *event) {
    atlas_play_t *play = ctx;
    const agv_event_t *recorded = &event->recorded;

    if (event->is_led || (recorded->kind != AGV_EVENT_STATE)) {
        return;
    }
    play->outcome.state = recorded->b;
    if ((recorded->b == AGV_STATE_TRIPPED) && !play->tripped) {
        play->tripped = true;
        play->outcome.reason = recorded->c;
    }
}

static bool is_ready(const atlas_play_t *play) {
    static const int states[ATLAS_STATES] = {
        [ATLAS_INIT] = AGV_STATE_INIT,       [ATLAS_STANDBY] = AGV_STATE_STANDBY, [ATLAS_ACTIVE] = AGV_STATE_ACTIVE,
        [ATLAS_TRIPPED] = AGV_STATE_TRIPPED, [ATLAS_SAFE] = AGV_STATE_SAFE,
    };
    const bool by_case = !play->tripped || (play->outcome.reason == AGV_FAULT_STEERING_COMMAND_TIMEOUT);
    return by_case && (play->outcome.state == states[play->pair->state]);
}

/** Since when the output has been open, and the vehicle has been standing. */
static void note_vehicle(atlas_play_t *play, uint64_t t_us) {
    const scenario_testbed_view_t view = look(play);
    const bool open = !view.output_closed;
    const bool moving = abs(view.vehicle.speed_mm_s) > STANDS_MM_S;
    const int32_t now_us = (t_us > play->first_us) ? after(play, t_us) : 0;

    if (!open) {
        play->outcome.open_us = ATLAS_NEVER;
    } else if (!play->was_open) {
        play->outcome.open_us = now_us;
    }
    if (moving) {
        play->outcome.stop_us = ATLAS_NEVER;
    } else if (play->was_moving) {
        play->outcome.stop_us = now_us;
    }
    play->was_open = open;
    play->was_moving = moving;
}

static void before_step(void *ctx, uint64_t t_ms, const scenario_step_t *step) {
    atlas_play_t *play = ctx;
    hazard_step(&play->hazard, t_ms, step);
}

static bool after_tick(void *ctx, uint64_t t_ms) {
    atlas_play_t *play = ctx;
    const uint64_t first_ms = play->first_us / US_PER_MS;
    const bool starts = (play->pair->first != NULL) && ((play->pair->first->flags & CAMPAIGN_START) != 0);

    hazard_tick(&play->hazard, t_ms);
    if (t_ms + 1 == first_ms) {
        play->outcome.ready = starts || is_ready(play);
        play->outcome.reason = starts ? play->outcome.reason : -1;
    }
    note_vehicle(play, t_ms * US_PER_MS);
    return true;
}

bool atlas_play(atlas_play_t *play, const atlas_case_t *pair) {
    text_clear(&play->text);
    atlas_scenario_write(&play->text, pair);
    text_add(&play->text, "expect: {states: any}\n");
    if (play->text.full) {
        return report("a case of the atlas is too long for a scenario");
    }
    if (!scenario_read_text(&play->scenario, "a case of the atlas", play->text.bytes, NULL) ||
        !scenario_testbed_init(&play->testbed, &play->scenario)) {
        return false;
    }
    play->pair = pair;
    play->first_us = (uint64_t)atlas_first_ms(pair->state) * US_PER_MS;
    play->tripped = false;
    play->was_open = false;
    play->was_moving = true;
    play->outcome = (atlas_outcome_t){.reason = -1, .safe_us = ATLAS_NEVER};
    hazard_init(&play->hazard, &play->scenario, &play->testbed);
    const scenario_watch_t judge = hazard_watch(&play->hazard);
    const scenario_watch_t own = {.on_event = on_event, .on_frame = on_frame, .ctx = play};
    scenario_testbed_watch(&play->testbed, &judge);
    scenario_testbed_watch(&play->testbed, &own);
    const scenario_play_t run = {.scenario = &play->scenario,
                                 .until_ms = play->scenario.duration_ms,
                                 .before_step = before_step,
                                 .after_tick = after_tick,
                                 .ctx = play};
    scenario_testbed_start(&play->testbed);
    scenario_play(&play->testbed, &run);
    play->outcome.hazard = play->hazard.kind;
    return true;
}

#include "hunt/hunt_play.h"

#include <stdlib.h>
#include <string.h>

#include "common/report.h"
#include "scenario/scenario_play.h"

enum { OPEN_MS = 700, STANDS_MS = 1000, HASH_START = 5381, HASH_FACTOR = 33 };

/** Kinds of features. */
enum { OF_STATE = 1, OF_FAULT, OF_CLOSENESS, OF_SPEED };

static void note_feature(hunt_play_t *play, uint32_t kind, uint32_t a, uint32_t b, uint32_t c) {
    const uint32_t parts[] = {kind, a, b, c};
    uint32_t hash = HASH_START;

    for (size_t i = 0; i < sizeof parts / sizeof parts[0]; i++) {
        hash = (hash * HASH_FACTOR) ^ (parts[i] * 0x9E3779B1u);
    }
    hash = (hash ^ (hash >> 16)) % HUNT_FEATURES;
    play->features[hash / 8] |= (uint8_t)(1u << (hash % 8));
}

/** What the supervisor reports guides the search. It decides nothing. */
static void on_event(void *ctx, const session_event_t *event) {
    hunt_play_t *play = ctx;
    const agv_event_t *recorded = &event->recorded;
    scenario_testbed_view_t view;

    if (event->is_led) {
        return;
    }
    scenario_testbed_view(&play->testbed, &view);
    const uint32_t closed = view.output_closed ? 1 : 0;
    if (recorded->kind == AGV_EVENT_STATE) {
        note_feature(play, OF_STATE, recorded->a, recorded->b, recorded->c);
        note_feature(play, OF_SPEED, recorded->b, (uint32_t)abs(view.vehicle.speed_mm_s) / 500, closed);
    } else if (recorded->kind == AGV_EVENT_FAULT) {
        note_feature(play, OF_FAULT, recorded->a, recorded->c, closed + (view.vehicle.autopilot ? 2 : 0));
    }
}

static void note_closeness(hunt_play_t *play) {
    for (uint32_t r = 0; r < HAZARD_ROWS_MAX; r++) {
        for (uint32_t level = 1; level <= play->hazard.closeness[r]; level++) {
            note_feature(play, OF_CLOSENESS, r, level, 0);
        }
    }
}

/** The time of the last step; repeated steps count once, except presses of a button. */
static uint32_t last_step_ms(const scenario_t *scenario) {
    uint32_t last_ms = 0;

    for (size_t i = 0; i < scenario->step_count; i++) {
        const scenario_step_t *step = &scenario->steps[i];
        const bool presses =
            step->of_vehicle ? (step->vehicle.what == VEHICLE_DO_BUTTON) : (step->supervisor.what == SCENARIO_BUTTON);
        const uint32_t until_ms = (presses && (step->again_every_ms != 0)) ? step->again_until_ms : step->at_ms;
        last_ms = (until_ms > last_ms) ? until_ms : last_ms;
    }
    return last_ms;
}

/** No hazard can come any more: all steps are done, and the output is open or the vehicle stands in the safe state. */
static bool is_over(hunt_play_t *play, uint32_t t_ms) {
    scenario_testbed_view_t view;

    scenario_testbed_view(&play->testbed, &view);
    const bool stands = hazard_is_tripped(&play->hazard) && (view.vehicle.speed_mm_s == 0);
    const bool open = !view.output_closed;

    if ((!open && !stands) || (t_ms <= play->last_step_ms)) {
        play->quiet_ms = t_ms;
    }
    return t_ms - play->quiet_ms > (uint32_t)(open ? OPEN_MS : STANDS_MS);
}

static void before_step(void *ctx, uint64_t t_ms, const scenario_step_t *step) {
    hunt_play_t *play = ctx;
    hazard_step(&play->hazard, t_ms, step);
}

static bool after_tick(void *ctx, uint64_t t_ms) {
    hunt_play_t *play = ctx;

    hazard_tick(&play->hazard, t_ms);
    play->played_ms = (uint32_t)t_ms;
    return (play->hazard.kind == HAZARD_NONE) && !is_over(play, (uint32_t)t_ms);
}

static void run(hunt_play_t *play) {
    const scenario_play_t run = {.scenario = &play->scenario,
                                 .until_ms = play->scenario.duration_ms,
                                 .before_step = before_step,
                                 .after_tick = after_tick,
                                 .ctx = play};

    play->last_step_ms = last_step_ms(&play->scenario);
    play->quiet_ms = 0;
    scenario_testbed_start(&play->testbed);
    scenario_play(&play->testbed, &run);
}

bool hunt_play(hunt_play_t *play, const hunt_program_t *program) {
    const scenario_watch_t guide = {.on_event = on_event, .ctx = play};

    text_clear(&play->text);
    hunt_program_write(program, "a run of the hunt", &play->text);
    text_add(&play->text, "expect: {states: any}\n");
    memset(play->features, 0, sizeof play->features);
    if (play->text.full) {
        return report("the scenario of a run is too long");
    }
    if (!scenario_read_text(&play->scenario, "a run of the hunt", play->text.bytes, NULL)) {
        return false;
    }
    if (!scenario_testbed_init(&play->testbed, &play->scenario)) {
        return report("a run of the hunt could not be built");
    }
    hazard_init(&play->hazard, &play->scenario, &play->testbed);
    const scenario_watch_t watch = hazard_watch(&play->hazard);
    scenario_testbed_watch(&play->testbed, &watch);
    scenario_testbed_watch(&play->testbed, &guide);
    run(play);
    note_closeness(play);
    return true;
}

#include "scenario/run/scenario_run.h"

#include <string.h>

#include "common/interrupt.h"

enum { LOOK_FOR_SIGNALS_EVERY_MS = 1000 };

static void check_event(void *ctx, const session_event_t *event) {
    scenario_check_event(ctx, event);
}

static void check_frame(void *ctx, uint64_t t_us, hal_can_side_t side, int from, const hal_can_frame_t *frame) {
    scenario_check_frame(ctx, t_us, side, from, frame);
}

/** Hazards are evaluated if the file asks for it. */
static void watch_hazards(scenario_run_t *run) {
    hazard_init(&run->hazard, &run->scenario, &run->testbed);
    if (run->scenario.expect.no_hazards != 0) {
        const scenario_watch_t watch = hazard_watch(&run->hazard);
        scenario_testbed_watch(&run->testbed, &watch);
    }
}

static void check_hazards(scenario_run_t *run) {
    const hazard_t *hazard = &run->hazard;

    if ((run->scenario.expect.no_hazards != 0) && (hazard->kind != HAZARD_NONE)) {
        scenario_check_fail(&run->check, run->scenario.expect.no_hazards,
                            "no hazard is expected, seen: %s (%s) at %u ms", hazard_info(hazard->kind)->name,
                            hazard->cause, (unsigned)hazard->at_ms);
    }
}

static void before_step(void *ctx, uint64_t t_ms, const scenario_step_t *step) {
    scenario_run_t *run = ctx;
    bool *was_done = &run->was_done[step - run->scenario.steps];

    if ((run->on_step != NULL) && !*was_done) {
        run->on_step(run->step_ctx, t_ms, step);
    }
    *was_done = true;
    hazard_step(&run->hazard, t_ms, step);
}

static bool after_tick(void *ctx, uint64_t t_ms) {
    scenario_run_t *run = ctx;
    scenario_testbed_view_t seen;

    hazard_tick(&run->hazard, t_ms);
    scenario_testbed_view(&run->testbed, &seen);
    scenario_check_output(&run->check, (uint32_t)t_ms, seen.output_closed);
    if (scenario_check_wants_vehicle(&run->check, (uint32_t)t_ms)) {
        vehicle_view_t view;
        scenario_testbed_vehicle(&run->testbed, &view);
        scenario_check_vehicle(&run->check, (uint32_t)t_ms, &view);
    }
    run->was_interrupted = ((t_ms % LOOK_FOR_SIGNALS_EVERY_MS) == 0) && interrupt_pending();
    return !run->was_interrupted;
}

bool scenario_run_start(scenario_run_t *run, const scenario_watch_t watches[], size_t count,
                        scenario_step_fn *on_step) {
    const scenario_watch_t checked = {.on_event = check_event, .on_frame = check_frame, .ctx = &run->check};

    run->was_interrupted = false;
    run->on_step = on_step;
    run->step_ctx = (count > 0) ? watches[0].ctx : NULL;
    memset(run->was_done, 0, sizeof run->was_done);
    scenario_player_init(&run->player, &run->scenario, scenario_testbed_events(&run->testbed));
    scenario_check_init(&run->check, &run->scenario);
    if (!scenario_testbed_init(&run->testbed, &run->scenario)) {
        scenario_check_fail(&run->check, 0, "the testbed could not be built");
        return false;
    }
    scenario_testbed_watch(&run->testbed, &checked);
    watch_hazards(run);
    for (size_t i = 0; i < count; i++) {
        scenario_testbed_watch(&run->testbed, &watches[i]);
    }
    scenario_testbed_start(&run->testbed);
    return true;
}

bool scenario_run_ms(scenario_run_t *run, uint64_t t_ms) {
    const scenario_play_t play = {
        .scenario = &run->scenario, .before_step = before_step, .after_tick = after_tick, .ctx = run};

    return scenario_play_ms(&run->testbed, &play, &run->player, t_ms);
}

void scenario_run_do(scenario_run_t *run, uint64_t t_ms, const scenario_step_t *step) {
    hazard_step(&run->hazard, t_ms, step);
    scenario_testbed_act(&run->testbed, t_ms, step);
}

bool scenario_run_end(scenario_run_t *run) {
    check_hazards(run);
    scenario_check_finish(&run->check, agv_supervisor_counters(&scenario_testbed_session(&run->testbed)->supervisor));
    return !run->was_interrupted && (run->check.failure_count == 0);
}

bool scenario_run(scenario_run_t *run, const scenario_watch_t watches[], size_t count, scenario_step_fn *on_step) {
    if (!scenario_run_start(run, watches, count, on_step)) {
        return false;
    }
    bool goes_on = true;
    for (uint64_t t_ms = 0; goes_on && (t_ms <= run->scenario.duration_ms); t_ms++) {
        goes_on = scenario_run_ms(run, t_ms);
    }
    return scenario_run_end(run);
}

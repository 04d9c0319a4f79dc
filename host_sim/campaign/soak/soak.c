#include "campaign/soak/soak.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "campaign/soak/soak_internal.h"
#include "common/interrupt.h"
#include "common/prng.h"
#include "scenario/scenario_play.h"
#include "text/units.h"

/* A disturbance comes when the one before is over and forgotten: counts in a row begin anew after a good frame. */
enum { QUIET_MIN_MS = 500, QUIET_MAX_MS = 3000, READY_MS = 2000 };
enum { LOOK_EVERY_MS = 1000, SAVE_EVERY_MS = 6 * 3600000, HOURS_PER_DAY = 24 };

/** Whether a row's steps make sense in this topology. */
static bool fits(const soak_t *soak, const soak_row_t *row) {
    const uint32_t other = soak->gateway ? SOAK_SHARED : SOAK_GATEWAY;
    return (row->flags & other) == 0;
}

static uint32_t add_steps(soak_t *soak, const char *words, uint32_t number) {
    while (*words != '\0') {
        const size_t length = strcspn(words, "|");
        text_add(&soak->text, "  - {at_ms: %" PRIu32 ", %.*s}\n", number, (int)length, words);
        number++;
        words += length;
        words += (*words == '|') ? 1 : 0;
    }
    return number;
}

/** All steps of all rows are read as those of one scenario, in their order. */
static bool read_rows(soak_t *soak) {
    uint32_t number = 0;

    text_add(&soak->text, "name: soak\nshows: [TIM-1]\ntopology: %s\nid_set: %s\nclock_start_ms: %" PRIu32 "\n",
             soak->gateway ? "gateway" : "shared", soak->table_ids ? "table" : "heading", (uint32_t)soak->start_ms);
    text_add(&soak->text, "config: {status_frame_id: %u, status_frame_period_ms: %u}\n", SOAK_STATUS_ID,
             SOAK_STATUS_MS);
    text_add(&soak->text, "duration_ms: 1000\nsteps:\n");
    for (size_t i = 0; i < SOAK_ROW_COUNT; i++) {
        soak->steps[i].begin = number;
        number = fits(soak, &SOAK_ROWS[i]) ? add_steps(soak, SOAK_ROWS[i].begin, number) : number;
        soak->steps[i].end = number;
        number = fits(soak, &SOAK_ROWS[i]) ? add_steps(soak, SOAK_ROWS[i].end, number) : number;
        soak->steps[i].after = number;
    }
    text_add(&soak->text, "expect: {states: []}\n");
    return soak->text.full ? report("the soak scenario is too long")
                           : scenario_read_text(&soak->scenario, "the soak", soak->text.bytes, NULL);
}

static void do_steps(soak_t *soak, uint32_t from, uint32_t to) {
    for (uint32_t i = from; i < to; i++) {
        const scenario_step_t *step = &soak->scenario.steps[i];
        if (!step->of_vehicle && (step->supervisor.what == SCENARIO_DELIVER)) {
            soak->state.delivered++;
        }
        scenario_testbed_act(&soak->testbed, soak->state.t_ms, step);
    }
}

static bool may_come(const soak_t *soak, const soak_row_t *row) {
    scenario_testbed_view_t view;
    scenario_testbed_view(&soak->testbed, &view);
    const uint32_t other = view.vehicle.autopilot ? SOAK_MANUAL : SOAK_ENGAGED;
    return fits(soak, row) && ((row->flags & other) == 0);
}

static uint32_t choose(soak_t *soak) {
    uint32_t weight = 0;
    for (size_t i = 0; i < SOAK_ROW_COUNT; i++) {
        weight += may_come(soak, &SOAK_ROWS[i]) ? SOAK_ROWS[i].weight : 0;
    }
    uint32_t left = prng_draw(&soak->state.random, 1, weight);
    for (uint32_t i = 0;; i++) {
        const uint32_t own = may_come(soak, &SOAK_ROWS[i]) ? SOAK_ROWS[i].weight : 0;
        if (left <= own) {
            return i;
        }
        left -= own;
    }
}

/** Begin a disturbance, or end it. */
static void begin_or_end_disturbance(void *ctx, uint64_t t_ms) {
    soak_t *soak = ctx;
    soak_state_t *state = &soak->state;

    if (t_ms < state->next_ms) {
        return;
    }
    if (state->row < SOAK_ROW_COUNT) {
        do_steps(soak, soak->steps[state->row].end, soak->steps[state->row].after);
        state->row = (uint32_t)SOAK_ROW_COUNT;
        state->next_ms = t_ms + prng_draw(&state->random, QUIET_MIN_MS, QUIET_MAX_MS);
        return;
    }
    state->row = choose(soak);
    state->counts[state->row]++;
    const soak_row_t *row = &SOAK_ROWS[state->row];
    state->next_ms = t_ms + prng_draw(&state->random, row->lowest_ms, row->highest_ms);
    do_steps(soak, soak->steps[state->row].begin, soak->steps[state->row].end);
}

static void count_real_time(soak_t *soak) {
    const uint64_t now_ms = monotonic_ms();
    soak->state.real_ms += now_ms - soak->began_ms;
    soak->began_ms = now_ms;
}

/** Once in a simulated second: show the progress, notice a signal, save. @return false: that is the end */
static bool check_each_second(soak_t *soak) {
    progress_show(&soak->progress, soak->state.t_ms / LOOK_EVERY_MS, "simulated seconds");
    soak->went = interrupt_pending() ? INTERRUPTED : OVER;
    if ((soak->went == INTERRUPTED) || ((soak->state.t_ms % SAVE_EVERY_MS) == 0)) {
        count_real_time(soak);
        soak->went = soak_save(soak) ? soak->went : UNSAVED;
    }
    return soak->went == OVER;
}

static bool after_tick(void *ctx, uint64_t t_ms) {
    soak_t *soak = ctx;

    soak_check_tick(soak);
    if ((t_ms % SOAK_MS_PER_HOUR) == SOAK_MS_PER_HOUR - 1) {
        soak_check_counters(soak);
    }
    soak->state.t_ms = t_ms + 1;
    return (((soak->state.t_ms % LOOK_EVERY_MS) != 0) || check_each_second(soak)) && (soak->state.broken[0] == '\0');
}

/** Until the end, or something is broken. */
static void run_until_end(soak_t *soak) {
    const scenario_play_t play = {.from_ms = soak->state.t_ms,
                                  .until_ms = soak->duration_ms - 1,
                                  .before_tick = begin_or_end_disturbance,
                                  .after_tick = after_tick,
                                  .ctx = soak};

    soak->began_ms = monotonic_ms();
    progress_begin(&soak->progress, soak->duration_ms / LOOK_EVERY_MS);
    interrupt_hold();
    if (soak->state.broken[0] == '\0') {
        scenario_play(&soak->testbed, &play);
    }
    progress_end(&soak->progress);
    count_real_time(soak);
}

static uint64_t count_disturbances(const soak_state_t *state) {
    uint64_t sum = 0;
    for (size_t i = 0; i < SOAK_ROW_COUNT; i++) {
        sum += state->counts[i];
    }
    return sum;
}

static uint32_t clock_wraps(const soak_t *soak) {
    return (uint32_t)(((soak->start_ms + soak->state.t_ms) >> 32) - (soak->start_ms >> 32));
}

static void print_result(const soak_t *soak) {
    const soak_state_t *state = &soak->state;
    for (size_t i = 0; i < SOAK_ROW_COUNT; i++) {
        if (state->counts[i] > 0) {
            (void)printf("%-26s %8" PRIu64 "\n", SOAK_ROWS[i].name, state->counts[i]);
        }
    }
    (void)printf("%s, %" PRIu64 ".%02" PRIu64 " days, %" PRIu32 " wraps of the clock, %" PRIu64 " ticks, %" PRIu64
                 " frames received, %" PRIu64 " sent, %" PRIu64 " warnings, %" PRIu64
                 " disturbances, status frames at most %" PRIu32 " ms late; took %" PRIu64 " s\n",
                 soak->gateway ? "gateway" : "shared bus", state->t_ms / SOAK_MS_PER_HOUR / HOURS_PER_DAY,
                 (state->t_ms / SOAK_MS_PER_HOUR % HOURS_PER_DAY) * 100 / HOURS_PER_DAY, clock_wraps(soak),
                 state->ticks, state->wire_others + state->delivered, state->wire_own, state->warnings,
                 count_disturbances(state), state->status_late_ms, state->real_ms / MS_PER_S);
    if (state->broken[0] != '\0') {
        (void)printf("BROKEN: %s\n", state->broken);
    }
}

static bool write_results(soak_t *soak) {
    const soak_state_t *state = &soak->state;

    if (!soak->results.is_open) {
        return true;
    }
    text_clear(&soak->text);
    text_add(&soak->text,
             "{\"soak\": 1, \"seed\": %" PRIu64 ", \"hours\": %" PRIu32 ", \"shard\": %" PRIu32 ", \"shards\": %" PRIu32
             ", \"topology\": \"%s\", \"ms\": %" PRIu64 ", \"wraps\": %" PRIu32 ", \"ticks\": %" PRIu64
             ", \"received\": %" PRIu64 ", \"sent\": %" PRIu64,
             soak->request->seed, soak->request->hours, soak->request->shard, soak->request->shards,
             soak->gateway ? "gateway" : "shared", state->t_ms, clock_wraps(soak), state->ticks,
             state->wire_others + state->delivered, state->wire_own);
    text_add(&soak->text,
             ", \"warnings\": %" PRIu64 ", \"disturbances\": %" PRIu64 ", \"status_late_ms\": %" PRIu32
             ", \"real_ms\": %" PRIu64 ", \"broken\": %s}\n",
             state->warnings, count_disturbances(state), state->status_late_ms, state->real_ms,
             (state->broken[0] != '\0') ? "true" : "false");
    (void)output_write(&soak->results, soak->text.bytes, soak->text.used);
    return output_commit(&soak->results);
}

static status_t conclude(soak_t *soak) {
    if (soak->state.broken[0] == '\0') {
        soak_check_counters(soak);
    }
    if (!output_is_stdout(soak->request->results)) {
        print_result(soak);
        (void)fflush(stdout); /* before the files are written; a failure is reported at the end of the program */
    } else if (soak->state.broken[0] != '\0') {
        note("BROKEN: %s", soak->state.broken);
    }
    const bool saved = soak_save(soak);
    if (!write_results(soak) || !saved) {
        return STATUS_UNUSABLE;
    }
    return (soak->state.broken[0] == '\0') ? STATUS_OK : STATUS_UNMET;
}

static bool prepare(soak_t *soak, const soak_request_t *request) {
    const uint64_t all_ms = (uint64_t)request->hours * SOAK_MS_PER_HOUR;
    uint64_t random = request->seed ^ ((uint64_t)request->shard << 32);

    soak->request = request;
    soak->start_ms = all_ms * (request->shard - 1) / request->shards;
    soak->duration_ms = (all_ms * request->shard / request->shards) - soak->start_ms;
    soak->gateway = (request->shard % 2) == 0;
    soak->table_ids = (prng_next(&random) % 2) == 0;
    soak->state.random = prng_next(&random);
    soak->state.row = (uint32_t)SOAK_ROW_COUNT;
    soak->state.next_ms = READY_MS;
    if (!read_rows(soak)) {
        return false;
    }
    if (!scenario_testbed_init(&soak->testbed, &soak->scenario)) {
        return report("the testbed of the soak could not be built");
    }
    const scenario_watch_t watch = soak_watch(soak);
    scenario_testbed_watch(&soak->testbed, &watch);
    scenario_testbed_start(&soak->testbed);
    return soak_load(soak) && ((request->results == NULL) || output_open(&soak->results, request->results));
}

status_t soak_run(const soak_request_t *request) {
    soak_t *soak = calloc(1, sizeof *soak);
    status_t status = STATUS_UNUSABLE;

    if (soak == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    if (prepare(soak, request)) {
        run_until_end(soak);
        if (soak->went == OVER) {
            status = conclude(soak);
        } else if (soak->went == INTERRUPTED) {
            note("interrupted after %" PRIu64 " simulated hours%s", soak->state.t_ms / SOAK_MS_PER_HOUR,
                 (request->checkpoint != NULL) ? "; the same command resumes" : "");
        }
    }
    output_discard(&soak->file);
    output_discard(&soak->results);
    checkpoint_close(&soak->checkpoint);
    free(soak);
    interrupt_release();
    return status;
}

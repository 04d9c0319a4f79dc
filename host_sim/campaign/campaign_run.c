#include "campaign/campaign_run.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>

#include "agv/names.h"
#include "campaign/campaign_scenario.h"
#include "campaign/campaign_why.h"
#include "common/interrupt.h"
#include "scenario/scenario_play.h"
#include "ui/progress.h"

enum { PATH_SIZE = 4096, FILES_MAX = 20, LOOK_FOR_SIGNALS_EVERY = 16 };

/** What the campaign works with; too large for the stack. */
typedef struct {
    const campaign_request_t *request;
    campaign_plan_t plan;
    campaign_check_t check;
    text_t text;
    scenario_t scenario;
    scenario_testbed_t testbed;
    campaign_samples_t samples;
    output_t results;
    output_t why_lines; /**< of --why */
    campaign_why_t why;
    output_t file; /**< of a broken run */
    size_t broken;
} campaign_t;

/** Read the planned run as a scenario, without expectations: campaign_check.h evaluates it. */
static bool read_plan(campaign_t *campaign) {
    text_t *text = &campaign->text;

    text_clear(text);
    text_add(text, "%sexpect: {states: []}\n", campaign->plan.head.bytes);
    if (campaign->plan.head.full || text->full) {
        return report("run %" PRIu64 ": its scenario is too long", campaign->plan.run);
    }
    return scenario_read_text(&campaign->scenario, "a run of the campaign", text->bytes, NULL);
}

static bool after_tick(void *ctx, uint64_t t_ms) {
    campaign_check_tick(ctx, t_ms);
    return true;
}

static void play_run(campaign_t *campaign) {
    const scenario_play_t play = {.scenario = &campaign->scenario,
                                  .until_ms = campaign->scenario.duration_ms,
                                  .after_tick = after_tick,
                                  .ctx = &campaign->check};

    scenario_testbed_start(&campaign->testbed);
    scenario_play(&campaign->testbed, &play);
    campaign_check_finish(&campaign->check);
}

/** Play a run and evaluate it. @return false: reported */
static bool run_one(campaign_t *campaign, uint64_t run) {
    const campaign_request_t *request = campaign->request;

    campaign_plan_make(&campaign->plan, request->part.seed, run, &request->part.causes);
    if (!read_plan(campaign)) {
        return false;
    }
    if (!scenario_testbed_init(&campaign->testbed, &campaign->scenario)) {
        return report("run %" PRIu64 ": its testbed could not be built", run);
    }
    campaign_check_init(&campaign->check, &campaign->plan, &campaign->testbed);
    const scenario_watch_t watch = campaign_check_watch(&campaign->check);
    scenario_testbed_watch(&campaign->testbed, &watch);
    if (campaign->why_lines.is_open) {
        if (!campaign_why_init(&campaign->why, &campaign->scenario.config)) {
            return false;
        }
        const scenario_watch_t why = campaign_why_watch(&campaign->why);
        scenario_testbed_watch(&campaign->testbed, &why);
    }
    play_run(campaign);
    return true;
}

/** Leave the scenario of a broken run. */
static bool write_file(campaign_t *campaign) {
    char path[PATH_SIZE];
    const campaign_plan_t *plan = &campaign->plan;
    const int length = snprintf(path, sizeof path, "%s/campaign-%" PRIu64 "-%" PRIu64 ".yaml",
                                campaign->request->folder, plan->seed, plan->run);

    if ((length < 0) || (length >= PATH_SIZE)) {
        return report("--broken: the name of the folder is too long");
    }
    text_clear(&campaign->text);
    campaign_scenario_write(&campaign->text, &campaign->check);
    if (!output_put(&campaign->file, path, campaign->text.bytes, campaign->text.used)) {
        return false;
    }
    (void)fprintf(output_is_stdout(campaign->request->results) ? stderr : stdout,
                  "BROKEN  run %" PRIu64 ", %s: %s; %s\n", plan->run, agv_fault_name(plan->row->fault),
                  campaign_break_name(campaign->check.broken), path);
    return true;
}

static bool store_result(campaign_t *campaign) {
    const campaign_sample_t sample = campaign_sample_of(&campaign->check);

    if (campaign->results.is_open) {
        campaign_write_run(&campaign->results, &campaign->check);
    }
    if (campaign->why_lines.is_open) {
        campaign_why_write(&campaign->why, &campaign->why_lines, &campaign->plan);
    }
    if (sample.broken) {
        campaign->broken++;
        if ((campaign->broken <= FILES_MAX) && !write_file(campaign)) {
            return false;
        }
    }
    return campaign_samples_add(&campaign->samples, &sample);
}

static bool outputs_work(const campaign_t *campaign) {
    return (campaign->results.error == 0) && (campaign->why_lines.error == 0);
}

/** All runs of this shard. @return false: reported, or interrupted */
static bool run_all(campaign_t *campaign) {
    const campaign_part_t *part = &campaign->request->part;
    const uint64_t mine = (part->runs - part->shard + part->shards) / part->shards;
    progress_t progress;
    uint64_t done = 0;
    bool good = true;

    progress_begin(&progress, (mine > 0) ? mine : 1);
    for (uint64_t run = part->shard - 1; good && (run < part->runs); run += part->shards) {
        good = run_one(campaign, run) && store_result(campaign);
        done++;
        progress_show(&progress, done, "runs");
        if (((done % LOOK_FOR_SIGNALS_EVERY) == 0) && (interrupt_pending() || !outputs_work(campaign))) {
            good = false;
        }
    }
    progress_end(&progress);
    return good;
}

static status_t conclude(campaign_t *campaign) {
    if (output_is_stdout(campaign->request->results) || output_is_stdout(campaign->request->why)) {
        return (campaign->broken == 0) ? STATUS_OK : STATUS_UNMET; /* no table: standard output has the results */
    }
    if (campaign->broken > FILES_MAX) {
        (void)printf("%zu broken runs, scenarios of the first %d\n", campaign->broken, FILES_MAX);
    }
    if (!campaign_print_table(&campaign->samples)) {
        return STATUS_UNUSABLE;
    }
    return (campaign->broken == 0) ? STATUS_OK : STATUS_UNMET;
}

static status_t run_campaign(campaign_t *campaign) {
    const campaign_request_t *request = campaign->request;

    if (((request->results != NULL) && !output_open(&campaign->results, request->results)) ||
        ((request->why != NULL) && !output_open(&campaign->why_lines, request->why))) {
        return STATUS_UNUSABLE;
    }
    if (campaign->results.is_open) {
        campaign_write_part(&campaign->results, &request->part);
    }
    const bool whole = run_all(campaign);
    if (!whole && outputs_work(campaign)) {
        return STATUS_UNUSABLE;
    }
    if (!output_flush_all(&campaign->results, 1) || !output_commit(&campaign->why_lines) ||
        !output_commit(&campaign->results)) {
        return STATUS_UNUSABLE;
    }
    return conclude(campaign);
}

/** Print one run as a scenario. */
static status_t show_one(campaign_t *campaign) {
    if (!run_one(campaign, campaign->request->one)) {
        return STATUS_UNUSABLE;
    }
    text_clear(&campaign->text);
    campaign_scenario_write(&campaign->text, &campaign->check);
    (void)fputs(campaign->text.bytes, stdout);
    return (campaign->check.broken == CAMPAIGN_SOUND) ? STATUS_OK : STATUS_UNMET;
}

status_t campaign_run(const campaign_request_t *request) {
    campaign_t *campaign = calloc(1, sizeof *campaign);
    if (campaign == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    campaign->request = request;
    const status_t status = request->shows_one ? show_one(campaign) : run_campaign(campaign);
    output_discard(&campaign->results);
    output_discard(&campaign->why_lines);
    campaign_why_free(&campaign->why);
    output_discard(&campaign->file);
    campaign_samples_free(&campaign->samples);
    free(campaign);
    interrupt_release();
    return status;
}

/**
 * @file cmd_campaign.c
 * `host_sim campaign`: randomised fault campaigns on the simulated bus.
 */
#include <inttypes.h>
#include <stdlib.h>

#include "agv/names.h"
#include "campaign/campaign_bounds.h"
#include "campaign/campaign_run.h"
#include "campaign/fault_option.h"
#include "cli/commands/commands.h"
#include "cli/options.h"
#include "cli/random_options.h"
#include "common/interrupt.h"
#include "io/output.h"

/** Runs of a campaign: as many as a table in memory may hold. */
#define RUNS_MAX 100000000u

/** The given options. */
typedef struct {
    campaign_request_t request;
    random_options_t random;
    uint64_t runs;
    uint64_t show;
    const char *fault;
    const char *results;
    const char *folder;
    bool newly_engaged;
    bool merge;
    bool tables;
    size_t file_count;
} given_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    option_t random_rows[RANDOM_OPTIONS];
    random_options_init(&given->random, random_rows, "only part I of N of the runs (1/1)");
    const option_t rows[] = {
        OPTION_NUMBER("--runs", "N", "number of runs, of all shards together", &given->runs, 1, RUNS_MAX),
        OPTION_FAULT("--fault", "cause this fault in every run", &given->fault),
        OPTION_FLAG("--newly-engaged",
                    "cause the fault at an engagement; only for faults that are detected later there than under way",
                    &given->newly_engaged),
        OPTION_TEXT("--results", "FILE", "results as JSON Lines", &given->results),
        OPTION_TEXT("--why", "FILE", "the JSON of replay --why for each run, one line each", &given->request.why),
        OPTION_TEXT("--broken", "FOLDER", "folder for the scenarios of runs that break an invariant (.)",
                    &given->folder),
        OPTION_NUMBER("--show", "RUN", "only print this run, as a scenario", &given->show, 0, RUNS_MAX - 1),
        OPTION_FLAG("--merge", "merge the results of all shards into one table, and into one file with --results",
                    &given->merge),
        OPTION_FLAG("--tables", "print the data from which reaction times are derived, as JSON", &given->tables),
    };
    const option_group_t groups[] = {
        {.title = "Options", .options = random_rows, .count = RANDOM_OPTIONS},
        {.options = rows, .count = sizeof rows / sizeof rows[0]},
    };
    static const option_example_t examples[] = {
        {"host_sim campaign --runs 200 --seed 1", "200 runs, and the table of their reaction times"},
        {"host_sim campaign --runs 200 --seed 1 --fault VCU_HEARTBEAT_LOST", "the same fault in every run"},
        {"host_sim campaign --runs 200 --seed 1 --show 17 > run.yaml", "run 17 as a file for host_sim scenario"},
    };
    const option_syntax_t syntax = {
        .usage = "campaign --runs N --seed S [OPTION]...",
        .or_usage = "campaign --merge [--results FILE] FILE...",
        .summary =
            "Inject random faults on the simulated bus in virtual time (fault, time, phases of all senders, bit\n"
            "rate, topology, ID set, kind of vehicle), check each run, and summarise the reaction times.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
        .operands_max = SHARDS_MAX,
        .operand = "FILE",
    };
    return options_parse(&syntax, argc, argv, &given->file_count);
}

static bool take_fault(const char *name, campaign_causes_t *causes) {
    return fault_option_take("--fault", name, &causes->only) &&
           (!causes->newly_engaged || (campaign_engagement(agv_fault_from_name(name)) != NULL) ||
            report("--newly-engaged: %s is not detected later at an engagement than under way", name));
}

/** Make the request of a campaign. */
static bool make_request(given_t *given, char **operands) {
    campaign_request_t *request = &given->request;

    if (given->file_count > 0) {
        return report("unexpected argument '%s'; only --merge takes files", operands[0]);
    }
    if (given->runs == OPTION_NOT_GIVEN) {
        return report("--runs is missing; see host_sim campaign --help");
    }
    request->part = (campaign_part_t){.runs = given->runs, .seed = given->random.seed};
    if (!random_options_check(&given->random, "campaign", &request->part.shard, &request->part.shards)) {
        return false;
    }
    request->part.causes.newly_engaged = given->newly_engaged;
    request->results = given->results;
    request->folder = (given->folder != NULL) ? given->folder : ".";
    request->shows_one = given->show != OPTION_NOT_GIVEN;
    request->one = given->show;
    if (request->shows_one && ((given->results != NULL) || (given->random.shard != NULL) || (request->why != NULL))) {
        return report("--show prints one run: --results, --why and --shard cannot be combined with it");
    }
    if (request->shows_one && (given->show >= given->runs)) {
        return report("--show: no run %" PRIu64 "; the runs are 0 to %" PRIu64, given->show, given->runs - 1);
    }
    const output_role_t roles[] = {{.role = "--results", .path = request->results, .is_written = true},
                                   {.role = "--why", .path = request->why, .is_written = true}};
    return output_check_distinct(roles, sizeof roles / sizeof roles[0]) &&
           ((given->fault == NULL) || take_fault(given->fault, &request->part.causes)) &&
           (request->shows_one || output_check_folder("--broken", request->folder));
}

static bool has_run_options(const given_t *given) {
    return (given->runs != OPTION_NOT_GIVEN) || (given->random.seed != OPTION_NOT_GIVEN) ||
           (given->random.shard != NULL) || (given->fault != NULL) || (given->show != OPTION_NOT_GIVEN) ||
           (given->folder != NULL) || given->newly_engaged || (given->request.why != NULL);
}

static bool check_merge(const given_t *given, char **files) {
    if (given->file_count == 0) {
        return report("--merge: FILE is missing; see host_sim campaign --help");
    }
    if (has_run_options(given)) {
        return report("--merge takes files, and of the other options only --results");
    }
    for (size_t i = 0; i < given->file_count; i++) {
        const output_role_t roles[] = {{.role = "FILE", .path = files[i]},
                                       {.role = "--results", .path = given->results, .is_written = true}};
        if (!output_check_distinct(roles, sizeof roles / sizeof roles[0])) {
            return false;
        }
    }
    return true;
}

static status_t merge(const given_t *given, char **files) {
    campaign_samples_t samples = {0};
    output_t *merged = calloc(1, sizeof *merged);
    status_t status = STATUS_UNUSABLE;

    if (merged == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    if (((given->results == NULL) || output_open(merged, given->results)) &&
        campaign_merge(files, given->file_count, &samples, merged) && output_commit(merged) &&
        (output_is_stdout(given->results) || campaign_print_table(&samples))) {
        status = STATUS_OK;
        for (size_t i = 0; i < samples.count; i++) {
            status = samples.samples[i].broken ? STATUS_UNMET : status;
        }
    }
    output_discard(merged);
    campaign_samples_free(&samples);
    free(merged);
    interrupt_release();
    return status;
}

static status_t print_tables(const given_t *given) {
    if (has_run_options(given) || given->merge || (given->results != NULL) || (given->file_count > 0)) {
        (void)report("--tables runs nothing: no other option and no file can be combined with it");
        return STATUS_UNUSABLE;
    }
    output_t *output = calloc(1, sizeof *output);
    const bool good =
        ((output != NULL) || report("out of memory")) && output_open(output, "-") && campaign_print_tables(output);
    const bool written = good && output_commit(output);
    free(output);
    return written ? STATUS_OK : STATUS_UNUSABLE;
}

status_t cmd_campaign(int argc, char **argv) {
    given_t given = {.runs = OPTION_NOT_GIVEN, .show = OPTION_NOT_GIVEN};
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    if (given.tables) {
        return print_tables(&given);
    }
    if (given.merge) {
        return check_merge(&given, argv) ? merge(&given, argv) : STATUS_UNUSABLE;
    }
    return make_request(&given, argv) ? campaign_run(&given.request) : STATUS_UNUSABLE;
}

/**
 * @file cmd_hunt.c
 * `host_sim hunt`: an adversary that searches for hazards.
 */
#include "cli/commands/commands.h"
#include "cli/options.h"
#include "cli/random_options.h"
#include "hunt/hunt.h"
#include "io/checkpoint.h"
#include "io/output.h"

#define RUNS_MAX 1000000000u

enum { MINUTES_MAX = 100000 };

/** The given options. */
typedef struct {
    hunt_request_t request;
    random_options_t random;
    const char *folder;
    bool lists;
} given_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    hunt_request_t *request = &given->request;
    option_t random_rows[RANDOM_OPTIONS];
    random_options_init(&given->random, random_rows, "only part I of N of the runs (1/1)");
    const option_t rows[] = {
        OPTION_NUMBER("--runs", "N", "number of runs, of all shards together", &request->runs, 1, RUNS_MAX),
        OPTION_DURATION_IN(DURATION_MIN, "--for-minutes", "stop after this time: 2h, or minutes alone",
                           &request->minutes, 1, MINUTES_MAX),
        OPTION_TEXT(
            "--checkpoint", "FILE",
            "save here after each 500 runs; the same command of the same program resumes; for one hunt at a time",
            &request->checkpoint),
        OPTION_TEXT("--found", "FOLDER", "folder for the scenarios of runs with a hazard (.)", &given->folder),
        OPTION_FLAG("--list-hazards", "print what counts as a hazard", &given->lists),
    };
    const option_group_t groups[] = {
        {.title = "Options", .options = random_rows, .count = RANDOM_OPTIONS},
        {.options = rows, .count = sizeof rows / sizeof rows[0]},
    };
    static const option_example_t examples[] = {
        {"host_sim hunt --seed 1 --runs 200", "200 runs"},
        {"host_sim hunt --list-hazards", "what counts as a hazard"},
    };
    const option_syntax_t syntax = {
        .usage = "hunt --seed S (--runs N | --for-minutes TIME) [OPTION]...",
        .or_usage = "hunt --list-hazards",
        .summary = "Attack the supervisor at random on the simulated bus (rogue nodes, broken nodes, unusual\n"
                   "configurations), and search for runs with a hazard. Exit status 1 if it finds one.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0;
    return options_parse(&syntax, argc, argv, &operands);
}

static bool make_request(given_t *given) {
    hunt_request_t *request = &given->request;

    if (!random_options_check(&given->random, "hunt", &request->shard, &request->shards)) {
        return false;
    }
    if ((request->runs == OPTION_NOT_GIVEN) && (request->minutes == OPTION_NOT_GIVEN)) {
        return report("--runs or --for-minutes is missing; see host_sim hunt --help");
    }
    if ((request->runs != OPTION_NOT_GIVEN) && (request->minutes != OPTION_NOT_GIVEN)) {
        return report("give only one of --runs and --for-minutes");
    }
    request->seed = given->random.seed;
    request->folder = (given->folder != NULL) ? given->folder : ".";
    return checkpoint_check_path(request->checkpoint) && output_check_folder("--found", request->folder);
}

static bool has_run_options(const given_t *given) {
    const hunt_request_t *request = &given->request;
    return (request->runs != OPTION_NOT_GIVEN) || (request->minutes != OPTION_NOT_GIVEN) ||
           (request->checkpoint != NULL) || (given->folder != NULL) || (given->random.seed != OPTION_NOT_GIVEN) ||
           (given->random.shard != NULL);
}

static status_t list_hazards(const given_t *given) {
    if (has_run_options(given)) {
        (void)report("--list-hazards runs nothing: no other option can be combined with it");
        return STATUS_UNUSABLE;
    }
    hunt_list_hazards();
    return STATUS_OK;
}

status_t cmd_hunt(int argc, char **argv) {
    given_t given = {.request = {.runs = OPTION_NOT_GIVEN, .minutes = OPTION_NOT_GIVEN}};
    const options_result_t parsed = parse(argc, argv, &given);

    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    if (given.lists) {
        return list_hazards(&given);
    }
    return make_request(&given) ? hunt_run(&given.request) : STATUS_UNUSABLE;
}

/**
 * @file cmd_soak.c
 * `host_sim soak`: months of virtual time with disturbances that have to be survived.
 */
#include "campaign/soak/soak.h"
#include "cli/commands/commands.h"
#include "cli/options.h"
#include "cli/random_options.h"
#include "io/checkpoint.h"
#include "io/output.h"

enum { HOURS_MAX = 876000 };

/** The given options. */
typedef struct {
    soak_request_t request;
    random_options_t random;
    uint64_t hours;
} given_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    option_t random_rows[RANDOM_OPTIONS];
    random_options_init(&given->random, random_rows, "only part I of N of the time (1/1)");
    const option_t rows[] = {
        OPTION_DURATION_IN(DURATION_H, "--hours", "virtual time, of all shards together: 365d, or hours alone",
                           &given->hours, 1, HOURS_MAX),
        OPTION_TEXT(
            "--checkpoint", "FILE",
            "save here every 6 simulated hours and on interrupt; the same command of the same program resumes; for one "
            "soak at a time",
            &given->request.checkpoint),
        OPTION_TEXT("--results", "FILE", "results as a line of JSON", &given->request.results),
    };
    const option_group_t groups[] = {
        {.title = "Options", .options = random_rows, .count = RANDOM_OPTIONS},
        {.options = rows, .count = sizeof rows / sizeof rows[0]},
    };
    static const option_example_t examples[] = {
        {"host_sim soak --hours 1 --seed 1", "an hour"},
        {"host_sim soak --hours 30d --seed 1 --shard 1/1000", "a small part of a month"},
    };
    const option_syntax_t syntax = {
        .usage = "soak --hours TIME --seed S [OPTION]...",
        .summary =
            "Run supervisor and vehicle for hours to months of virtual time, with random disturbances below every\n"
            "limit: nothing may trip, drift or be miscounted.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0;
    return options_parse(&syntax, argc, argv, &operands);
}

static bool make_request(given_t *given) {
    soak_request_t *request = &given->request;
    const output_role_t roles[] = {{.role = "--checkpoint", .path = request->checkpoint, .is_written = true},
                                   {.role = "--results", .path = request->results, .is_written = true}};

    if (given->hours == OPTION_NOT_GIVEN) {
        return report("--hours is missing; see host_sim soak --help");
    }
    request->hours = (uint32_t)given->hours;
    request->seed = given->random.seed;
    return random_options_check(&given->random, "soak", &request->shard, &request->shards) &&
           checkpoint_check_path(request->checkpoint) && output_check_distinct(roles, sizeof roles / sizeof roles[0]);
}

status_t cmd_soak(int argc, char **argv) {
    given_t given = {.hours = OPTION_NOT_GIVEN};
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    return make_request(&given) ? soak_run(&given.request) : STATUS_UNUSABLE;
}

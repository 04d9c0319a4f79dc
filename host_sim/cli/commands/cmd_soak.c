/**
 * @file cmd_soak.c
 * `host_sim soak`: months of virtual time with disturbances that have to be survived.
 */
#include "campaign/soak/soak.h"
#include "cli/commands/commands.h"
#include "cli/options.h"
#include "cli/shard_option.h"
#include "io/output.h"

/** As a number that was not given. */
#define NOT_GIVEN UINT64_MAX

enum { HOURS_MAX = 876000 };

/** What was given. */
typedef struct {
    soak_request_t request;
    uint64_t hours;
    uint64_t seed;
    const char *shard;
} given_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    const option_t rows[] = {
        OPTION_NUMBER("--hours", "N", "hours of virtual time, of all shards together; a year has 8760", &given->hours,
                      1, HOURS_MAX),
        OPTION_NUMBER("--seed", "S", "random seed; the same seed gives the same disturbances", &given->seed, 0,
                      INT64_MAX),
        OPTION_TEXT("--shard", "I/N", "only stretch I of N of the time (1/1)", &given->shard),
        OPTION_TEXT("--checkpoint", "FILE",
                    "saved every 6 simulated hours and when interrupted; resumed from if it exists",
                    &given->request.checkpoint),
        OPTION_TEXT("--results", "FILE", "results as a line of JSON", &given->request.results),
    };
    const option_group_t groups[] = {{.title = "Options", .options = rows, .count = sizeof rows / sizeof rows[0]}};
    const option_syntax_t syntax = {
        .usage = "soak --hours N --seed S [OPTION]...",
        .summary =
            "Run supervisor and vehicle for hours to months of virtual time, with random disturbances below every\n"
            "limit: nothing may trip, drift or be miscounted.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
    };
    size_t operands = 0u;
    return options_parse(&syntax, argc, argv, &operands);
}

static bool make_request(given_t *given) {
    soak_request_t *request = &given->request;
    const output_role_t roles[] = {{.role = "--checkpoint", .path = request->checkpoint, .is_written = true},
                                   {.role = "--results", .path = request->results, .is_written = true}};

    if (given->hours == NOT_GIVEN) {
        return report("--hours is missing; see host_sim soak --help");
    }
    if (given->seed == NOT_GIVEN) {
        return report("--seed is missing; see host_sim soak --help");
    }
    request->hours = (uint32_t)given->hours;
    request->seed = given->seed;
    request->shard = 1u;
    request->shards = 1u;
    return ((given->shard == NULL) || shard_option_take(given->shard, &request->shard, &request->shards)) &&
           output_check_distinct(roles, sizeof roles / sizeof roles[0]);
}

status_t cmd_soak(int argc, char **argv) {
    given_t given = {.hours = NOT_GIVEN, .seed = NOT_GIVEN};
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    return make_request(&given) ? soak_run(&given.request) : STATUS_UNUSABLE;
}

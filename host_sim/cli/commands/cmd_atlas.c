/**
 * @file cmd_atlas.c
 * `host_sim atlas`: every ordered pair of faults on the simulated bus.
 */
#include "atlas/atlas_case.h"
#include "atlas/atlas_run.h"
#include "campaign/fault_option.h"
#include "cli/commands/commands.h"
#include "cli/options.h"
#include "cli/random_options.h"

/** The given options. */
typedef struct {
    const char *shard;
    const char *first;
    const char *second;
    const char *results;
    uint64_t show;
} given_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    const option_t rows[] = {
        OPTION_TEXT("--shard", "I/N", "only part I of N of the cases (1/1)", &given->shard),
        OPTION_FAULT("--first", "only cases with this first fault", &given->first),
        OPTION_FAULT("--second", "only cases with this second fault", &given->second),
        OPTION_TEXT("--results", "FILE", "results of each case, and of each of the two alone, as JSON Lines",
                    &given->results),
        OPTION_NUMBER("--show", "CASE", "only print this case, as a scenario", &given->show, 0,
                      (uint64_t)atlas_case_count() - 1),
    };
    const option_group_t groups[] = {{.title = "Options", .options = rows, .count = sizeof rows / sizeof rows[0]}};
    static const option_example_t examples[] = {
        {"host_sim atlas --first EMERGENCY_STOP --second BUS_OFF", "one pair, in every state and topology"},
        {"host_sim atlas --shard 1/1000 --results atlas-1.jsonl", "a part of all cases"},
    };
    const option_syntax_t syntax = {
        .usage = "atlas [OPTION]...",
        .summary = "Cause every ordered pair of faults on the simulated bus, in every state in which both can be\n"
                   "caused, in both topologies, 0, 1, 50 and 500 ms apart, and compare each of these cases with each\n"
                   "of the two faults alone.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0; /* none: they are refused */
    return options_parse(&syntax, argc, argv, &operands);
}

static bool make_request(const given_t *given, atlas_request_t *request) {
    *request = (atlas_request_t){.shard = 1, .shards = 1, .results = given->results};
    request->shows_one = given->show != OPTION_NOT_GIVEN;
    if (request->shows_one &&
        ((given->results != NULL) || (given->shard != NULL) || (given->first != NULL) || (given->second != NULL))) {
        return report("--show prints one case: --results, --shard, --first and --second cannot be combined with it");
    }
    request->one = request->shows_one ? (uint32_t)given->show : 0;
    if (((given->shard != NULL) && !random_options_shard(given->shard, &request->shard, &request->shards)) ||
        !fault_option_take("--first", given->first, &request->first) ||
        !fault_option_take("--second", given->second, &request->second)) {
        return false;
    }
    if ((request->first != NULL) && (request->first == request->second)) {
        return report("--first and --second are the same fault, %s: a fault is not paired with itself", given->first);
    }
    return true;
}

status_t cmd_atlas(int argc, char **argv) {
    given_t given = {.show = OPTION_NOT_GIVEN};
    atlas_request_t request;
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    return make_request(&given, &request) ? atlas_run(&request) : STATUS_UNUSABLE;
}

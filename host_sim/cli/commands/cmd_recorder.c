/**
 * @file cmd_recorder.c
 * `host_sim recorder`: its options.
 */
#include "analysis/analysis_options.h"
#include "cli/commands/commands.h"
#include "cli/options.h"
#include "config/config_options.h"
#include "io/output.h"
#include "recorder/recorder_run.h"

enum { RUN_MAX = 255, FIXED_FILES = 3 };

/** The given options. */
typedef struct {
    recorder_request_t request;
    config_options_t config;
    analysis_paths_t analysis;
} given_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    const option_t rows[] = {
        OPTION_NUMBER("--run", "N", "show run N; default: the newest run with a trip, else the newest run",
                      &given->request.run, 0, RUN_MAX),
        OPTION_TEXT("--events", "FILE", "events as JSON Lines", &given->request.events),
    };
    static const option_example_t examples[] = {
        {"host_sim replay --store agv.store @/examples/ai-stops.log", "leaves what a device would keep in agv.store"},
        {"host_sim recorder agv.store", "what was kept"},
        {"host_sim recorder --report why.html agv.store", "the same as a page with pictures"},
    };
    const analysis_command_t command = {
        .usage = "recorder [OPTION]... FILE",
        .summary =
            "Show what the flight recorder of a device kept: what its shell's 'agv dump' printed, what a debugger\n"
            "dumped of its memory, or the --store file of replay (- = standard input).\n",
        .operand = "FILE",
        .config_title = "Configuration of the device",
        .shadow_help = "the device ran in shadow mode",
        .rows = rows,
        .row_count = sizeof rows / sizeof rows[0],
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    return analysis_options_parse(&command, argc, argv, &given->analysis, &given->config);
}

static bool check_files(const given_t *given) {
    output_role_t roles[FIXED_FILES + (int)ANALYSIS_FILES] = {
        {.role = "FILE", .path = given->request.path},
        {.role = "--config", .path = given->config.path},
        {.role = "--events", .path = given->request.events, .is_written = true},
    };
    analysis_options_roles(&given->analysis, &roles[FIXED_FILES]);
    return output_check_distinct(roles, sizeof roles / sizeof roles[0]);
}

status_t cmd_recorder(int argc, char **argv) {
    given_t given = {.request = {.run = RECORDER_RUN_NEWEST}};
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    given.request.path = argv[0];
    given.request.analysis = given.analysis;
    if (!check_files(&given) || !config_options_make(&given.config, &given.request.config)) {
        return STATUS_UNUSABLE;
    }
    return recorder_run(&given.request);
}

/**
 * @file cmd_replay.c
 * `host_sim replay`: its options.
 */
#include "analysis/analysis_options.h"
#include "cli/commands/commands.h"
#include "cli/options.h"
#include "config/config_options.h"
#include "io/output.h"
#include "io/store_file.h"
#include "replay/replay.h"

/** The words of --reset-cause, in the order of hal_reset_cause_t. */
#define RESET_CAUSES "power-on|watchdog|brown-out|lock-up|software|unknown"

/** Files besides those of the analysis. */
enum { FIXED_FILES = 5 };

/** The given options. */
typedef struct {
    replay_request_t request;
    config_options_t config;
    analysis_paths_t analysis;
    uint64_t start_ms;
    int reset_cause;
} given_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    const option_t rows[] = {
        OPTION_TEXT("--out", "FILE", "candump log of the frames that the supervisor sent", &given->request.out),
        OPTION_TEXT("--events", "FILE", "events as JSON Lines", &given->request.events),
        OPTION_FLAG("--timeline", "print a line for each action and event, as demo does", &given->request.timeline),
        OPTION_FLAG("--fail-on-trip",
                    "exit status 1 if it tripped, nothing was supervised, or time stamps go back by 10 ms or more",
                    &given->request.fail_on_trip),
        OPTION_DURATION("--until", "leave out the lines from this time on, counted from the first one",
                        &given->request.until_ms, 1, REPLAY_TAIL_MAX_MS),
        OPTION_DURATION("--tail", "continue for this time after the last line (0)", &given->request.tail_ms, 0,
                        REPLAY_TAIL_MAX_MS),
        OPTION_DURATION("--start-ms", "the supervisor's clock at the start, in ms (0)", &given->start_ms, 0,
                        UINT32_MAX),
        OPTION_FLAG("--skip-bad-lines", "skip and count lines that are not frames", &given->request.skip_bad_lines),
        OPTION_TEXT("--ai-if", "NAME", "interface of the AI side; selects the gateway topology",
                    &given->request.ai_interface),
        {.name = "--reset-cause",
         .value = "CAUSE",
         .help = RESET_CAUSES,
         .word = &given->reset_cause,
         .words = RESET_CAUSES},
        OPTION_TEXT("--store", "FILE", "storage that survives a reset: latch and flight recorder",
                    &given->request.store),
    };
    static const option_example_t examples[] = {
        {"host_sim replay @/examples/ai-stops.log", "whether and why it tripped"},
        {"host_sim replay --report why.html @/examples/ai-stops.log", "the same as a page with pictures"},
        {"host_sim replay --timeline --tail 1s @/examples/ai-stops.log",
         "a line for each event; a second of silence after the log"},
    };
    const analysis_command_t command = {
        .usage = "replay [OPTION]... LOG",
        .summary =
            "Replay a recorded log to the supervisor in virtual time, and say whether, when and why it would have\n"
            "stopped the vehicle. LOG is candump -l, candump -t a or Vector ASC, also compressed with\n"
            "gzip; - = standard input.\n",
        .operand = "LOG",
        .config_title = "Configuration of the supervisor",
        .rows = rows,
        .row_count = sizeof rows / sizeof rows[0],
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    return analysis_options_parse(&command, argc, argv, &given->analysis, &given->config);
}

static bool check_files(const given_t *given) {
    output_role_t roles[FIXED_FILES + (int)ANALYSIS_FILES] = {
        {.role = "LOG", .path = given->request.log},
        {.role = "--config", .path = given->config.path},
        {.role = "--out", .path = given->request.out, .is_written = true},
        {.role = "--events", .path = given->request.events, .is_written = true},
        {.role = "--store", .path = given->request.store, .is_written = true},
    };
    analysis_options_roles(&given->analysis, &roles[FIXED_FILES]);
    if (output_is_stdout(given->request.store)) {
        return report("--store: give a file; standard output cannot be read");
    }
    if (given->request.timeline && (analysis_paths_use_stdout(&given->analysis) ||
                                    output_is_stdout(given->request.out) || output_is_stdout(given->request.events))) {
        return report("--timeline: standard output is already used by another option");
    }
    return output_check_distinct(roles, sizeof roles / sizeof roles[0]) &&
           ((given->request.store == NULL) || store_file_may_replace(given->request.store));
}

status_t cmd_replay(int argc, char **argv) {
    given_t given = {.reset_cause = (int)HAL_RESET_POWER_ON};
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    given.request.log = argv[0];
    given.request.analysis = given.analysis;
    given.request.start_ms = (uint32_t)given.start_ms;
    given.request.reset_cause = (hal_reset_cause_t)given.reset_cause;
    given.config.has_ai_side = given.request.ai_interface != NULL;
    if (!check_files(&given) || !config_options_make(&given.config, &given.request.config)) {
        return STATUS_UNUSABLE;
    }
    return replay_run(&given.request);
}

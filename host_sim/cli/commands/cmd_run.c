/**
 * @file cmd_run.c
 * `host_sim run`: its options.
 */
#include <stddef.h>

#include "analysis/analysis_options.h"
#include "cli/commands/commands.h"
#include "cli/interface_options.h"
#include "cli/options.h"
#include "config/config_options.h"
#include "io/output.h"
#include "live/live.h"

/** The given options. */
typedef struct {
    live_request_t request;
    config_options_t config;
    analysis_paths_t analysis;
} given_t;

/** Files besides those of the analysis. */
enum { FIXED_FILES = 3 };

static options_result_t parse(int argc, char **argv, given_t *given) {
    option_t config_rows[CONFIG_OPTIONS];
    config_options_init(&given->config, config_rows);
    live_request_t *request = &given->request;
    option_t interface_rows[INTERFACE_OPTIONS];
    option_t analysis_rows[ANALYSIS_OPTIONS];
    interface_options_init(&request->bus, interface_rows);
    analysis_options_init(&given->analysis, analysis_rows);
    const option_t rows[] = {
        OPTION_FLAG("--fail-on-trip", "exit status 1 if it tripped at any time, or never left INIT",
                    &request->fail_on_trip),
        OPTION_TEXT("--events", "FILE", "events as JSON Lines, as they come", &request->events),
        OPTION_TEXT("--out", "FILE", "candump log of the frames that the supervisor sends", &request->out),
        OPTION_FLAG("--screen", "on a terminal: the screen of host_sim monitor", &request->screen),
        OPTION_FLAG("--realtime", "SCHED_FIFO, memory locked (CAP_SYS_NICE, CAP_IPC_LOCK)", &request->realtime),
    };
    const option_group_t groups[] = {
        {.title = "Options (FILE may be -, standard output)", .options = interface_rows, .count = INTERFACE_OPTIONS},
        {.options = rows, .count = sizeof rows / sizeof rows[0]},
        {.options = analysis_rows, .count = ANALYSIS_OPTIONS},
        {.title = "Configuration of the supervisor", .options = config_rows, .count = CONFIG_OPTIONS},
    };
    static const option_example_t examples[] = {
        {"host_sim run --can can0", "supervise the bus can0"},
        {"host_sim run --can can0 --shadow --for 1.5min --report why.html",
         "only watch, and say what it would have done"},
    };
    const option_syntax_t syntax = {
        .usage = "run --can IF [OPTION]...",
        .summary =
            "Run the supervisor as a node on SocketCAN, in real time, until SIGINT, SIGTERM or SIGHUP. It then\n"
            "makes no new frames; waiting frames are sent within 20 ms, or discarded. On a terminal it shows its\n"
            "state while it runs.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .instead = "--can",
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0;
    return options_parse(&syntax, argc, argv, &operands);
}

static bool check_files(const given_t *given) {
    output_role_t roles[FIXED_FILES + (int)ANALYSIS_FILES] = {
        {.role = "--config", .path = given->config.path},
        {.role = "--out", .path = given->request.out, .is_written = true},
        {.role = "--events", .path = given->request.events, .is_written = true},
    };
    analysis_options_roles(&given->analysis, &roles[FIXED_FILES]);
    return output_check_distinct(roles, sizeof roles / sizeof roles[0]);
}

status_t cmd_run(int argc, char **argv) {
    given_t given = {0};
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    given.request.analysis = given.analysis;
    given.config.has_ai_side = given.request.bus.interfaces[HAL_CAN_AI] != NULL;
    if (!check_files(&given) || !config_options_make(&given.config, &given.request.config) ||
        !interface_options_check(&given.request.bus, "run", given.request.config.topology == AGV_TOPOLOGY_GATEWAY)) {
        return STATUS_UNUSABLE;
    }
    return live_run(&given.request);
}

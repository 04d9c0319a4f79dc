/**
 * @file cmd_monitor.c
 * `host_sim monitor`: its options.
 */
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands/commands.h"
#include "cli/interface_options.h"
#include "cli/options.h"
#include "config/config_options.h"
#include "io/output.h"
#include "logs/log_sides.h"
#include "monitor/inputs/monitor_run.h"

#define SPEED_LOWEST 0.01
#define SPEED_HIGHEST 1000.0

/** The given options. */
typedef struct {
    monitor_request_t request;
    config_options_t config;
    bool has_speed;
} given_t;

/** "4", "0.5", "max". */
static bool take_speed(void *ctx, const char *text) {
    given_t *given = ctx;
    char *end = NULL;
    given->has_speed = true;
    if (strcmp(text, "max") == 0) {
        given->request.speed = MONITOR_SPEED_ANY;
        return true;
    }
    const bool is_plain = (text[0] != '\0') && (text[strspn(text, "0123456789.")] == '\0');
    given->request.speed = is_plain ? strtod(text, &end) : 0.0;
    if (!is_plain || (*end != '\0') || (given->request.speed < SPEED_LOWEST) ||
        (given->request.speed > SPEED_HIGHEST)) {
        return report("--speed: '%s' is not a number from 0.01 to 1000, nor max", text);
    }
    return true;
}

static options_result_t parse(int argc, char **argv, given_t *given) {
    monitor_request_t *request = &given->request;
    option_t interface_rows[INTERFACE_OPTIONS];
    option_t config_rows[CONFIG_OPTIONS];
    interface_options_init(&given->request.bus, interface_rows);
    config_options_init(&given->config, config_rows);
    const option_t rows[] = {
        OPTION_TEXT("--record", "FILE", "record the bus into this candump log, a new file", &request->record),
        OPTION_FLAG("--shadow", "show the supervisor inside this program even when a status frame is received",
                    &request->shadow),
    };
    const option_t log_rows[] = {
        OPTION_TEXT("--log", "FILE", "a recorded log instead; - is standard input", &request->log),
        {.name = "--speed",
         .value = "N",
         .help = "play the log N times as fast as recorded; max: without waiting",
         .each = take_speed,
         .ctx = given,
         .words = "max"},
        OPTION_TEXT("--ai-if", "NAME", "of the log: the interface of the AI side", &request->ai_interface),
        OPTION_FLAG("--skip-bad-lines", "of the log: skip and count invalid lines", &request->skip_bad_lines),
    };
    const option_group_t groups[] = {
        {.title = "A bus", .options = interface_rows, .count = INTERFACE_OPTIONS},
        {.options = rows, .count = sizeof rows / sizeof rows[0]},
        {.title = "A log", .options = log_rows, .count = sizeof log_rows / sizeof log_rows[0]},
        {.title = "Configuration of the supervisor (deadlines, identifiers, topology)",
         .options = config_rows,
         .count = CONFIG_OPTIONS_OF_BUS},
    };
    static const option_example_t examples[] = {
        {"host_sim monitor --can can0", "a bus"},
        {"host_sim monitor --log @/examples/ai-stops.log --speed max", "a log, without waiting"},
    };
    const option_syntax_t syntax = {
        .usage = "monitor --can IF | --log FILE [OPTION]...",
        .summary =
            "Show what happens on a bus: each message with its signals, its age against its deadline, gaps and\n"
            "counter, the alarms, the state of the supervisor, and what changes. It sends nothing.\n\n"
            "On a terminal it is a screen; press h there for the keys. Elsewhere, and with TERM=dumb, it prints a\n"
            "line for each change. NO_COLOR=1 turns colours off.\n\n"
            "The state of the supervisor is that of its status frame. When none comes for 1 s (or for three\n"
            "of its periods, if that is longer), it is that of a supervisor in this program, which only listens.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .instead = "--log",
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0;
    return options_parse(&syntax, argc, argv, &operands);
}

static bool check_log(const given_t *given) {
    const monitor_request_t *request = &given->request;
    const bool is_gateway = request->config.topology == AGV_TOPOLOGY_GATEWAY;
    if ((given->request.bus.interfaces[HAL_CAN_VEHICLE] != NULL) ||
        (given->request.bus.interfaces[HAL_CAN_AI] != NULL)) {
        return report("--log and --can exclude each other");
    }
    if (request->record != NULL) {
        return report("--record needs --can: a log is recorded already");
    }
    return log_sides_check(is_gateway, request->ai_interface);
}

/** An option that was given and makes sense for a log only; NULL: none was. */
static const char *option_of_log(const given_t *given) {
    if (given->has_speed) {
        return "--speed";
    }
    if (given->request.ai_interface != NULL) {
        return "--ai-if";
    }
    return given->request.skip_bad_lines ? "--skip-bad-lines" : NULL;
}

static bool check_bus(const given_t *given) {
    const char *of_log = option_of_log(given);
    if (of_log != NULL) {
        return report("%s needs --log", of_log);
    }
    if (given->request.bus.interfaces[HAL_CAN_VEHICLE] == NULL) {
        return report("--can or --log is missing: what to watch; see host_sim monitor --help");
    }
    return interface_options_check(&given->request.bus, "monitor",
                                   given->request.config.topology == AGV_TOPOLOGY_GATEWAY);
}

/** Before the bus is opened. */
static bool check_record(const char *path) {
    return (access(path, F_OK) != 0) || report("%s: exists already, and is not replaced", path);
}

static bool check_files(const given_t *given) {
    const output_role_t roles[] = {
        {.role = "--config", .path = given->config.path},
        {.role = "--record", .path = given->request.record, .is_written = true},
    };
    const char *record = given->request.record;
    return output_check_distinct(roles, sizeof roles / sizeof roles[0]) && ((record == NULL) || check_record(record));
}

status_t cmd_monitor(int argc, char **argv) {
    given_t given = {.request = {.speed = 1.0}};
    const options_result_t parsed = parse(argc, argv, &given);
    monitor_request_t *request = &given.request;
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    given.config.has_ai_side = (request->bus.interfaces[HAL_CAN_AI] != NULL) || (request->ai_interface != NULL);
    if (!check_files(&given) || !config_options_make(&given.config, &request->config) ||
        !((request->log != NULL) ? check_log(&given) : check_bus(&given))) {
        return STATUS_UNUSABLE;
    }
    return monitor_run(request);
}

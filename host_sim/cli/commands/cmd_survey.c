/**
 * @file cmd_survey.c
 * `host_sim survey`: its options.
 */
#include "cli/commands/commands.h"
#include "cli/interface_options.h"
#include "cli/options.h"
#include "config/config_options.h"
#include "io/output.h"
#include "logs/log_sides.h"
#include "survey/survey.h"

enum { BIT_RATE_DEFAULT = 500000, BIT_RATE_LOWEST = 10000, BIT_RATE_HIGHEST = 1000000, ID_SET_NOT_GIVEN = -1 };

/** The given options. */
typedef struct {
    survey_request_t request;
    config_options_t config;
} given_t;

static options_result_t parse(int argc, char **argv, given_t *given, size_t *operands) {
    survey_request_t *request = &given->request;
    option_t config_rows[CONFIG_OPTIONS];
    config_options_init(&given->config, config_rows);
    option_t interface_rows[INTERFACE_OPTIONS];
    interface_options_init(&request->bus, interface_rows);
    const option_t rows[] = {
        OPTION_TEXT("--ai-if", "NAME", "of a log: interface of the AI side; selects the gateway topology",
                    &request->ai_interface),
        OPTION_NUMBER("--bitrate", "N", "bit/s of the bus, for its load (500000)", &request->bit_rate, BIT_RATE_LOWEST,
                      BIT_RATE_HIGHEST),
        OPTION_FLAG("--json", "print JSON instead of text", &request->is_json),
        OPTION_TEXT("--config-out", "FILE", "write the proposed configuration; -: print only it", &request->config_out),
        OPTION_FLAG("--skip-bad-lines", "skip and count lines that are not frames", &request->skip_bad_lines),
    };
    const option_group_t groups[] = {
        {.title = "Options", .options = rows, .count = sizeof rows / sizeof rows[0]},
        {.title = "Instead of a log", .options = interface_rows, .count = INTERFACE_OPTIONS},
        {.title = "Configuration to compare with", .options = config_rows, .count = CONFIG_OPTIONS_OF_BUS},
    };
    static const option_example_t examples[] = {
        {"host_sim survey @/examples/ai-stops.log", "what is in a log"},
        {"host_sim survey --config-out agv.yaml @/examples/other-vehicle.log.gz",
         "and the configuration that would fit, as a file"},
        {"host_sim survey --can can0 --for 60s", "a bus, for a minute"},
    };
    const option_syntax_t syntax = {
        .usage = "survey [OPTION]... (LOG | --can IF [--for TIME])",
        .summary =
            "Show what is on a bus: each message with its gaps and the margin to its deadline, counters, values,\n"
            "alarms, unknown identifiers and what they may be, load. At the end: a configuration that would fit,\n"
            "each setting with its reason. LOG is candump -l, candump -t a or Vector ASC, also compressed with\n"
            "gzip; - = standard input. Nothing is sent.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
        .operands_max = 1,
        .operand = "LOG",
    };
    return options_parse(&syntax, argc, argv, operands);
}

static bool check_files(const given_t *given) {
    const output_role_t roles[] = {
        {.role = "LOG", .path = given->request.log},
        {.role = "--config", .path = given->config.path},
        {.role = "--config-out", .path = given->request.config_out, .is_written = true},
    };
    if (given->request.is_json && output_is_stdout(given->request.config_out)) {
        return report(
            "--json and --config-out -: only one of them can be on standard output; give --config-out a file");
    }
    return output_check_distinct(roles, sizeof roles / sizeof roles[0]);
}

/** Either a log or interfaces, and what belongs to it. */
static bool check_source(const survey_request_t *request) {
    const bool is_gateway = request->config.topology == AGV_TOPOLOGY_GATEWAY;
    const bool is_live =
        (request->bus.interfaces[HAL_CAN_VEHICLE] != NULL) || (request->bus.interfaces[HAL_CAN_AI] != NULL);
    if ((request->log == NULL) && !is_live) {
        return report("LOG or --can is missing; see host_sim survey --help");
    }
    if ((request->log != NULL) && is_live) {
        return report("give only one of LOG and --can");
    }
    if (request->log == NULL) {
        return (request->ai_interface == NULL) ? interface_options_check(&request->bus, "survey", is_gateway)
                                               : report("--ai-if is for a log; with --can it is --ai-can");
    }
    if (request->bus.for_ms != INTERFACE_UNTIL_SIGNAL) {
        return report("--for is for --can: a log is read to its end");
    }
    return log_sides_check(is_gateway, request->ai_interface);
}

status_t cmd_survey(int argc, char **argv) {
    given_t given = {.request = {.bit_rate = BIT_RATE_DEFAULT}};
    size_t operands = 0;
    const options_result_t parsed = parse(argc, argv, &given, &operands);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    given.request.log = (operands > 0) ? argv[0] : NULL;
    given.request.id_set_is_given = given.config.id_set != ID_SET_NOT_GIVEN;
    given.config.has_ai_side =
        (given.request.ai_interface != NULL) || (given.request.bus.interfaces[HAL_CAN_AI] != NULL);
    if (!check_files(&given) || !config_options_make(&given.config, &given.request.config) ||
        !check_source(&given.request)) {
        return STATUS_UNUSABLE;
    }
    return survey_run(&given.request);
}

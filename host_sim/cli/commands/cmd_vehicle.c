/**
 * @file cmd_vehicle.c
 * `host_sim vehicle`: its options.
 */
#include "cli/commands/commands.h"
#include "cli/interface_options.h"
#include "cli/options.h"
#include "config/config_options.h"
#include "live/vehicle_run.h"

/** The given options. */
typedef struct {
    vehicle_run_request_t request;
    config_options_t config;
    const char *faults[VEHICLE_RUN_FAULTS_MAX];
    size_t fault_count;
} given_t;

static bool take_fault(void *ctx, const char *text) {
    given_t *given = ctx;

    if (given->fault_count == VEHICLE_RUN_FAULTS_MAX) {
        return report("--fault: given more than %u times", VEHICLE_RUN_FAULTS_MAX);
    }
    given->faults[given->fault_count] = text;
    given->fault_count++;
    return true;
}

static options_result_t parse(int argc, char **argv, given_t *given) {
    vehicle_run_request_t *request = &given->request;
    option_t interface_rows[INTERFACE_OPTIONS];
    option_t config_rows[CONFIG_OPTIONS];
    interface_options_init(&request->bus, interface_rows);
    config_options_init(&given->config, config_rows);
    const option_t rows[] = {
        {.name = "--fault",
         .value = "WHO-WHAT[,NAME=VALUE]...@TIME",
         .help = "inject a fault at that time",
         .each = take_fault,
         .adds_up = true,
         .ctx = given},
        OPTION_FLAG("--screen", "on a terminal: the screen of host_sim monitor", &request->screen),
        OPTION_FLAG("--manual", "do not engage the autopilot", &request->manual),
    };
    const option_group_t groups[] = {
        {.title = "Options", .options = interface_rows, .count = INTERFACE_OPTIONS},
        {.options = rows, .count = sizeof rows / sizeof rows[0]},
        {.title = "Configuration of the supervisor (its topology and identifiers)",
         .options = config_rows,
         .count = CONFIG_OPTIONS_OF_BUS},
    };
    static const option_example_t examples[] = {
        {"host_sim vehicle --can vcan0", "until Ctrl-C"},
        {"host_sim vehicle --can vcan0 --fault ai-stop@4s --for 8.5s", "the AI computer stops after 4 s"},
    };
    const option_syntax_t syntax = {
        .usage = "vehicle --can IF [OPTION]...",
        .summary =
            "Simulate VCU, EPS and AI computer as nodes on SocketCAN, in real time, until SIGINT, SIGTERM or\n"
            "SIGHUP. They obey the commands on the bus. After 1.5 s the operator engages the autopilot, and the\n"
            "AI computer drives: gear D, throttle 30 %.\n\n"
            "Inject faults, and the other steps of a scenario that a CAN interface allows, by option: --fault\n"
            "ai-stop@2s or --fault eps-set,field=faults,value=08h@3s; or type them while it runs: 'ai stop',\n"
            "'eps set field=faults value=08h'. 'help' lists them; 'status' and 'quit' are commands, too. Times\n"
            "are 250ms, 1.5s, or milliseconds alone; identifiers are 168h, 0x168 or decimal 360.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .instead = "--can",
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0;
    return options_parse(&syntax, argc, argv, &operands);
}

/** Read the faults, in the order of their time. */
static bool make_faults(const given_t *given, vehicle_run_request_t *request) {
    for (size_t i = 0; i < given->fault_count; i++) {
        vehicle_words_t words;
        if (!vehicle_words_fault(given->faults[i], &request->config, &words)) {
            return false;
        }
        if ((request->bus.for_ms != INTERFACE_UNTIL_SIGNAL) && (words.step.at_ms >= request->bus.for_ms)) {
            return report("--fault %.80s: the time is after the end (--for)", given->faults[i]);
        }
        size_t place = i;
        for (; (place > 0) && (request->faults[place - 1].step.at_ms > words.step.at_ms); place--) {
            request->faults[place] = request->faults[place - 1];
        }
        request->faults[place] = words;
    }
    request->fault_count = given->fault_count;
    return true;
}

status_t cmd_vehicle(int argc, char **argv) {
    given_t given = {0};
    const options_result_t parsed = parse(argc, argv, &given);

    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    given.config.has_ai_side = given.request.bus.interfaces[HAL_CAN_AI] != NULL;
    if (!config_options_make(&given.config, &given.request.config) ||
        !interface_options_check(&given.request.bus, "vehicle",
                                 given.request.config.topology == AGV_TOPOLOGY_GATEWAY)) {
        return STATUS_UNUSABLE;
    }
    return make_faults(&given, &given.request) ? vehicle_run_nodes(&given.request) : STATUS_UNUSABLE;
}

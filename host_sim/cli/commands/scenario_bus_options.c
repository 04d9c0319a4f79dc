#include "cli/commands/scenario_bus_options.h"

#include <errno.h>
#include <string.h>
#include <unistd.h>

#include "common/report.h"

enum { DEFAULT_TOLERANCE_MS = 50, TOLERANCE_MAX_MS = 1000, PROGRAM_SIZE = 4096 };

void scenario_bus_options_init(scenario_bus_options_t *options, option_t rows[SCENARIO_BUS_OPTIONS]) {
    *options = (scenario_bus_options_t){.tolerance_ms = OPTION_NOT_GIVEN};
    const option_t all[SCENARIO_BUS_OPTIONS] = {
        {.name = "--bus",
         .value = "sim|IF[,IF]",
         .help =
             "the simulated bus in virtual time (sim), or CAN interfaces (of the vehicle, of the AI side) in real time",
         .text = &options->bus,
         .words = "sim"},
        OPTION_DURATION("--tolerance", "on CAN interfaces: tolerance of all times (50ms)", &options->tolerance_ms, 0,
                        TOLERANCE_MAX_MS),
        OPTION_TEXT("--supervisor", "COMMAND",
                    "on CAN interfaces: start this external supervisor; it prints its events as JSON Lines",
                    &options->supervisor),
        OPTION_TEXT("--sent", "FILE",
                    "on CAN interfaces: candump log of the frames that the supervisor sent (of one scenario)",
                    &options->sent),
    };
    (void)memcpy(rows, all, sizeof all);
}

bool scenario_bus_options_any(const scenario_bus_options_t *options) {
    return (options->bus != NULL) || (options->supervisor != NULL) || (options->sent != NULL) ||
           (options->tolerance_ms != OPTION_NOT_GIVEN);
}

/** Take the name of an interface out of --bus. */
static bool take_interface(scenario_bus_options_t *options, hal_can_side_t side, const char *name, size_t length) {
    if ((length == 0) || (length > LINUX_CAN_NAME_MAX) || (memchr(name, ',', length) != NULL)) {
        return report("--bus: '%s' is not sim, IF or IF,IF", options->bus);
    }
    memcpy(options->interface_names[side], name, length);
    return true;
}

/** A command that begins with a path: what the shell would say of a program that is not there, in one line. */
static bool check_program(const char *command) {
    char path[PROGRAM_SIZE];
    const size_t length = strspn(command, "/._-+ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789");
    const bool is_path = ((command[length] == '\0') || (command[length] == ' ')) && (length < sizeof path) &&
                         (memchr(command, '/', length) != NULL);
    if (!is_path) {
        return true;
    }
    memcpy(path, command, length);
    path[length] = '\0';
    return (access(path, X_OK) == 0) || report("--supervisor: %s: %s", path, strerror(errno));
}

bool scenario_bus_options_check(scenario_bus_options_t *options) {
    if ((options->bus == NULL) || (strcmp(options->bus, "sim") == 0)) {
        const bool is_simulated =
            (options->tolerance_ms == OPTION_NOT_GIVEN) && (options->supervisor == NULL) && (options->sent == NULL);
        return is_simulated || report("--tolerance, --supervisor and --sent need CAN interfaces: --bus IF[,IF]");
    }
    const size_t length = strcspn(options->bus, ",");
    const char *second = (options->bus[length] == ',') ? &options->bus[length + 1] : NULL;
    if (!take_interface(options, HAL_CAN_VEHICLE, options->bus, length) ||
        ((second != NULL) && !take_interface(options, HAL_CAN_AI, second, strlen(second)))) {
        return false;
    }
    if ((second != NULL) && (strcmp(options->interface_names[HAL_CAN_VEHICLE], second) == 0)) {
        return report("--bus: both sides are the same interface, '%s'", second);
    }
    options->tolerance_ms = (options->tolerance_ms == OPTION_NOT_GIVEN) ? DEFAULT_TOLERANCE_MS : options->tolerance_ms;
    return (options->supervisor == NULL) || check_program(options->supervisor);
}

bool scenario_bus_options_is_real(const scenario_bus_options_t *options) {
    return options->interface_names[HAL_CAN_VEHICLE][0] != '\0';
}

scenario_bus_t scenario_bus_options_bus(const scenario_bus_options_t *options) {
    const char *vehicle = options->interface_names[HAL_CAN_VEHICLE];
    const char *ai = options->interface_names[HAL_CAN_AI];
    return (scenario_bus_t){
        .interfaces = {[HAL_CAN_VEHICLE] = vehicle, [HAL_CAN_AI] = (ai[0] != '\0') ? ai : NULL},
        .tolerance_ms = (uint32_t)options->tolerance_ms,
        .command = options->supervisor,
    };
}

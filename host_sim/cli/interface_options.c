#include "cli/interface_options.h"

#include <stddef.h>
#include <string.h>

#include "common/report.h"

/** The longest time that can be asked for: 100 days. */
#define FOR_MAX_MS 8640000000u

void interface_options_init(interface_options_t *options, option_t rows[INTERFACE_OPTIONS]) {
    *options = (interface_options_t){.for_ms = INTERFACE_UNTIL_SIGNAL};
    rows[0] = (option_t)OPTION_TEXT("--can", "IF", "the interface of the vehicle side, or of the shared bus",
                                    &options->interfaces[HAL_CAN_VEHICLE]);
    rows[1] = (option_t)OPTION_TEXT("--ai-can", "IF", "interface of the AI side; selects the gateway topology",
                                    &options->interfaces[HAL_CAN_AI]);
    rows[2] = (option_t)OPTION_DURATION("--for", "stop after this time (250ms, 10s, 1.5min), or earlier by a signal",
                                        &options->for_ms, 1, FOR_MAX_MS);
}

bool interface_options_check(const interface_options_t *options, const char *command, bool is_gateway) {
    const char *vehicle = options->interfaces[HAL_CAN_VEHICLE];
    const char *ai = options->interfaces[HAL_CAN_AI];
    if (vehicle == NULL) {
        return report("--can is missing: the interface of the vehicle side; see host_sim %s --help", command);
    }
    if (is_gateway && (ai == NULL)) {
        return report("the gateway topology needs --ai-can: the interface of the AI side");
    }
    if (!is_gateway && (ai != NULL)) {
        return report("--ai-can needs --topology gateway: a shared bus has no AI side");
    }
    if ((ai != NULL) && (strcmp(vehicle, ai) == 0)) {
        return report("--can and --ai-can are the same interface, '%s'", ai);
    }
    return true;
}

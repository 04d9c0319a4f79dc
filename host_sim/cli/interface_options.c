#include "cli/interface_options.h"

#include <stddef.h>
#include <string.h>

#include "common/report.h"

bool interface_options_check(const char *command, const char *const interfaces[HAL_CAN_SIDES], bool is_gateway) {
    const char *vehicle = interfaces[HAL_CAN_VEHICLE];
    const char *ai = interfaces[HAL_CAN_AI];
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

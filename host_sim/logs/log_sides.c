#include "logs/log_sides.h"

#include <string.h>

#include "common/report.h"
#include "logs/candump_line.h"

bool log_sides_check(bool is_gateway, const char *ai_interface) {
    if (is_gateway && (ai_interface == NULL)) {
        return report("the gateway topology needs --ai-if: which interface of the log is the AI side");
    }
    if (!is_gateway && (ai_interface != NULL)) {
        return report("--ai-if needs --topology gateway: a shared bus has no AI side");
    }
    if ((ai_interface != NULL) && (strlen(ai_interface) > CANDUMP_INTERFACE_MAX)) {
        return report("--ai-if: '%s' is too long for an interface name", ai_interface);
    }
    return true;
}

bool log_sides_check_heard(const char *ai_interface, bool was_heard, const char *heard) {
    return (ai_interface == NULL) || was_heard ||
           report("--ai-if: the log has frames from %s, but none from %s", heard, ai_interface);
}

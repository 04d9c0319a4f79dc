#include "common/shipped.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

/* From the folder of the program. */
static const char installed[] = "../share/agv-supervisor/scenarios";
static const char built[] = HOST_SIM_SCENARIOS_FROM_PROGRAM;

/** The folder of the program, with a slash at the end; "" if it is not known. */
static void own_folder(char *folder, size_t size) {
    const ssize_t length = readlink("/proc/self/exe", folder, size - 1u);
    folder[(length > 0) ? length : 0] = '\0';
    char *slash = strrchr(folder, '/');
    if (slash != NULL) {
        slash[1] = '\0';
    }
}

const char *shipped_scenarios(void) {
    static char path[2 * PATH_MAX];
    char folder[PATH_MAX];
    if (path[0] == '\0') {
        own_folder(folder, sizeof folder);
        (void)snprintf(path, sizeof path, "%s%s", folder, built);
        if (access(path, R_OK) != 0) {
            (void)snprintf(path, sizeof path, "%s%s", folder, installed);
        }
    }
    return path;
}

#include "common/shipped.h"

#include <dirent.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { SCENARIOS_MAX = 1000, NAME_SIZE = 64 };

/* From the folder of the program. */
static const char installed[] = "../share/agv-supervisor/scenarios";
static const char built[] = HOST_SIM_SCENARIOS_FROM_PROGRAM;

/** The folder of the program, with a slash at the end; "" if it is not known. */
static void own_folder(char *folder, size_t size) {
    const ssize_t length = readlink("/proc/self/exe", folder, size - 1);
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

const char *shipped_shown(char path[SHIPPED_PATH_SIZE]) {
    char real[PATH_MAX];
    char here[PATH_MAX];
    (void)snprintf(path, SHIPPED_PATH_SIZE, "%s", SHIPPED_PACKAGE);
    if ((realpath(shipped_scenarios(), real) == NULL) || (getcwd(here, sizeof here) == NULL)) {
        return path;
    }
    *strrchr(real, '/') = '\0';
    const size_t length = strlen(here);
    const bool is_below = (strncmp(real, here, length) == 0) && (real[length] == '/');
    (void)snprintf(path, SHIPPED_PATH_SIZE, "%s", is_below ? &real[length + 1] : real);
    return path;
}

/** Names that are being collected. */
typedef struct {
    char names[SCENARIOS_MAX][NAME_SIZE];
    size_t count;
} names_t;

static int compare(const void *a, const void *b) {
    return strcmp(a, b);
}

/** Without the ending of a scenario; 0: it is none, such as a copy of an editor. */
static size_t name_length(const char *file) {
    static const char ending[] = ".yaml";
    const size_t length = strlen(file);
    const size_t without = (length > strlen(ending)) ? length - strlen(ending) : 0;
    return (strcmp(&file[without], ending) == 0) ? without : 0;
}

/** Add the scenarios of a folder. */
static void add_scenarios_of(names_t *names, const char *path) {
    DIR *folder = opendir(path);
    if (folder == NULL) {
        return;
    }
    for (const struct dirent *entry = readdir(folder); entry != NULL; entry = readdir(folder)) {
        const size_t length = name_length(entry->d_name);
        if ((length > 0) && (length < NAME_SIZE) && (names->count < SCENARIOS_MAX)) {
            (void)snprintf(names->names[names->count], NAME_SIZE, "%.*s", (int)length, entry->d_name);
            names->count++;
        }
    }
    (void)closedir(folder);
}

/** Add the scenarios of all topics. */
static void collect_all(names_t *names) {
    DIR *topics = opendir(shipped_scenarios());
    if (topics == NULL) {
        return;
    }
    for (const struct dirent *topic = readdir(topics); topic != NULL; topic = readdir(topics)) {
        char path[PATH_MAX];
        if ((topic->d_name[0] != '.') &&
            (snprintf(path, sizeof path, "%s/%s", shipped_scenarios(), topic->d_name) < (int)sizeof path)) {
            add_scenarios_of(names, path);
        }
    }
    (void)closedir(topics);
}

const char *shipped_scenario_names(void) {
    static char list[SCENARIOS_MAX * NAME_SIZE];
    static names_t names;
    size_t used = 0;
    names.count = 0;
    list[0] = '\0';
    collect_all(&names);
    qsort(names.names, names.count, sizeof names.names[0], compare);
    for (size_t i = 0; (i < names.count) && (used < sizeof list); i++) {
        used += (size_t)snprintf(&list[used], sizeof list - used, "%s%s", (i > 0) ? "|" : "", names.names[i]);
    }
    return list;
}

/**
 * @file cmd_demo.c
 * `host_sim demo`: a scenario played as a timeline.
 */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands/commands.h"
#include "cli/options.h"
#include "common/interrupt.h"
#include "common/shipped.h"
#include "config/config_options.h"
#include "io/events.h"
#include "io/output.h"
#include "scenario/run/scenario_run.h"
#include "ui/timeline.h"

#define MAIN_JOB "demo"

enum { PATH_SIZE = 4096 };

/** The given options. */
typedef struct {
    config_options_t config;
    const char *scenario;
    const char *events;
} given_t;

/** The memory of the command. */
typedef struct {
    char path[PATH_SIZE];
    scenario_options_t options;
    timeline_t timeline;
    output_t events;
    FILE *text_out;
    scenario_run_t run;
} work_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    option_t config_rows[CONFIG_OPTIONS];
    config_options_init(&given->config, config_rows);
    const option_t rows[] = {
        OPTION_TEXT("--scenario", "NAME", "another scenario: its name, or the path of a file", &given->scenario),
        OPTION_TEXT("--events", "FILE", "events as JSON Lines; - prints them in place of the timeline", &given->events),
    };
    const option_group_t groups[] = {
        {.title = "Options", .options = rows, .count = sizeof rows / sizeof rows[0]},
        {.title = "Configuration of the supervisor (settings of the scenario take precedence)",
         .options = config_rows,
         .count = CONFIG_OPTIONS},
    };
    const option_syntax_t syntax = {
        .usage = "demo [OPTION]...",
        .summary =
            "Watch the supervisor on the simulated bus in virtual time: a vehicle drives off on autopilot, its AI\n"
            "computer stops, the supervisor parks the vehicle, the operator resets; then the EPS fails.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
    };
    size_t operands = 0u;
    return options_parse(&syntax, argc, argv, &operands);
}

/** The path of a shipped scenario: it lies in one of the folders. @return what snprintf returns; 0: there is none */
static int find_shipped(const char *name, char path[PATH_SIZE]) {
    const char *folder = shipped_scenarios();
    DIR *topics = opendir(folder);
    int length = 0;

    if (topics == NULL) {
        return 0;
    }
    for (const struct dirent *topic = readdir(topics); topic != NULL; topic = readdir(topics)) {
        length = snprintf(path, PATH_SIZE, "%s/%s/%s.yaml", folder, topic->d_name, name);
        if ((length < 0) || (length >= PATH_SIZE) || (access(path, R_OK) == 0)) {
            break;
        }
        length = 0;
    }
    (void)closedir(topics);
    return length;
}

/** A name is that of a shipped scenario, anything with a slash or an ending is a path. */
static bool find_scenario(const char *name, char path[PATH_SIZE]) {
    const bool is_path = (strchr(name, '/') != NULL) || (strchr(name, '.') != NULL);
    const int length = is_path ? snprintf(path, PATH_SIZE, "%s", name) : find_shipped(name, path);

    if ((length < 0) || (length >= PATH_SIZE)) {
        return report("--scenario: the name is too long");
    }
    if (!is_path && (length == 0)) {
        return report("--scenario: no scenario '%s'; the shipped scenarios are the files in %s", name,
                      shipped_scenarios());
    }
    return true;
}

static status_t print_result(const work_t *work, bool good) {
    const scenario_check_t *check = &work->run.check;

    if (good) {
        (void)fprintf(work->text_out, "\nAll %zu expectations passed.\n", check->expectation_count);
        return STATUS_OK;
    }
    (void)fprintf(work->text_out, "\nExpectations FAILED, %s:\n", work->path);
    for (size_t i = 0u; (i < check->failure_count) && (i < SCENARIO_FAILURES_MAX); i++) {
        (void)fprintf(work->text_out, "  %s\n", check->failures[i]);
    }
    return STATUS_UNMET;
}

static status_t play(work_t *work, const char *events) {
    if (!scenario_read(&work->run.scenario, work->path, &work->options) ||
        ((events != NULL) && !output_open(&work->events, events))) {
        return STATUS_UNUSABLE;
    }
    scenario_watch_t watches[2];
    size_t count = 0u;
    const bool is_told = !output_is_stdout(events);
    work->text_out = is_told ? stdout : stderr;
    if (is_told) {
        timeline_init(&work->timeline, &work->run.testbed);
        watches[count] = timeline_watch(&work->timeline);
        count++;
        (void)printf("%s\n\n", work->run.scenario.name);
    }
    if (events != NULL) {
        watches[count] = (scenario_watch_t){.on_event = events_write, .ctx = &work->events};
        count++;
    }
    const bool good = scenario_run(&work->run, watches, count, is_told ? timeline_step : NULL);
    if (work->run.was_interrupted) {
        return STATUS_UNUSABLE;
    }
    if (work->events.is_open) {
        events_summary_t summary = {0};
        events_summarise(scenario_testbed_session(&work->run.testbed), &summary);
        events_write_summary(&work->events, &summary);
    }
    if (!output_commit(&work->events)) {
        return STATUS_UNUSABLE;
    }
    return print_result(work, good);
}

static bool check_files(const given_t *given, const char *path) {
    const output_role_t roles[] = {
        {.role = "--scenario", .path = path},
        {.role = "--config", .path = given->config.path},
        {.role = "--events", .path = given->events, .is_written = true},
    };
    return output_check_distinct(roles, sizeof roles / sizeof roles[0]);
}

status_t cmd_demo(int argc, char **argv) {
    given_t given = {.scenario = MAIN_JOB};
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    work_t *work = calloc(1u, sizeof *work);
    if (work == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    status_t status = STATUS_UNUSABLE;
    work->options.topology = given.config.topology;
    work->options.id_set = given.config.id_set;
    if (find_scenario(given.scenario, work->path) && check_files(&given, work->path) &&
        config_options_make(&given.config, &work->options.config)) {
        status = play(work, given.events);
    }
    output_discard(&work->events);
    free(work);
    interrupt_release();
    return status;
}

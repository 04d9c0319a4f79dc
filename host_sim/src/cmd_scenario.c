/**
 * @file cmd_scenario.c
 * `host_sim scenario`: scenario files, played and judged.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "commands.h"
#include "config_options.h"
#include "events.h"
#include "junit.h"
#include "options.h"
#include "output.h"
#include "scenario_run.h"

/** The words of --planted, in the order of scenario_planted_t without SCENARIO_REAL. */
#define PLANTED "mute|tripped"

enum { FILES_MAX = 1000, NOT_PLANTED = -1 };

/** What was given. */
typedef struct {
    config_options_t config;
    scenario_options_t options;
    const char *junit;
    const char *events;
    const char *bus;
    int planted;
    size_t file_count;
} given_t;

/** What came of one file. */
typedef struct {
    char name[SCENARIO_TEXT_MAX];
    char failures[SCENARIO_FAILURES_MAX][SCENARIO_FAILURE_SIZE];
    size_t failure_count;
} result_t;

/** What the command works with. */
typedef struct {
    given_t given;
    output_t events;
    output_t junit;
    scenario_run_t run;
    result_t results[];
} work_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    option_t config_rows[CONFIG_OPTIONS];
    config_options_init(&given->config, config_rows);
    const option_t rows[] = {
        {.name = "--junit", .value = "FILE", .help = "results as JUnit XML", .text = &given->junit},
        {.name = "--events", .value = "FILE", .help = "events as JSON Lines (of one scenario)", .text = &given->events},
        {.name = "--bus", .value = "sim", .help = "the simulated bus, in virtual time (sim)", .text = &given->bus},
        {.name = "--planted",
         .value = PLANTED,
         .help = "test of the scenarios: this stands in for the supervisor, all must fail",
         .word = &given->planted,
         .words = PLANTED},
    };
    const option_group_t groups[] = {
        {.title = "Options (FILE may be -, standard output)", .options = rows, .count = sizeof rows / sizeof rows[0]},
        {.title = "Configuration of the supervisor, under what a scenario says",
         .options = config_rows,
         .count = CONFIG_OPTIONS},
    };
    const option_syntax_t syntax = {
        .usage = "scenario [OPTION]... FILE...",
        .summary = "Play scenario files with a simulated vehicle, and say which expectations did not hold.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .operands_min = 1u,
        .operands_max = FILES_MAX,
        .operand = "FILE",
    };
    return options_parse(&syntax, argc, argv, &given->file_count);
}

static bool check_files(const given_t *given, char **files) {
    for (size_t i = 0u; i < given->file_count; i++) {
        const output_role_t roles[] = {
            {.role = "FILE", .path = files[i]},
            {.role = "--config", .path = given->config.path},
            {.role = "--junit", .path = given->junit, .is_written = true},
            {.role = "--events", .path = given->events, .is_written = true},
        };
        if (!output_check_distinct(roles, sizeof roles / sizeof roles[0])) {
            return false;
        }
    }
    return true;
}

static bool check_given(given_t *given, char **files) {
    if ((given->bus != NULL) && (strcmp(given->bus, "sim") != 0)) {
        return report("--bus %s: only the simulated bus (sim) is there", given->bus);
    }
    if ((given->events != NULL) && (given->file_count > 1u)) {
        return report("--events is for one scenario, %zu were given", given->file_count);
    }
    if (!check_files(given, files) || !config_options_make(&given->config, &given->options.config)) {
        return false;
    }
    given->options.topology = given->config.topology;
    given->options.id_set = given->config.id_set;
    return true;
}

/** Read every file once, so that nothing runs when one of them makes no sense. */
static bool check_scenarios(work_t *work, char **files) {
    for (size_t i = 0u; i < work->given.file_count; i++) {
        if (!scenario_read(&work->run.scenario, files[i], &work->given.options)) {
            return false;
        }
    }
    return true;
}

static void print_result(const work_t *work, const char *file, const result_t *result) {
    if (result->failure_count == 0u) {
        (void)printf("ok      %s: %zu expectations\n", file, work->run.check.expectation_count);
        return;
    }
    (void)printf("FAILED  %s: %zu of %zu expectations\n", file, result->failure_count,
                 work->run.check.expectation_count);
    for (size_t i = 0u; (i < result->failure_count) && (i < SCENARIO_FAILURES_MAX); i++) {
        (void)printf("        %s\n", result->failures[i]);
    }
}

static bool play(work_t *work, const char *file, result_t *result) {
    const scenario_watch_t watch = {.on_event = events_write, .ctx = &work->events};
    const given_t *given = &work->given;
    const scenario_planted_t planted =
        (given->planted == NOT_PLANTED) ? SCENARIO_REAL : (scenario_planted_t)(given->planted + 1);

    if (!scenario_read(&work->run.scenario, file, &given->options)) {
        return false;
    }
    (void)scenario_run(&work->run, planted, (given->events != NULL) ? &watch : NULL, NULL);
    if (given->events != NULL) {
        events_summary_t summary;
        events_summarise(&work->run.world.session, &summary);
        events_write_summary(&work->events, &summary);
    }
    memcpy(result->name, work->run.scenario.name, sizeof result->name);
    memcpy(result->failures, work->run.check.failures, sizeof result->failures);
    result->failure_count = work->run.check.failure_count;
    print_result(work, file, result);
    return true;
}

static void write_junit(work_t *work, char **files, size_t failed) {
    junit_begin(&work->junit, "scenarios", work->given.file_count, failed);
    for (size_t i = 0u; i < work->given.file_count; i++) {
        const result_t *result = &work->results[i];
        const size_t shown =
            (result->failure_count < SCENARIO_FAILURES_MAX) ? result->failure_count : SCENARIO_FAILURES_MAX;
        junit_test(&work->junit, files[i], result->name, result->failures[0], shown, SCENARIO_FAILURE_SIZE);
    }
    junit_end(&work->junit);
}

static status_t play_all(work_t *work, char **files) {
    size_t failed = 0u;

    for (size_t i = 0u; i < work->given.file_count; i++) {
        if (!play(work, files[i], &work->results[i])) {
            return STATUS_UNUSABLE;
        }
        failed += (work->results[i].failure_count != 0u) ? 1u : 0u;
    }
    (void)printf("%zu scenarios: %zu passed, %zu failed\n", work->given.file_count, work->given.file_count - failed,
                 failed);
    if (work->given.junit != NULL) {
        write_junit(work, files, failed);
    }
    if (!output_commit(&work->events) || !output_commit(&work->junit)) {
        return STATUS_UNUSABLE;
    }
    return (failed == 0u) ? STATUS_OK : STATUS_UNMET;
}

static status_t run_all(work_t *work, char **files) {
    const given_t *given = &work->given;

    if (!check_scenarios(work, files) || ((given->junit != NULL) && !output_open(&work->junit, given->junit)) ||
        ((given->events != NULL) && !output_open(&work->events, given->events))) {
        return STATUS_UNUSABLE;
    }
    return play_all(work, files);
}

status_t cmd_scenario(int argc, char **argv) {
    given_t given = {.planted = NOT_PLANTED};
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    if (!check_given(&given, argv)) {
        return STATUS_UNUSABLE;
    }
    work_t *work = calloc(1u, sizeof *work + (given.file_count * sizeof work->results[0]));
    if (work == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    work->given = given;
    const status_t status = run_all(work, argv);
    output_discard(&work->events);
    output_discard(&work->junit);
    free(work);
    return status;
}

/**
 * @file cmd_demo.c
 * `host_sim demo`: a scenario played as a timeline.
 */
#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "analysis/analysis.h"
#include "analysis/analysis_options.h"
#include "cli/commands/commands.h"
#include "cli/options.h"
#include "common/interrupt.h"
#include "common/shipped.h"
#include "config/config_options.h"
#include "config/config_text.h"
#include "io/events.h"
#include "io/output.h"
#include "scenario/run/scenario_analysis.h"
#include "scenario/run/scenario_run.h"
#include "text/suggest.h"
#include "text/units.h"
#include "text/words.h"
#include "ui/timeline.h"

#define MAIN_JOB "demo"

enum { PATH_SIZE = 4096, FIXED_FILES = 3 };

/** The given options. */
typedef struct {
    config_options_t config;
    analysis_paths_t analysis;
    const char *scenario;
    const char *events;
} given_t;

/** The memory of the command. */
typedef struct {
    char path[PATH_SIZE];
    scenario_options_t options;
    timeline_t timeline;
    analysis_t *analysis; /* NULL: not asked for */
    output_t events;
    FILE *text_out;
    scenario_run_t run;
} work_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    option_t config_rows[CONFIG_OPTIONS];
    option_t analysis_rows[ANALYSIS_OPTIONS];
    config_options_init(&given->config, config_rows);
    analysis_options_init(&given->analysis, analysis_rows);
    const option_t rows[] = {
        {.name = "--scenario",
         .value = "NAME|FILE",
         .help = "another scenario: its name, or the path of a file",
         .text = &given->scenario,
         .candidates = shipped_scenario_names},
        OPTION_TEXT("--events", "FILE", "events as JSON Lines; - prints them in place of the timeline", &given->events),
    };
    const option_group_t groups[] = {
        {.title = "Options", .options = rows, .count = sizeof rows / sizeof rows[0]},
        {.options = analysis_rows, .count = ANALYSIS_OPTIONS},
        {.title = "Configuration of the supervisor (settings of the scenario take precedence)",
         .options = config_rows,
         .count = CONFIG_OPTIONS},
    };
    static const option_example_t examples[] = {
        {"host_sim demo", "the timeline"},
        {"host_sim demo --scenario park_at_standstill", "another scenario"},
        {"host_sim demo --report why.html", "a page that says why it tripped"},
    };
    const option_syntax_t syntax = {
        .usage = "demo [OPTION]...",
        .summary =
            "Watch the supervisor on the simulated bus in virtual time: a vehicle drives off on autopilot, its AI\n"
            "computer stops, the supervisor parks the vehicle, the operator resets; then the EPS fails.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .instead = "--scenario",
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0;
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
    if (!is_path && (length == 0) && (access(shipped_scenarios(), R_OK) != 0)) {
        return report("no folder %s; keep the program with its share folder, or give --scenario FILE",
                      shipped_scenarios());
    }
    if (!is_path && (length == 0)) {
        char meant[SUGGEST_SIZE];
        (void)suggest_from(shipped_scenario_names(), name, meant);
        return (meant[0] != '\0')
                   ? report("--scenario: no scenario '%s'%s", name, meant)
                   : report(
                         "--scenario: no scenario '%s'; the shipped scenarios are the .yaml files in the folders of %s",
                         name, shipped_scenarios());
    }
    return true;
}

static status_t print_result(const work_t *work, bool good) {
    const scenario_check_t *check = &work->run.check;
    const char *space = (work->text_out == stdout) ? "\n" : ""; /* below the timeline */

    if (good) {
        const size_t count = check->expectation_count;
        (void)fprintf(work->text_out, "%sAll %zu expectation%s passed.\n", space, count, words_plural(count));
        return STATUS_OK;
    }
    (void)fprintf(work->text_out, "%sExpectations FAILED, %s:\n", space, work->path);
    for (size_t i = 0; (i < check->failure_count) && (i < SCENARIO_FAILURES_MAX); i++) {
        (void)fprintf(work->text_out, "  %s\n", check->failures[i]);
    }
    return STATUS_UNMET;
}

/** Read the scenario, and open what is written. @return false: reported */
static bool prepare(work_t *work, const given_t *given) {
    if (!scenario_read(&work->run.scenario, work->path, &work->options) ||
        ((given->events != NULL) && !output_open(&work->events, given->events))) {
        return false;
    }
    if (!analysis_paths_any(&given->analysis)) {
        return true;
    }
    analysis_request_t request = {.config = &work->run.scenario.config, .log = work->run.scenario.name};
    request.files = given->analysis;
    work->analysis = analysis_new(&request);
    return (work->analysis != NULL) && analysis_open(work->analysis);
}

/** Put the files in their place. @return false: reported */
static bool finish(work_t *work) {
    const session_t *session = scenario_testbed_session(&work->run.testbed);
    if (work->events.is_open) {
        events_summary_t summary = {0};
        events_summarise(session, &summary);
        events_write_summary(&work->events, &summary);
    }
    if (work->analysis != NULL) {
        analysis_end(work->analysis, session->t_ms * US_PER_MS);
        analysis_write(work->analysis);
        return output_flush_all(&work->events, 1) && analysis_commit(work->analysis) && output_commit(&work->events);
    }
    return output_commit(&work->events);
}

static status_t play(work_t *work, const given_t *given) {
    if (!prepare(work, given)) {
        return STATUS_UNUSABLE;
    }
    config_note_deviations(&work->options.config);
    scenario_watch_t watches[3];
    size_t count = 0;
    const bool is_told = !output_is_stdout(given->events) && !analysis_paths_use_stdout(&given->analysis);
    work->text_out = is_told ? stdout : stderr;
    if (is_told) {
        timeline_init(&work->timeline, &work->run.testbed);
        watches[count] = timeline_watch(&work->timeline);
        count++;
        (void)printf("%s\n\n", work->run.scenario.name);
    }
    if (given->events != NULL) {
        watches[count] = (scenario_watch_t){.on_event = events_write, .ctx = &work->events};
        count++;
    }
    if (work->analysis != NULL) {
        watches[count] = scenario_analysis_watch(work->analysis);
        count++;
    }
    const bool good = scenario_run(&work->run, watches, count, is_told ? timeline_step : NULL);
    if (work->run.was_interrupted || !finish(work)) {
        return STATUS_UNUSABLE;
    }
    return print_result(work, good);
}

static bool check_files(const given_t *given, const char *path) {
    output_role_t roles[FIXED_FILES + (int)ANALYSIS_FILES] = {
        {.role = "--scenario", .path = path},
        {.role = "--config", .path = given->config.path},
        {.role = "--events", .path = given->events, .is_written = true},
    };
    analysis_options_roles(&given->analysis, &roles[FIXED_FILES]);
    return output_check_distinct(roles, sizeof roles / sizeof roles[0]);
}

status_t cmd_demo(int argc, char **argv) {
    given_t given = {.scenario = MAIN_JOB};
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    work_t *work = calloc(1, sizeof *work);
    if (work == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    status_t status = STATUS_UNUSABLE;
    work->options.topology = given.config.topology;
    work->options.id_set = given.config.id_set;
    if (find_scenario(given.scenario, work->path) && check_files(&given, work->path) &&
        config_options_make(&given.config, &work->options.config)) {
        status = play(work, &given);
    }
    output_discard(&work->events);
    analysis_free(work->analysis);
    free(work);
    interrupt_release();
    return status;
}

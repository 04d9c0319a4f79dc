/**
 * @file cmd_scenario.c
 * `host_sim scenario`: scenario files, played and evaluated.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "analysis/analysis.h"
#include "analysis/analysis_options.h"
#include "cli/commands/commands.h"
#include "cli/commands/scenario_bus_options.h"
#include "cli/commands/skeleton_options.h"
#include "cli/options.h"
#include "common/interrupt.h"
#include "config/config_options.h"
#include "config/config_text.h"
#include "io/events.h"
#include "io/junit.h"
#include "io/output.h"
#include "io/yaml_schema.h"
#include "live/scenario_bus.h"
#include "logs/candump_line.h"
#include "scenario/parse/scenario_schema.h"
#include "scenario/run/scenario_analysis.h"
#include "scenario/run/scenario_run.h"
#include "text/text.h"
#include "text/units.h"
#include "text/words.h"

enum { FILES_MAX = 1000, FIXED_FILES = 5 };

/** Its outputs. */
enum { EVENTS, JUNIT, SENT, OUTPUTS };

/** The given options. */
typedef struct {
    config_options_t config;
    analysis_paths_t analysis;
    scenario_options_t options;
    const char *junit;
    const char *events;
    bool is_schema;
    scenario_bus_options_t bus;
    skeleton_options_t from;
    size_t file_count;
} given_t;

/** The result of one file. */
typedef struct {
    char name[SCENARIO_TEXT_MAX];
    char failures[SCENARIO_FAILURES_MAX][SCENARIO_FAILURE_SIZE];
    size_t failure_count;
    const char *left_out; /**< why it was not played; NULL: it was */
} result_t;

/** The result of all files. */
typedef struct {
    size_t passed;
    size_t failed;
    size_t left_out;
} totals_t;

/** The memory of the command. */
typedef struct {
    given_t given;
    FILE *text_out; /* results as text: standard error if an output goes to standard output */
    output_t outputs[OUTPUTS];
    analysis_t *analysis; /* NULL: not asked for */
    scenario_run_t run;
    result_t results[];
} work_t;

static options_result_t parse(int argc, char **argv, given_t *given) {
    option_t config_rows[CONFIG_OPTIONS];
    option_t analysis_rows[ANALYSIS_OPTIONS];
    config_options_init(&given->config, config_rows);
    analysis_options_init(&given->analysis, analysis_rows);
    option_t from_rows[SKELETON_OPTIONS];
    skeleton_options_init(&given->from, from_rows);
    option_t bus_rows[SCENARIO_BUS_OPTIONS];
    scenario_bus_options_init(&given->bus, bus_rows);
    const option_t rows[] = {
        OPTION_TEXT("--junit", "FILE", "results as JUnit XML", &given->junit),
        OPTION_TEXT("--events", "FILE", "events as JSON Lines (of one scenario)", &given->events),
    };
    const option_t schema_rows[] = {
        OPTION_FLAG("--schema", "print the JSON Schema of a scenario file, and run nothing", &given->is_schema),
    };
    const option_group_t groups[] = {
        {.title = "Options (FILE may be -, standard output)", .options = rows, .count = sizeof rows / sizeof rows[0]},
        {.options = bus_rows, .count = SCENARIO_BUS_OPTIONS},
        {.options = schema_rows, .count = sizeof schema_rows / sizeof schema_rows[0]},
        {.options = analysis_rows, .count = ANALYSIS_OPTIONS},
        {.title = "A scenario from a log", .options = from_rows, .count = SKELETON_OPTIONS},
        {.title = "Configuration of the supervisor (settings of a scenario take precedence)",
         .options = config_rows,
         .count = CONFIG_OPTIONS},
    };
    static const option_example_t examples[] = {
        {"host_sim scenario @/scenarios/overview/demo.yaml", "one scenario"},
        {"host_sim scenario --junit results.xml @/scenarios/reset/*.yaml", "many, with results for a CI server"},
        {"host_sim scenario --bus vcan0 @/scenarios/overview/demo.yaml", "on a CAN interface, in real time"},
    };
    const option_syntax_t syntax = {
        .usage = "scenario [OPTION]... FILE...",
        .summary =
            "Run scenario files with a simulated vehicle, and report the expectations that failed.\n"
            "In a file, times are 250ms, 1.5s, or milliseconds alone; identifiers are 168h, 0x168 or decimal 360.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
        .operands_max = FILES_MAX,
        .operand = "FILE",
    };
    return options_parse(&syntax, argc, argv, &given->file_count);
}

static bool check_files(const given_t *given, char **files) {
    for (size_t i = 0; i < given->file_count; i++) {
        output_role_t roles[FIXED_FILES + (int)ANALYSIS_FILES] = {
            {.role = "FILE", .path = files[i]},
            {.role = "--config", .path = given->config.path},
            {.role = "--junit", .path = given->junit, .is_written = true},
            {.role = "--events", .path = given->events, .is_written = true},
            {.role = "--sent", .path = given->bus.sent, .is_written = true},
        };
        analysis_options_roles(&given->analysis, &roles[FIXED_FILES]);
        if (!output_check_distinct(roles, sizeof roles / sizeof roles[0])) {
            return false;
        }
    }
    return true;
}

static bool check_given(given_t *given, char **files) {
    if (!scenario_bus_options_check(&given->bus)) {
        return false;
    }
    const bool is_of_one = (given->events != NULL) || (given->bus.sent != NULL) || analysis_paths_any(&given->analysis);
    if (is_of_one && (given->file_count > 1)) {
        return report("--events, --sent, --why, --report and --trace need a single scenario, %zu were given",
                      given->file_count);
    }
    if (scenario_bus_options_is_real(&given->bus) && analysis_paths_any(&given->analysis)) {
        return report("--why, --report and --trace need the simulated bus; on CAN interfaces host_sim run has them");
    }
    if (!check_files(given, files) || !config_options_make(&given->config, &given->options.config)) {
        return false;
    }
    given->options.topology = given->config.topology;
    given->options.id_set = given->config.id_set;
    return true;
}

/** Whether --bus names the interfaces that a scenario needs. */
static bool check_place(const work_t *work, const char *file) {
    const scenario_t *scenario = &work->run.scenario;
    const scenario_bus_t bus = scenario_bus_options_bus(&work->given.bus);
    if (scenario_bus_options_is_real(&work->given.bus) && scenario->vehicle.gateway &&
        (bus.interfaces[HAL_CAN_AI] == NULL)) {
        return report("%s: the gateway topology needs two interfaces: --bus %s,IF", file,
                      bus.interfaces[HAL_CAN_VEHICLE]);
    }
    return true;
}

/** Several files are read twice, which a pipe cannot be. One that is not there is for who reads it. */
static bool check_readable_twice(const given_t *given, const char *file) {
    struct stat found;
    return (given->file_count == 1) || (stat(file, &found) != 0) || S_ISREG(found.st_mode) ||
           report("%s: not a regular file, which is needed to run several scenarios", file);
}

/** Read every file once, so that nothing runs when one of them makes no sense. @return NULL: all do; else that one */
static const char *find_unusable(work_t *work, char **files) {
    for (size_t i = 0; i < work->given.file_count; i++) {
        if (!check_readable_twice(&work->given, files[i]) ||
            !scenario_read(&work->run.scenario, files[i], &work->given.options) || !check_place(work, files[i])) {
            return files[i];
        }
    }
    const scenario_bus_t bus = scenario_bus_options_bus(&work->given.bus);
    return (!scenario_bus_options_is_real(&work->given.bus) || scenario_bus_check(&bus)) ? NULL : work->given.bus.bus;
}

static void print_result(const work_t *work, const char *file, const result_t *result) {
    const size_t count = work->run.check.expectation_count;
    const char *plural = words_plural(count);
    text_t copy;
    const char *name = text_one_line(&copy, file);
    if (result->failure_count == 0) {
        (void)fprintf(work->text_out, "ok      %s: %zu expectation%s\n", name, count, plural);
        return;
    }
    (void)fprintf(work->text_out, "FAILED  %s: %zu of %zu expectation%s\n", name, result->failure_count, count, plural);
    for (size_t i = 0; (i < result->failure_count) && (i < SCENARIO_FAILURES_MAX); i++) {
        (void)fprintf(work->text_out, "        %s\n", result->failures[i]);
    }
}

/** What the simulated run is analysed with. @return false: reported */
static bool open_analysis(work_t *work) {
    analysis_request_t request = {.config = &work->run.scenario.config, .log = work->run.scenario.name};
    if (!analysis_paths_any(&work->given.analysis)) {
        return true;
    }
    request.files = work->given.analysis;
    work->analysis = analysis_new(&request);
    return (work->analysis != NULL) && analysis_open(work->analysis);
}

/** Play it on the simulated bus. */
static void play_simulated(work_t *work, events_summary_t *summary) {
    const session_t *session = scenario_testbed_session(&work->run.testbed);
    scenario_watch_t watches[2];
    size_t count = 0;

    if (work->given.events != NULL) {
        watches[count] = (scenario_watch_t){.on_event = events_write, .ctx = &work->outputs[EVENTS]};
        count++;
    }
    if (work->analysis != NULL) {
        watches[count] = scenario_analysis_watch(work->analysis);
        count++;
    }
    (void)scenario_run(&work->run, watches, count, NULL);
    events_summarise(session, summary);
    if (work->analysis != NULL) {
        analysis_end(work->analysis, session->t_ms * US_PER_MS);
        analysis_write(work->analysis);
    }
}

/** A frame of the supervisor, as a line of a log. */
static void write_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us) {
    work_t *work = ctx;
    char line[CANDUMP_WRITE_MAX];
    (void)output_write(&work->outputs[SENT], line,
                       candump_write(line, at_us, work->given.bus.interface_names[side], frame));
}

/** Play it on CAN interfaces, or leave it out. @return false: reported */
static bool play_real(work_t *work, events_summary_t *summary, const char **left_out) {
    const scenario_bus_watch_t watch = {
        .on_event = (work->given.events != NULL) ? events_write : NULL,
        .event_ctx = &work->outputs[EVENTS],
        .on_sent = (work->given.bus.sent != NULL) ? write_sent : NULL,
        .sent_ctx = work,
    };
    const scenario_bus_t bus = scenario_bus_options_bus(&work->given.bus);

    *left_out = scenario_bus_leaves_out(&bus, &work->run.scenario);
    if (*left_out != NULL) {
        return true;
    }
    scenario_bus_tolerate(&bus, &work->run.scenario);
    scenario_check_init(&work->run.check, &work->run.scenario);
    return scenario_bus_play(&bus, &work->run.check, &watch, summary);
}

static bool play(work_t *work, const char *file, result_t *result) {
    events_summary_t summary = {0};

    if ((work->given.file_count > 1) && !scenario_read(&work->run.scenario, file, &work->given.options)) {
        return false;
    }
    if (!scenario_bus_options_is_real(&work->given.bus)) {
        play_simulated(work, &summary);
        if (work->run.was_interrupted) {
            return false;
        }
    } else if (!play_real(work, &summary, &result->left_out)) {
        return false;
    } else if (result->left_out != NULL) {
        return true;
    }
    if ((work->given.events != NULL) && (work->given.bus.supervisor == NULL)) {
        events_write_summary(&work->outputs[EVENTS], &summary);
    }
    memcpy(result->name, work->run.scenario.name, sizeof result->name);
    memcpy(result->failures, work->run.check.failures, sizeof result->failures);
    result->failure_count = work->run.check.failure_count;
    print_result(work, file, result);
    return true;
}

/** @param played so many files were played @param unusable what could not be played then; NULL: nothing */
static void write_junit(work_t *work, char **files, const totals_t *totals, size_t played, const char *unusable) {
    const size_t errors = (unusable != NULL) ? 1 : 0;
    junit_begin(&work->outputs[JUNIT], "scenarios", totals->passed + totals->failed + errors, totals->failed, errors);
    for (size_t i = 0; i < played; i++) {
        const result_t *result = &work->results[i];
        const size_t shown =
            (result->failure_count < SCENARIO_FAILURES_MAX) ? result->failure_count : SCENARIO_FAILURES_MAX;
        if (result->left_out == NULL) {
            junit_test(&work->outputs[JUNIT], files[i], result->name, result->failures[0], shown,
                       SCENARIO_FAILURE_SIZE);
        }
    }
    if (unusable != NULL) {
        junit_error(&work->outputs[JUNIT], unusable, unusable, "could not be run; standard error says why");
    }
    junit_end(&work->outputs[JUNIT]);
}

/** An older file of --junit would pass for the result of this run, so it says what could not be played. */
static status_t give_up(work_t *work, char **files, const totals_t *totals, size_t played, const char *unusable) {
    if (work->outputs[JUNIT].is_open && !interrupt_pending()) {
        write_junit(work, files, totals, played, unusable);
        (void)output_commit(&work->outputs[JUNIT]);
    }
    return STATUS_UNUSABLE;
}

static void count(totals_t *totals, const result_t *result) {
    if (result->left_out != NULL) {
        totals->left_out++;
    } else if (result->failure_count != 0) {
        totals->failed++;
    } else {
        totals->passed++;
    }
}

/** The last lines: what was left out, and the sum. */
static void print_totals(const work_t *work, char **files, const totals_t *totals) {
    for (size_t i = 0; i < work->given.file_count; i++) {
        if (work->results[i].left_out != NULL) {
            text_t name;
            (void)fprintf(work->text_out, "left out %s: %s\n", text_one_line(&name, files[i]),
                          work->results[i].left_out);
        }
    }
    (void)fprintf(work->text_out, "%zu scenario%s: %zu passed, %zu failed", work->given.file_count,
                  words_plural(work->given.file_count), totals->passed, totals->failed);
    if (scenario_bus_options_is_real(&work->given.bus)) {
        (void)fprintf(work->text_out, ", %zu left out", totals->left_out);
    }
    (void)fprintf(work->text_out, "\n");
}

static status_t play_all(work_t *work, char **files) {
    totals_t totals = {0};

    for (size_t i = 0; i < work->given.file_count; i++) {
        if (!play(work, files[i], &work->results[i])) {
            return give_up(work, files, &totals, i, files[i]);
        }
        count(&totals, &work->results[i]);
        if (scenario_bus_options_is_real(&work->given.bus)) {
            (void)fflush(work->text_out); /* it takes its time until the next line */
        }
    }
    print_totals(work, files, &totals);
    if (work->given.junit != NULL) {
        write_junit(work, files, &totals, work->given.file_count, NULL);
    }
    if (((work->analysis != NULL) && (!output_flush_all(work->outputs, OUTPUTS) || !analysis_commit(work->analysis))) ||
        !output_commit_all(work->outputs, OUTPUTS)) {
        return STATUS_UNUSABLE;
    }
    return (totals.failed == 0) ? STATUS_OK : STATUS_UNMET;
}

static status_t run_all(work_t *work, char **files) {
    const given_t *given = &work->given;
    const totals_t none = {0};

    if ((given->junit != NULL) && !output_open(&work->outputs[JUNIT], given->junit)) {
        return STATUS_UNUSABLE;
    }
    const char *unusable = find_unusable(work, files);
    if (unusable != NULL) {
        return give_up(work, files, &none, 0, unusable);
    }
    if (((given->events != NULL) && !output_open(&work->outputs[EVENTS], given->events)) ||
        ((given->bus.sent != NULL) && !output_open(&work->outputs[SENT], given->bus.sent)) || !open_analysis(work)) {
        return give_up(work, files, &none, 0, files[0]);
    }
    config_note_deviations(&given->options.config);
    return play_all(work, files);
}

/** What runs no scenario. */
static status_t run_none(given_t *given) {
    const bool any = (given->junit != NULL) || (given->events != NULL) || scenario_bus_options_any(&given->bus) ||
                     analysis_paths_any(&given->analysis);
    if (any || (given->is_schema && (given->from.log != NULL))) {
        (void)report("%s runs no scenario, so it takes no option of a run", given->is_schema ? "--schema" : "--from");
        return STATUS_UNUSABLE;
    }
    if (given->file_count > 0) {
        (void)report("%s takes no FILE", given->is_schema ? "--schema" : "--from");
        return STATUS_UNUSABLE;
    }
    if (given->from.log != NULL) {
        return skeleton_options_run(&given->from, &given->config);
    }
    return yaml_schema_print(scenario_schema(), "Scenario of the AGV safety supervisor") ? STATUS_OK : STATUS_UNUSABLE;
}

status_t cmd_scenario(int argc, char **argv) {
    given_t given = {0};
    const options_result_t parsed = parse(argc, argv, &given);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    if (!skeleton_options_check(&given.from)) {
        return STATUS_UNUSABLE;
    }
    if (given.is_schema || (given.from.log != NULL)) {
        return run_none(&given);
    }
    if (given.file_count == 0) {
        (void)report("FILE is missing; see host_sim scenario --help");
        return STATUS_UNUSABLE;
    }
    if (!check_given(&given, argv)) {
        return STATUS_UNUSABLE;
    }
    work_t *work = calloc(1, sizeof *work + (given.file_count * sizeof work->results[0]));
    if (work == NULL) {
        (void)report("out of memory");
        return STATUS_UNUSABLE;
    }
    work->given = given;
    const bool is_taken = output_is_stdout(given.junit) || output_is_stdout(given.events) ||
                          output_is_stdout(given.bus.sent) || analysis_paths_use_stdout(&given.analysis);
    work->text_out = is_taken ? stderr : stdout;
    const status_t status = run_all(work, argv);
    for (size_t i = 0; i < OUTPUTS; i++) {
        output_discard(&work->outputs[i]);
    }
    analysis_free(work->analysis);
    const bool was_interrupted = work->run.was_interrupted;
    free(work);
    if (was_interrupted) {
        interrupt_release(); /* on CAN interfaces it was reported */
    }
    return status;
}

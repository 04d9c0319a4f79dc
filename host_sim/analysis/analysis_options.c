#include "analysis/analysis_options.h"

void analysis_options_init(analysis_paths_t *options, option_t rows[ANALYSIS_OPTIONS]) {
    *options = (analysis_paths_t){{NULL}};
    rows[0] = (option_t)OPTION_TEXT("--why", "FILE", "why it tripped, as JSON", &options->paths[ANALYSIS_WHY]);
    rows[1] = (option_t)OPTION_TEXT("--report", "FILE", "the same as a page with pictures (HTML)",
                                    &options->paths[ANALYSIS_REPORT]);
    rows[2] = (option_t)OPTION_TEXT("--trace", "FILE", "the run as Chrome trace events, which ui.perfetto.dev shows",
                                    &options->paths[ANALYSIS_TRACE]);
}

options_result_t analysis_options_parse(const analysis_command_t *command, int argc, char **argv,
                                        analysis_paths_t *analysis, config_options_t *config) {
    option_t config_rows[CONFIG_OPTIONS];
    option_t analysis_rows[ANALYSIS_OPTIONS];
    config_options_init(config, config_rows);
    option_t *shadow = &config_rows[CONFIG_OPTIONS - 1];
    shadow->help = (command->shadow_help != NULL) ? command->shadow_help : shadow->help;
    analysis_options_init(analysis, analysis_rows);
    const option_group_t groups[] = {
        {.title = "Options (FILE may be -, standard output)", .options = analysis_rows, .count = ANALYSIS_OPTIONS},
        {.options = command->rows, .count = command->row_count},
        {.title = command->config_title, .options = config_rows, .count = CONFIG_OPTIONS},
    };
    const option_syntax_t syntax = {
        .usage = command->usage,
        .summary = command->summary,
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .examples = command->examples,
        .example_count = command->example_count,
        .operands_min = 1,
        .operands_max = 1,
        .operand = command->operand,
    };
    size_t operands = 0;
    return options_parse(&syntax, argc, argv, &operands);
}

void analysis_options_roles(const analysis_paths_t *options, output_role_t roles[ANALYSIS_FILES]) {
    static const char *const names[ANALYSIS_FILES] = {
        [ANALYSIS_WHY] = "--why", [ANALYSIS_REPORT] = "--report", [ANALYSIS_TRACE] = "--trace"};
    for (size_t i = 0; i < ANALYSIS_FILES; i++) {
        roles[i] = (output_role_t){.role = names[i], .path = options->paths[i], .is_written = true};
    }
}

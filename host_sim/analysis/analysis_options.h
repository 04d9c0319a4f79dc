/**
 * @file analysis_options.h
 * The options of every command that can say why the supervisor tripped.
 */
#ifndef HOST_SIM_ANALYSIS_OPTIONS_H
#define HOST_SIM_ANALYSIS_OPTIONS_H

#include <stdbool.h>

#include "analysis/analysis.h"
#include "cli/options.h"
#include "config/config_options.h"
#include "io/output.h"

#define ANALYSIS_OPTIONS 3u

/** Nothing given. @param rows are filled in with the options */
void analysis_options_init(analysis_paths_t *options, option_t rows[ANALYSIS_OPTIONS]);

/** A command that analyses one file. */
typedef struct {
    const char *usage;
    const char *summary;
    const char *operand; /**< the file: "LOG" */
    const char *config_title;
    const char *shadow_help;
    /**< of the option --shadow; NULL: as in every command */ /**< of the group of the configuration */
    const option_t *rows;                                     /**< its own options */
    size_t row_count;
    const option_example_t *examples;
    size_t example_count;
} analysis_command_t;

/** Parse its command line: the files of the analysis, its own options, the configuration, and the one file. */
options_result_t analysis_options_parse(const analysis_command_t *command, int argc, char **argv,
                                        analysis_paths_t *analysis, config_options_t *config);

/** The roles of the files, for output_check_distinct(). */
void analysis_options_roles(const analysis_paths_t *options, output_role_t roles[ANALYSIS_FILES]);

#endif

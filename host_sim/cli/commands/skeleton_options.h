/**
 * @file skeleton_options.h
 * `host_sim scenario --from LOG`: a scenario file from a log.
 */
#ifndef HOST_SIM_SKELETON_OPTIONS_H
#define HOST_SIM_SKELETON_OPTIONS_H

#include "cli/options.h"
#include "common/report.h"
#include "config/config_options.h"

#define SKELETON_OPTIONS 4u

/** Its options. */
typedef struct {
    const char *log; /**< --from; NULL: not given */
    const char *out;
    const char *ai_interface;
    bool skip_bad_lines;
} skeleton_options_t;

/** Nothing given. @param rows are filled in with the options */
void skeleton_options_init(skeleton_options_t *from, option_t rows[SKELETON_OPTIONS]);

/** Whether an option was given that needs --from. @return false: reported */
bool skeleton_options_check(const skeleton_options_t *from);

/** Make the file. */
status_t skeleton_options_run(const skeleton_options_t *from, config_options_t *config);

#endif

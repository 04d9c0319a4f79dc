/**
 * @file config_options.h
 * The options of the supervisor's configuration, the same for every command.
 */
#ifndef HOST_SIM_CONFIG_OPTIONS_H
#define HOST_SIM_CONFIG_OPTIONS_H

#include <stdbool.h>

#include "agv/config.h"
#include "cli/options.h"

#define CONFIG_OPTIONS 4u
#define CONFIG_OPTIONS_OF_BUS 3u /**< the first ones, which also matter to other nodes */

/** What was given. Start from config_options_init(). */
typedef struct {
    const char *path; /**< --config; NULL: not given */
    int topology;     /**< --topology; -1: not given */
    int id_set;       /**< --id-set; -1: not given */
    bool shadow;      /**< --shadow */
    bool has_ai_side; /**< --ai-can or --ai-if was given: a gateway, unless --topology or the file sets the topology */
} config_options_t;

/**
 * Nothing given.
 * @param rows are filled in with the options; for the command's option groups
 */
void config_options_init(config_options_t *options, option_t rows[CONFIG_OPTIONS]);

/**
 * Make the configuration: defaults, changed by the file, changed by the options, checked as a whole.
 * @return false: it makes no sense; was reported.
 */
bool config_options_make(const config_options_t *options, agv_config_t *config);

#endif

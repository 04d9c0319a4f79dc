#include "config/config_options.h"

#include <string.h>

#include "config/config_file.h"

enum { NOT_GIVEN = -1 };

void config_options_init(config_options_t *options, option_t rows[CONFIG_OPTIONS]) {
    options->path = NULL;
    options->topology = NOT_GIVEN;
    options->id_set = NOT_GIVEN;
    options->shadow = false;
    options->has_ai_side = false;
    const option_t all[CONFIG_OPTIONS] = {
        OPTION_TEXT("--config", "FILE", "settings (YAML); see host_sim config", &options->path),
        OPTION_WORD("--topology", "one bus for all, or an AI side and a vehicle side", &options->topology,
                    "shared|gateway"),
        OPTION_WORD("--id-set", "43Fh and 363h, or 201h and 203h", &options->id_set, "heading|table"),
        OPTION_FLAG("--shadow", "supervise, but send nothing", &options->shadow),
    };
    (void)memcpy(rows, all, sizeof all);
}

bool config_options_make(const config_options_t *options, agv_config_t *config) {
    config_lines_t lines;
    (void)memset(&lines, 0, sizeof lines);
    agv_config_defaults(config);
    if ((options->path != NULL) && !config_file_load(options->path, config, &lines)) {
        return false;
    }
    if (options->topology != NOT_GIVEN) {
        config->topology = (uint16_t)options->topology;
    } else if (options->has_ai_side && (lines.settings[AGV_SETTING_topology] == 0)) {
        config->topology = AGV_TOPOLOGY_GATEWAY;
    }
    if (options->id_set != NOT_GIVEN) {
        config->id_set = (uint16_t)options->id_set;
    }
    if (options->shadow) {
        config->shadow = AGV_SHADOW_ON;
    }
    return config_check(config, &lines);
}

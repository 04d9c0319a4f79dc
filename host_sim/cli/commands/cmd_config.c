/**
 * @file cmd_config.c
 * `host_sim config`.
 */
#include "cli/commands/commands.h"
#include "cli/options.h"
#include "config/config_options.h"
#include "config/config_schema.h"
#include "config/config_text.h"
#include "io/yaml_schema.h"

static status_t print(const config_options_t *given, bool is_schema, bool to_kconfig) {
    if (is_schema && to_kconfig) {
        (void)report("give only one of --schema and --to-kconfig");
        return STATUS_UNUSABLE;
    }
    if (is_schema && ((given->path != NULL) || (given->topology >= 0) || (given->id_set >= 0) || given->shadow)) {
        (void)report("--schema prints the schema of every configuration: give no configuration with it");
        return STATUS_UNUSABLE;
    }
    if (is_schema) {
        return yaml_schema_print(config_schema(false), "Configuration of the AGV safety supervisor") ? STATUS_OK
                                                                                                     : STATUS_UNUSABLE;
    }
    agv_config_t config;
    if (!config_options_make(given, &config)) {
        return STATUS_UNUSABLE;
    }
    if (to_kconfig) {
        config_print_kconfig(&config);
    } else {
        config_print_yaml(&config);
    }
    return STATUS_OK;
}

status_t cmd_config(int argc, char **argv) {
    config_options_t given;
    option_t config_rows[CONFIG_OPTIONS];
    config_options_init(&given, config_rows);
    bool to_kconfig = false;
    bool is_schema = false;
    const option_t rows[] = {
        OPTION_FLAG("--to-kconfig", "print a Kconfig fragment for the firmware instead", &to_kconfig),
        OPTION_FLAG("--schema", "print the JSON Schema of a configuration file instead", &is_schema),
    };
    const option_group_t groups[] = {
        {.title = "Options", .options = rows, .count = sizeof rows / sizeof rows[0]},
        {.title = "Configuration of the supervisor", .options = config_rows, .count = CONFIG_OPTIONS},
    };
    static const option_example_t examples[] = {
        {"host_sim config > agv.yaml", "all settings, to be changed in an editor"},
        {"host_sim config --config agv.yaml --to-kconfig > agv.conf", "the same for the firmware"},
    };
    const option_syntax_t syntax = {
        .usage = "config [OPTION]...",
        .summary =
            "Print every setting with its default, unit, range and meaning, as a YAML file for --config; with\n"
            "--config FILE, print that configuration.\n"
            "In a file, times are 250ms, 1.5s, or milliseconds alone; identifiers are 168h, 0x168 or decimal 360.\n",
        .groups = groups,
        .group_count = sizeof groups / sizeof groups[0],
        .instead = "--config",
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0;
    const options_result_t parsed = options_parse(&syntax, argc, argv, &operands);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    return print(&given, is_schema, to_kconfig);
}

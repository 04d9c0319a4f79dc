/**
 * @file cmd_help.c
 * `host_sim help`: what `--help` prints.
 */
#include "cli/commands/commands.h"
#include "cli/options.h"

status_t cmd_help(int argc, char **argv) {
    static const option_example_t examples[] = {
        {"host_sim help", "the commands"},
        {"host_sim help replay", "the options of replay"},
    };
    const option_syntax_t syntax = {
        .usage = "help [COMMAND]",
        .summary = "Print the help of a command, like host_sim COMMAND --help, or the list of commands.\n",
        .operands_max = 1,
        .operand = "COMMAND",
        .words = command_words(),
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0;
    const options_result_t parsed = options_parse(&syntax, argc, argv, &operands);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    if (operands == 0) {
        command_print_help();
        return STATUS_OK;
    }
    const command_t *command = command_find(argv[0]);
    return (command != NULL) ? command_show(command, NULL) : STATUS_UNUSABLE;
}

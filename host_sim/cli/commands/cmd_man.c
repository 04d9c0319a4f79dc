/**
 * @file cmd_man.c
 * `host_sim man`: a man page.
 */
#include "cli/commands/commands.h"
#include "cli/man_page.h"
#include "cli/options.h"

status_t cmd_man(int argc, char **argv) {
    static const option_example_t examples[] = {
        {"host_sim man > host_sim.1", "for share/man/man1"},
        {"host_sim man replay | man -l -", "read the page of replay"},
    };
    const option_syntax_t syntax = {
        .usage = "man [COMMAND]",
        .summary = "Print the man page of a command, or of the program. An installed host_sim has them in place.\n",
        .operands_max = 1u,
        .operand = "COMMAND",
        .words = command_words(),
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0u;
    const options_result_t parsed = options_parse(&syntax, argc, argv, &operands);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    const command_t *command = NULL;
    if (operands > 0u) {
        command = command_find(argv[0]);
        if (command == NULL) {
            return STATUS_UNUSABLE;
        }
    }
    man_page_print(command);
    return STATUS_OK;
}

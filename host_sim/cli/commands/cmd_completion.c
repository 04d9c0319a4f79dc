/**
 * @file cmd_completion.c
 * `host_sim completion`: a script that completes command lines in a shell.
 */
#include "cli/commands/completion/completion.h"

#include "cli/commands/commands.h"
#include "cli/options.h"
#include "text/suggest.h"
#include "text/words.h"

#define SHELLS "bash|zsh|fish"

status_t cmd_completion(int argc, char **argv) {
    static void (*const print[])(void) = {completion_print_bash, completion_print_zsh, completion_print_fish};
    static const option_example_t examples[] = {
        {"host_sim completion bash > host_sim.bash", "for share/bash-completion/completions/host_sim"},
        {"host_sim completion zsh > _host_sim", "for a folder of $fpath"},
        {"host_sim completion fish > host_sim.fish", "for ~/.config/fish/completions"},
    };
    const option_syntax_t syntax = {
        .usage = "completion " SHELLS,
        .summary =
            "Print a script that completes command lines of host_sim in a shell. Installation sets it up. To use\n"
            "it in the current shell: source <(host_sim completion bash)\n",
        .operands_min = 1,
        .operands_max = 1,
        .operand = "SHELL",
        .words = SHELLS,
        .examples = examples,
        .example_count = sizeof examples / sizeof examples[0],
    };
    size_t operands = 0;
    const options_result_t parsed = options_parse(&syntax, argc, argv, &operands);
    if (parsed != OPTIONS_GO) {
        return (parsed == OPTIONS_DONE) ? STATUS_OK : STATUS_UNUSABLE;
    }
    const int shell = words_find(SHELLS, argv[0]);
    if (shell < 0) {
        char meant[SUGGEST_SIZE];
        (void)report("'%s' is not one of %s%s", argv[0], SHELLS, suggest_from(SHELLS, argv[0], meant));
        return STATUS_UNUSABLE;
    }
    print[shell]();
    return STATUS_OK;
}

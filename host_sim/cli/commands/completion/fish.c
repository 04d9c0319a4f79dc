/* A line for each command and each option. */
#include <stdio.h>

#include "cli/commands/completion/completion.h"

/* Have a meaning within single quotes. */
#define SPECIAL "\\"

/** Print "-F" (files), "-x" (no files), and words. */
static void print_value(const completion_value_t *value) {
    (void)printf(" %s", value->is_file ? "-rF" : "-x");
    if ((value->words == NULL) && !value->is_folder && !value->is_interface) {
        return;
    }
    (void)printf(" -a '");
    completion_print_words((value->words != NULL) ? value->words : "");
    (void)printf("%s%s'", value->is_folder ? " (__fish_complete_directories)" : "",
                 value->is_interface ? " (" COMPLETION_CAN_INTERFACES ")" : "");
}

static void print_operand(const char *command, const option_syntax_t *syntax) {
    if (syntax->operands_max == 0) {
        return;
    }
    (void)printf("complete -c host_sim -n '__fish_seen_subcommand_from %s'", command);
    if (syntax->words == NULL) {
        (void)printf(" -F\n");
        return;
    }
    (void)printf(" -a '");
    completion_print_words(syntax->words);
    (void)printf("'\n");
}

static void print_command(const void *ctx, const option_syntax_t *syntax) {
    const command_t *command = ctx;
    (void)printf("\ncomplete -c host_sim -n __fish_use_subcommand -a %s -d '", command->name);
    completion_print_escaped(command->help, SPECIAL);
    (void)printf("'\n");
    for (size_t i = 0; options_at(syntax, i) != NULL; i++) {
        const option_t *option = options_at(syntax, i);
        const bool is_short = option->name[1] != '-';
        (void)printf("complete -c host_sim -n '__fish_seen_subcommand_from %s' -%c %s", command->name,
                     is_short ? 's' : 'l', &option->name[is_short ? 1 : 2]);
        if (option->value != NULL) {
            const completion_value_t value = completion_of_option(option);
            print_value(&value);
        }
        (void)printf(" -d '");
        completion_print_escaped(option->help, SPECIAL);
        (void)printf("'\n");
    }
    print_operand(command->name, syntax);
}

void completion_print_fish(void) {
    (void)printf("# fish completion of host_sim; made by `host_sim completion fish`\n"
                 "complete -c host_sim -f\n"
                 "complete -c host_sim -s h -l help -d 'print the help'\n"
                 "complete -c host_sim -n __fish_use_subcommand -s V -l version -d 'print the version'\n");
    completion_each_command(print_command);
}

/* One call of _arguments for each command. */
#include <stdio.h>

#include "cli/commands/completion/completion.h"

/* Have a meaning in the descriptions of _arguments. */
#define SPECIAL "[]:\\"

/** What completes a value, within single quotes. */
static void print_action(const completion_value_t *value) {
    const char *const actions[] = {
        value->is_file ? "_files" : NULL,
        value->is_folder ? "_files -/" : NULL,
        value->is_interface ? "{ compadd -- $(" COMPLETION_CAN_INTERFACES ") }" : NULL,
    };
    const char *action = NULL;
    for (size_t i = 0; (i < sizeof actions / sizeof actions[0]) && (action == NULL); i++) {
        action = actions[i];
    }
    if (value->words == NULL) {
        (void)printf("%s", (action != NULL) ? action : " ");
    } else if (action == NULL) {
        (void)printf("(");
        completion_print_words(value->words);
        (void)printf(")");
    } else {
        (void)printf("{ compadd -- ");
        completion_print_words(value->words);
        (void)printf("; %s }", action);
    }
}

static void print_option(const option_t *option) {
    (void)printf(" \\\n            '%s%s%s[", option->adds_up ? "*" : "", option->name,
                 (option->value != NULL) ? "=" : "");
    completion_print_escaped(option->help, SPECIAL);
    (void)printf("]");
    if (option->value != NULL) {
        const completion_value_t value = completion_of_option(option);
        (void)printf(":value:");
        print_action(&value);
    }
    (void)printf("'");
}

static void print_command(const void *ctx, const option_syntax_t *syntax) {
    const command_t *command = ctx;
    (void)printf("    %s)\n        _arguments -S '(- *)--help[print the help]'", command->name);
    for (size_t i = 0; options_at(syntax, i) != NULL; i++) {
        print_option(options_at(syntax, i));
    }
    if (syntax->operands_max > 0) {
        const completion_value_t operand = completion_of_operand(syntax);
        (void)printf(" \\\n            '%s:%s:", (syntax->operands_max > 1) ? "*" : "1", syntax->operand);
        print_action(&operand);
        (void)printf("'");
    }
    (void)printf("\n        ;;\n");
}

void completion_print_zsh(void) {
    (void)printf("#compdef host_sim\n"
                 "# zsh completion of host_sim; made by `host_sim completion zsh`\n"
                 "\n"
                 "_host_sim() {\n"
                 "    local -a commands=(\n");
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        (void)printf("        '%s:", COMMANDS[i].name);
        completion_print_escaped(COMMANDS[i].help, SPECIAL);
        (void)printf("'\n");
    }
    (void)printf("    )\n"
                 "    if ((CURRENT == 2)); then\n"
                 "        _describe -t commands command commands\n"
                 "        compadd -- --help --version\n"
                 "        return\n"
                 "    fi\n"
                 "    shift words\n"
                 "    ((CURRENT--))\n"
                 "    case $words[1] in\n");
    completion_each_command(print_command);
    (void)printf("    esac\n"
                 "}\n"
                 "\n"
                 "if [[ $funcstack[1] == _host_sim ]]; then\n"
                 "    _host_sim \"$@\"\n"
                 "else\n"
                 "    compdef _host_sim host_sim\n"
                 "fi\n");
}

#include "cli/commands/completion/completion.h"

#include <stdio.h>
#include <string.h>

completion_value_t completion_of_option(const option_t *option) {
    return (completion_value_t){
        .is_file = strstr(option->value, "FILE") != NULL,
        .is_folder = strstr(option->value, "FOLDER") != NULL,
        .is_interface = (strcmp(option->value, "IF") == 0) || (strstr(option->value, "IF[") != NULL),
        .words = (option->candidates != NULL) ? option->candidates() : option->words,
    };
}

completion_value_t completion_of_operand(const option_syntax_t *syntax) {
    const bool has_operand = syntax->operands_max > 0;
    return (completion_value_t){
        .is_file = has_operand && (syntax->words == NULL),
        .words = has_operand ? syntax->words : NULL,
    };
}

void completion_print_words(const char *words) {
    for (const char *at = words; *at != '\0'; at++) {
        (void)putchar((*at == '|') ? ' ' : *at);
    }
}

void completion_print_escaped(const char *text, const char *special) {
    for (const char *at = text; *at != '\0'; at++) {
        if (*at == '\'') {
            (void)printf("'\\'");
        } else if (strchr(special, *at) != NULL) {
            (void)putchar('\\');
        }
        (void)putchar(*at);
    }
}

void completion_each_command(option_show_fn *show) {
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        (void)command_show(&COMMANDS[i], show);
    }
}

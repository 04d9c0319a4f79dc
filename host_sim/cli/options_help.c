#include <stdio.h>
#include <string.h>

#include "cli/options.h"
#include "common/shipped.h"
#include "text/text.h"

enum { HELP_COLUMN = 24 };

static void print_row(const char *name, const char *value, const char *help, const char *more) {
    const int width = printf("  %s%s%s", name, (value != NULL) ? " " : "", (value != NULL) ? value : "");
    text_t text = {.used = 0};
    text_add(&text, "%s%s", help, more);
    /* A long one gets a line of its own. */
    (void)printf("%s%*s", (width >= HELP_COLUMN) ? "\n" : "",
                 (width >= HELP_COLUMN) ? HELP_COLUMN : HELP_COLUMN - width, "");
    text_print_from(HELP_COLUMN, text.bytes);
}

void options_example_line(const option_example_t *example, const char *folder, char *line, size_t size) {
    size_t used = 0;
    line[0] = '\0';
    for (const char *at = example->line; (*at != '\0') && (used < size); at++) {
        const bool is_folder = (*at == '@') && (at[1] == '/');
        used += (size_t)snprintf(&line[used], size - used, "%.*s", is_folder ? (int)strlen(folder) : 1,
                                 is_folder ? folder : at);
    }
}

static void print_examples(const option_syntax_t *syntax) {
    char folder[SHIPPED_PATH_SIZE];
    char line[SHIPPED_PATH_SIZE + 256];
    (void)printf("\nExamples:\n");
    for (size_t i = 0; i < syntax->example_count; i++) {
        options_example_line(&syntax->examples[i], shipped_shown(folder), line, sizeof line);
        (void)printf("  %s\n      %s\n", line, syntax->examples[i].does);
    }
}

void options_print_help(const option_syntax_t *syntax) {
    (void)printf("usage: host_sim %s\n", syntax->usage);
    if (syntax->or_usage != NULL) {
        (void)printf("       host_sim %s\n", syntax->or_usage);
    }
    (void)printf("\n%s", syntax->summary);
    for (size_t g = 0; g < syntax->group_count; g++) {
        const option_group_t *group = &syntax->groups[g];
        if (group->title != NULL) {
            (void)printf("\n%s:\n", group->title);
        }
        for (size_t i = 0; i < group->count; i++) {
            const option_t *option = &group->options[i];
            print_row(option->name, option->value, option->help, option->adds_up ? "; may be given several times" : "");
        }
    }
    if (syntax->example_count > 0) {
        print_examples(syntax);
    }
}

#include "cli/options.h"

#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "common/duration.h"
#include "common/report.h"
#include "common/words.h"

enum { HELP_COLUMN = 24 };

static int command_length(const option_syntax_t *syntax) {
    return (int)strcspn(syntax->usage, " ");
}

static void print_help(const option_syntax_t *syntax) {
    (void)printf("usage: host_sim %s\n\n%s", syntax->usage, syntax->summary);
    for (size_t g = 0u; g < syntax->group_count; g++) {
        const option_group_t *group = &syntax->groups[g];
        if (group->title != NULL) {
            (void)printf("\n%s:\n", group->title);
        }
        for (size_t i = 0u; i < group->count; i++) {
            const option_t *option = &group->options[i];
            int width = printf("  %s%s%s", option->name, (option->value != NULL) ? " " : "",
                               (option->value != NULL) ? option->value : "");
            /* A long one gets a line of its own. */
            (void)printf("%s%*s%s\n", (width >= HELP_COLUMN) ? "\n" : "",
                         (width >= HELP_COLUMN) ? HELP_COLUMN : HELP_COLUMN - width, "", option->help);
        }
    }
}

/** Find the option of which `argument` is "--name" or "--name=value". */
static const option_t *find(const option_syntax_t *syntax, const char *argument) {
    size_t length = strcspn(argument, "=");
    for (size_t g = 0u; g < syntax->group_count; g++) {
        const option_group_t *group = &syntax->groups[g];
        for (size_t i = 0u; i < group->count; i++) {
            const char *name = group->options[i].name;
            if ((strlen(name) == length) && (memcmp(name, argument, length) == 0)) {
                return &group->options[i];
            }
        }
    }
    return NULL;
}

static bool take_duration(const option_t *option, const char *value) {
    char problem[DURATION_PROBLEM_SIZE];
    const duration_result_t result =
        duration_read(value, option->unit, option->lowest, option->highest, option->duration);
    return (result == DURATION_OK) ||
           report("%s: %s", option->name,
                  duration_problem(result, value, option->unit, option->lowest, option->highest, problem));
}

static bool take_value(const option_t *option, const char *value) {
    if (option->each != NULL) {
        return option->each(option->ctx, value);
    }
    if (option->number != NULL) {
        uint64_t number = 0u;
        if (!words_decimal(value, option->lowest, option->highest, &number)) {
            return report("%s: '%s' is not a number from %" PRIu64 " to %" PRIu64, option->name, value, option->lowest,
                          option->highest);
        }
        *option->number = number;
        return true;
    }
    if (option->duration != NULL) {
        return take_duration(option, value);
    }
    if (option->word != NULL) {
        int index = words_find(option->words, value);
        if (index < 0) {
            return report("%s: '%s' is not one of %s", option->name, value, option->words);
        }
        *option->word = index;
        return true;
    }
    if (value[0] == '\0') {
        return report("%s: the value is empty", option->name);
    }
    *option->text = value;
    return true;
}

/** Take the option at argv[*at], and its value. @return false: reported. */
static bool take_option(const option_syntax_t *syntax, int argc, char **argv, int *at) {
    const char *argument = argv[*at];
    const option_t *option = find(syntax, argument);
    if (option == NULL) {
        return report("unknown option '%s'; see host_sim %.*s --help", argument, command_length(syntax), syntax->usage);
    }
    const char *value = strchr(argument, '=');
    if (option->value == NULL) {
        if (value != NULL) {
            return report("%s takes no value", option->name);
        }
        *option->flag = true;
        return true;
    }
    if (value != NULL) {
        return take_value(option, &value[1]);
    }
    if ((*at + 1 >= argc) || (strncmp(argv[*at + 1], "--", 2u) == 0)) {
        return report("%s needs a value: %s", option->name, option->value);
    }
    (*at)++;
    return take_value(option, argv[*at]);
}

static bool check_operands(const option_syntax_t *syntax, size_t operands, char **argv) {
    if (operands < syntax->operands_min) {
        return report("%s is missing; see host_sim %.*s --help", syntax->operand, command_length(syntax),
                      syntax->usage);
    }
    if (operands > syntax->operands_max) {
        return report("unexpected argument '%s'; see host_sim %.*s --help", argv[syntax->operands_max],
                      command_length(syntax), syntax->usage);
    }
    return true;
}

options_result_t options_parse(const option_syntax_t *syntax, int argc, char **argv, size_t *operands) {
    bool only_operands = false;
    *operands = 0u;
    for (int at = 0; at < argc; at++) {
        char *argument = argv[at];
        if (only_operands || (argument[0] != '-') || (argument[1] == '\0')) {
            argv[*operands] = argument;
            (*operands)++;
        } else if (strcmp(argument, "--") == 0) {
            only_operands = true;
        } else if ((strcmp(argument, "--help") == 0) || (strcmp(argument, "-h") == 0)) {
            print_help(syntax);
            return OPTIONS_DONE;
        } else if (!take_option(syntax, argc, argv, &at)) {
            return OPTIONS_BAD;
        }
    }
    return check_operands(syntax, *operands, argv) ? OPTIONS_GO : OPTIONS_BAD;
}

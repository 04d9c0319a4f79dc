#include "cli/options.h"

#include <inttypes.h>
#include <string.h>

#include "common/report.h"
#include "text/duration.h"
#include "text/suggest.h"
#include "text/words.h"

/** Options of a command, at most. */
#define OPTIONS_MAX 64u

/** A command line that is being parsed. */
typedef struct {
    const option_syntax_t *syntax;
    int argc;
    char **argv;
    int at;
    bool given[OPTIONS_MAX];
} parsing_t;

static option_show_fn *show_instead;
static const void *show_ctx;

void options_show_with(option_show_fn *show, const void *ctx) {
    show_instead = show;
    show_ctx = ctx;
}

static void show(const option_syntax_t *syntax) {
    if (show_instead != NULL) {
        show_instead(show_ctx, syntax);
    } else {
        options_print_help(syntax);
    }
}

static int command_length(const option_syntax_t *syntax) {
    return (int)strcspn(syntax->usage, " ");
}

const option_t *options_at(const option_syntax_t *syntax, size_t index) {
    for (size_t g = 0; g < syntax->group_count; g++) {
        if (index < syntax->groups[g].count) {
            return &syntax->groups[g].options[index];
        }
        index -= syntax->groups[g].count;
    }
    return NULL;
}

/** The only option that begins with what was written, of which at least a letter. @return NULL: none, or several do */
static const char *abbreviated(const option_syntax_t *syntax, const char *argument, size_t length) {
    const char *only = NULL;
    size_t found = 0;
    for (size_t i = 0; (length > strlen("--")) && (i < OPTIONS_MAX); i++) {
        const option_t *option = options_at(syntax, i);
        if ((option != NULL) && (strncmp(option->name, argument, length) == 0)) {
            only = option->name;
            found++;
        }
    }
    return (found == 1) ? only : NULL;
}

static bool refuse_unknown(const option_syntax_t *syntax, const char *argument, size_t length) {
    const char *whole = abbreviated(syntax, argument, length);
    if (whole != NULL) {
        return report("unknown option '%s': did you mean '%s'?", argument, whole);
    }
    char meant[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin(argument, length);
    size_t next = 0;
    for (const option_t *option = options_at(syntax, next); option != NULL; option = options_at(syntax, next)) {
        suggest_offer(&suggestion, option->name, strlen(option->name));
        next++;
    }
    suggest_offer(&suggestion, "--help", strlen("--help"));
    if (suggestion.word != NULL) {
        return report("unknown option '%s'%s", argument, suggest_text(&suggestion, meant));
    }
    return report("unknown option '%s'; see host_sim %.*s --help", argument, command_length(syntax), syntax->usage);
}

/** Find the option of which the argument is "--name" or "--name=value". @return NULL: reported */
static const option_t *find(parsing_t *parsing) {
    const char *argument = parsing->argv[parsing->at];
    const size_t length = strcspn(argument, "=");
    for (size_t i = 0; i < OPTIONS_MAX; i++) {
        const option_t *option = options_at(parsing->syntax, i);
        if (option == NULL) {
            break;
        }
        if ((strlen(option->name) == length) && (memcmp(option->name, argument, length) == 0)) {
            if (parsing->given[i] && !option->adds_up) {
                (void)report("%s is given twice", option->name);
                return NULL;
            }
            parsing->given[i] = true;
            return option;
        }
    }
    (void)refuse_unknown(parsing->syntax, argument, length);
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
        uint64_t number = 0;
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
            char meant[SUGGEST_SIZE];
            return report("%s: '%s' is not one of %s%s", option->name, value, option->words,
                          suggest_from(option->words, value, meant));
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

/** Take an option, and its value. @return false: reported. */
static bool take_option(parsing_t *parsing) {
    const char *value = strchr(parsing->argv[parsing->at], '=');
    const option_t *option = find(parsing);
    if (option == NULL) {
        return false;
    }
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
    const int next = parsing->at + 1;
    if ((next >= parsing->argc) || (strncmp(parsing->argv[next], "--", 2) == 0)) {
        return report("%s needs a value: %s", option->name, option->value);
    }
    parsing->at = next;
    return take_value(option, parsing->argv[next]);
}

/** Whether an option was given. */
static bool is_given(const parsing_t *parsing, const char *name) {
    for (size_t i = 0; i < OPTIONS_MAX; i++) {
        const option_t *option = options_at(parsing->syntax, i);
        if ((option == NULL) || (strcmp(option->name, name) == 0)) {
            return (option != NULL) && parsing->given[i];
        }
    }
    return false;
}

static bool refuse_operand(const parsing_t *parsing, size_t at) {
    const option_syntax_t *syntax = parsing->syntax;
    char **argv = parsing->argv;
    if ((syntax->instead != NULL) && !is_given(parsing, syntax->instead)) {
        return report("unexpected argument '%s': did you mean '%s %s'?", argv[at], syntax->instead, argv[at]);
    }
    if (at > 0) {
        return report("unexpected argument '%s' after '%s'; see host_sim %.*s --help", argv[at], argv[at - 1],
                      command_length(syntax), syntax->usage);
    }
    return report("unexpected argument '%s'; see host_sim %.*s --help", argv[at], command_length(syntax),
                  syntax->usage);
}

static bool check_operands(const parsing_t *parsing, size_t operands) {
    const option_syntax_t *syntax = parsing->syntax;
    if (operands < syntax->operands_min) {
        return report("%s is missing; see host_sim %.*s --help", syntax->operand, command_length(syntax),
                      syntax->usage);
    }
    if ((operands > syntax->operands_max) && (syntax->operands_max > 1)) {
        return report("%s: more than %zu were given", syntax->operand, syntax->operands_max);
    }
    if (operands > syntax->operands_max) {
        return refuse_operand(parsing, syntax->operands_max);
    }
    for (size_t i = 0; i < operands; i++) {
        if (parsing->argv[i][0] == '\0') {
            return report("%s: the name is empty", syntax->operand);
        }
    }
    return true;
}

options_result_t options_parse(const option_syntax_t *syntax, int argc, char **argv, size_t *operands) {
    parsing_t parsing = {.syntax = syntax, .argc = argc, .argv = argv};
    bool only_operands = false;
    *operands = 0;
    for (; parsing.at < argc; parsing.at++) {
        char *argument = argv[parsing.at];
        if (only_operands || (argument[0] != '-') || (argument[1] == '\0')) {
            argv[*operands] = argument;
            (*operands)++;
        } else if (strcmp(argument, "--") == 0) {
            only_operands = true;
        } else if ((strcmp(argument, "--help") == 0) || (strcmp(argument, "-h") == 0)) {
            show(syntax);
            return OPTIONS_DONE;
        } else if (!take_option(&parsing)) {
            return OPTIONS_BAD;
        }
    }
    return check_operands(&parsing, *operands) ? OPTIONS_GO : OPTIONS_BAD;
}

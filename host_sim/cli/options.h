/**
 * @file options.h
 * Options of a command, described as tables of rows: how they are parsed, what `--help` prints, what the man page says
 * and what a shell completes.
 *
 * `--name VALUE` and `--name=VALUE` (only the latter for a value that begins with `--`). An option that is given twice is
 * refused, unless it `adds_up`. `--` ends the options. Everything else that does not begin with `-`, and `-` itself, is an
 * operand.
 */
#ifndef HOST_SIM_OPTIONS_H
#define HOST_SIM_OPTIONS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "text/duration.h"

/**
 * Called for every occurrence of an option.
 * @return false: the value makes no sense, and that was reported.
 */
typedef bool option_each_fn(void *ctx, const char *value);

/** Lists the words that a text may be, "a|b|c". */
typedef const char *option_words_fn(void);

/** As a number that was not given. */
#define OPTION_NOT_GIVEN UINT64_MAX

/** One option. Exactly one of flag, text, number, duration, word and each is set; it is where the value goes. */
typedef struct {
    const char *name;   /**< "--tail" */
    const char *value;  /**< what `--help` calls its value: "MS"; NULL for a flag */
    const char *help;   /**< one line */
    bool *flag;         /**< set to true */
    const char **text;  /**< any text but an empty one */
    uint64_t *number;   /**< decimal, `lowest` .. `highest` */
    uint64_t *duration; /**< a time (text/duration.h), in `unit`, `lowest` .. `highest` */
    duration_unit_t unit;
    int *word; /**< index of one of `words` */
    option_each_fn *each;
    void *ctx;    /**< for `each` */
    bool adds_up; /**< may be given several times; for `each` */
    uint64_t lowest;
    uint64_t highest;
    const char *words;           /**< "a|b|c"; of a text, those that a shell completes besides */
    option_words_fn *candidates; /**< of a text: what a shell completes; NULL: what the name of its value says */
} option_t;

/** @name Rows of a table of options @{ */
#define OPTION_FLAG(name_, help_, target) {.name = (name_), .help = (help_), .flag = (target)}
#define OPTION_TEXT(name_, value_, help_, target)                                                                      \
    {.name = (name_), .value = (value_), .help = (help_), .text = (target)}
#define OPTION_NUMBER(name_, value_, help_, target, low, high)                                                         \
    {.name = (name_), .value = (value_), .help = (help_), .number = (target), .lowest = (low), .highest = (high)}
#define OPTION_DURATION_IN(unit_, name_, help_, target, low, high)                                                     \
    {.name = (name_),                                                                                                  \
     .value = "TIME",                                                                                                  \
     .help = (help_),                                                                                                  \
     .duration = (target),                                                                                             \
     .unit = (unit_),                                                                                                  \
     .lowest = (low),                                                                                                  \
     .highest = (high)}
#define OPTION_DURATION(...) OPTION_DURATION_IN(DURATION_MS, __VA_ARGS__)
#define OPTION_WORD(name_, help_, target, list)                                                                        \
    {.name = (name_), .value = (list), .help = (help_), .word = (target), .words = (list)}
/** @} */

/** Options that belong together in `--help`. */
typedef struct {
    const char *title; /**< "Options"; NULL: they go on with the group before */
    const option_t *options;
    size_t count;
} option_group_t;

/** A command line that works as it stands; `@` is the folder of the files that come with the program. */
typedef struct {
    const char *line; /**< "host_sim replay @/examples/ai-stops.log" */
    const char *does;
} option_example_t;

/** What a command takes. */
typedef struct {
    const char *usage;    /**< what follows "host_sim": "replay [OPTION]... LOG" */
    const char *or_usage; /**< another form of it, or NULL */
    const char *summary;  /**< lines that say what it does, each ended by a line break */
    const option_group_t *groups;
    size_t group_count;
    size_t operands_min;
    size_t operands_max;
    const char *operand; /**< what an operand is called in a message: "LOG" */
    const char *words;   /**< of an operand, "a|b|c"; NULL: any text */
    const char *instead; /**< the option that was meant with an operand too many, "--can"; NULL: none */
    const option_example_t *examples;
    size_t example_count;
} option_syntax_t;

/** Shows what a command takes, in the place of its `--help`. */
typedef void option_show_fn(const void *ctx, const option_syntax_t *syntax);

/** From now on `--help` calls this: for man pages and completion. NULL: it prints the help */
void options_show_with(option_show_fn *show, const void *ctx);

/** The option with an index, counted over all groups; NULL: no such index. */
const option_t *options_at(const option_syntax_t *syntax, size_t index);

/** Write the line of an example, with the folder of the files in its place. What does not fit is cut. */
void options_example_line(const option_example_t *example, const char *folder, char *line, size_t size);

/** Print the help of a command. */
void options_print_help(const option_syntax_t *syntax);

/** The result. */
typedef enum {
    OPTIONS_GO,   /**< run the command */
    OPTIONS_DONE, /**< `--help` was asked for and printed: the command ends, successfully */
    OPTIONS_BAD   /**< that was reported */
} options_result_t;

/**
 * Parse the arguments of a command. The operands are moved to the front of @p argv in their order.
 *
 * @param argc number of arguments, the command's name not among them
 * @param argv the arguments
 * @param operands how many operands there are
 */
options_result_t options_parse(const option_syntax_t *syntax, int argc, char **argv, size_t *operands);

#endif

/**
 * @file completion.h
 * Scripts that complete command lines in a shell, made from the tables of options of all commands.
 */
#ifndef HOST_SIM_COMPLETION_H
#define HOST_SIM_COMPLETION_H

#include <stdbool.h>

#include "cli/commands/commands.h"
#include "cli/options.h"

/** A command that lists the CAN interfaces (type 280 of the kernel's ARPHRD_), in every shell. */
#define COMPLETION_CAN_INTERFACES "grep -lx 280 /sys/class/net/*/type 2>/dev/null | cut -d / -f 5"

/** What can stand in the place of a value or of an operand. All false and NULL: something that a shell does not know. */
typedef struct {
    bool is_file;
    bool is_folder;
    bool is_interface; /**< a CAN interface */
    const char *words; /**< "a|b|c" */
} completion_value_t;

/** Of the value of an option; not for a flag. */
completion_value_t completion_of_option(const option_t *option);

/** Of an operand of a command. */
completion_value_t completion_of_operand(const option_syntax_t *syntax);

/** Print "a b c" for "a|b|c". */
void completion_print_words(const char *words);

/** Print a text that stands in single quotes, with a backslash before the characters of @p special. */
void completion_print_escaped(const char *text, const char *special);

/** Have each command shown. */
void completion_each_command(option_show_fn *show);

/** @name Print the script of a shell on standard output @{ */
void completion_print_bash(void);
void completion_print_zsh(void);
void completion_print_fish(void);
/** @} */

#endif

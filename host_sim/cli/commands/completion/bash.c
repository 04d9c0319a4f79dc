/* The table is made from the options; the function that reads it is the same for all commands. */
#include <stdio.h>

#include "cli/commands/completion/completion.h"

static const char HEAD[] = "# bash completion of host_sim; made by `host_sim completion bash`\n"
                           "\n"
                           "# The options of command $1, those that may be given again, and what its option $2 takes "
                           "(with $2 empty: an operand):\n"
                           "# kinds and words. Without a command: the commands.\n"
                           "_host_sim_table() {\n"
                           "    options='' again='' kinds='' words=''\n"
                           "    case $1 in\n";

static const char TAIL[] =
    "    esac\n"
    "}\n"
    "\n"
    "_host_sim_add() {\n"
    "    local found\n"
    "    while IFS= read -r found; do\n"
    "        COMPREPLY+=(\"$found\")\n"
    "    done < <(compgen \"$@\")\n"
    "}\n"
    "\n"
    "_host_sim() {\n"
    "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} options again kinds words given\n"
    "    local ended=''\n"
    "    COMPREPLY=()\n"
    "    if ((COMP_CWORD == 1)); then\n"
    "        _host_sim_table '' ''\n"
    "        _host_sim_add -W \"$words --help --version\" -- \"$word\"\n"
    "        return\n"
    "    fi\n"
    "    # --name=value is three words here\n"
    "    if [[ $word == = ]]; then\n"
    "        word=''\n"
    "    elif [[ $before == = ]]; then\n"
    "        before=${COMP_WORDS[COMP_CWORD - 2]}\n"
    "    fi\n"
    "    for given in \"${COMP_WORDS[@]:2:COMP_CWORD - 2}\"; do\n"
    "        if [[ $given == -- ]]; then\n"
    "            ended=yes\n"
    "        fi\n"
    "    done\n"
    "    if [[ -z $ended && $before == -* ]]; then\n"
    "        _host_sim_table \"${COMP_WORDS[1]}\" \"$before\"\n"
    "    fi\n"
    "    if [[ -z $kinds ]]; then\n"
    "        _host_sim_table \"${COMP_WORDS[1]}\" ''\n"
    "        if [[ -z $ended && $word == -* ]]; then\n"
    "            options=\" $options --help \"\n"
    "            for given in \"${COMP_WORDS[@]:2:COMP_CWORD - 2}\"; do\n"
    "                if [[ \" $again \" != *\" $given \"* ]]; then\n"
    "                    options=${options/\" $given \"/ }\n"
    "                fi\n"
    "            done\n"
    "            _host_sim_add -W \"$options\" -- \"$word\"\n"
    "            return\n"
    "        fi\n"
    "    fi\n"
    "    if [[ $kinds == *file* ]]; then\n"
    "        compopt -o filenames 2>/dev/null\n"
    "        _host_sim_add -f -- \"$word\"\n"
    "    elif [[ $kinds == *folder* ]]; then\n"
    "        compopt -o filenames 2>/dev/null\n"
    "        _host_sim_add -d -- \"$word\"\n"
    "    fi\n"
    "    if [[ $kinds == *interface* ]]; then\n"
    "        words+=\" $(" COMPLETION_CAN_INTERFACES ")\"\n"
    "    fi\n"
    "    _host_sim_add -W \"$words\" -- \"$word\"\n"
    "}\n"
    "\n"
    "complete -F _host_sim host_sim\n";

static void print_value(const completion_value_t *value) {
    (void)printf("kinds='value%s%s%s'", value->is_file ? " file" : "", value->is_folder ? " folder" : "",
                 value->is_interface ? " interface" : "");
    if (value->words != NULL) {
        (void)printf(" words='");
        completion_print_words(value->words);
        (void)printf("'");
    }
    (void)printf(" ;;\n");
}

/** Print the options, or only those that may be given again. */
static void print_options(const option_syntax_t *syntax, bool only_again) {
    const char *separator = "";
    for (size_t i = 0; options_at(syntax, i) != NULL; i++) {
        const option_t *option = options_at(syntax, i);
        if (!only_again || option->adds_up) {
            (void)printf("%s%s", separator, option->name);
            separator = " ";
        }
    }
}

static void print_command(const void *ctx, const option_syntax_t *syntax) {
    const command_t *command = ctx;
    (void)printf("    %s)\n        options='", command->name);
    print_options(syntax, false);
    (void)printf("' again='");
    print_options(syntax, true);
    (void)printf("'\n        case $2 in\n");
    for (size_t i = 0; options_at(syntax, i) != NULL; i++) {
        const option_t *option = options_at(syntax, i);
        if (option->value != NULL) {
            const completion_value_t value = completion_of_option(option);
            (void)printf("        %s) ", option->name);
            print_value(&value);
        }
    }
    const completion_value_t operand = completion_of_operand(syntax);
    (void)printf("        '') ");
    print_value(&operand);
    (void)printf("        esac\n        ;;\n");
}

void completion_print_bash(void) {
    (void)printf("%s    '') words='", HEAD);
    completion_print_words(command_words());
    (void)printf("' ;;\n");
    completion_each_command(print_command);
    (void)printf("%s", TAIL);
}

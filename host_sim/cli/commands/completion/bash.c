/* The table is made from the options; the function that reads it is the same for all commands. */
#include <stdio.h>

#include "cli/commands/completion/completion.h"

static const char HEAD[] = "# bash completion of host_sim; made by `host_sim completion bash`\n"
                           "\n"
                           "# The options of command $1, and what its option $2 takes (with $2 empty: an operand): "
                           "kinds and words. Without a\n"
                           "# command: the commands.\n"
                           "_host_sim_table() {\n"
                           "    options='' kinds='' words=''\n"
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
    "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD - 1]} options kinds words\n"
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
    "    if [[ $before == -* ]]; then\n"
    "        _host_sim_table \"${COMP_WORDS[1]}\" \"$before\"\n"
    "    fi\n"
    "    if [[ -z $kinds ]]; then\n"
    "        _host_sim_table \"${COMP_WORDS[1]}\" ''\n"
    "        if [[ $word == -* ]]; then\n"
    "            _host_sim_add -W \"$options --help\" -- \"$word\"\n"
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

static void print_command(const void *ctx, const option_syntax_t *syntax) {
    const command_t *command = ctx;
    (void)printf("    %s)\n        options='", command->name);
    for (size_t i = 0u; options_at(syntax, i) != NULL; i++) {
        (void)printf("%s%s", (i > 0u) ? " " : "", options_at(syntax, i)->name);
    }
    (void)printf("'\n        case $2 in\n");
    for (size_t i = 0u; options_at(syntax, i) != NULL; i++) {
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

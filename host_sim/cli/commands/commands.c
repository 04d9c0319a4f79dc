#include "cli/commands/commands.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/exit_status.h"
#include "text/suggest.h"
#include "text/text.h"

enum { WORDS_SIZE = 256 };

const command_t COMMANDS[] = {
    {"atlas", "cause every pair of faults on the simulated bus, and compare it with each of the two alone", cmd_atlas},
    {"campaign", "inject random faults on the simulated bus, thousands of times, and check each run", cmd_campaign},
    {"completion", "print a script that completes command lines in bash, zsh or fish", cmd_completion},
    {"config", "print every setting as a configuration file, or a configuration as Kconfig", cmd_config},
    {"demo", "watch the supervisor park a vehicle that loses its AI computer", cmd_demo},
    {"help", "print the help of a command", cmd_help},
    {"hunt", "attack the supervisor at random, and search for runs with a hazard", cmd_hunt},
    {"man", "print a man page", cmd_man},
    {"monitor", "watch a bus or a log: messages, deadlines, alarms, the supervisor's state", cmd_monitor},
    {"recorder", "show what the flight recorder of a device kept", cmd_recorder},
    {"replay", "replay a recorded log to the supervisor in virtual time, and say why it trips", cmd_replay},
    {"run", "run the supervisor as a node on SocketCAN, in real time", cmd_run},
    {"scenario", "run scenario files with a simulated vehicle, and check their expectations", cmd_scenario},
    {"soak", "run supervisor and vehicle for months of virtual time, with tolerable disturbances", cmd_soak},
    {"survey", "show what is in a log or on a bus, and propose a configuration", cmd_survey},
    {"vehicle", "simulate VCU, EPS and AI computer as nodes on SocketCAN", cmd_vehicle},
};

const size_t COMMAND_COUNT = sizeof COMMANDS / sizeof COMMANDS[0];

const char *command_words(void) {
    static char words[WORDS_SIZE];
    size_t used = 0;
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        used += (size_t)snprintf(&words[used], sizeof words - used, "%s%s", (i > 0) ? "|" : "", COMMANDS[i].name);
    }
    return words;
}

/** Report what is no command. */
static void refuse(const char *name) {
    char meant[SUGGEST_SIZE];
    suggestion_t suggestion = suggest_begin(name, strlen(name));
    suggest_offer_words(&suggestion, (name[0] == '-') ? "--help|--version|-V" : command_words());
    suggest_offer_words(&suggestion, (name[0] == '-') ? command_words() : "--version");
    if (suggestion.word != NULL) {
        (void)report("unknown command '%s'%s", name, suggest_text(&suggestion, meant));
    } else if (name[0] == '-') {
        (void)report("no command before '%s'; see host_sim --help", name);
    } else if (access(name, F_OK) == 0) {
        (void)report("no command before the file '%s', such as replay; see host_sim --help", name);
    } else {
        (void)report("unknown command '%s'; see host_sim --help", name);
    }
}

const command_t *command_find(const char *name) {
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        if (strcmp(name, COMMANDS[i].name) == 0) {
            return &COMMANDS[i];
        }
    }
    refuse(name);
    return NULL;
}

status_t command_show(const command_t *command, option_show_fn *show) {
    char option[] = "--help";
    char *arguments[] = {option};
    options_show_with(show, command);
    const status_t status = command->run(1, arguments);
    options_show_with(NULL, NULL);
    return status;
}

void command_print_help(void) {
    (void)printf("usage: host_sim COMMAND [OPTION]...\n"
                 "\n"
                 "The safety supervisor of an AGV's CAN bus, on a computer.\n"
                 "\n"
                 "Commands:\n");
    for (size_t i = 0; i < COMMAND_COUNT; i++) {
        text_print_from(printf("  %-11s ", COMMANDS[i].name), COMMANDS[i].help);
    }
    (void)printf("\n"
                 "  -h, --help     print this help; after a command: its options (also host_sim help COMMAND)\n"
                 "  -V, --version  print the version\n"
                 "\n"
                 "First: host_sim demo. Then, with a log of your own: host_sim survey LOG, host_sim replay LOG\n"
                 "\n"
                 "Exit status:\n");
    for (size_t i = 0; i < EXIT_STATUS_COUNT; i++) {
        text_print_from(printf("  %d  ", (int)EXIT_STATUSES[i].status), EXIT_STATUSES[i].means);
    }
}

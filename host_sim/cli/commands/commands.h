/**
 * @file commands.h
 * The sub-commands. To add one: a file cmd_<name>.c with its function, a prototype here, a row in commands.c.
 */
#ifndef HOST_SIM_COMMANDS_H
#define HOST_SIM_COMMANDS_H

#include <stddef.h>

#include "cli/options.h"
#include "common/report.h"

/**
 * Run a sub-command.
 * @param argc number of its arguments, its own name not among them
 * @param argv its arguments; the function may change their order
 * @return exit status of the program; whatever is not STATUS_OK was reported on standard error
 */
typedef status_t command_fn(int argc, char **argv);

/** One sub-command, as `--help` lists it. */
typedef struct {
    const char *name;
    const char *help; /**< one line */
    command_fn *run;
} command_t;

/** The commands by their names, and what they are; sorted. */
extern const command_t COMMANDS[];
extern const size_t COMMAND_COUNT;

/** The command of a name. @return NULL: there is none; was reported */
const command_t *command_find(const char *name);

/** The names of all commands, "campaign|config|...". */
const char *command_words(void);

/** Have the options of a command shown. @param show its context is the command_t; NULL: print the help */
status_t command_show(const command_t *command, option_show_fn *show);

/** Print what the program is, its commands, and the exit statuses. */
void command_print_help(void);

/** `host_sim recorder`: what a device's flight recorder kept. */
command_fn cmd_recorder;

/** `host_sim replay`: a recorded log, supervised in virtual time. */
command_fn cmd_replay;

/** `host_sim run`: the supervisor as a node on SocketCAN. */
command_fn cmd_run;

/** `host_sim demo`: the main job on the simulated bus, as a timeline. */
command_fn cmd_demo;

/** `host_sim scenario`: scenario files, played and evaluated. */
command_fn cmd_scenario;

/** `host_sim survey`: what is on a bus, and the configuration that would fit. */
command_fn cmd_survey;

/** `host_sim vehicle`: VCU, EPS and AI computer as nodes on SocketCAN. */
command_fn cmd_vehicle;

/** `host_sim atlas`: every ordered pair of faults. */
command_fn cmd_atlas;

/** `host_sim campaign`: randomised fault campaigns on the simulated bus. */
command_fn cmd_campaign;

/** `host_sim soak`: months of virtual time with disturbances that have to be survived. */
command_fn cmd_soak;

/** `host_sim hunt`: an adversary that searches for hazards. */
command_fn cmd_hunt;

/** `host_sim monitor`: a screen of what happens on a bus. */
command_fn cmd_monitor;

/** `host_sim help`: what `--help` prints. */
command_fn cmd_help;

/** `host_sim completion`: a script that completes command lines in a shell. */
command_fn cmd_completion;

/** `host_sim man`: a man page. */
command_fn cmd_man;

/** `host_sim config`: every setting, as YAML or as a Kconfig fragment. */
command_fn cmd_config;

#endif

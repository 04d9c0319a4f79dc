/**
 * @file main.c
 * The program's front: finds the sub-command and runs it.
 */
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "cli/commands/commands.h"
#include "common/report.h"

/** One sub-command, as `--help` lists it. */
typedef struct {
    const char *name;
    const char *help; /**< one line */
    command_fn *run;
} command_t;

static const command_t commands[] = {
    {"campaign", "inject random faults on the simulated bus, thousands of times, and check each run", cmd_campaign},
    {"config", "print every setting as a configuration file, or a configuration as Kconfig", cmd_config},
    {"demo", "watch the supervisor park a vehicle that loses its AI computer", cmd_demo},
    {"hunt", "attack the supervisor at random, and search for runs with a hazard", cmd_hunt},
    {"monitor", "watch a bus or a log: messages, deadlines, alarms, the supervisor's state", cmd_monitor},
    {"recorder", "tell what the flight recorder of a device kept", cmd_recorder},
    {"replay", "replay a recorded candump log to the supervisor in virtual time", cmd_replay},
    {"run", "run the supervisor as a node on SocketCAN, in real time", cmd_run},
    {"scenario", "run scenario files with a simulated vehicle, and check their expectations", cmd_scenario},
    {"soak", "run supervisor and vehicle for months of virtual time, with tolerable disturbances", cmd_soak},
    {"survey", "show what is in a log or on a bus, and propose a configuration", cmd_survey},
    {"vehicle", "simulate VCU, EPS and AI computer as nodes on SocketCAN", cmd_vehicle},
};

static const size_t command_count = sizeof commands / sizeof commands[0];

static void print_help(void) {
    (void)printf("usage: host_sim COMMAND [OPTION]...\n"
                 "\n"
                 "The safety supervisor of an AGV's CAN bus, on a computer.\n"
                 "\n"
                 "Commands:\n");
    for (size_t i = 0u; i < command_count; i++) {
        (void)printf("  %-10s %s\n", commands[i].name, commands[i].help);
    }
    (void)printf(
        "\n"
        "  --help     print this help; after a command: its options\n"
        "  --version  print the version\n"
        "\n"
        "Exit status: 0 success; 1 it ran, and an expectation failed; 2 it could not run, and one line on standard\n"
        "error says why.\n");
}

static status_t run_command(int argc, char **argv) {
    for (size_t i = 0u; i < command_count; i++) {
        if (strcmp(argv[0], commands[i].name) == 0) {
            return commands[i].run(argc - 1, &argv[1]);
        }
    }
    (void)report("unknown command '%s'; see host_sim --help", argv[0]);
    return STATUS_UNUSABLE;
}

/**
 * Occupy standard streams that the caller has closed, so that no file gets their numbers; using them is an error as
 * before.
 */
static void occupy_closed_streams(void) {
    bool occupied = true;
    for (int stream = STDIN_FILENO; occupied && (stream <= STDERR_FILENO); stream++) {
        if (fcntl(stream, F_GETFD) < 0) {
            occupied = open("/dev/null", (stream == STDIN_FILENO) ? O_WRONLY : O_RDONLY) == stream;
        }
    }
}

int main(int argc, char **argv) {
    occupy_closed_streams();
    /* A reader that goes away is a write error like any other, with a message and an exit status. */
    (void)signal(SIGPIPE, SIG_IGN);
    (void)signal(SIGXFSZ, SIG_IGN); /* so is a file that may not grow any more */
    status_t status = STATUS_OK;
    if (argc < 2) {
        (void)report("no command given; see host_sim --help");
        status = STATUS_UNUSABLE;
    } else if ((strcmp(argv[1], "--help") == 0) || (strcmp(argv[1], "-h") == 0)) {
        print_help();
    } else if (strcmp(argv[1], "--version") == 0) {
        (void)printf("host_sim %s\n", HOST_SIM_VERSION);
    } else {
        status = run_command(argc - 1, &argv[1]);
    }
    if (!report_stdout() && (status == STATUS_OK)) {
        status = STATUS_UNUSABLE;
    }
    return (int)status;
}

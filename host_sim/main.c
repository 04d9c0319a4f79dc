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

static status_t run_command(int argc, char **argv) {
    char help[] = "help";
    if ((strcmp(argv[0], "--help") == 0) || (strcmp(argv[0], "-h") == 0)) {
        argv[0] = help;
    }
    if ((strcmp(argv[0], "--version") == 0) || (strcmp(argv[0], "-V") == 0)) {
        if (argc > 1) {
            (void)report("unexpected argument '%s'; see host_sim --help", argv[1]);
            return STATUS_UNUSABLE;
        }
        (void)printf("host_sim %s\n", HOST_SIM_VERSION);
        return STATUS_OK;
    }
    const command_t *command = command_find(argv[0]);
    return (command != NULL) ? command->run(argc - 1, &argv[1]) : STATUS_UNUSABLE;
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
    } else {
        status = run_command(argc - 1, &argv[1]);
    }
    if (!report_stdout() && (status == STATUS_OK)) {
        status = STATUS_UNUSABLE;
    }
    return (int)status;
}

#include "commands.h"

status_t cmd_replay(int argc, char **argv) {
    (void)argc;
    (void)argv;
    (void)report("replay: not there yet");
    return STATUS_UNUSABLE;
}

#include "commands.h"

status_t cmd_config(int argc, char **argv) {
    (void)argc;
    (void)argv;
    (void)report("config: not there yet");
    return STATUS_UNUSABLE;
}

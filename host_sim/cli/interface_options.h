/**
 * @file interface_options.h
 * The interfaces that `--can` and `--ai-can` name, the same for every command that is a node on SocketCAN.
 */
#ifndef HOST_SIM_INTERFACE_OPTIONS_H
#define HOST_SIM_INTERFACE_OPTIONS_H

#include <stdbool.h>

#include "hal/can.h"

/**
 * Check that there are as many as the topology needs, and that they are not the same.
 * @param command    "run": whose `--help` is named
 * @param interfaces NULL: not given
 * @return false: not so; was reported.
 */
bool interface_options_check(const char *command, const char *const interfaces[HAL_CAN_SIDES], bool is_gateway);

#endif

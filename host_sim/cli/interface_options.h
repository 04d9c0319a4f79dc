/**
 * @file interface_options.h
 * The options of every command that is a node on SocketCAN: its interfaces, and how long it runs.
 */
#ifndef HOST_SIM_INTERFACE_OPTIONS_H
#define HOST_SIM_INTERFACE_OPTIONS_H

#include <stdbool.h>

#include "cli/options.h"
#include "hal/can.h"

#define INTERFACE_OPTIONS 3u

/** As a time to run for: until a signal comes. */
#define INTERFACE_UNTIL_SIGNAL 0u

/** What was given. Start from interface_options_init(). */
typedef struct {
    const char *interfaces[HAL_CAN_SIDES]; /**< --can, --ai-can; NULL: not given */
    uint64_t for_ms;                       /**< --for; INTERFACE_UNTIL_SIGNAL: not given */
} interface_options_t;

/** Nothing given. @param rows are filled in with the options */
void interface_options_init(interface_options_t *options, option_t rows[INTERFACE_OPTIONS]);

/**
 * Check that there are as many interfaces as the topology needs, and that they are not the same.
 * @param command "run": whose `--help` is named
 * @return false: not so; was reported.
 */
bool interface_options_check(const interface_options_t *options, const char *command, bool is_gateway);

#endif

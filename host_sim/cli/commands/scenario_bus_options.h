/**
 * @file scenario_bus_options.h
 * The options of `host_sim scenario` that choose where it plays: the simulated bus, or CAN interfaces.
 */
#ifndef HOST_SIM_SCENARIO_BUS_OPTIONS_H
#define HOST_SIM_SCENARIO_BUS_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "cli/options.h"
#include "hal_linux/linux_can.h"
#include "live/scenario_bus.h"

#define SCENARIO_BUS_OPTIONS 4u

/** What was given. Start from scenario_bus_options_init(). */
typedef struct {
    const char *bus;                                             /**< --bus; NULL: not given */
    const char *supervisor;                                      /**< --supervisor; NULL: not given */
    const char *sent;                                            /**< --sent; NULL: not given */
    uint64_t tolerance_ms;                                       /**< --tolerance; OPTION_NOT_GIVEN */
    char interface_names[HAL_CAN_SIDES][LINUX_CAN_NAME_MAX + 1]; /**< "": none; no vehicle side: the simulated bus */
} scenario_bus_options_t;

/** Nothing given. @param rows are filled in with the options; for the command's option groups */
void scenario_bus_options_init(scenario_bus_options_t *options, option_t rows[SCENARIO_BUS_OPTIONS]);

/** Whether any was given. */
bool scenario_bus_options_any(const scenario_bus_options_t *options);

/** Take --bus apart, and see whether the others fit it. @return false: reported */
bool scenario_bus_options_check(scenario_bus_options_t *options);

/** Whether --bus names CAN interfaces. */
bool scenario_bus_options_is_real(const scenario_bus_options_t *options);

/** The interfaces. It points into @p options. */
scenario_bus_t scenario_bus_options_bus(const scenario_bus_options_t *options);

#endif

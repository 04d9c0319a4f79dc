/**
 * @file fault_option.h
 * Options that name a fault which the simulated bus can cause.
 */
#ifndef HOST_SIM_FAULT_OPTION_H
#define HOST_SIM_FAULT_OPTION_H

#include <stdbool.h>

#include "campaign/campaign_rows.h"
#include "cli/options.h"

/** The names, "A|B|C". */
const char *fault_option_names(void);

/** Row of a table of options. */
#define OPTION_FAULT(name_, help_, target)                                                                             \
    {.name = (name_), .value = "FAULT", .help = (help_), .text = (target), .candidates = fault_option_names}

/**
 * Find the fault of an option.
 * @param option its name, for messages
 * @param name   its value; NULL: it was not given, and @p row stays
 * @return false: no fault, or one that cannot be caused; was reported
 */
bool fault_option_take(const char *option, const char *name, const campaign_row_t **row);

#endif

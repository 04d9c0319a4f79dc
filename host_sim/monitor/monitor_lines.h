/**
 * @file monitor_lines.h
 * The monitor where standard output is no terminal: a line for each transition.
 */
#ifndef HOST_SIM_MONITOR_LINES_H
#define HOST_SIM_MONITOR_LINES_H

#include <stdbool.h>

#include "monitor/monitor_log.h"

/** Print an entry. A monitor_entry_fn; @p ctx is not used. */
void monitor_lines_print(void *ctx, const monitor_entry_t *entry);

/** Hand over what was printed; wait for a slow reader. @return false: a signal came, or standard output failed */
bool monitor_lines_flush(void);

#endif

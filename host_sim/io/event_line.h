/**
 * @file event_line.h
 * An event of a supervisor, read from a line of JSON as events.h writes it.
 */
#ifndef HOST_SIM_EVENT_LINE_H
#define HOST_SIM_EVENT_LINE_H

#include <stdbool.h>
#include <stddef.h>

#include "session/session.h"

/** Read a line; t_ms stays 0. @return false: not an event, or the summary */
bool event_line_read(const char *line, size_t length, session_event_t *event);

#endif

/**
 * @file log_sides.h
 * Which interface of a log is the AI side (option --ai-if).
 */
#ifndef HOST_SIM_LOG_SIDES_H
#define HOST_SIM_LOG_SIDES_H

#include <stdbool.h>

/**
 * Whether the interface that was given fits the topology: a gateway needs one, a shared bus has none.
 * @param ai_interface NULL: not given
 * @return false: it does not, or is too long for a name; was reported
 */
bool log_sides_check(bool is_gateway, const char *ai_interface);

/** Print when the log had no frame of the given interface: the AI side was then silent in the whole run. */
void log_sides_note_silent(const char *ai_interface, bool was_heard);

#endif

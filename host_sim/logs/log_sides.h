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

/**
 * Whether the log, which is over, had a frame of the given interface. Without one the name is wrong.
 * @param ai_interface NULL: not given
 * @param heard the other interfaces of the log, or one of them
 * @return false: it had none; was reported
 */
bool log_sides_check_heard(const char *ai_interface, bool was_heard, const char *heard);

#endif

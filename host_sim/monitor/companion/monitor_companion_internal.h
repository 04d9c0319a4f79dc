/**
 * @file monitor_companion_internal.h
 * What goes from the program to its companion.
 */
#ifndef HOST_SIM_MONITOR_COMPANION_INTERNAL_H
#define HOST_SIM_MONITOR_COMPANION_INTERNAL_H

#include "monitor/companion/monitor_companion.h"
#include "monitor/monitor.h"

/** Kinds of messages. */
typedef enum { MONITOR_MESSAGE_SHOW, MONITOR_MESSAGE_EVENT, MONITOR_MESSAGE_STATE } monitor_message_kind_t;

/** A message: both ends are the same program, so the struct itself is sent. */
typedef struct {
    monitor_message_kind_t kind;
    session_event_t event;
    monitor_supervisor_t state;
} monitor_message_t;

/** The companion's ends. */
typedef struct {
    int control;
    int text;
    int typed;
    pid_t parent;
} monitor_ends_t;

/** The companion: runs until the program has ended or the user quits. @return exit status */
int monitor_companion_main(const monitor_companion_config_t *config, const monitor_ends_t *ends);

#endif

/**
 * @file monitor_companion.h
 * The monitor as the screen of a program that is a node itself (`run`, `vehicle`). It is a process of its own, which
 * listens to the same interfaces: drawing never holds up the node. The program tells it what its supervisor does; what
 * the program prints is listed among the transitions, and typed lines go to the program.
 *
 * Order: monitor_companion_fork() before anything is opened, monitor_companion_show() when the node runs,
 * monitor_companion_end() when it has ended.
 */
#ifndef HOST_SIM_MONITOR_COMPANION_H
#define HOST_SIM_MONITOR_COMPANION_H

#include <stdbool.h>
#include <sys/types.h>

#include "agv/config.h"
#include "hal/can.h"
#include "session/session.h"

/** How it is made. */
typedef struct {
    const char *title; /**< "run" */
    const agv_config_t *config;
    const char *interfaces[HAL_CAN_SIDES];
    bool has_supervisor; /**< monitor_companion_tell() is called; else the state comes from the bus */
    bool can_type;
} monitor_companion_config_t;

/** The side of the program. Start from all zero. */
typedef struct {
    pid_t child; /**< 0: there is none, and all functions do nothing */
    int control; /**< to the companion */
    int text;    /**< to the companion: what is printed */
    int typed;   /**< typed lines come from here */
    int stdout_was;
    int stderr_was;
    bool is_shown;
    uint64_t told_ms; /**< when the state was told last */
} monitor_companion_t;

/**
 * Start it, unshown, if there is a terminal; else there is none, successfully. It ends when the program does; when the
 * user quits, the program gets SIGTERM.
 * @return false: was reported
 */
bool monitor_companion_fork(monitor_companion_t *companion, const monitor_companion_config_t *config);

/** Show the screen. Standard output and standard error go to it from now on. */
void monitor_companion_show(monitor_companion_t *companion);

/** Tell it an event of the supervisor. Never waits. */
void monitor_companion_event(monitor_companion_t *companion, const session_event_t *event);

/** Tell it the state of the supervisor, ten times a second. Never waits. */
void monitor_companion_tell(monitor_companion_t *companion, const session_t *session, uint64_t now_ms);

/** Where typed lines come from: to be used in place of standard input. -1: there is no companion */
int monitor_companion_typed(const monitor_companion_t *companion);

/** End it, and give the terminal back. */
void monitor_companion_end(monitor_companion_t *companion);

#endif

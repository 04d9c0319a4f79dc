/**
 * @file live_files.h
 * The files of a node in a loop: which of them are waited for, as interfaces go and come back.
 */
#ifndef HOST_SIM_LIVE_FILES_H
#define HOST_SIM_LIVE_FILES_H

#include <stdbool.h>

#include "hal/can.h"
#include "hal_linux/linux_loop.h"
#include "live/node.h"

/** The files to wait for. Start from live_files_none(). */
typedef struct {
    int fds[HAL_CAN_SIDES]; /**< -1: nothing */
} live_files_t;

/** Nothing is waited for. */
void live_files_none(live_files_t *files);

/** Wait for the present files of a node, and for no others of it. @return false: was reported */
bool live_files_follow(live_files_t *files, linux_loop_t *loop, const node_t *node);

/** Wait for none of them. */
void live_files_leave(live_files_t *files, linux_loop_t *loop);

#endif

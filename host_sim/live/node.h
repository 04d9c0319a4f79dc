/**
 * @file node.h
 * A supervisor as a node on SocketCAN: the shipped core on the SocketCAN port (hal/linux), in a session.
 *
 * This file alone knows the SocketCAN port; the rest of the program runs on the simulated one.
 */
#ifndef HOST_SIM_NODE_H
#define HOST_SIM_NODE_H

#include <stdbool.h>
#include <stdint.h>

#include "agv/config.h"
#include "hal/can.h"
#include "session/session.h"

typedef struct node node_t;

/** A frame of the supervisor has left. @param at_us since the node was opened */
typedef void node_sent_fn(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us);

/** A frame is handed to the supervisor. @param at_us when it was received, since the node was opened */
typedef void node_received_fn(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us);

/** How a node is made. */
typedef struct {
    const agv_config_t *config;            /**< is copied */
    const char *interfaces[HAL_CAN_SIDES]; /**< the AI side: NULL on the shared bus */
    session_observer_fn *on_event;         /**< or NULL; t_ms since the node was opened */
    node_sent_fn *on_sent;                 /**< or NULL */
    node_received_fn *on_received;         /**< or NULL */
    void *ctx;                             /**< of all */
} node_config_t;

/**
 * Open the interfaces. The supervisor does not run yet.
 * @return NULL: that was reported
 */
node_t *node_open(const node_config_t *config);

/** Start the supervisor, or start it again. */
void node_start(node_t *node);

/** The file of a side, for linux_loop_add(); -1: not open now. */
int node_fd(const node_t *node, hal_can_side_t side);

/** Hand over what has arrived. */
void node_receive(node_t *node);

/** Hand over what has arrived by now, and a tick at this time. @return true: a file of node_fd() has changed */
bool node_tick(node_t *node);

/** Microseconds since the node was opened. */
uint64_t node_now_us(const node_t *node);

/** Its session, to read. */
const session_t *node_session(const node_t *node);

/** After the supervisor's last call: wait until its frames have left, LINUX_HAL_FINISH_MS at most. Nothing for NULL. */
void node_finish(node_t *node);

/** End: nothing more is sent, what waits is discarded, as when the power fails. Nothing for NULL. */
void node_close(node_t *node);

#endif

/**
 * @file linux_hal_internal.h
 * What the files of the port share. linux_hal.c drives a side, linux_hal_queue.c holds what waits to be sent,
 * linux_hal_controller.c the state of the controller.
 */
#ifndef HAL_LINUX_LINUX_HAL_INTERNAL_H
#define HAL_LINUX_LINUX_HAL_INTERNAL_H

#include "hal_forward/hal_ops.h"
#include "hal_linux/linux_hal.h"

extern const hal_ops_t linux_hal_ops;

/** The side, or NULL when it does not exist. */
linux_hal_side_t *linux_hal_side(hal_t *hal, hal_can_side_t side);

/** Take a frame to be sent. @return false: no room, in the kernel or here; or not a frame that can be sent */
bool linux_hal_queue_take(linux_hal_side_t *side, const hal_can_frame_t *frame, uint64_t now_us);

/** Give the next frame to the kernel, if it has none. */
void linux_hal_queue_give(linux_hal_side_t *side, uint64_t now_us);

/** A frame of this socket has left: if it is the one that the kernel was given last, it has none any more. */
void linux_hal_queue_left(linux_hal_side_t *side, const hal_can_frame_t *frame);

/** Forget what waits; what the kernel has may still leave. */
void linux_hal_queue_purge(linux_hal_side_t *side);

/** Forget what waits, and what the kernel had. */
void linux_hal_queue_discard(linux_hal_side_t *side);

/** As hal_can_status_t.tx_pending_ms. */
uint32_t linux_hal_queue_pending_ms(const linux_hal_side_t *side, uint64_t now_us);

/** Let an error frame act on the controller's state. */
void linux_hal_controller_error(linux_hal_side_t *side, const hal_can_frame_t *frame);

/** The interface went down, or is gone. */
void linux_hal_controller_down(linux_hal_side_t *side);

/** It is up. */
void linux_hal_controller_up(linux_hal_side_t *side);

/** The state to report. */
hal_can_state_t linux_hal_controller_state(const linux_hal_side_t *side);

#endif

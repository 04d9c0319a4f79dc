/**
 * @file linux_hal_internal.h
 * Declarations that the source files of the port share. linux_hal.c runs a side, linux_hal_queue.c contains the queue
 * of frames to send, linux_hal_controller.c the state of the controller.
 */
#ifndef HAL_LINUX_LINUX_HAL_INTERNAL_H
#define HAL_LINUX_LINUX_HAL_INTERNAL_H

#include "hal_forward/hal_ops.h"
#include "hal_linux/linux_hal.h"

extern const hal_ops_t linux_hal_ops;

/** The side, or NULL when it does not exist. */
linux_hal_side_t *linux_hal_side(hal_t *hal, hal_can_side_t side);

/** Accept a frame to be sent. @return false: no room in the kernel or in the queue, or a frame that cannot be sent */
bool linux_hal_queue_take(linux_hal_side_t *side, const hal_can_frame_t *frame, uint64_t now_us);

/** Pass the next frame to the kernel, if no frame is in flight. */
void linux_hal_queue_give(linux_hal_side_t *side, uint64_t now_us);

/** Handle the echo of a sent frame: if it is the frame in flight, none is in flight any more. */
void linux_hal_queue_left(linux_hal_side_t *side, const hal_can_frame_t *frame);

/**
 * Give up a frame in flight whose echo does not come. Call regularly, for a side that is not purged.
 * @param now_us the time up to which echoes were read; here and below
 */
void linux_hal_queue_look(linux_hal_side_t *side, uint64_t now_us);

/** Discard the waiting frames. The frame in flight may still be sent; one whose echo does not come is given up. */
void linux_hal_queue_purge(linux_hal_side_t *side, uint64_t now_us);

/** Discard the waiting frames and the frame in flight: the kernel has dropped it. */
void linux_hal_queue_discard(linux_hal_side_t *side);

/** As hal_can_status_t.tx_pending_ms. */
uint32_t linux_hal_queue_pending_ms(const linux_hal_side_t *side, uint64_t now_us);

/** Update the controller's state from an error frame. */
void linux_hal_controller_error(linux_hal_side_t *side, const hal_can_frame_t *frame);

/** The interface went down or was removed. */
void linux_hal_controller_down(linux_hal_side_t *side);

/** The interface is up. */
void linux_hal_controller_up(linux_hal_side_t *side);

/** Compare with the state that the kernel reports: error frames may have been lost, or sent before the port was opened. */
void linux_hal_controller_look(linux_hal_side_t *side);

/** Update the controller's state from one that the kernel was asked for. */
void linux_hal_controller_asked(linux_hal_side_t *side, hal_can_state_t state);

/** The state that hal_can_status() reports. */
hal_can_state_t linux_hal_controller_state(const linux_hal_side_t *side);

#endif

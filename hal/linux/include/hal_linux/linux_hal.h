/**
 * @file linux_hal.h
 * The SocketCAN port: `struct hal` for a supervisor that is a node on one or two CAN interfaces.
 *
 * Frames wait here, lowest identifier first. The kernel gets one frame at a time, the next one when the echo shows that
 * the last one was sent. So after a purge or bus-off at most one frame may still be sent (hal/can.h). SocketCAN alone does
 * not ensure that: frames cannot be removed from the kernel's queue.
 *
 * Controller states come from error frames: bus-off, restarted, error passive, error active, overrun. Bus-off also comes from
 * the kernel's reports on the interface. An interface that is down or gone reports bus-off until it is back. A virtual
 * interface has no controller; error frames that a program sends there have the same effect. There is no hardware watchdog,
 * and the latch is kept in memory only.
 *
 * What hal_can_status() reports is as of the last linux_hal_receive().
 */
#ifndef HAL_LINUX_LINUX_HAL_H
#define HAL_LINUX_LINUX_HAL_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/can.h"
#include "hal/clock.h"
#include "hal/hal.h"
#include "hal/led.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "hal/store.h"
#include "hal/watchdog.h"
#include "hal_forward/hal_ops.h"
#include "hal_linux/linux_can.h"
#include "hal_linux/linux_clock.h"

/** Frames of one side that wait here; hal_can_send() refuses more. */
#define LINUX_HAL_QUEUE_SIZE 16u

/** Called for every frame of this supervisor that was sent. @param at_us the kernel's time stamp, since the start */
typedef void linux_hal_left_fn(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame, uint64_t at_us);

/** How a port is opened. */
typedef struct {
    const char *interfaces[HAL_CAN_SIDES]; /**< AI side NULL: shared bus */
    const uint16_t *ids;                   /**< identifiers in use, own ones among them: see linux_can_options_t */
    size_t id_count;
    linux_hal_left_fn *on_left; /**< or NULL */
    void *ctx;
} linux_hal_config_t;

/** A frame that waits to be given to the kernel. */
typedef struct {
    hal_can_frame_t frame;
    uint64_t taken_us; /**< when hal_can_send() took it */
    uint64_t since_us; /**< from when its age counts: taken_us of the first frame that it replaced, or its own */
} linux_hal_waiting_t;

/** One side. */
typedef struct {
    const char *interface; /**< NULL: it does not exist */
    linux_can_t can;
    bool is_open; /**< the interface existed at the last check */
    bool is_up;
    bool fd_changed; /**< linux_hal_tick() must still report it */
    uint64_t look_again_us;
    hal_can_state_t state;   /**< of the controller */
    uint8_t looks_restarted; /**< times in a row that the kernel, asked in bus-off, said that this is over */
    uint16_t bus_offs;
    uint16_t overruns;
    uint32_t lost;            /**< as in the last record */
    bool in_flight;           /**< the kernel has a frame */
    linux_hal_waiting_t sent; /**< that one */
    bool sent_is_purged;      /**< it may still be sent, but no longer counts as pending (tx_pending_ms) */
    uint64_t given_us;        /**< when the kernel accepted it */
    uint8_t given_up;         /**< frames whose echo did not come, in a row (up to a limit) */
    linux_hal_waiting_t waiting[LINUX_HAL_QUEUE_SIZE];
    size_t waiting_count;
    bool has_next; /**< `next` is the record that linux_hal_receive() returns next */
    linux_can_record_t next;
    uint64_t next_us; /**< its receive time */
} linux_hal_side_t;

/** The port. The members may be read; change them through the functions only. */
struct hal {
    const hal_ops_t *ops; /**< first: hal_ops.h */
    linux_hal_side_t sides[HAL_CAN_SIDES];
    linux_hal_config_t config;
    linux_clock_t clock;
    uint64_t handed_us; /**< receive time of the frame that was returned last */
    uint64_t looked_us; /**< when linux_hal_receive() last looked */
    bool led_on;
    bool output_closed;
    uint32_t feeds;
    uint8_t latch[HAL_STORE_LATCH_SIZE_MAX];
    size_t latch_size;
};

/**
 * Open the port. Its clock starts at 0.
 * @param config is copied; the strings and identifiers must outlive the port
 * @param error LINUX_CAN_ERROR_SIZE bytes for a one-line error message (no such interface, both sides on one, ...)
 * @return false: not opened
 */
bool linux_hal_open(hal_t *hal, const linux_hal_config_t *config, char *error);

/** Longest time of linux_hal_finish(): the waiting frames at 125 kbit/s, about 1 ms each, and one in transmission. */
#define LINUX_HAL_FINISH_MS 20

/**
 * Send the waiting frames and report them (on_left), so that the bus does not end with an incomplete set of commands.
 * Returns when no frame waits, or after LINUX_HAL_FINISH_MS; does not wait for a side that is down or gone. Received
 * frames are discarded: only linux_hal_close() may follow.
 */
void linux_hal_finish(hal_t *hal);

/** Close the port, the AI side first. Waiting frames are discarded; sent ones are reported (on_left). */
void linux_hal_close(hal_t *hal);

/** The file descriptor of a side, for linux_loop.h; it changes when an interface comes back. -1: none now. */
int linux_hal_fd(const hal_t *hal, hal_can_side_t side);

/** Microseconds since the port was opened: the clock with a finer resolution. */
uint64_t linux_hal_now_us(const hal_t *hal);

/**
 * Take the next received frame, the earliest of both sides. Own frames are not returned; error frames are, after they have
 * changed the state.
 * @param frame time_ms and time_us: the clock at its reception, from the kernel's time stamp
 * @param at_us its receive time since the port was opened; never before that of the previous frame
 * @return false: no frame
 */
bool linux_hal_receive(hal_t *hal, hal_can_side_t *side, hal_can_frame_t *frame, uint64_t *at_us);

/**
 * Call every millisecond, before the supervisor's tick. Passes waiting frames to the kernel, and checks for interfaces that
 * are down or gone. @return true: the file descriptor of a side (linux_hal_fd()) has changed.
 */
bool linux_hal_tick(hal_t *hal);

#endif

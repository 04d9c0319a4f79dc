/**
 * @file linux_hal.h
 * The SocketCAN port: `struct hal` for a supervisor that is a node on one or two CAN interfaces.
 *
 * What is sent waits here, lowest identifier first; the kernel is given one frame at a time, the next one when that has
 * left (its echo came back). So a purge, or bus-off, leaves at most one frame that may still go out (hal/can.h), which
 * SocketCAN alone could not promise: nobody takes a frame back from the kernel's queue.
 *
 * Controller states come from error frames: bus-off, restarted, error passive, error active, overrun. An interface that
 * is down or gone reports bus-off until it is back. A virtual interface has no controller; error frames that somebody
 * sends there act the same. There is no hardware watchdog, and the latch is kept in memory: both end with the program.
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

/** Told of every frame of this supervisor that has left, with the kernel's stamp in time since the start. */
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
} linux_hal_waiting_t;

/** One side. */
typedef struct {
    const char *interface; /**< NULL: it does not exist */
    linux_can_t can;
    bool is_open; /**< the interface was there when last looked for */
    bool is_up;
    bool fd_changed; /**< linux_hal_tick() has still to tell */
    uint64_t look_again_us;
    hal_can_state_t state; /**< of the controller, as error frames tell */
    uint16_t bus_offs;
    uint16_t overruns;
    uint32_t lost;            /**< as in the last record */
    bool in_flight;           /**< the kernel has a frame */
    linux_hal_waiting_t sent; /**< that one */
    bool sent_is_purged;      /**< it may still leave, and is not waited for any more (tx_pending_ms) */
    uint64_t given_us;        /**< when the kernel took it */
    linux_hal_waiting_t waiting[LINUX_HAL_QUEUE_SIZE];
    size_t waiting_count;
    bool has_next; /**< the record that linux_hal_receive() hands out next */
    linux_can_record_t next;
    uint64_t next_us; /**< its arrival */
} linux_hal_side_t;

/** Read the members freely; change nothing but through the functions. */
struct hal {
    const hal_ops_t *ops; /**< first: hal_ops.h */
    linux_hal_side_t sides[HAL_CAN_SIDES];
    linux_hal_config_t config;
    linux_clock_t clock;
    uint64_t handed_us; /**< arrival of the frame that was handed out last */
    bool led_on;
    bool output_closed;
    uint32_t feeds;
    uint8_t latch[HAL_STORE_LATCH_SIZE_MAX];
    size_t latch_size;
};

/**
 * Open the port; its clock reads 0 now.
 * @param config is copied; the strings and identifiers must outlive the port
 * @param error LINUX_CAN_ERROR_SIZE bytes for one line that says what is wrong (no such interface, two sides on one, ...)
 * @return false: not opened
 */
bool linux_hal_open(hal_t *hal, const linux_hal_config_t *config, char *error);

/** How long linux_hal_finish() takes at most: what waits at 125 kbit/s, some 1 ms a frame, and a frame that is on its way. */
#define LINUX_HAL_FINISH_MS 20

/**
 * Let what waits leave, and tell of it (on_left), so that no half of a set of commands is what the bus saw last. Returns when
 * nothing waits, or after LINUX_HAL_FINISH_MS; a side that is down or gone is not waited for. What is received is
 * forgotten: only linux_hal_close() may follow.
 */
void linux_hal_finish(hal_t *hal);

/** Close, the AI side first. What still waits is discarded; what has left is told of (on_left). */
void linux_hal_close(hal_t *hal);

/** The file of a side, to wait for (linux_loop.h); it changes when an interface comes back. -1: none at the moment. */
int linux_hal_fd(const hal_t *hal, hal_can_side_t side);

/** Microseconds since the port was opened: the clock, finer. */
uint64_t linux_hal_now_us(const hal_t *hal);

/**
 * Take the next received frame, of both sides the one that arrived first. Own frames are not among them, error frames
 * are, after they have acted on the state.
 * @param frame time_ms and time_us: the clock at its arrival, by the kernel's stamp
 * @param at_us the same moment since the port was opened; never before that of the frame handed out last
 * @return false: nothing there
 */
bool linux_hal_receive(hal_t *hal, hal_can_side_t *side, hal_can_frame_t *frame, uint64_t *at_us);

/**
 * A millisecond passed; before the supervisor's tick. Gives what waits to the kernel, looks for interfaces that are down
 * or gone. @return true: a side's file (linux_hal_fd()) has changed.
 */
bool linux_hal_tick(hal_t *hal);

#endif

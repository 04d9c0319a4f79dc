/**
 * @file linux_can.h
 * One raw SocketCAN socket on one interface. It never blocks and allocates nothing. The port of hal_linux is built on it,
 * and so are simulated nodes and listeners.
 */
#ifndef HAL_LINUX_LINUX_CAN_H
#define HAL_LINUX_LINUX_CAN_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/can.h"

/** Characters of an interface's name, without the final 0 (IFNAMSIZ - 1). */
#define LINUX_CAN_NAME_MAX 15u
/** Room for a message of linux_can_open(). */
#define LINUX_CAN_ERROR_SIZE 160u
/** Identifiers that can be filtered for. */
#define LINUX_CAN_IDS_MAX 64u

/** Options of a socket. All zero: everything is received except error frames and own frames. */
typedef struct {
    const uint16_t *ids; /**< 11-bit identifiers that the kernel lets through; 29-bit and remote frames whose identifier
                                has the same value too (they are counted as rejected). NULL: all frames */
    size_t id_count;     /**< at most LINUX_CAN_IDS_MAX */
    bool error_frames;   /**< controller errors as frames with HAL_CAN_ERROR */
    bool own_frames;     /**< frames of this socket are received too, marked `own`, when they have been sent */
    uint32_t receive_size; /**< bytes of the receive queue asked for (SO_RCVBUF); 0: the system's default */
} linux_can_options_t;

/** An open socket; change it through the functions. */
typedef struct {
    int fd;                     /**< for epoll: readable when linux_can_read() has something; -1: not open */
    int index;                  /**< of the interface */
    bool is_down;               /**< it was down at the last read or write */
    bool report_down;           /**< a write found it down, and linux_can_read() must still report it */
    bool is_gone;               /**< the interface no longer exists */
    bool has_link;              /**< linux_can_is_up() was called */
    int link_fd;                /**< then: the socket on which the kernel reports changes of interfaces */
    bool link_is_known;         /**< then: the kernel answered the last question, or reported a change since */
    bool link_is_up;            /**< then: the last reported state */
    bool link_has_state;        /**< then: its controller has an error state */
    hal_can_state_t link_state; /**< then: the last reported one */
} linux_can_t;

/** Result of linux_can_read(). */
typedef enum {
    LINUX_CAN_RECORD, /**< a frame */
    LINUX_CAN_NOTHING,
    LINUX_CAN_IS_DOWN, /**< the interface went down; reported once each time. The socket works again when it is up */
    LINUX_CAN_IS_GONE  /**< the interface no longer exists: close the socket, and open it again when it is back */
} linux_can_read_t;

/** Result of linux_can_write(). */
typedef enum {
    LINUX_CAN_TAKEN,
    LINUX_CAN_FULL,      /**< ENOBUFS, EAGAIN: the kernel's queue is full */
    LINUX_CAN_NOT_TAKEN, /**< interface down, gone, or a frame that cannot be sent */
} linux_can_write_t;

/** A received frame. */
typedef struct {
    hal_can_frame_t frame; /**< time_ms and time_us are 0; the identifier of an error frame is its classes */
    uint64_t stamp_us;     /**< the kernel's time stamp of its reception, CLOCK_REALTIME; 0: it has none */
    uint32_t lost; /**< frames that this socket's full queue has lost since it was opened (SO_RXQ_OVFL), wrapping */
    bool own;      /**< this socket sent it (options.own_frames) */
} linux_can_record_t;

/**
 * Open a socket on an interface that exists and is a CAN interface; it may be down.
 * @param error LINUX_CAN_ERROR_SIZE bytes for a one-line error message that names the interface
 * @return false: not opened
 */
bool linux_can_open(linux_can_t *can, const char *interface, const linux_can_options_t *options, char *error);

/** Close the socket; does nothing if it is not open. */
void linux_can_close(linux_can_t *can);

/** Read the next frame, if there is one. */
linux_can_read_t linux_can_read(linux_can_t *can, linux_can_record_t *record);

/** Send a classic data frame, with HAL_CAN_EXTENDED and HAL_CAN_REMOTE if set, or an error frame. */
linux_can_write_t linux_can_write(linux_can_t *can, const hal_can_frame_t *frame);

/**
 * Whether the interface is up; false also if that is unknown. The first call queries the kernel, which may block while an
 * interface is being changed. Later calls read the changes that the kernel has reported, and query again only if some of
 * these reports were lost (hundreds of changes between two calls), or the last query failed.
 */
bool linux_can_is_up(linux_can_t *can);

/**
 * The controller's state that the kernel last reported (linux_can_is_up()). It reports the begin and the end of bus-off, up
 * to a second late, and not each change between the other states.
 * @return false: unknown, because it has no controller (a virtual interface), or that does not run
 */
bool linux_can_state(const linux_can_t *can, hal_can_state_t *state);

/**
 * Query the kernel now, for linux_can_state() and linux_can_is_up(). This may block while an interface is being changed.
 * @return false: no answer, and nothing has changed
 */
bool linux_can_ask(linux_can_t *can);

/**
 * Request that the kernel restarts a controller in bus-off (`ip link set IF type can restart`). Needs CAP_NET_ADMIN.
 * @return false: refused, or no controller (a virtual interface). An error frame reports the end of bus-off.
 */
bool linux_can_restart(const linux_can_t *can);

#endif

/**
 * @file linux_can_internal.h
 * Declarations that the source files of a socket share.
 */
#ifndef HAL_LINUX_LINUX_CAN_INTERNAL_H
#define HAL_LINUX_LINUX_CAN_INTERNAL_H

#include <stdbool.h>
#include <stddef.h>

#include "hal/can.h"

/** What the kernel says of an interface. */
typedef struct {
    int index;
    unsigned kind; /**< ARPHRD_CAN for one that carries CAN */
    bool is_up;
    bool has_state;        /**< it has a controller, which runs */
    hal_can_state_t state; /**< then: of the controller; else HAL_CAN_ERROR_ACTIVE */
} linux_can_link_t;

/**
 * Read a message of rtnetlink (RTM_NEWLINK, RTM_DELLINK).
 * @param size bytes that were received; the lengths in the message may be wrong
 * @return false: a message of another kind, or not even its head
 */
bool linux_can_link_read(const void *message, size_t size, linux_can_link_t *link);

/**
 * Look for an interface by rtnetlink. An ioctl with a name that does not exist would start modprobe and wait for it, at
 * every search for an adapter that was unplugged.
 * @param name at most LINUX_CAN_NAME_MAX characters
 * @param kind ARPHRD_CAN for one that carries CAN
 * @return 0, or an errno
 */
int linux_can_find(const char *name, int *index, unsigned *kind);

#endif

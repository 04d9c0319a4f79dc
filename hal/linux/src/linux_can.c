/* Opening and closing a socket, and its options. */
#include "hal_linux/linux_can.h"

#include <errno.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if_arp.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "linux_can_internal.h"

/* Characters of a name in an error message; a longer name is cut off. */
#define NAME_SHOWN 40

static bool refuse(char *error, const char *interface, const char *what) {
    (void)snprintf(error, LINUX_CAN_ERROR_SIZE, "%.*s: %s", NAME_SHOWN, interface, what);
    return false;
}

static bool refuse_errno(char *error, const char *interface, const char *what) {
    (void)snprintf(error, LINUX_CAN_ERROR_SIZE, "%.*s: %s: %s", NAME_SHOWN, interface, what, strerror(errno));
    return false;
}

static bool open_socket(linux_can_t *can, const char *interface, char *error) {
    can->fd = socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW);
    if (can->fd >= 0) {
        return true;
    }
    can->fd = -1;
    if (errno == EAFNOSUPPORT || errno == EPROTONOSUPPORT) {
        return refuse(error, interface, "this kernel has no CAN, or 'modprobe can-raw' is needed first");
    }
    return refuse_errno(error, interface, "no CAN socket");
}

static bool find_interface(linux_can_t *can, const char *interface, char *error) {
    unsigned kind = 0;
    errno = linux_can_find(interface, &can->index, &kind);
    if (errno != 0) {
        return (errno == ENODEV) ? refuse(error, interface, "there is no such interface")
                                 : refuse_errno(error, interface, "not found");
    }
    return (kind == ARPHRD_CAN) || refuse(error, interface, "not a CAN interface");
}

static bool set_option(const linux_can_t *can, int level, int name, int value) {
    return setsockopt(can->fd, level, name, &value, sizeof value) == 0;
}

/* Only the value is compared, so 29-bit and remote frames with the value of one of the identifiers pass, too. */
static bool set_filters(const linux_can_t *can, const linux_can_options_t *options) {
    struct can_filter filters[LINUX_CAN_IDS_MAX];
    for (size_t i = 0; i < options->id_count; i++) {
        filters[i] = (struct can_filter){.can_id = options->ids[i], .can_mask = CAN_EFF_MASK};
    }
    const socklen_t size = (socklen_t)(options->id_count * sizeof filters[0]);
    return setsockopt(can->fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters, size) == 0;
}

static bool set_options(const linux_can_t *can, const linux_can_options_t *options) {
    return set_option(can, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, 1) && set_option(can, SOL_SOCKET, SO_TIMESTAMPNS, 1) &&
           set_option(can, SOL_SOCKET, SO_RXQ_OVFL, 1) &&
           set_option(can, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, options->error_frames ? (int)CAN_ERR_MASK : 0) &&
           set_option(can, SOL_CAN_RAW, CAN_RAW_RECV_OWN_MSGS, options->own_frames ? 1 : 0) &&
           (options->receive_size == 0 || set_option(can, SOL_SOCKET, SO_RCVBUF, (int)options->receive_size)) &&
           (options->ids == NULL || set_filters(can, options));
}

/* The socket is bound last: until then it receives nothing, so no frame arrives before all options are set. */
static bool prepare(linux_can_t *can, const char *interface, const linux_can_options_t *options, char *error) {
    if (!find_interface(can, interface, error)) {
        return false;
    }
    if (!set_options(can, options)) {
        return refuse_errno(error, interface, "the kernel refuses an option of CAN sockets");
    }
    const struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = can->index};
    if (bind(can->fd, (const struct sockaddr *)&address, sizeof address) != 0) {
        return refuse_errno(error, interface, "cannot be used");
    }
    return true;
}

bool linux_can_open(linux_can_t *can, const char *interface, const linux_can_options_t *options, char *error) {
    *can = (linux_can_t){.fd = -1};
    error[0] = '\0';
    if (strlen(interface) > LINUX_CAN_NAME_MAX) {
        return refuse(error, interface, "the name of an interface has at most 15 characters");
    }
    if (options->id_count > LINUX_CAN_IDS_MAX) {
        return refuse(error, interface, "more identifiers than can be filtered for");
    }
    if (!open_socket(can, interface, error)) {
        return false;
    }
    if (!prepare(can, interface, options, error)) {
        linux_can_close(can);
        return false;
    }
    return true;
}

void linux_can_close(linux_can_t *can) {
    if (can->fd >= 0) {
        (void)close(can->fd); /* closed even after an error; no data is left to write */
    }
    if (can->has_link) {
        (void)close(can->link_fd);
    }
    *can = (linux_can_t){.fd = -1};
}

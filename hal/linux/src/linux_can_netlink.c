/* Operations by rtnetlink: find an interface, read whether it is up and the state of its controller, and restart a
 * controller in bus-off. */
#include <errno.h>
#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal_linux/linux_can.h"
#include "linux_can_internal.h"

/* More messages than the kernel keeps for a socket. */
#define NEWS_AT_ONCE_MAX 1024u

typedef struct {
    struct nlmsghdr header;
    struct ifinfomsg interface;
} look_t;

typedef struct {
    struct nlmsghdr header;
    struct ifinfomsg interface;
    struct rtattr name;
    char name_text[IFNAMSIZ];
} find_t;

/* Nested attributes. The size of every part is a multiple of four bytes, so there is no padding between them. */
typedef struct {
    struct nlmsghdr header;
    struct ifinfomsg interface;
    struct rtattr link_info;
    struct rtattr kind;
    char kind_text[4];
    struct rtattr data;
    struct rtattr restart;
    uint32_t restart_value;
} restart_t;

_Static_assert(sizeof(find_t) == NLMSG_HDRLEN + sizeof(struct ifinfomsg) + 20, "attributes follow each other");
_Static_assert(sizeof(restart_t) == NLMSG_HDRLEN + sizeof(struct ifinfomsg) + 24, "attributes follow each other");

/* A message of the kernel: all of what it says of a CAN interface. The rest of a longer one is cut off. */
typedef union {
    struct {
        struct nlmsghdr header;
        struct nlmsgerr verdict;
    } is;
    unsigned char bytes[8192];
} answer_t;

/* The kernel executes a request within send(), so the answer can be read as soon as send() returns. */
static int exchange(int fd, const void *request, size_t size, linux_can_link_t *link) {
    answer_t answer;
    if (send(fd, request, size, MSG_DONTWAIT) < 0) {
        return errno;
    }
    const ssize_t answered = recv(fd, &answer, sizeof answer, MSG_DONTWAIT);
    if (answered < 0) {
        return errno;
    }
    if ((size_t)answered >= sizeof answer.is && answer.is.header.nlmsg_type == NLMSG_ERROR) {
        return -answer.is.verdict.error;
    }
    return linux_can_link_read(answer.bytes, (size_t)answered, link) ? 0 : EPROTO;
}

static int query(const void *request, size_t size, linux_can_link_t *link) {
    *link = (linux_can_link_t){0};
    const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
    if (fd < 0) {
        return errno;
    }
    const int result = exchange(fd, request, size, link);
    (void)close(fd);
    return result;
}

static struct rtattr attribute(unsigned type, size_t begin, size_t end) {
    return (struct rtattr){.rta_type = (unsigned short)type, .rta_len = (unsigned short)(end - begin)};
}

int linux_can_find(const char *name, int *index, unsigned *kind) {
    linux_can_link_t link;
    find_t request = {.header = {.nlmsg_len = sizeof request, .nlmsg_type = RTM_GETLINK, .nlmsg_flags = NLM_F_REQUEST},
                      .interface = {.ifi_family = AF_UNSPEC}};
    memcpy(request.name_text, name, strlen(name));
    request.name = attribute(IFLA_IFNAME, offsetof(find_t, name), offsetof(find_t, name_text) + strlen(name) + 1);
    const int result = query(&request, sizeof request, &link);
    if (result == 0) {
        *index = link.index;
        *kind = link.kind;
    }
    return result;
}

bool linux_can_restart(const linux_can_t *can) {
    linux_can_link_t link;
    restart_t request = {
        .header = {.nlmsg_len = sizeof request, .nlmsg_type = RTM_NEWLINK, .nlmsg_flags = NLM_F_REQUEST | NLM_F_ACK},
        .interface = {.ifi_family = AF_UNSPEC, .ifi_index = can->index},
        .kind_text = "can",
        .restart_value = 1};
    request.link_info = attribute(IFLA_LINKINFO, offsetof(restart_t, link_info), sizeof request);
    request.kind = attribute(IFLA_INFO_KIND, offsetof(restart_t, kind), offsetof(restart_t, data));
    request.data = attribute(IFLA_INFO_DATA, offsetof(restart_t, data), sizeof request);
    request.restart = attribute(IFLA_CAN_RESTART, offsetof(restart_t, restart), sizeof request);
    return can->fd >= 0 && query(&request, sizeof request, &link) == 0;
}

static void set_link(linux_can_t *can, const linux_can_link_t *link) {
    can->link_is_known = true;
    can->link_is_up = link->is_up;
    can->link_has_state = link->has_state;
    can->link_state = link->state;
}

bool linux_can_ask(linux_can_t *can) {
    linux_can_link_t link;
    const look_t request = {
        .header = {.nlmsg_len = sizeof request, .nlmsg_type = RTM_GETLINK, .nlmsg_flags = NLM_F_REQUEST},
        .interface = {.ifi_family = AF_UNSPEC, .ifi_index = can->index}};
    if (can->fd < 0 || query(&request, sizeof request, &link) != 0) {
        return false;
    }
    set_link(can, &link);
    return true;
}

/* The socket is bound before the state is queried, so that no change between the two is missed. */
static bool open_link(linux_can_t *can) {
    const struct sockaddr_nl changes = {.nl_family = AF_NETLINK, .nl_groups = RTMGRP_LINK};
    const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, NETLINK_ROUTE);
    if (fd < 0) {
        return false;
    }
    if (bind(fd, (const struct sockaddr *)&changes, sizeof changes) != 0) {
        (void)close(fd);
        return false;
    }
    can->has_link = true;
    can->link_fd = fd;
    (void)linux_can_ask(can);
    return true;
}

/* When reports were lost, the state is queried after all kept reports were read, because they are older. */
static void read_reports(linux_can_t *can) {
    bool has_lost = false;
    answer_t news;
    linux_can_link_t link;
    for (unsigned i = 0; i < NEWS_AT_ONCE_MAX; i++) {
        const ssize_t size = recv(can->link_fd, &news, sizeof news, MSG_DONTWAIT);
        if (size >= 0) {
            if (linux_can_link_read(news.bytes, (size_t)size, &link) && link.index == can->index) {
                set_link(can, &link);
            }
        } else if (errno == ENOBUFS) {
            has_lost = true;
        } else {
            break;
        }
    }
    if (has_lost) {
        can->link_is_known = linux_can_ask(can);
    }
}

/* By index, because an ioctl needs the name, and starts modprobe if the interface is being renamed at that time. */
bool linux_can_is_up(linux_can_t *can) {
    if (can->fd < 0) {
        return false;
    }
    if (!can->has_link) {
        return open_link(can) && can->link_is_known && can->link_is_up;
    }
    read_reports(can);
    if (!can->link_is_known && !can->is_gone) { /* the kernel reports only changes */
        (void)linux_can_ask(can);
    }
    return can->link_is_known && can->link_is_up;
}

bool linux_can_state(const linux_can_t *can, hal_can_state_t *state) {
    *state = can->link_state;
    return can->has_link && can->link_has_state;
}

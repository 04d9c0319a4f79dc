/* What needs rtnetlink: finding an interface, and what `ip link set IF type can restart` does. */
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

typedef struct {
    struct nlmsghdr header;
    struct ifinfomsg interface;
    struct rtattr name;
    char name_text[IFNAMSIZ];
} find_t;

/* Attributes within attributes; every part is a multiple of four bytes, so there is no padding between them. */
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

/* The beginning of it: what follows about an interface is cut off. */
typedef struct {
    struct nlmsghdr header;
    union {
        struct nlmsgerr verdict;
        struct ifinfomsg interface;
    } is;
} answer_t;

/* The kernel carries a request out while it takes it: the answer is there when send() returns. */
static int exchange(int fd, const void *request, size_t size, answer_t *answer) {
    if (send(fd, request, size, MSG_DONTWAIT) < 0) {
        return errno;
    }
    const ssize_t answered = recv(fd, answer, sizeof *answer, MSG_DONTWAIT);
    if (answered < 0) {
        return errno;
    }
    if ((size_t)answered < sizeof answer->header + sizeof answer->is.interface) {
        return EPROTO;
    }
    return (answer->header.nlmsg_type == NLMSG_ERROR) ? -answer->is.verdict.error : 0;
}

static int ask(const void *request, size_t size, answer_t *answer) {
    const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
    if (fd < 0) {
        return errno;
    }
    const int result = exchange(fd, request, size, answer);
    (void)close(fd);
    return result;
}

static struct rtattr attribute(unsigned type, size_t begin, size_t end) {
    return (struct rtattr){.rta_type = (unsigned short)type, .rta_len = (unsigned short)(end - begin)};
}

int linux_can_find(const char *name, int *index, unsigned *kind) {
    answer_t answer = {0};
    find_t request = {.header = {.nlmsg_len = sizeof request, .nlmsg_type = RTM_GETLINK, .nlmsg_flags = NLM_F_REQUEST},
                      .interface = {.ifi_family = AF_UNSPEC}};
    memcpy(request.name_text, name, strlen(name));
    request.name = attribute(IFLA_IFNAME, offsetof(find_t, name), offsetof(find_t, name_text) + strlen(name) + 1u);
    const int result = ask(&request, sizeof request, &answer);
    if (result == 0) {
        *index = answer.is.interface.ifi_index;
        *kind = answer.is.interface.ifi_type;
    }
    return result;
}

bool linux_can_restart(const linux_can_t *can) {
    answer_t answer = {0};
    restart_t request = {
        .header = {.nlmsg_len = sizeof request, .nlmsg_type = RTM_NEWLINK, .nlmsg_flags = NLM_F_REQUEST | NLM_F_ACK},
        .interface = {.ifi_family = AF_UNSPEC, .ifi_index = can->index},
        .kind_text = "can",
        .restart_value = 1};
    request.link_info = attribute(IFLA_LINKINFO, offsetof(restart_t, link_info), sizeof request);
    request.kind = attribute(IFLA_INFO_KIND, offsetof(restart_t, kind), offsetof(restart_t, data));
    request.data = attribute(IFLA_INFO_DATA, offsetof(restart_t, data), sizeof request);
    request.restart = attribute(IFLA_CAN_RESTART, offsetof(restart_t, restart), sizeof request);
    return can->fd >= 0 && ask(&request, sizeof request, &answer) == 0;
}

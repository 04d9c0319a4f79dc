/* The one thing that needs rtnetlink: what `ip link set IF type can restart` does. */
#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/netlink.h>
#include <linux/rtnetlink.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

#include "hal_linux/linux_can.h"

/* Attributes within attributes; every part is a multiple of four bytes, so there is no padding between them. */
typedef struct {
    struct nlmsghdr header;
    struct ifinfomsg interface;
    struct rtattr link_info;
    struct rtattr kind;
    char kind_name[4];
    struct rtattr data;
    struct rtattr restart;
    uint32_t restart_value;
} request_t;

typedef struct {
    struct nlmsghdr header;
    struct nlmsgerr verdict;
} answer_t;

_Static_assert(sizeof(request_t) == NLMSG_HDRLEN + sizeof(struct ifinfomsg) + 24, "attributes follow each other");

static struct rtattr attribute(unsigned type, size_t begin, size_t end) {
    return (struct rtattr){.rta_type = (unsigned short)type, .rta_len = (unsigned short)(end - begin)};
}

static request_t request_for(int index) {
    request_t request = {
        .header = {.nlmsg_len = sizeof request, .nlmsg_type = RTM_NEWLINK, .nlmsg_flags = NLM_F_REQUEST | NLM_F_ACK},
        .interface = {.ifi_family = AF_UNSPEC, .ifi_index = index},
        .kind_name = "can",
        .restart_value = 1};
    request.link_info = attribute(IFLA_LINKINFO, offsetof(request_t, link_info), sizeof request);
    request.kind = attribute(IFLA_INFO_KIND, offsetof(request_t, kind), offsetof(request_t, data));
    request.data = attribute(IFLA_INFO_DATA, offsetof(request_t, data), sizeof request);
    request.restart = attribute(IFLA_CAN_RESTART, offsetof(request_t, restart), sizeof request);
    return request;
}

/* The kernel carries a request out while it takes it: the answer is there when send() returns. */
static bool ask(int fd, int index) {
    const request_t request = request_for(index);
    answer_t answer;
    return send(fd, &request, sizeof request, MSG_DONTWAIT) == (ssize_t)sizeof request &&
           recv(fd, &answer, sizeof answer, MSG_DONTWAIT) == (ssize_t)sizeof answer &&
           answer.header.nlmsg_type == NLMSG_ERROR && answer.verdict.error == 0;
}

bool linux_can_restart(const linux_can_t *can) {
    if (can->fd < 0) {
        return false;
    }
    const int fd = socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_ROUTE);
    if (fd < 0) {
        return false;
    }
    const bool done = ask(fd, can->index);
    (void)close(fd);
    return done;
}

/* Reading a message of rtnetlink on an interface. Its lengths are not trusted. */
#include <linux/can/netlink.h>
#include <linux/if_link.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <string.h>
#include <sys/socket.h>

#include "linux_can_internal.h"

enum { ALIGNED = 4 };

/* Bytes that were received. */
typedef struct {
    const unsigned char *bytes;
    size_t size;
} part_t;

static size_t aligned(size_t size) {
    return (size + ALIGNED - 1) / ALIGNED * ALIGNED;
}

static part_t after(part_t part, size_t size) {
    const size_t skipped = (size < part.size) ? size : part.size;
    return (part_t){.bytes = part.bytes + skipped, .size = part.size - skipped};
}

/* The content of the first attribute of this type; empty: there is none. One that is not whole ends the search. */
static part_t find(part_t in, unsigned type) {
    struct rtattr head;
    while (in.size >= sizeof head) {
        memcpy(&head, in.bytes, sizeof head);
        if (head.rta_len < sizeof head || head.rta_len > in.size) {
            break;
        }
        if ((head.rta_type & NLA_TYPE_MASK) == type) {
            return (part_t){.bytes = in.bytes + sizeof head, .size = head.rta_len - sizeof head};
        }
        in = after(in, aligned(head.rta_len));
    }
    return (part_t){.bytes = in.bytes};
}

static bool is_can(part_t kind) {
    static const char can[] = "can";
    return kind.size >= sizeof can && memcmp(kind.bytes, can, sizeof can) == 0;
}

/* A controller that is stopped or asleep has no error state, and other kinds of interfaces use the same numbers for other
 * attributes. */
static void read_state(part_t attributes, linux_can_link_t *link) {
    const part_t info = find(attributes, IFLA_LINKINFO);
    const part_t state = find(find(info, IFLA_INFO_DATA), IFLA_CAN_STATE);
    uint32_t value = CAN_STATE_MAX;
    if (is_can(find(info, IFLA_INFO_KIND)) && state.size == sizeof value) {
        memcpy(&value, state.bytes, sizeof value);
    }
    link->has_state = value <= CAN_STATE_BUS_OFF;
    if (value == CAN_STATE_BUS_OFF) {
        link->state = HAL_CAN_BUS_OFF;
    } else if (value == CAN_STATE_ERROR_PASSIVE) {
        link->state = HAL_CAN_ERROR_PASSIVE;
    }
}

bool linux_can_link_read(const void *message, size_t size, linux_can_link_t *link) {
    struct nlmsghdr header;
    struct ifinfomsg interface;
    *link = (linux_can_link_t){.state = HAL_CAN_ERROR_ACTIVE};
    if (size < sizeof header + sizeof interface) {
        return false;
    }
    memcpy(&header, message, sizeof header);
    memcpy(&interface, (const unsigned char *)message + sizeof header, sizeof interface);
    const bool is_new = header.nlmsg_type == RTM_NEWLINK;
    if ((!is_new && header.nlmsg_type != RTM_DELLINK) || interface.ifi_family != AF_UNSPEC) {
        return false;
    }
    const part_t all = {.bytes = message, .size = (header.nlmsg_len < size) ? header.nlmsg_len : size};
    link->index = interface.ifi_index;
    link->kind = interface.ifi_type;
    link->is_up = is_new && (interface.ifi_flags & (unsigned)IFF_UP) != 0;
    if (is_new) {
        read_state(after(all, sizeof header + sizeof interface), link);
    }
    return true;
}

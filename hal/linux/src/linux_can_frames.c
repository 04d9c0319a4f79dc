/* Reading and writing frames. */
#include <errno.h>
#include <linux/can.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>

#include "hal_linux/linux_can.h"

enum { US_PER_S = 1000000, NS_PER_US = 1000 };

/* The control messages that the kernel passes with a frame. */
typedef union {
    struct cmsghdr aligned;
    char bytes[CMSG_SPACE(sizeof(struct timespec)) + CMSG_SPACE(sizeof(uint32_t))];
} control_t;

/* Only the bytes within the length are copied, because the sender may leave any value in the others. The caller has
 * zeroed the frame. */
static void from_kernel(const struct canfd_frame *raw, bool is_fd, hal_can_frame_t *frame) {
    *frame = (hal_can_frame_t){.length = raw->len};
    if ((raw->can_id & CAN_ERR_FLAG) != 0) {
        frame->id = raw->can_id & CAN_ERR_MASK;
        frame->flags = HAL_CAN_ERROR;
    } else {
        const bool is_extended = (raw->can_id & CAN_EFF_FLAG) != 0;
        frame->id = raw->can_id & (is_extended ? CAN_EFF_MASK : CAN_SFF_MASK);
        frame->flags |= is_extended ? HAL_CAN_EXTENDED : 0;
        frame->flags |= ((raw->can_id & CAN_RTR_FLAG) != 0) ? HAL_CAN_REMOTE : 0;
    }
    frame->flags |= is_fd ? HAL_CAN_FD : 0;
    if ((frame->flags & HAL_CAN_REMOTE) == 0) {
        memcpy(frame->data, raw->data, (raw->len < sizeof frame->data) ? raw->len : sizeof frame->data);
    }
}

static bool to_kernel(const hal_can_frame_t *frame, struct can_frame *raw) {
    const bool is_extended = (frame->flags & (HAL_CAN_EXTENDED | HAL_CAN_ERROR)) != 0;
    if ((frame->flags & HAL_CAN_FD) != 0 || frame->length > CAN_MAX_DLEN ||
        frame->id > (is_extended ? CAN_EFF_MASK : CAN_SFF_MASK)) {
        return false;
    }
    *raw = (struct can_frame){.can_id = frame->id, .len = frame->length};
    raw->can_id |= ((frame->flags & HAL_CAN_EXTENDED) != 0) ? CAN_EFF_FLAG : 0;
    raw->can_id |= ((frame->flags & HAL_CAN_REMOTE) != 0) ? CAN_RTR_FLAG : 0;
    raw->can_id |= ((frame->flags & HAL_CAN_ERROR) != 0) ? CAN_ERR_FLAG : 0;
    if ((frame->flags & HAL_CAN_REMOTE) == 0) {
        memcpy(raw->data, frame->data, frame->length);
    }
    return true;
}

static void read_control(struct msghdr *message, linux_can_record_t *record) {
    for (struct cmsghdr *part = CMSG_FIRSTHDR(message); part != NULL; part = CMSG_NXTHDR(message, part)) {
        if (part->cmsg_level != SOL_SOCKET) {
            continue;
        }
        if (part->cmsg_type == SCM_TIMESTAMPNS) {
            struct timespec stamp;
            memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
            record->stamp_us = (uint64_t)stamp.tv_sec * US_PER_S + (uint64_t)stamp.tv_nsec / NS_PER_US;
        } else if (part->cmsg_type == SO_RXQ_OVFL) {
            memcpy(&record->lost, CMSG_DATA(part), sizeof record->lost);
        }
    }
}

/* Reading and writing return the same errors. The kernel reports a pending error once, to the next call of either. */
static void note_error(linux_can_t *can, int error) {
    if (error == ENETDOWN) {
        can->report_down = can->report_down || !can->is_down;
        can->is_down = true;
    } else if (error == ENODEV || error == ENXIO || error == EBADF) {
        can->is_gone = true;
    }
}

static linux_can_read_t result_of_read_error(linux_can_t *can, int error) {
    if (error == ENETDOWN) {
        can->is_down = false; /* the kernel reports it once each time that the interface goes down: report it again */
    }
    note_error(can, error);
    if (can->is_gone) {
        return LINUX_CAN_IS_GONE;
    }
    const bool report_down = can->report_down;
    can->report_down = false;
    return report_down ? LINUX_CAN_IS_DOWN : LINUX_CAN_NOTHING;
}

static linux_can_write_t result_of_write_error(linux_can_t *can, int error) {
    if (error == ENOBUFS || error == EAGAIN) {
        return LINUX_CAN_FULL;
    }
    note_error(can, error);
    return LINUX_CAN_NOT_TAKEN;
}

linux_can_read_t linux_can_read(linux_can_t *can, linux_can_record_t *record) {
    if (can->is_gone || can->report_down) {
        return result_of_read_error(can, 0);
    }
    struct canfd_frame raw = {0};
    control_t control;
    struct iovec part = {.iov_base = &raw, .iov_len = sizeof raw};
    struct msghdr message = {
        .msg_iov = &part, .msg_iovlen = 1, .msg_control = &control, .msg_controllen = sizeof control};
    const ssize_t size = recvmsg(can->fd, &message, MSG_DONTWAIT);
    if (size < 0) {
        return result_of_read_error(can, errno);
    }
    if (size != (ssize_t)CAN_MTU && size != (ssize_t)CANFD_MTU) {
        return LINUX_CAN_NOTHING;
    }
    *record = (linux_can_record_t){.own = ((unsigned)message.msg_flags & (unsigned)MSG_CONFIRM) != 0};
    from_kernel(&raw, size == (ssize_t)CANFD_MTU, &record->frame);
    read_control(&message, record);
    return LINUX_CAN_RECORD;
}

linux_can_write_t linux_can_write(linux_can_t *can, const hal_can_frame_t *frame) {
    struct can_frame raw;
    if (!to_kernel(frame, &raw)) {
        return LINUX_CAN_NOT_TAKEN;
    }
    if (send(can->fd, &raw, sizeof raw, MSG_DONTWAIT) < 0) {
        return result_of_write_error(can, errno);
    }
    can->is_down = false;
    return LINUX_CAN_TAKEN;
}

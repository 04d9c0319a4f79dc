#include "player.h"

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

enum { STEERING_COMMAND, TURN_SIGNAL_COMMAND, GEAR_COMMAND, THROTTLE_COMMAND, STATUSES };
enum {
    VEHICLE_STATUS = STATUSES,
    THROTTLE_STATUS,
    WHEEL_SPEED,
    STEERING_STATUS,
    EPS_STATUS,
    STEERING_POSITION,
    GEAR_STATUS
};

#define GEAR_D 1u
#define GEAR_P 8u
#define EPS_FAULT 0x08u
#define AUTOPILOT_OFF 0x40u
#define COMMANDED_LOW 0x28u /* 9000 + 0..63: 0.0 to 6.3 degrees; the running number is in the lowest bits */
#define COMMANDED_HIGH 0x23u
#define MEASURED_LOW 0x14u /* 8980: -2.0 degrees, which differs from every commanded angle */
#define MEASURED_HIGH 0x23u
#define STEP_MS 10

/* Messages and cycles of docs/protocol.md, with different phases. */
static const struct {
    uint16_t id;
    player_side_t side;
    uint32_t cycle_us;
    uint32_t phase_us;
} MESSAGES[PLAYER_MESSAGES] = {
    [STEERING_COMMAND] = {0x065, PLAYER_AI, 25000, 6100}, [TURN_SIGNAL_COMMAND] = {0x43F, PLAYER_AI, 100000, 7000},
    [GEAR_COMMAND] = {0x168, PLAYER_AI, 100000, 7900},    [THROTTLE_COMMAND] = {0x075, PLAYER_AI, 100000, 8700},
    [VEHICLE_STATUS] = {0x363, PLAYER_VEHICLE, 10000, 0}, [THROTTLE_STATUS] = {0x050, PLAYER_VEHICLE, 10000, 900},
    [WHEEL_SPEED] = {0x101, PLAYER_VEHICLE, 10000, 1700}, [STEERING_STATUS] = {0x067, PLAYER_VEHICLE, 10000, 2500},
    [EPS_STATUS] = {0x167, PLAYER_VEHICLE, 10000, 3300},  [STEERING_POSITION] = {0x267, PLAYER_VEHICLE, 10000, 4100},
    [GEAR_STATUS] = {0x0A3, PLAYER_VEHICLE, 25000, 5200},
};

uint64_t player_now_ns(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return ((uint64_t)now.tv_sec * NS_PER_S) + (uint64_t)now.tv_nsec;
}

/* ---- sockets ---- */

static bool listen_to(int fd, const uint16_t *ids, size_t count) {
    struct can_filter filters[8];
    for (size_t i = 0; i < count; i++) {
        filters[i] = (struct can_filter){.can_id = ids[i], .can_mask = CAN_SFF_MASK | CAN_EFF_FLAG | CAN_RTR_FLAG};
    }
    return setsockopt(fd, SOL_CAN_RAW, CAN_RAW_FILTER, filters, (socklen_t)(count * sizeof filters[0])) == 0;
}

static int open_socket(const char *interface) {
    const struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = (int)if_nametoindex(interface)};
    const int fd = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
    const int on = 1;
    if ((fd < 0) || (address.can_ifindex == 0) || (bind(fd, (const struct sockaddr *)&address, sizeof address) != 0) ||
        (setsockopt(fd, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on) != 0)) {
        perror(interface);
        return -1;
    }
    return fd;
}

/* Receive filters. In a flood only the first three, the safe commands. */
static const uint16_t HEARD[] = {0x075, 0x168, 0x43F, 0x065, 0x101, 0x167};
#define HEARD_COUNT (sizeof HEARD / sizeof HEARD[0])
#define HEARD_SAFE_COUNT 3u

static bool open_side(player_t *player, player_side_t side, const char *interface) {
    player->send_fd[side] = open_socket(interface);
    player->listen_fd[side] = open_socket(interface);
    return (player->send_fd[side] >= 0) && (player->listen_fd[side] >= 0) &&
           listen_to(player->send_fd[side], HEARD, 0) && listen_to(player->listen_fd[side], HEARD, HEARD_COUNT);
}

bool player_open(player_t *player, const char *vehicle, const char *ai) {
    (void)memset(player, 0, sizeof *player);
    player->timer_fd = timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK);
    if (!open_side(player, PLAYER_VEHICLE, vehicle)) {
        return false;
    }
    if (ai != NULL) {
        return open_side(player, PLAYER_AI, ai);
    }
    player->send_fd[PLAYER_AI] = player->send_fd[PLAYER_VEHICLE];
    player->listen_fd[PLAYER_AI] = -1;
    return true;
}

/* ---- sending ---- */

/** Fill in a payload of docs/protocol.md, without a fault except the requested one. */
static void fill(player_t *player, unsigned message, uint32_t count, uint8_t *data) {
    const bool on = player->engaged;
    const uint8_t number = (uint8_t)(count % PLAYER_PENDING);
    switch (message) {
    case STEERING_COMMAND:
        data[0] = (uint8_t)(COMMANDED_LOW + number);
        data[1] = COMMANDED_HIGH;
        break;
    case TURN_SIGNAL_COMMAND:
        data[4] = 0x80u; /* headlight off */
        data[7] = (uint8_t)count;
        break;
    case GEAR_COMMAND:
        data[0] = GEAR_D;
        break;
    case THROTTLE_COMMAND:
        data[0] = 10;
        break;
    case VEHICLE_STATUS:
        data[6] = (uint8_t)((on ? 0x80u : 0x40u) | (player->button ? 0x01u : 0x00u));
        data[7] = (uint8_t)count;
        break;
    case THROTTLE_STATUS:
        data[0] = on ? 10 : 0;
        break;
    case WHEEL_SPEED: /* up to 63 mm/s difference, which is the running number; 0 at standstill */
        data[0] = on ? 200 : 0;
        data[4] = on ? (uint8_t)(140 + number) : 0;
        break;
    case STEERING_STATUS:
        data[0] = (uint8_t)count;
        data[1] = 100;
        data[2] = MEASURED_LOW;
        data[3] = MEASURED_HIGH;
        break;
    case EPS_STATUS:
        data[3] = 1; /* angle control */
        data[7] = player->eps_fault ? EPS_FAULT : 0;
        player->eps_fault = false;
        break;
    case STEERING_POSITION:
        data[0] = 0x23u;
        data[1] = 0x28u;
        break;
    default: /* GEAR_STATUS */
        data[0] = on ? GEAR_D : GEAR_P;
        break;
    }
}

static void send_message(player_t *player, unsigned message) {
    struct can_frame frame = {.can_id = MESSAGES[message].id, .can_dlc = 8};
    if ((message == STEERING_COMMAND) && player->steering_silent) {
        return;
    }
    fill(player, message, player->count[message], frame.data);
    player->count[message]++;
    if (write(player->send_fd[MESSAGES[message].side], &frame, sizeof frame) == (ssize_t)sizeof frame) {
        player->sent++;
    } else {
        perror("bench_vcan_traffic: write");
    }
}

static void set_timer(const player_t *player) {
    uint64_t next = (player->extra_ns != 0) ? player->extra_due_ns : UINT64_MAX;
    for (unsigned i = 0; i < PLAYER_MESSAGES; i++) {
        next = (player->due_ns[i] < next) ? player->due_ns[i] : next;
    }
    const struct itimerspec when = {.it_value = {.tv_sec = player->sending ? (time_t)(next / NS_PER_S) : 0,
                                                 .tv_nsec = player->sending ? (long)(next % NS_PER_S) : 0}};
    (void)timerfd_settime(player->timer_fd, TFD_TIMER_ABSTIME, &when, NULL);
}

void player_start(player_t *player) {
    const uint64_t now = player_now_ns();
    for (unsigned i = 0; i < PLAYER_MESSAGES; i++) {
        player->due_ns[i] = now + ((uint64_t)MESSAGES[i].phase_us * NS_PER_US);
    }
    player->sending = true;
    set_timer(player);
}

void player_stop(player_t *player) {
    player->sending = false;
    set_timer(player);
}

bool player_flood(player_t *player, uint32_t frames_a_second) {
    player->extra_ns = (frames_a_second != 0) ? NS_PER_S / frames_a_second : 0;
    player->extra_due_ns = player_now_ns();
    set_timer(player);
    return listen_to(player->listen_fd[PLAYER_VEHICLE], HEARD, (frames_a_second != 0) ? HEARD_SAFE_COUNT : HEARD_COUNT);
}

/**
 * Send all frames that are due. A late frame is still sent; when a message is late by more than its cycle, frames are
 * skipped.
 */
static void send_due(player_t *player) {
    const uint64_t now = player_now_ns();
    for (unsigned i = 0; i < PLAYER_MESSAGES; i++) {
        const uint64_t cycle_ns = (uint64_t)MESSAGES[i].cycle_us * NS_PER_US;
        if (player->due_ns[i] <= now) {
            send_message(player, i);
            player->due_ns[i] += ((now - player->due_ns[i]) / cycle_ns + 1) * cycle_ns;
        }
    }
    while ((player->extra_ns != 0) && (player->extra_due_ns <= now)) {
        send_message(player, STATUSES + player->extra_next);
        player->extra_next = (player->extra_next + 1) % (PLAYER_MESSAGES - STATUSES);
        player->extra_due_ns += player->extra_ns;
    }
    set_timer(player);
}

/* ---- receiving ---- */

void player_forget(player_t *player) {
    (void)memset(player->safe_ns, 0, sizeof player->safe_ns);
}

static void hear_safe(player_t *player, player_safe_t which, uint64_t stamp_ns) {
    if (player->safe_ns[which] == 0) {
        player->safe_ns[which] = stamp_ns;
    }
}

static void pass(player_passing_t *passing, bool in, unsigned number, uint64_t stamp_ns) {
    uint64_t *in_ns = &passing->in_ns[number % PLAYER_PENDING];
    uint64_t *out_ns = &passing->out_ns[number % PLAYER_PENDING];
    passing->lost += (in && (*in_ns != 0)) ? 1 : 0;
    *(in ? in_ns : out_ns) = stamp_ns;
    if ((*in_ns != 0) && (*out_ns != 0)) {
        if (passing->passed < PLAYER_SAMPLES) {
            passing->took_ns[passing->passed] = *out_ns - *in_ns;
        }
        passing->passed++;
        *in_ns = 0;
        *out_ns = 0;
    }
}

static void hear_steering(player_t *player, player_side_t side, const struct can_frame *frame, uint64_t stamp_ns) {
    const unsigned number = (unsigned)frame->data[0] - COMMANDED_LOW;
    if ((frame->data[0] == MEASURED_LOW) && (side == PLAYER_VEHICLE)) {
        hear_safe(player, PLAYER_SAFE_STEERING, stamp_ns);
    } else if (number < PLAYER_PENDING) {
        const bool shared = player->listen_fd[PLAYER_AI] < 0;
        player->steering_ns = (shared || (side == PLAYER_AI)) ? stamp_ns : player->steering_ns;
        pass(&player->command, side == PLAYER_AI, number, stamp_ns);
    }
}

static void hear(player_t *player, player_side_t side, const struct can_frame *frame, uint64_t stamp_ns) {
    const bool vehicle = side == PLAYER_VEHICLE;
    if ((frame->can_id == 0x075) && vehicle && (frame->data[0] == 0)) {
        hear_safe(player, PLAYER_SAFE_THROTTLE, stamp_ns);
    } else if ((frame->can_id == 0x168) && vehicle && (frame->data[0] == GEAR_P)) {
        hear_safe(player, PLAYER_SAFE_GEAR, stamp_ns);
    } else if ((frame->can_id == 0x43F) && vehicle && ((frame->data[4] & AUTOPILOT_OFF) != 0)) {
        hear_safe(player, PLAYER_SAFE_LIGHTS, stamp_ns);
    } else if ((frame->can_id == 0x167) && vehicle && (frame->data[7] == EPS_FAULT)) {
        player->fault_ns = stamp_ns;
    } else if ((frame->can_id == 0x101) && (frame->data[0] != 0)) {
        pass(&player->status, vehicle, frame->data[4] - 140, stamp_ns);
    } else if (frame->can_id == 0x065) {
        hear_steering(player, side, frame, stamp_ns);
    }
}

static uint64_t stamp_of(struct msghdr *message) {
    struct timespec stamp = {0};
    for (struct cmsghdr *part = CMSG_FIRSTHDR(message); part != NULL; part = CMSG_NXTHDR(message, part)) {
        if ((part->cmsg_level == SOL_SOCKET) && (part->cmsg_type == SCM_TIMESTAMPNS)) {
            (void)memcpy(&stamp, CMSG_DATA(part), sizeof stamp);
        }
    }
    return ((uint64_t)stamp.tv_sec * NS_PER_S) + (uint64_t)stamp.tv_nsec;
}

static bool read_frame(player_t *player, player_side_t side) {
    struct can_frame frame;
    _Alignas(struct cmsghdr) char control[CMSG_SPACE(sizeof(struct timespec))];
    struct iovec part = {.iov_base = &frame, .iov_len = sizeof frame};
    struct msghdr message = {
        .msg_iov = &part, .msg_iovlen = 1, .msg_control = control, .msg_controllen = sizeof control};
    if (recvmsg(player->listen_fd[side], &message, MSG_DONTWAIT) != (ssize_t)sizeof frame) {
        return false;
    }
    hear(player, side, &frame, stamp_of(&message));
    return true;
}

bool player_step(player_t *player, int other_fd) {
    enum { TIMER = PLAYER_SIDES, OTHER, FILES };
    struct pollfd files[FILES] = {
        [TIMER] = {.fd = player->timer_fd, .events = POLLIN}, [OTHER] = {.fd = other_fd, .events = POLLIN}};
    for (unsigned side = 0; side < PLAYER_SIDES; side++) {
        files[side] = (struct pollfd){.fd = player->listen_fd[side], .events = POLLIN};
    }
    (void)poll(files, FILES, STEP_MS);
    if (player->sending && (files[TIMER].revents != 0)) {
        send_due(player);
    }
    for (unsigned side = 0; side < PLAYER_SIDES; side++) {
        while ((files[side].revents != 0) && read_frame(player, (player_side_t)side)) {
        }
    }
    return files[OTHER].revents != 0;
}

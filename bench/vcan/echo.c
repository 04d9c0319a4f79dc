/*
 * Minimal program for comparison: it only answers two faults, and shows the least time that kernel and bus need.
 *
 *     bench_vcan_echo INTERFACE [LATE_MS]
 *
 * Sends throttle 0, gear P and autopilot off when a 167h carries the EPS fault 08h, and when no 065h was received for
 * more than 125 ms. It has no counters, states or cycles. LATE_MS delays every answer, for the self-test.
 */
#include <linux/can.h>
#include <net/if.h>
#include <poll.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#define DEADLINE_NS 125000000
#define NS_PER_S 1000000000
#define NS_PER_MS 1000000
#define FAULT 0x08u

static int64_t now_ns(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return ((int64_t)now.tv_sec * NS_PER_S) + now.tv_nsec;
}

static int open_bus(const char *interface) {
    struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = (int)if_nametoindex(interface)};
    const int fd = socket(PF_CAN, SOCK_RAW, CAN_RAW);
    if ((fd < 0) || (address.can_ifindex == 0) || (bind(fd, (const struct sockaddr *)&address, sizeof address) != 0)) {
        perror(interface);
        exit(2);
    }
    return fd;
}

static void answer(int fd, long late_ms) {
    static const struct can_frame SAFE[3] = {{.can_id = 0x075, .can_dlc = 8},
                                             {.can_id = 0x168, .can_dlc = 8, .data = {8}},
                                             {.can_id = 0x43F, .can_dlc = 8, .data = {0, 0, 0, 0, 0x70}}};
    const struct timespec late = {.tv_nsec = late_ms * NS_PER_MS};
    if (late_ms > 0) {
        (void)nanosleep(&late, NULL);
    }
    for (unsigned i = 0; i < 3; i++) {
        if (write(fd, &SAFE[i], sizeof SAFE[i]) < 0) {
            perror("bench_vcan_echo");
        }
    }
}

/** Wait for a frame, but not after `due_ns` (0: without limit). @return false: `due_ns` has passed */
static bool wait_until(int fd, int64_t due_ns) {
    struct pollfd file = {.fd = fd, .events = POLLIN};
    const int64_t left = due_ns - now_ns();
    const int64_t wait = (left > 0) ? left : 0;
    const struct timespec timeout = {.tv_sec = wait / NS_PER_S, .tv_nsec = wait % NS_PER_S};
    return ppoll(&file, 1, (due_ns != 0) ? &timeout : NULL, NULL) > 0;
}

int main(int argc, char **argv) {
    if (argc < 2) {
        (void)fprintf(stderr, "usage: bench_vcan_echo INTERFACE [LATE_MS]\n");
        return 2;
    }
    const long late_ms = (argc > 2) ? strtol(argv[2], NULL, 10) : 0;
    const int fd = open_bus(argv[1]);
    int64_t due_ns = 0;
    struct can_frame frame;
    for (;;) {
        if (!wait_until(fd, due_ns)) {
            answer(fd, late_ms);
            due_ns = 0;
        } else if (read(fd, &frame, sizeof frame) != (ssize_t)sizeof frame) {
            return 1;
        } else if ((frame.can_id == 0x167) && (frame.data[7] == FAULT)) {
            answer(fd, late_ms);
        } else if (frame.can_id == 0x065) {
            due_ns = now_ns() + DEADLINE_NS;
        }
    }
}

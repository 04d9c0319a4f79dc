#include "vcan.h"

#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "unity.h"

#define TESTERS_MAX 8u

static int testers[TESTERS_MAX];
static unsigned tester_count;
static bool links_changed;
static bool is_stuck;

/* vcan_restore() must not use assertions: after a failed test an assertion would end tearDown. */
static void require(bool works, const char *what) {
    if (!works) {
        TEST_FAIL_MESSAGE(what);
    }
}

void vcan_run(const char *command) {
    require(system(command) == 0, command);
}

static void change(const char *command, const char *interface, const char *rest) {
    char line[64];
    (void)snprintf(line, sizeof line, "ip link %s dev %s %s", command, interface, rest);
    vcan_run(line);
    links_changed = true;
}

void vcan_add(const char *interface) {
    change("add", interface, "type vcan");
}

void vcan_remove(const char *interface) {
    change("del", interface, "");
}

/* Not by the program ip, which takes long to start on an emulated processor. */
static void set_up(const char *interface, bool up) {
    struct ifreq request = {0};
    const int asked = socket(AF_INET, SOCK_DGRAM, 0);
    require(asked >= 0, "no socket");
    (void)snprintf(request.ifr_name, sizeof request.ifr_name, "%s", interface);
    require(ioctl(asked, SIOCGIFFLAGS, &request) == 0, interface);
    const unsigned others = (unsigned)request.ifr_flags & ~(unsigned)IFF_UP;
    request.ifr_flags = (short)(others | (up ? (unsigned)IFF_UP : 0));
    require(ioctl(asked, SIOCSIFFLAGS, &request) == 0, interface);
    (void)close(asked);
    links_changed = true;
}

void vcan_up(const char *interface) {
    set_up(interface, true);
}

void vcan_down(const char *interface) {
    set_up(interface, false);
}

void vcan_stick(void) {
    vcan_run("tc qdisc add dev vcan0 root plug limit 160"); /* bytes: 16 a frame; no timer ever opens it */
    is_stuck = true;
}

void vcan_unstick(void) {
    vcan_run("tc qdisc del dev vcan0 root");
    is_stuck = false;
}

unsigned vcan_dropped(void) {
    char text[512] = "";
    FILE *output = popen("tc -s qdisc show dev vcan0", "r");
    TEST_ASSERT_NOT_NULL(output);
    const size_t size = fread(text, 1, sizeof text - 1, output);
    TEST_ASSERT_EQUAL_INT(0, pclose(output));
    text[size] = '\0';
    const char *dropped = strstr(text, "(dropped ");
    TEST_ASSERT_NOT_NULL_MESSAGE(dropped, text);
    return (unsigned)strtoul(dropped + strlen("(dropped "), NULL, 10);
}

void vcan_restore(void) {
    vcan_pause_ms(VCAN_SETTLED_MS); /* frames still in flight belong to this test */
    while (tester_count > 0) {
        (void)close(testers[--tester_count]);
    }
    if (is_stuck) {
        vcan_unstick();
    }
    if (links_changed) {
        if (if_nametoindex("vcan0") == 0) {
            vcan_add("vcan0");
        }
        vcan_up("vcan0");
        vcan_up("vcan1");
        links_changed = false;
    }
}

/* The stamp of a frame sent now; it is read a little later. */
static uint64_t stamp_of_a_frame(int stamped, int sender) {
    const struct can_frame frame = {.can_id = 1};
    struct can_frame received;
    _Alignas(struct cmsghdr) char control[CMSG_SPACE(sizeof(struct timespec))];
    struct iovec part = {.iov_base = &received, .iov_len = sizeof received};
    struct msghdr message = {
        .msg_iov = &part, .msg_iovlen = 1, .msg_control = control, .msg_controllen = sizeof control};
    struct timespec stamp;
    TEST_ASSERT_EQUAL_INT(sizeof frame, send(sender, &frame, sizeof frame, 0));
    vcan_pause_ms(VCAN_SETTLED_MS);
    TEST_ASSERT_EQUAL_INT(sizeof received, recvmsg(stamped, &message, 0));
    TEST_ASSERT_NOT_NULL(CMSG_FIRSTHDR(&message));
    memcpy(&stamp, CMSG_DATA(CMSG_FIRSTHDR(&message)), sizeof stamp);
    return (uint64_t)stamp.tv_sec * 1000000 + (uint64_t)stamp.tv_nsec / 1000;
}

static int bind_raw(int can_socket, const char *interface) {
    const struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = (int)if_nametoindex(interface)};
    TEST_ASSERT_TRUE_MESSAGE(can_socket >= 0, "no CAN socket");
    TEST_ASSERT_NOT_EQUAL_MESSAGE(0, address.can_ifindex, interface);
    TEST_ASSERT_EQUAL_INT(0, bind(can_socket, (const struct sockaddr *)&address, sizeof address));
    return can_socket;
}

/* All on one processor, so that the kernel does its deferred work as soon as this program sleeps. */
static void stay_on_one_processor(void) {
    cpu_set_t first;
    CPU_ZERO(&first);
    CPU_SET((unsigned)sched_getcpu(), &first);
    TEST_ASSERT_EQUAL_INT(0, sched_setaffinity(0, sizeof first, &first));
}

void vcan_begin(void) {
    static int stamped = -1; /* stays open, so that the kernel keeps stamping */
    const int on = 1;
    if (stamped >= 0) {
        return;
    }
    stay_on_one_processor();
    stamped = bind_raw(socket(PF_CAN, SOCK_RAW, CAN_RAW), "vcan2");
    TEST_ASSERT_EQUAL_INT(0, setsockopt(stamped, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on));
    const int sender = bind_raw(socket(PF_CAN, SOCK_RAW, CAN_RAW), "vcan2");
    uint64_t before_us = 0;
    unsigned times = 0;
    do {
        TEST_ASSERT_TRUE_MESSAGE(times++ < VCAN_SOON_MS / VCAN_SETTLED_MS, "the kernel does not stamp");
        before_us = vcan_real_us();
    } while (stamp_of_a_frame(stamped, sender) >= before_us + VCAN_SETTLED_MS * 1000);
    (void)close(sender);
}

int vcan_open(const char *interface) {
    const int on = 1;
    const can_err_mask_t errors = CAN_ERR_MASK;
    const int tester = bind_raw(socket(PF_CAN, SOCK_RAW, CAN_RAW), interface);
    TEST_ASSERT_TRUE(tester_count < TESTERS_MAX);
    testers[tester_count++] = tester;
    TEST_ASSERT_EQUAL_INT(0, setsockopt(tester, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on));
    TEST_ASSERT_EQUAL_INT(0, setsockopt(tester, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors));
    return tester;
}

static struct can_frame make(uint32_t can_id, uint8_t length, const uint8_t *data) {
    struct can_frame frame = {.can_id = can_id, .len = length};
    memcpy(frame.data, data, sizeof frame.data);
    return frame;
}

void vcan_send(int tester, uint32_t can_id, uint8_t length, const uint8_t *data) {
    const struct can_frame frame = make(can_id, length, data);
    TEST_ASSERT_EQUAL_INT(sizeof frame, send(tester, &frame, sizeof frame, 0));
}

bool vcan_try(int tester, uint32_t can_id) {
    const struct can_frame frame = {.can_id = can_id, .len = 8};
    return send(tester, &frame, sizeof frame, MSG_DONTWAIT) == (ssize_t)sizeof frame;
}

void vcan_send_fd(int tester, uint32_t can_id, uint8_t length) {
    struct canfd_frame frame = {.can_id = can_id, .len = length};
    for (unsigned i = 0; i < length; i++) {
        frame.data[i] = (uint8_t)(i + 1);
    }
    TEST_ASSERT_EQUAL_INT(sizeof frame, send(tester, &frame, sizeof frame, 0));
}

void vcan_send_error(int tester, uint32_t classes, uint8_t controller) {
    const uint8_t data[8] = {0, controller};
    vcan_send(tester, classes | CAN_ERR_FLAG, 8, data);
}

/* The size of what came, 0: nothing. */
static ssize_t receive(int tester, struct canfd_frame *frame, int wait_ms) {
    struct pollfd file = {.fd = tester, .events = POLLIN};
    memset(frame, 0, sizeof *frame);
    return (poll(&file, 1, wait_ms) == 1) ? recv(tester, frame, sizeof *frame, MSG_DONTWAIT) : 0;
}

void vcan_expect(int tester, uint32_t can_id, uint8_t length, const uint8_t *data) {
    struct canfd_frame frame;
    TEST_ASSERT_EQUAL_INT(sizeof(struct can_frame), receive(tester, &frame, VCAN_SOON_MS));
    TEST_ASSERT_EQUAL_HEX32(can_id, frame.can_id);
    TEST_ASSERT_EQUAL_UINT8(length, frame.len);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, frame.data, 8);
}

void vcan_expect_id(int tester, uint32_t can_id) {
    struct canfd_frame frame;
    TEST_ASSERT_EQUAL_INT(sizeof(struct can_frame), receive(tester, &frame, VCAN_SOON_MS));
    TEST_ASSERT_EQUAL_HEX32(can_id, frame.can_id);
}

void vcan_expect_nothing(int tester) {
    struct canfd_frame frame;
    const ssize_t size = receive(tester, &frame, VCAN_NEVER_MS);
    TEST_ASSERT_EQUAL_HEX32_MESSAGE(0, frame.can_id, "this frame was not to come");
    TEST_ASSERT_EQUAL_INT(0, size);
}

void vcan_drain(int tester) {
    struct canfd_frame frame;
    while (receive(tester, &frame, 0) != 0) {
    }
}

uint64_t vcan_real_us(void) {
    struct timespec now;
    TEST_ASSERT_EQUAL_INT(0, clock_gettime(CLOCK_REALTIME, &now));
    return (uint64_t)now.tv_sec * 1000000 + (uint64_t)now.tv_nsec / 1000;
}

void vcan_pause_ms(unsigned ms) {
    const struct timespec time = {.tv_sec = ms / 1000, .tv_nsec = (long)(ms % 1000) * 1000000};
    (void)nanosleep(&time, NULL);
}

hal_can_frame_t vcan_frame(uint32_t id) {
    return (hal_can_frame_t){.id = id, .length = 8, .data = {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}};
}

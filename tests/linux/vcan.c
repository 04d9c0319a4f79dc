#include "vcan.h"

#include <linux/can/raw.h>
#include <net/if.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <time.h>
#include <unistd.h>

#include "unity.h"

#define TESTERS_MAX 8u

static int testers[TESTERS_MAX];
static unsigned tester_count;
static bool is_changed;

void vcan_run(const char *commands) {
    is_changed = true;
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, system(commands), commands);
}

long vcan_number(const char *command) {
    char line[64] = "";
    FILE *output = popen(command, "r");
    TEST_ASSERT_NOT_NULL(output);
    TEST_ASSERT_NOT_NULL_MESSAGE(fgets(line, sizeof line, output), command);
    TEST_ASSERT_EQUAL_INT_MESSAGE(0, pclose(output), command);
    return strtol(line, NULL, 10);
}

void vcan_restore(void) {
    while (tester_count > 0) {
        (void)close(testers[--tester_count]);
    }
    if (is_changed) {
        is_changed = false;
        TEST_ASSERT_EQUAL_INT(0, system("for name in vcan0 vcan1; do"
                                        "  ip link show dev $name >/dev/null 2>&1 || ip link add dev $name type vcan;"
                                        "  tc qdisc del dev $name root 2>/dev/null;"
                                        "  ip link set dev $name up || exit 1; done"));
    }
}

int vcan_open(const char *interface) {
    const int on = 1;
    const can_err_mask_t errors = CAN_ERR_MASK;
    const int tester = socket(PF_CAN, SOCK_RAW, CAN_RAW);
    TEST_ASSERT_TRUE_MESSAGE(tester >= 0, "no CAN socket");
    TEST_ASSERT_TRUE(tester_count < TESTERS_MAX);
    testers[tester_count++] = tester;
    const struct sockaddr_can address = {.can_family = AF_CAN, .can_ifindex = (int)if_nametoindex(interface)};
    TEST_ASSERT_NOT_EQUAL_MESSAGE(0, address.can_ifindex, interface);
    TEST_ASSERT_EQUAL_INT(0, setsockopt(tester, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on));
    TEST_ASSERT_EQUAL_INT(0, setsockopt(tester, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof errors));
    TEST_ASSERT_EQUAL_INT(0, bind(tester, (const struct sockaddr *)&address, sizeof address));
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
        frame.data[i] = (uint8_t)(i + 1u);
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
    return (uint64_t)now.tv_sec * 1000000u + (uint64_t)now.tv_nsec / 1000u;
}

void vcan_pause_ms(unsigned ms) {
    const struct timespec time = {.tv_sec = ms / 1000u, .tv_nsec = (long)(ms % 1000u) * 1000000};
    (void)nanosleep(&time, NULL);
}

hal_can_frame_t vcan_frame(uint32_t id) {
    return (hal_can_frame_t){.id = id, .length = 8, .data = {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88}};
}

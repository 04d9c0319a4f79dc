/* Reading the kernel's messages on interfaces: bytes written by hand from <linux/rtnetlink.h>, as a little-endian computer has
 * them. */
#include <net/if.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

#include "hal_linux/linux_can.h"
#include "linux_can_internal.h"
#include "unity.h"

enum { HEAD = 32, KIND_CAN = 280, NEWLINK = 16, DELLINK = 17 };

/* can0, index 5, up: name, statistics that do not matter, then the controller's state within kind and data. */
static const unsigned char BUS_OFF[] = {
    0x58, 0, 0,    0,    NEWLINK, 0,   0,   0,   1,    0, 0, 0, 0, 0, 0,  0, /* nlmsghdr, 88 bytes */
    0,    0, 0x18, 1,    5,       0,   0,   0,   0x41, 0, 1, 0, 0, 0, 0,  0, /* ifinfomsg: type 280, index 5, up and running */
    9,    0, 3,    0,    'c',     'a', 'n', '0', 0,    0, 0, 0, 5, 0, 16, 0, 1,
    0,    0, 0,                                /* IFLA_IFNAME, IFLA_OPERSTATE */
    0x24, 0, 18,   0x80,                       /* IFLA_LINKINFO, marked as nested */
    8,    0, 1,    0,    'c',     'a', 'n', 0, /* IFLA_INFO_KIND */
    0x18, 0, 2,    0,                          /* IFLA_INFO_DATA */
    8,    0, 6,    0,    0,       0,   0,   0, /* IFLA_CAN_RESTART_MS */
    8,    0, 4,    0,    3,       0,   0,   0, /* IFLA_CAN_STATE: bus-off */
    4,    0, 0,    0,                          /* an empty one */
};

enum { SIZE = sizeof BUS_OFF, TYPE_AT = 4, FAMILY_AT = 16, UP_AT = 24, LINK_INFO_AT = 52, KIND_AT = 56, DATA_AT = 64 };
enum { STATE_AT = 76, VALUE_AT = 80 };

static unsigned char message[SIZE];
static linux_can_link_t link_read;

void setUp(void) {
    memcpy(message, BUS_OFF, sizeof message);
    memset(&link_read, 0xA5, sizeof link_read);
}

void tearDown(void) {
}

static bool read_all(void) {
    return linux_can_link_read(message, sizeof message, &link_read);
}

static void expect_unknown(void) {
    TEST_ASSERT_TRUE(read_all());
    TEST_ASSERT_FALSE(link_read.has_state);
    TEST_ASSERT_EQUAL(HAL_CAN_ERROR_ACTIVE, link_read.state);
    TEST_ASSERT_EQUAL_INT(5, link_read.index);
}

/* Shows: SUP-7 */
void test_a_controller_in_bus_off(void) {
    TEST_ASSERT_EQUAL_UINT(message[0], sizeof message);
    TEST_ASSERT_TRUE(read_all());
    TEST_ASSERT_EQUAL_INT(5, link_read.index);
    TEST_ASSERT_EQUAL_UINT(KIND_CAN, link_read.kind);
    TEST_ASSERT_TRUE(link_read.is_up);
    TEST_ASSERT_TRUE(link_read.has_state);
    TEST_ASSERT_EQUAL(HAL_CAN_BUS_OFF, link_read.state);
}

void test_each_state_of_a_controller(void) {
    const hal_can_state_t states[] = {HAL_CAN_ERROR_ACTIVE, HAL_CAN_ERROR_ACTIVE /* warning */, HAL_CAN_ERROR_PASSIVE,
                                      HAL_CAN_BUS_OFF};
    for (unsigned char value = 0; value < 4; value++) {
        message[VALUE_AT] = value;
        TEST_ASSERT_TRUE(read_all());
        TEST_ASSERT_TRUE(link_read.has_state);
        TEST_ASSERT_EQUAL(states[value], link_read.state);
    }
}

void test_a_controller_that_does_not_run_has_no_state(void) {
    for (unsigned char value = 4; value < 8; value++) {
        message[VALUE_AT] = value;
        expect_unknown();
    }
    message[VALUE_AT] = 0;
    message[VALUE_AT + 3] = 0xFF;
    expect_unknown();
}

void test_an_interface_without_a_controller_has_no_state(void) {
    message[KIND_AT + 4] = 'v'; /* van */
    expect_unknown();
    memcpy(&message[KIND_AT + 4], "cann", 4); /* longer */
    expect_unknown();
    setUp();
    message[KIND_AT + 2] = 7; /* no kind */
    expect_unknown();
    setUp();
    message[DATA_AT + 2] = 7; /* no data */
    expect_unknown();
    setUp();
    message[STATE_AT + 2] = 9; /* no state in it */
    expect_unknown();
    setUp();
    message[LINK_INFO_AT + 2] = 99;
    expect_unknown();
}

void test_an_interface_that_is_down_or_removed(void) {
    message[UP_AT] = 0x40;
    TEST_ASSERT_TRUE(read_all());
    TEST_ASSERT_FALSE(link_read.is_up);
    message[UP_AT] = 0x41;
    message[TYPE_AT] = DELLINK;
    expect_unknown();
    TEST_ASSERT_FALSE(link_read.is_up);
}

void test_other_messages_are_not_read(void) {
    message[TYPE_AT] = 2; /* NLMSG_ERROR */
    TEST_ASSERT_FALSE(read_all());
    message[TYPE_AT] = 20; /* RTM_NEWADDR */
    TEST_ASSERT_FALSE(read_all());
    message[TYPE_AT] = NEWLINK;
    message[FAMILY_AT] = 7; /* of a bridge */
    TEST_ASSERT_FALSE(read_all());
}

/* Bytes behind the end are of another size each time, so that a sanitizer sees each reading beyond it. */
void test_a_message_that_is_cut_off_anywhere(void) {
    for (size_t size = 0; size < sizeof message; size++) {
        unsigned char *part = malloc(size + 1);
        TEST_ASSERT_NOT_NULL(part);
        memcpy(part + 1, message, size);
        const bool is_read = linux_can_link_read(part + 1, size, &link_read); /* at an odd address, too */
        free(part);
        TEST_ASSERT_EQUAL(size >= HEAD, is_read);
        TEST_ASSERT_FALSE(link_read.has_state);
    }
}

/* A length that is wrong hides what follows, and no more is read than was received. */
void test_a_message_that_says_it_is_shorter_or_longer(void) {
    for (unsigned length = 0; length < 256; length++) {
        message[0] = (unsigned char)length;
        TEST_ASSERT_TRUE(read_all());
        TEST_ASSERT_EQUAL(length >= sizeof message, link_read.has_state);
    }
    memset(message, 0xFF, 4);
    TEST_ASSERT_TRUE(read_all());
    TEST_ASSERT_TRUE(link_read.has_state);
}

/* Where a length stands, and the values with which the state is still found: lengths are rounded up to 4. */
static const struct {
    size_t at;
    unsigned from;
    unsigned to;
    unsigned also_from;
    unsigned also_to;
} LENGTHS[] = {
    {32, 9, 12, 17, 20},            /* the name; or name and IFLA_OPERSTATE as one */
    {44, 5, 8, 5, 8},               /* IFLA_OPERSTATE */
    {LINK_INFO_AT, 36, 36, 36, 36}, /* all that follows, and no more */
    {KIND_AT, 8, 8, 8, 8},          /* "can" with its end */
    {DATA_AT, 20, 24, 20, 24},      /* up to the state, or to the end */
    {68, 5, 8, 5, 8},               /* IFLA_CAN_RESTART_MS */
    {STATE_AT, 8, 8, 8, 8},         /* a state of 4 bytes */
    {84, 0, 0x1FF, 0, 0x1FF},       /* behind the state */
};

static void read_with_length(size_t at, unsigned length) {
    unsigned char *copy = malloc(sizeof message);
    TEST_ASSERT_NOT_NULL(copy);
    memcpy(copy, message, sizeof message);
    copy[at] = (unsigned char)length;
    copy[at + 1] = (unsigned char)(length >> 8);
    const bool is_read = linux_can_link_read(copy, sizeof message, &link_read);
    free(copy);
    TEST_ASSERT_TRUE(is_read);
    TEST_ASSERT_EQUAL_INT(5, link_read.index);
}

/* Each length of an attribute with each value that matters: the reading ends, and within the bytes. */
void test_lengths_that_are_wrong(void) {
    for (size_t i = 0; i < sizeof LENGTHS / sizeof LENGTHS[0]; i++) {
        for (unsigned value = 0; value < 0x200; value++) {
            const bool is_found = (value >= LENGTHS[i].from && value <= LENGTHS[i].to) ||
                                  (value >= LENGTHS[i].also_from && value <= LENGTHS[i].also_to);
            setUp();
            read_with_length(LENGTHS[i].at, value);
            TEST_ASSERT_EQUAL(is_found, link_read.has_state);
            TEST_ASSERT_EQUAL(is_found ? HAL_CAN_BUS_OFF : HAL_CAN_ERROR_ACTIVE, link_read.state);
        }
    }
    setUp();
    memset(&message[HEAD], 0, sizeof message - HEAD); /* attributes of the length 0 */
    expect_unknown();
    memset(&message[HEAD], 0xFF, sizeof message - HEAD);
    expect_unknown();
}

void test_a_state_of_another_size_is_none(void) {
    message[STATE_AT] = 6;
    expect_unknown();
    message[STATE_AT] = 12; /* the empty one belongs to it */
    expect_unknown();
}

/* With one descriptor left, the socket for the changes can be opened, but not the one for the query. lo stands for the
 * interface; it may be down. The kernel reports no change of it. */
void test_a_query_that_failed_is_repeated(void) {
    linux_can_t can = {.fd = STDIN_FILENO, .index = (int)if_nametoindex("lo")};
    linux_can_t other = can;
    struct rlimit limit;
    const bool is_up = linux_can_is_up(&other);
    TEST_ASSERT_TRUE(other.link_is_known);
    const int free_fd = dup(STDIN_FILENO);
    TEST_ASSERT_EQUAL_INT(0, close(free_fd));
    TEST_ASSERT_EQUAL_INT(0, getrlimit(RLIMIT_NOFILE, &limit));
    const struct rlimit one_left = {.rlim_cur = (rlim_t)free_fd + 1, .rlim_max = limit.rlim_max};
    TEST_ASSERT_EQUAL_INT(0, setrlimit(RLIMIT_NOFILE, &one_left));
    const bool up_at_first = linux_can_is_up(&can);
    TEST_ASSERT_EQUAL_INT(0, setrlimit(RLIMIT_NOFILE, &limit));
    TEST_ASSERT_FALSE(up_at_first);
    TEST_ASSERT_FALSE(can.link_is_known);
    TEST_ASSERT_EQUAL(is_up, linux_can_is_up(&can));
    TEST_ASSERT_TRUE(can.link_is_known);
}

/* A socket on an interface of the kernel: opening, both directions, reports besides frames. */

#include "hal_linux/linux_can.h"
#include "unity.h"
#include "vcan.h"

static const uint8_t EIGHT[8] = {0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77, 0x88};

static linux_can_t can;
static char error[LINUX_CAN_ERROR_SIZE];
static int tester;

void setUp(void) {
    vcan_begin();
    can = (linux_can_t){.fd = -1};
    tester = -1;
}

void tearDown(void) {
    linux_can_close(&can);
    vcan_restore();
}

static void open_with(const linux_can_options_t *options) {
    TEST_ASSERT_TRUE_MESSAGE(linux_can_open(&can, "vcan0", options, error), error);
    tester = vcan_open("vcan0");
}

static void open_plain(void) {
    const linux_can_options_t plain = {0};
    open_with(&plain);
}

/* The next result that is not LINUX_CAN_NOTHING. */
static linux_can_read_t read_soon(linux_can_record_t *record) {
    linux_can_read_t result = linux_can_read(&can, record);
    for (unsigned ms = 0; result == LINUX_CAN_NOTHING && ms < VCAN_SOON_MS; ms++) {
        vcan_pause_ms(1);
        result = linux_can_read(&can, record);
    }
    return result;
}

static hal_can_frame_t receive(void) {
    linux_can_record_t record;
    TEST_ASSERT_EQUAL(LINUX_CAN_RECORD, read_soon(&record));
    TEST_ASSERT_FALSE(record.own);
    TEST_ASSERT_EQUAL_UINT32(0, record.frame.time_ms);
    TEST_ASSERT_EQUAL_UINT16(0, record.frame.time_us);
    return record.frame;
}

static void receive_nothing(void) {
    linux_can_record_t record;
    vcan_pause_ms(VCAN_NEVER_MS);
    TEST_ASSERT_EQUAL(LINUX_CAN_NOTHING, linux_can_read(&can, &record));
}

static void expect_frame(uint32_t id, uint8_t flags, uint8_t length, const uint8_t *data) {
    const hal_can_frame_t frame = receive();
    TEST_ASSERT_EQUAL_HEX32(id, frame.id);
    TEST_ASSERT_EQUAL_HEX8(flags, frame.flags);
    TEST_ASSERT_EQUAL_UINT8(length, frame.length);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(data, frame.data, 8);
}

static void expect_refusal(const char *interface, const char *line) {
    const linux_can_options_t plain = {0};
    TEST_ASSERT_FALSE(linux_can_open(&can, interface, &plain, error));
    TEST_ASSERT_EQUAL_STRING(line, error);
    TEST_ASSERT_EQUAL_INT(-1, can.fd);
}

void test_an_interface_that_cannot_be_opened_is_named(void) {
    expect_refusal("vcan9", "vcan9: there is no such interface");
    expect_refusal("lo", "lo: not a CAN interface");
    expect_refusal("", ": there is no such interface");
    expect_refusal("vcan0123456789ab", "vcan0123456789ab: the name of an interface has at most 15 characters");
    expect_refusal("a-name-of-an-interface-that-is-much-too-long-to-be-repeated",
                   "a-name-of-an-interface-that-is-much-too-: the name of an interface has at most 15 characters");
}

void test_too_many_identifiers_are_refused(void) {
    const uint16_t ids[LINUX_CAN_IDS_MAX + 1] = {0};
    const linux_can_options_t options = {.ids = ids, .id_count = LINUX_CAN_IDS_MAX + 1};
    TEST_ASSERT_FALSE(linux_can_open(&can, "vcan0", &options, error));
    TEST_ASSERT_EQUAL_STRING("vcan0: more identifiers than can be filtered for", error);
    const linux_can_options_t most = {.ids = ids, .id_count = LINUX_CAN_IDS_MAX};
    TEST_ASSERT_TRUE(linux_can_open(&can, "vcan0", &most, error));
}

void test_closing_twice_is_closing(void) {
    linux_can_record_t record;
    open_plain();
    linux_can_close(&can);
    linux_can_close(&can);
    TEST_ASSERT_EQUAL_INT(-1, can.fd);
    TEST_ASSERT_FALSE(linux_can_is_up(&can));
    TEST_ASSERT_FALSE(linux_can_restart(&can));
    TEST_ASSERT_EQUAL(LINUX_CAN_IS_GONE, linux_can_read(&can, &record));
}

/* Shows: P15 */
void test_received_frames(void) {
    const uint8_t zeros[8] = {0};
    const uint8_t three[8] = {0x11, 0x22, 0x33};
    const uint8_t fd_bytes[8] = {1, 2, 3, 4, 5, 6, 7, 8};
    const uint8_t fd_five[8] = {1, 2, 3, 4, 5};
    open_plain();
    receive_nothing();
    vcan_send(tester, 0x065, 8, EIGHT);
    expect_frame(0x065, 0, 8, EIGHT);
    vcan_send(tester, 0x7FF, 3, EIGHT); /* bytes beyond the third one are not part of the payload */
    expect_frame(0x7FF, 0, 3, three);
    vcan_send(tester, 0x000, 0, EIGHT);
    expect_frame(0x000, 0, 0, zeros);
    vcan_send(tester, CAN_EFF_FLAG | 0x1ABCDEF0, 8, EIGHT);
    expect_frame(0x1ABCDEF0, HAL_CAN_EXTENDED, 8, EIGHT);
    vcan_send(tester, CAN_EFF_FLAG | 0x065, 8, EIGHT);
    expect_frame(0x065, HAL_CAN_EXTENDED, 8, EIGHT);
    vcan_send(tester, CAN_RTR_FLAG | 0x168, 5, EIGHT);
    expect_frame(0x168, HAL_CAN_REMOTE, 5, zeros);
    vcan_send(tester, CAN_EFF_FLAG | CAN_RTR_FLAG | 0x168, 0, EIGHT);
    expect_frame(0x168, HAL_CAN_EXTENDED | HAL_CAN_REMOTE, 0, zeros);
    vcan_send_fd(tester, 0x075, 64);
    expect_frame(0x075, HAL_CAN_FD, 64, fd_bytes);
    vcan_send_fd(tester, CAN_EFF_FLAG | 0x075, 5);
    expect_frame(0x075, HAL_CAN_FD | HAL_CAN_EXTENDED, 5, fd_five);
    receive_nothing();
}

void test_error_frames_are_received_only_if_requested(void) {
    const uint8_t passive[8] = {0, 0x30};
    const linux_can_options_t options = {.error_frames = true};
    open_with(&options);
    vcan_send_error(tester, CAN_ERR_CRTL, 0x30);
    expect_frame(0x004, HAL_CAN_ERROR, 8, passive);
    vcan_send_error(tester, CAN_ERR_BUSOFF | CAN_ERR_RESTARTED, 0);
    expect_frame(0x140, HAL_CAN_ERROR, 8, (const uint8_t[8]){0});
    linux_can_close(&can);
    open_plain();
    vcan_send_error(tester, CAN_ERR_CRTL, 0x30);
    receive_nothing();
}

static void expect_sent(const hal_can_frame_t *frame, uint32_t can_id, uint8_t length, const uint8_t *data) {
    TEST_ASSERT_EQUAL(LINUX_CAN_TAKEN, linux_can_write(&can, frame));
    vcan_expect(tester, can_id, length, data);
}

void test_sent_frames(void) {
    const uint8_t two[8] = {0x11, 0x22};
    open_plain();
    hal_can_frame_t frame = vcan_frame(0x7FF);
    frame.time_ms = 12345;
    expect_sent(&frame, 0x7FF, 8, EIGHT);
    frame.length = 2;
    expect_sent(&frame, 0x7FF, 2, two);
    frame = vcan_frame(0x1FFFFFFF);
    frame.flags = HAL_CAN_EXTENDED;
    expect_sent(&frame, CAN_EFF_FLAG | 0x1FFFFFFF, 8, EIGHT);
    frame.id = 0x168;
    frame.flags = HAL_CAN_REMOTE;
    expect_sent(&frame, CAN_RTR_FLAG | 0x168, 8, (const uint8_t[8]){0});
    frame.id = CAN_ERR_BUSOFF;
    frame.flags = HAL_CAN_ERROR;
    expect_sent(&frame, CAN_ERR_FLAG | 0x040, 8, EIGHT);
    vcan_expect_nothing(tester);
}

void test_frames_that_cannot_be_sent(void) {
    const hal_can_frame_t frames[] = {{.id = 0x800},
                                      {.id = 0x20000000, .flags = HAL_CAN_EXTENDED},
                                      {.id = 0x100, .length = 9},
                                      {.id = 0x100, .flags = HAL_CAN_FD}};
    open_plain();
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_EQUAL(LINUX_CAN_NOT_TAKEN, linux_can_write(&can, &frames[i]));
    }
    vcan_expect_nothing(tester);
}

void test_filters_let_these_values_through_whatever_the_kind_of_frame(void) {
    const uint16_t ids[] = {0x065, 0x7FF};
    const linux_can_options_t options = {.ids = ids, .id_count = 2};
    open_with(&options);
    vcan_send(tester, 0x064, 8, EIGHT);
    vcan_send(tester, 0x000, 8, EIGHT);
    vcan_send(tester, CAN_EFF_FLAG | 0x10000065, 8, EIGHT);
    vcan_send(tester, CAN_EFF_FLAG | 0x065, 8, EIGHT);
    vcan_send(tester, CAN_RTR_FLAG | 0x065, 0, EIGHT);
    vcan_send_fd(tester, 0x065, 8);
    vcan_send(tester, 0x065, 8, EIGHT);
    vcan_send(tester, 0x7FF, 8, EIGHT);
    TEST_ASSERT_EQUAL_HEX8(HAL_CAN_EXTENDED, receive().flags);
    TEST_ASSERT_EQUAL_HEX8(HAL_CAN_REMOTE, receive().flags);
    TEST_ASSERT_EQUAL_HEX8(HAL_CAN_FD, receive().flags);
    expect_frame(0x065, 0, 8, EIGHT);
    expect_frame(0x7FF, 0, 8, EIGHT);
    receive_nothing();
}

void test_no_identifiers_let_nothing_through(void) {
    const uint16_t ids[] = {0};
    const linux_can_options_t options = {.ids = ids, .id_count = 0};
    open_with(&options);
    vcan_send(tester, 0x000, 8, EIGHT);
    vcan_send(tester, 0x065, 8, EIGHT);
    receive_nothing();
}

void test_own_frames_are_received_only_if_requested(void) {
    const hal_can_frame_t frame = vcan_frame(0x065);
    linux_can_record_t record;
    open_plain();
    TEST_ASSERT_EQUAL(LINUX_CAN_TAKEN, linux_can_write(&can, &frame));
    receive_nothing();
    linux_can_close(&can);
    const linux_can_options_t options = {.own_frames = true};
    open_with(&options);
    TEST_ASSERT_EQUAL(LINUX_CAN_TAKEN, linux_can_write(&can, &frame));
    TEST_ASSERT_EQUAL(LINUX_CAN_RECORD, read_soon(&record));
    TEST_ASSERT_TRUE(record.own);
    TEST_ASSERT_EQUAL_HEX32(0x065, record.frame.id);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(EIGHT, record.frame.data, 8);
    vcan_send(tester, 0x065, 8, EIGHT); /* the same bytes from another socket of this computer are not an own frame */
    expect_frame(0x065, 0, 8, EIGHT);
}

void test_the_stamp_is_the_time_of_arrival(void) {
    linux_can_record_t record;
    open_plain();
    const uint64_t before_us = vcan_real_us();
    vcan_send(tester, 0x065, 8, EIGHT);
    const uint64_t after_us = vcan_real_us();
    vcan_pause_ms(50);
    TEST_ASSERT_EQUAL(LINUX_CAN_RECORD, linux_can_read(&can, &record));
    TEST_ASSERT_TRUE(record.stamp_us >= before_us);
    TEST_ASSERT_TRUE(record.stamp_us <= after_us);
}

void test_frames_lost_by_a_full_queue_are_counted(void) {
    const linux_can_options_t options = {.receive_size = 1};
    linux_can_record_t record;
    open_with(&options);
    for (unsigned i = 0; i < 200; i++) {
        vcan_send(tester, 0x065, 8, EIGHT);
    }
    vcan_pause_ms(VCAN_SETTLED_MS);
    unsigned received = 0;
    while (linux_can_read(&can, &record) == LINUX_CAN_RECORD) {
        received++;
    }
    TEST_ASSERT_TRUE(received >= 1 && received < 100);
    vcan_send(tester, 0x066, 8, EIGHT); /* the kernel reports the loss with the next frame that it keeps */
    TEST_ASSERT_EQUAL(LINUX_CAN_RECORD, read_soon(&record));
    TEST_ASSERT_EQUAL_HEX32(0x066, record.frame.id);
    TEST_ASSERT_EQUAL_UINT32(200 - received, record.lost);
}

void test_an_interface_that_is_down_is_reported_once_and_works_again(void) {
    const hal_can_frame_t frame = vcan_frame(0x065);
    linux_can_record_t record;
    open_plain();
    TEST_ASSERT_TRUE(linux_can_is_up(&can));
    vcan_down("vcan0");
    TEST_ASSERT_FALSE(linux_can_is_up(&can));
    TEST_ASSERT_EQUAL(LINUX_CAN_IS_DOWN, linux_can_read(&can, &record));
    TEST_ASSERT_EQUAL(LINUX_CAN_NOTHING, linux_can_read(&can, &record));
    TEST_ASSERT_EQUAL(LINUX_CAN_NOT_TAKEN, linux_can_write(&can, &frame));
    TEST_ASSERT_EQUAL(LINUX_CAN_NOTHING, linux_can_read(&can, &record));
    vcan_up("vcan0");
    TEST_ASSERT_TRUE(linux_can_is_up(&can));
    vcan_drain(tester);
    TEST_ASSERT_EQUAL(LINUX_CAN_TAKEN, linux_can_write(&can, &frame));
    vcan_expect(tester, 0x065, 8, EIGHT);
    vcan_send(tester, 0x066, 8, EIGHT);
    expect_frame(0x066, 0, 8, EIGHT);
}

void test_a_write_does_not_hide_the_report(void) {
    const hal_can_frame_t frame = vcan_frame(0x065);
    linux_can_record_t record;
    open_plain();
    for (unsigned times = 0; times < 2; times++) {
        vcan_down("vcan0");
        TEST_ASSERT_EQUAL(LINUX_CAN_NOT_TAKEN, linux_can_write(&can, &frame));
        TEST_ASSERT_EQUAL(LINUX_CAN_NOT_TAKEN, linux_can_write(&can, &frame));
        TEST_ASSERT_EQUAL(LINUX_CAN_IS_DOWN, linux_can_read(&can, &record));
        TEST_ASSERT_EQUAL(LINUX_CAN_NOTHING, linux_can_read(&can, &record));
        vcan_up("vcan0");
        TEST_ASSERT_EQUAL(LINUX_CAN_TAKEN, linux_can_write(&can, &frame));
    }
}

void test_whether_it_is_up_does_not_depend_on_its_name(void) {
    open_plain();
    TEST_ASSERT_TRUE(linux_can_is_up(&can));
    vcan_down("vcan0");
    vcan_run("ip link set dev vcan0 name other0");
    TEST_ASSERT_FALSE(linux_can_is_up(&can));
    vcan_up("other0");
    TEST_ASSERT_TRUE(linux_can_is_up(&can));
    vcan_down("vcan1"); /* another one */
    TEST_ASSERT_TRUE(linux_can_is_up(&can));
    vcan_down("other0");
    vcan_run("ip link set dev other0 name vcan0");
    TEST_ASSERT_FALSE(linux_can_is_up(&can));
}

/* The kernel keeps some hundred changes for a socket that does not read them. */
void test_whether_it_is_up_is_known_after_more_changes_than_the_kernel_keeps(void) {
    open_plain();
    TEST_ASSERT_TRUE(linux_can_is_up(&can));
    vcan_run("for i in $(seq 500); do printf 'link set vcan1 down\\nlink set vcan1 up\\n'; done | ip -batch -");
    vcan_down("vcan0");
    TEST_ASSERT_FALSE(linux_can_is_up(&can));
    TEST_ASSERT_FALSE(linux_can_is_up(&can));
    vcan_up("vcan0");
    TEST_ASSERT_TRUE(linux_can_is_up(&can));
}

void test_an_interface_that_was_removed_is_gone(void) {
    const linux_can_options_t plain = {0};
    const hal_can_frame_t frame = vcan_frame(0x065);
    linux_can_record_t record;
    open_plain();
    vcan_remove("vcan0");
    TEST_ASSERT_EQUAL(LINUX_CAN_IS_GONE, read_soon(&record));
    TEST_ASSERT_EQUAL(LINUX_CAN_IS_GONE, linux_can_read(&can, &record));
    TEST_ASSERT_EQUAL(LINUX_CAN_NOT_TAKEN, linux_can_write(&can, &frame));
    TEST_ASSERT_FALSE(linux_can_is_up(&can));
    vcan_add("vcan0");
    vcan_up("vcan0");
    TEST_ASSERT_EQUAL(LINUX_CAN_IS_GONE, linux_can_read(&can, &record));
    linux_can_close(&can);
    TEST_ASSERT_TRUE_MESSAGE(linux_can_open(&can, "vcan0", &plain, error), error);
    TEST_ASSERT_EQUAL(LINUX_CAN_TAKEN, linux_can_write(&can, &frame));
}

void test_a_removed_interface_is_found_by_a_write_too(void) {
    const hal_can_frame_t frame = vcan_frame(0x065);
    linux_can_record_t record;
    open_plain();
    vcan_remove("vcan0");
    TEST_ASSERT_EQUAL(LINUX_CAN_NOT_TAKEN, linux_can_write(&can, &frame));
    TEST_ASSERT_EQUAL(LINUX_CAN_NOT_TAKEN, linux_can_write(&can, &frame));
    TEST_ASSERT_EQUAL(LINUX_CAN_IS_GONE, linux_can_read(&can, &record));
}

void test_a_full_kernel_queue_is_reported(void) {
    const hal_can_frame_t frame = vcan_frame(0x065);
    open_plain();
    vcan_stick();
    for (unsigned i = 0; i < VCAN_STUCK_MAX; i++) {
        TEST_ASSERT_EQUAL(LINUX_CAN_TAKEN, linux_can_write(&can, &frame));
    }
    TEST_ASSERT_EQUAL(LINUX_CAN_FULL, linux_can_write(&can, &frame));
    TEST_ASSERT_EQUAL(LINUX_CAN_FULL, linux_can_write(&can, &frame));
    vcan_unstick();
    TEST_ASSERT_EQUAL(LINUX_CAN_TAKEN, linux_can_write(&can, &frame));
}

void test_a_virtual_interface_has_no_controller_to_restart(void) {
    open_plain();
    TEST_ASSERT_FALSE(linux_can_restart(&can));
}

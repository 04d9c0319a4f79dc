/* The log of what was sent: order kept, interfaces named as first heard. */
#include "logs/sent_log.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "scratch.h"
#include "unity.h"

static sent_log_t *sent;
static output_t *output;

void setUp(void) {
    scratch_open();
    sent = calloc(1, sizeof *sent);
    output = calloc(1, sizeof *output);
    TEST_ASSERT_TRUE(output_open(output, scratch_path("out")));
    sent->output = output;
}

void tearDown(void) {
    output_discard(output);
    free(output);
    free(sent);
}

static void add(hal_can_side_t side, uint32_t id, uint64_t stamp_us) {
    const hal_can_frame_t frame = {.id = id, .length = 1, .data = {0x55}};
    sent_log_add(sent, side, &frame, stamp_us);
}

static const char *finish(void) {
    sent_log_finish(sent);
    TEST_ASSERT_TRUE(output_commit(output));
    return scratch_read("out");
}

void test_lines_wait_for_the_name_of_their_interface(void) {
    add(HAL_CAN_VEHICLE, 0x43F, 1);
    add(HAL_CAN_AI, 0x363, 2);
    sent_log_heard(sent, HAL_CAN_AI, "ai0 and more", 3);
    add(HAL_CAN_AI, 0x364, 3);
    sent_log_heard(sent, HAL_CAN_VEHICLE, "veh", 3);
    sent_log_heard(sent, HAL_CAN_VEHICLE, "other", 5);
    add(HAL_CAN_VEHICLE, 0x440, 4);
    TEST_ASSERT_EQUAL_STRING("(0000000000.000001) veh 43F#55\n(0000000000.000002) ai0 363#55\n"
                             "(0000000000.000003) ai0 364#55\n(0000000000.000004) veh 440#55\n",
                             finish());
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
}

void test_a_side_that_is_never_heard_gets_a_name_at_the_end(void) {
    add(HAL_CAN_VEHICLE, 0x43F, 1);
    TEST_ASSERT_EQUAL_STRING("(0000000000.000001) can0 43F#55\n", finish());
    TEST_ASSERT_NOT_NULL(strstr(scratch_said(), "no frame was received on the vehicle side"));
}

void test_a_name_that_is_made_up_is_nobody_elses(void) {
    sent_log_heard(sent, HAL_CAN_AI, "can0", 4);
    add(HAL_CAN_VEHICLE, 0x43F, 1);
    TEST_ASSERT_EQUAL_STRING("(0000000000.000001) can1 43F#55\n", finish());
}

void test_nothing_is_said_when_nothing_waits(void) {
    TEST_ASSERT_EQUAL_STRING("", finish());
    TEST_ASSERT_EQUAL_STRING("", scratch_said());
}

void test_waiting_is_bounded(void) {
    for (size_t i = 0; i < SENT_LOG_WAITING_MAX + 2; i++) {
        add(HAL_CAN_VEHICLE, 0x100, i);
    }
    TEST_ASSERT_NOT_NULL(strstr(scratch_said(), "logged as can0"));
    TEST_ASSERT_EQUAL_UINT(0, sent->waiting_count);
    sent_log_heard(sent, HAL_CAN_VEHICLE, "veh", 3);
    add(HAL_CAN_VEHICLE, 0x100, 0);
    TEST_ASSERT_EQUAL_STRING("can0", sent->interfaces[HAL_CAN_VEHICLE]);
}

void test_without_an_output_nothing_waits(void) {
    sent->output = NULL;
    add(HAL_CAN_VEHICLE, 0x43F, 1);
    TEST_ASSERT_EQUAL_UINT(0, sent->waiting_count);
    TEST_ASSERT_EQUAL_STRING("", finish());
}

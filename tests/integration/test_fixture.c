/* The fixture itself: its traffic is healthy, and its helpers work. */
#include "one_fixture.h"

/* 700 frames a second but for the AI's 70: 7 messages each 10 ms or 25 ms, 4 commands. */
void test_a_second_of_healthy_traffic(void) {
    static const uint32_t EXPECTED[AGV_MSG_COUNT] = {10, 10, 10, 40, 100, 40, 100, 100, 100, 100, 100};
    fixture_start(&f);
    fixture_run(&f, 1000);
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        TEST_ASSERT_EQUAL_UINT32(EXPECTED[i], f.traffic[i].sent);
    }
    TEST_ASSERT_EQUAL_UINT32(710, agv_supervisor_counters(&f.supervisor)->received);
    TEST_ASSERT_EQUAL_UINT32(0, f.hal.bites);
}

/* Shows: SUP-1, SUP-2, SUP-3 */
void test_healthy_traffic_raises_nothing_and_nothing_is_sent(void) {
    fixture_active(&f);
    expect_state_after(&f, 5000, AGV_STATE_ACTIVE);
    expect_silence(&f);
    expect_output(&f, true);
    expect_led(&f, 0);
    TEST_ASSERT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_active(&f.supervisor));
}

void test_run_past_and_run_before(void) {
    fixture_start(&f);
    fixture_run_before(&f, AGV_MSG_GEAR_STATUS);
    TEST_ASSERT_EQUAL_UINT32(6, f.elapsed_ms);
    TEST_ASSERT_EQUAL_UINT32(0, f.traffic[AGV_MSG_GEAR_STATUS].sent);
    fixture_run_past(&f, AGV_MSG_GEAR_STATUS);
    TEST_ASSERT_EQUAL_UINT32(7, f.elapsed_ms);
    TEST_ASSERT_EQUAL_UINT32(1, f.traffic[AGV_MSG_GEAR_STATUS].sent);
    fixture_run_past(&f, AGV_MSG_GEAR_STATUS);
    TEST_ASSERT_EQUAL_UINT32(32, f.elapsed_ms);
}

static uint32_t down_for_ms;
static bool last_down;

static bool note_button(fixture_t *fixture, agv_message_t message, hal_can_frame_t *frame) {
    static uint32_t pressed_ms;
    if (message == AGV_MSG_VEHICLE_STATUS) {
        const bool down = (frame->data[6] & BUTTON_1) != 0;
        pressed_ms = down && !last_down ? fixture->now_ms : pressed_ms;
        down_for_ms = !down && last_down ? fixture->now_ms - pressed_ms : down_for_ms;
        last_down = down;
    }
    return true;
}

void test_a_press(void) {
    f.edit = note_button;
    fixture_standby(&f);
    fixture_press(&f, 1230);
    TEST_ASSERT_EQUAL_UINT32(1230, down_for_ms);
    TEST_ASSERT_FALSE(last_down); /* the releasing frame was just sent */
}

/* Shows: TOP-3 */
void test_status_frames_are_counted_and_logged_if_so_chosen(void) {
    fixture_active(&f);
    fixture_run(&f, 1000);
    expect_silence(&f);
    const uint32_t before = f.status_count;
    f.log_status = true;
    fixture_run(&f, 1000);
    TEST_ASSERT_EQUAL_UINT32(10, f.status_count - before);
    TEST_ASSERT_EQUAL_UINT32(10, fixture_count_sent(&f, 0x7F0));
}

/* 1 m/s are 3600 m/h. */
void test_drive(void) {
    fixture_drive(&f, -1000);
    TEST_ASSERT_EQUAL_HEX8(0x10, f.traffic[AGV_MSG_VEHICLE_STATUS].data[0]);
    TEST_ASSERT_EQUAL_HEX8(0x0E, f.traffic[AGV_MSG_VEHICLE_STATUS].data[1]);
    TEST_ASSERT_EQUAL_HEX8(0x18, f.traffic[AGV_MSG_WHEEL_SPEED].data[0]);
    TEST_ASSERT_EQUAL_HEX8(0xFF, f.traffic[AGV_MSG_WHEEL_SPEED].data[7]);
}

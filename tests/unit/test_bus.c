/* One CAN controller as the supervisor follows it. */
#include "agv/bus.h"

#include "unity.h"

/* Recovery 100 ms after bus-off, stalled when a frame waits for more than 50 ms. */
static agv_bus_t bus;
static hal_can_status_t controller;

/* What a look shows, as a set. */
enum { OFF = 1, RECOVERED = 2, ASK = 4, PASSIVE = 8, OVERRUN = 16, STALLED = 32 };

static int look(uint32_t now_ms) {
    const agv_bus_report_t report = agv_bus_tick(&bus, &controller, 100, 50, now_ms);
    return (report.off ? OFF : 0) | (report.recovered ? RECOVERED : 0) | (report.ask_recovery ? ASK : 0) |
           (report.passive ? PASSIVE : 0) | (report.overrun ? OVERRUN : 0) | (report.stalled ? STALLED : 0);
}

static bool is_off(void) {
    return agv_bus_is_off(&bus);
}

/* The controller has counted before: what it counted then is no news. */
void setUp(void) {
    controller = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE, .bus_off_count = 65535, .overrun_count = 65535};
    agv_bus_start(&bus, &controller);
}

void tearDown(void) {
}

static void enter_bus_off(void) {
    controller.state = HAL_CAN_BUS_OFF;
    controller.bus_off_count++; /* 65535 to 0 */
}

void test_a_healthy_controller_has_nothing_to_say(void) {
    TEST_ASSERT_EQUAL_HEX(0, look(0));
    TEST_ASSERT_EQUAL_HEX(0, look(1000000));
    TEST_ASSERT_FALSE(is_off());
}

/* Shows: SUP-7, TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFF80)
void test_recovery_is_asked_for_every_100_ms_of_bus_off(uint32_t start_ms) {
    enter_bus_off();
    for (uint32_t ms = 0; ms < 350; ms++) {
        const bool asked = ms == 100 || ms == 200 || ms == 300;
        TEST_ASSERT_EQUAL_HEX(asked ? (OFF | ASK) : OFF, look(start_ms + ms));
        TEST_ASSERT_TRUE(is_off());
    }
    controller.state = HAL_CAN_ERROR_ACTIVE;
    TEST_ASSERT_EQUAL_HEX(RECOVERED, look(start_ms + 350));
    TEST_ASSERT_FALSE(is_off());
    TEST_ASSERT_EQUAL_HEX(0, look(start_ms + 351));
}

/* Shows: SUP-7 */
void test_a_bus_off_between_two_looks_is_seen(void) {
    controller.bus_off_count++;
    TEST_ASSERT_EQUAL_HEX(OFF | RECOVERED, look(0));
    TEST_ASSERT_FALSE(is_off());
    TEST_ASSERT_EQUAL_HEX(0, look(1));
}

/* Off, back, and off again between two looks: still off. */
void test_a_second_bus_off_between_two_looks_is_bus_off(void) {
    enter_bus_off();
    (void)look(0);
    enter_bus_off();
    TEST_ASSERT_EQUAL_HEX(OFF, look(1));
}

/* Shows: SUP-7 */
void test_error_passive(void) {
    controller.state = HAL_CAN_ERROR_PASSIVE;
    TEST_ASSERT_EQUAL_HEX(PASSIVE, look(0));
    controller.state = HAL_CAN_ERROR_ACTIVE;
    TEST_ASSERT_EQUAL_HEX(0, look(1));
}

/* Shows: SUP-7 */
void test_an_overrun_is_told_once(void) {
    controller.overrun_count = 3; /* four more, across the wrap */
    TEST_ASSERT_EQUAL_HEX(OVERRUN, look(0));
    TEST_ASSERT_EQUAL_HEX(0, look(1));
}

/* Shows: SUP-7 */
void test_a_frame_that_waits_for_too_long(void) {
    controller.tx_pending_ms = 50;
    TEST_ASSERT_EQUAL_HEX(0, look(0));
    controller.tx_pending_ms = 51;
    TEST_ASSERT_EQUAL_HEX(STALLED, look(1));
    enter_bus_off(); /* says more than "stalled" */
    TEST_ASSERT_EQUAL_HEX(OFF, look(2));
}

/* The supervisor's view of a CAN controller. */
#include "observe/bus.h"

#include <stddef.h>

#include "unity.h"

/* Recovery 100 ms after bus-off, stalled when a frame waits for more than 50 ms. */
static agv_bus_t bus;
static agv_timers_t timers;
static agv_config_t config;
static hal_can_status_t controller;

void hal_can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    (void)hal;
    (void)side;
    *status = controller;
}

enum {
    OFF = AGV_BUS_OFF,
    RECOVERED = AGV_BUS_RECOVERED,
    ASK = AGV_BUS_ASK_RECOVERY,
    PASSIVE = AGV_BUS_PASSIVE,
    OVERRUN = AGV_BUS_OVERRUN,
    STALLED = AGV_BUS_STALLED,
    WAITING = AGV_BUS_WAITING
};

static uint32_t look(uint32_t now_ms) {
    agv_timers_advance(&timers, &config, now_ms, 0);
    return agv_bus_tick(&bus, &timers, &config, NULL, HAL_CAN_VEHICLE);
}

static bool is_off(void) {
    return agv_bus_is_off(&timers, HAL_CAN_VEHICLE);
}

/* The counts of the controller before the start are not reported. */
void setUp(void) {
    controller = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE, .bus_off_count = 65535, .overrun_count = 65535};
    agv_config_defaults(&config);
    config.bus_off_recovery_ms = 100;
    config.tx_stalled_ms = 50;
    agv_timers_set_time(&timers, 0);
    agv_timers_start(&timers);
    agv_bus_start(&bus, NULL, HAL_CAN_VEHICLE);
}

static void enter_bus_off(void) {
    controller.state = HAL_CAN_BUS_OFF;
    controller.bus_off_count++; /* 65535 to 0 */
}

void test_a_healthy_controller_reports_nothing(void) {
    TEST_ASSERT_EQUAL_HEX(0, look(0));
    TEST_ASSERT_EQUAL_HEX(0, look(1000000));
    TEST_ASSERT_FALSE(is_off());
}

/* Shows: SUP-7, TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFF80)
void test_recovery_is_requested_every_100_ms_of_bus_off(uint32_t start_ms) {
    agv_timers_set_time(&timers, start_ms);
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
void test_a_bus_off_between_two_ticks_is_detected(void) {
    controller.bus_off_count++;
    TEST_ASSERT_EQUAL_HEX(OFF | RECOVERED, look(0));
    TEST_ASSERT_FALSE(is_off());
    TEST_ASSERT_EQUAL_HEX(0, look(1));
}

/* Off, recovered, and off again between two ticks: still off. */
void test_a_second_bus_off_between_two_ticks_is_bus_off(void) {
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
void test_an_overrun_is_reported_once(void) {
    controller.overrun_count = 3; /* four more, across the wrap */
    TEST_ASSERT_EQUAL_HEX(OVERRUN, look(0));
    TEST_ASSERT_EQUAL_HEX(0, look(1));
}

/* Shows: SUP-7 */
void test_a_frame_that_waits_for_too_long(void) {
    controller.tx_pending_ms = 50;
    TEST_ASSERT_EQUAL_HEX(WAITING, look(0));
    controller.tx_pending_ms = 51;
    TEST_ASSERT_EQUAL_HEX(WAITING | STALLED, look(1));
    enter_bus_off(); /* more specific than "stalled" */
    TEST_ASSERT_EQUAL_HEX(OFF, look(2));
}

/* Each side is independent. */
void test_the_two_sides_are_independent(void) {
    agv_bus_t ai = {0};
    agv_bus_start(&ai, NULL, HAL_CAN_AI);
    enter_bus_off();
    TEST_ASSERT_EQUAL_HEX(OFF, look(0));
    TEST_ASSERT_TRUE(is_off());
    TEST_ASSERT_FALSE(agv_bus_is_off(&timers, HAL_CAN_AI));
    TEST_ASSERT_EQUAL_HEX(OFF, agv_bus_tick(&ai, &timers, &config, NULL, HAL_CAN_AI));
    TEST_ASSERT_TRUE(agv_bus_is_off(&timers, HAL_CAN_AI));
    controller.state = HAL_CAN_ERROR_ACTIVE;
    TEST_ASSERT_EQUAL_HEX(RECOVERED, look(1));
    TEST_ASSERT_FALSE(is_off());
    TEST_ASSERT_TRUE(agv_bus_is_off(&timers, HAL_CAN_AI));
}

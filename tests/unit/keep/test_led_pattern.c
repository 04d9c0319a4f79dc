/* The LED, millisecond by millisecond. */
#include "keep/led.h"

#include "unity.h"

static agv_led_t led;

void setUp(void) {
    led = (agv_led_t){0};
}

/* The pattern of a code by LED-1: the LED in each millisecond. @return its length */
static uint32_t pattern_of(int code, bool pattern[10000]) {
    uint32_t length = 0;
    for (int flash = 0; flash < code; flash++) {
        for (uint32_t ms = 0; ms < 400; ms++) {
            pattern[length++] = ms < 200;
        }
    }
    for (uint32_t ms = 0; ms < 1400; ms++) {
        pattern[length++] = false;
    }
    return length;
}

static void expect_pattern(int8_t code, bool shadow, const bool *pattern, uint32_t length) {
    bool shown = false;
    const int8_t other = (code == 7) ? 8 : 7; /* shown before, so that this one begins in the middle of it */
    (void)agv_led_tick(&led, other, false, 1);
    (void)agv_led_tick(&led, other, false, 300);
    TEST_ASSERT_FALSE(led.on);
    for (uint32_t ms = 0; ms < 3 * length; ms++) {
        const bool switched = agv_led_tick(&led, code, shadow, (ms == 0) ? 5 : 1);
        shown = switched ? led.on : shown;
        TEST_ASSERT_EQUAL(pattern[ms % length], led.on);
        TEST_ASSERT_EQUAL(led.on, shown); /* switching the LED only at changes gives the same pattern */
    }
}

/* Each code, and in shadow mode too. */
/* Shows: P19, LED-1, TOP-4 */
TEST_RANGE([ 1, 17, 1 ], [ 0, 1, 1 ])
void test_a_code_is_that_many_flashes_and_a_pause(int code, int shadow) {
    static bool pattern[10000];
    const uint32_t length = pattern_of(code, pattern);
    expect_pattern((int8_t)code, shadow != 0, pattern, length);
}

/* Healthy, healthy in shadow mode, a fault without a code. */
/* Shows: LED-1, TOP-4 */
TEST_CASE(AGV_LED_HEALTHY, false, 1000, 2000)
TEST_CASE(AGV_LED_HEALTHY, true, 100, 2000)
TEST_CASE(AGV_LED_BLINK, false, 100, 200)
void test_without_a_code_it_is_on_and_off(int code, bool shadow, uint32_t lit_ms, uint32_t period_ms) {
    static bool pattern[2000];
    for (uint32_t ms = 0; ms < period_ms; ms++) {
        pattern[ms] = ms < lit_ms;
    }
    expect_pattern((int8_t)code, shadow, pattern, period_ms);
}

/* Steps of any length keep the pattern in time: code 2 is 2200 ms long. */
void test_a_late_tick_keeps_the_pattern(void) {
    (void)agv_led_tick(&led, 2, false, 0);
    TEST_ASSERT_TRUE(led.on);
    TEST_ASSERT_FALSE(agv_led_tick(&led, 2, false, 2200)); /* one whole pattern */
    TEST_ASSERT_TRUE(agv_led_tick(&led, 2, false, 300));
    TEST_ASSERT_FALSE(led.on);
    TEST_ASSERT_TRUE(agv_led_tick(&led, 2, false, 3 * 2200 + 100)); /* 400 ms into the fourth */
    TEST_ASSERT_TRUE(led.on);
}

/* Codes of the protocol document's list, and two faults that are not in it. */
/* Shows: P19, LED-1 */
void test_a_fault_has_the_code_of_the_list(void) {
    TEST_ASSERT_EQUAL_INT(0, agv_led_code(AGV_FAULT_NONE));
    TEST_ASSERT_EQUAL_INT(14, agv_led_code(AGV_FAULT_BUS_OFF));
    TEST_ASSERT_EQUAL_INT(17, agv_led_code(AGV_FAULT_REMOTE_SIGNAL_LOST));
    TEST_ASSERT_EQUAL_INT(16, agv_led_code(AGV_FAULT_REMOTE_POWER_LOST));
    TEST_ASSERT_EQUAL_INT(13, agv_led_code(AGV_FAULT_EPS_MOTOR_ENCODER));
    TEST_ASSERT_EQUAL_INT(7, agv_led_code(AGV_FAULT_THROTTLE_STATUS_TIMEOUT));
    TEST_ASSERT_EQUAL_INT(-1, agv_led_code(AGV_FAULT_MEMORY_CORRUPTED));
    TEST_ASSERT_EQUAL_INT(-1, agv_led_code(AGV_FAULT_VCU_HEARTBEAT_LOST));
    TEST_ASSERT_EQUAL_INT(-1, agv_led_code(AGV_FAULT_NONE + 1)); /* no fault: never shown as healthy */
}

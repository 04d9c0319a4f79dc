/* What the gateway passes on: which commands in which state, reserved bits, throttle ceiling, steering slew. */
#include "transmit/gateway.h"

#include <string.h>

#include "unity.h"

static agv_gateway_t gateway;
static agv_config_t config;
static agv_vehicle_t vehicle;
static agv_state_t state;
static uint32_t now_ms;
static uint8_t data[8];

void setUp(void) {
    gateway = (agv_gateway_t){0};
    vehicle = (agv_vehicle_t){0};
    agv_config_defaults(&config);
    config.topology = AGV_TOPOLOGY_GATEWAY;
    state = AGV_STATE_ACTIVE;
    now_ms = 1000;
}

void tearDown(void) {
}

/* The adaptor to the module: everything below goes through these two. */
static bool passes(agv_message_t command) {
    return agv_gateway_passes(&config, state, command);
}

static void limit(agv_message_t command) {
    agv_gateway_limit(&gateway, &config, &vehicle, state, now_ms, command, data);
}

/* Hand in 8 bytes, look at those that come out. */
static void expect_passed(agv_message_t command, const uint8_t in[8], const uint8_t out[8]) {
    memcpy(data, in, 8);
    limit(command);
    TEST_ASSERT_EQUAL_HEX8_ARRAY(out, data, 8);
}

static unsigned throttle(uint8_t counts) {
    memset(data, 0, sizeof data);
    data[0] = counts;
    limit(AGV_MSG_THROTTLE_COMMAND);
    return data[0];
}

/* A steering command after so many milliseconds, in 0.1 degree from the centre. */
static int steer(uint32_t after_ms, int wanted_ddeg) {
    const unsigned raw = (unsigned)(wanted_ddeg + 9000);
    memset(data, 0, sizeof data);
    data[0] = (uint8_t)(raw & 0xFF);
    data[1] = (uint8_t)(raw >> 8);
    now_ms += after_ms;
    limit(AGV_MSG_STEERING_COMMAND);
    return (data[0] | data[1] << 8) - 9000;
}

/* Shows: TOP-2 */
void test_which_commands_pass_in_which_state(void) {
    for (unsigned value = 0; value < 256; value++) {
        for (unsigned command = 0; command < 4; command++) {
            const bool active = value == 0x3C;
            const bool standby = value == 0x33;
            state = (agv_state_t)value;
            config.gateway_in_manual = AGV_IN_MANUAL_HEARTBEAT;
            TEST_ASSERT_EQUAL(active || (standby && command == 0), passes((agv_message_t)command));
            config.gateway_in_manual = AGV_IN_MANUAL_ALL;
            TEST_ASSERT_EQUAL(active || standby, passes((agv_message_t)command));
        }
    }
}

/* P14: the document says nothing of the other bits. */
/* Shows: TOP-2, P14 */
void test_reserved_bits_are_passed_as_0(void) {
    static const struct {
        agv_message_t command;
        uint8_t in[8];
        uint8_t out[8];
    } cases[] = {
        {AGV_MSG_TURN_SIGNAL_COMMAND, {1, 2, 4, 8, 0xFF, 0x80, 0x7F, 200}, {0, 0, 0, 0, 0xF0, 0, 0, 200}},
        {AGV_MSG_TURN_SIGNAL_COMMAND, {0, 0, 0, 0, 0, 0, 0, 255}, {0, 0, 0, 0, 0, 0, 0, 255}},
        {AGV_MSG_TURN_SIGNAL_COMMAND, {0xFF, 0, 0, 0, 0x0F, 0, 0, 0}, {0}},
        {AGV_MSG_GEAR_COMMAND, {2, 9, 9, 9, 9, 9, 9, 9}, {2}},
        {AGV_MSG_THROTTLE_COMMAND, {100, 1, 0, 0, 0, 0, 0, 255}, {100}},
        {AGV_MSG_STEERING_COMMAND, {0x50, 0x46, 1, 2, 3, 4, 5, 6}, {0x50, 0x46}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        expect_passed(cases[i].command, cases[i].in, cases[i].out);
    }
}

/* 250 counts are 100 %. */
/* Shows: TOP-2 */
void test_the_throttle_ceiling(void) {
    TEST_ASSERT_EQUAL_UINT(250, throttle(250));
    config.throttle_ceiling_pct = 30;
    TEST_ASSERT_EQUAL_UINT(75, throttle(250));
    TEST_ASSERT_EQUAL_UINT(75, throttle(75));
    TEST_ASSERT_EQUAL_UINT(74, throttle(74));
    config.throttle_ceiling_pct = 33; /* 82.5 counts, rounded down */
    TEST_ASSERT_EQUAL_UINT(82, throttle(250));
    config.throttle_ceiling_pct = 99; /* 247.5 */
    TEST_ASSERT_EQUAL_UINT(247, throttle(250));
    config.throttle_ceiling_pct = 0;
    TEST_ASSERT_EQUAL_UINT(0, throttle(1));
}

/* Shows: TOP-2 */
void test_in_manual_the_throttle_is_0(void) {
    state = AGV_STATE_STANDBY;
    TEST_ASSERT_EQUAL_UINT(0, throttle(250));
    TEST_ASSERT_EQUAL_UINT(0, throttle(0));
}

/* Shows: TOP-2 */
void test_without_a_slew_limit_steering_passes_as_it_is(void) {
    TEST_ASSERT_EQUAL_INT(9000, steer(25, 9000));
    TEST_ASSERT_EQUAL_INT(-9000, steer(25, -9000));
    TEST_ASSERT_EQUAL_INT(0, steer(0, 0));
}

/* 400.0 degrees a second are 10.0 in the 25 ms of a cycle. */
/* Shows: TOP-2 */
void test_the_slew_limit_starts_from_the_measured_angle(void) {
    config.steering_slew_ddeg_s = 4000;
    vehicle.angle_known = true;
    vehicle.angle_raw = 9000 - 200;
    TEST_ASSERT_EQUAL_INT(-100, steer(0, 500)); /* the first one may use one cycle */
    TEST_ASSERT_EQUAL_INT(0, steer(25, 500));
    TEST_ASSERT_EQUAL_INT(40, steer(10, 500));
    TEST_ASSERT_EQUAL_INT(100, steer(25, 100));
    TEST_ASSERT_EQUAL_INT(0, steer(25, -9000));
    TEST_ASSERT_EQUAL_INT(-100, steer(25, -9000));
}

void test_without_a_measured_angle_the_first_command_is_the_start(void) {
    config.steering_slew_ddeg_s = 4000;
    TEST_ASSERT_EQUAL_INT(500, steer(0, 500));
    TEST_ASSERT_EQUAL_INT(400, steer(25, 0));
}

/* Longer pauses than a second give no more than a second does: 50.0 degrees. */
/* Shows: TOP-2, TIM-2 */
void test_a_pause_gives_at_most_a_second_of_slew(void) {
    config.steering_slew_ddeg_s = 500;
    now_ms = 0xFFFFFF00u;
    TEST_ASSERT_EQUAL_INT(-9000, steer(0, -9000));
    TEST_ASSERT_EQUAL_INT(-8500, steer(1000, 9000));
    TEST_ASSERT_EQUAL_INT(-8000, steer(5000, 9000));
}

/* 900.0 degrees a second: a millisecond more would be 0.9 degrees more. */
/* Shows: TOP-2 */
void test_a_second_of_slew_is_exact(void) {
    config.steering_slew_ddeg_s = 9000;
    TEST_ASSERT_EQUAL_INT(-9000, steer(0, -9000));
    TEST_ASSERT_EQUAL_INT(-9, steer(999, 9000));
    TEST_ASSERT_EQUAL_INT(8991, steer(1000, 9000));
    TEST_ASSERT_EQUAL_INT(-9, steer(1001, -9000));
}

/* 1.0 degree a second: a tenth takes 100 ms, and 25 ms frames must not round it away. */
/* Shows: TOP-2 */
void test_a_slow_slew_adds_up(void) {
    config.steering_slew_ddeg_s = 10;
    (void)steer(0, 0);
    for (int i = 1; i <= 40; i++) {
        TEST_ASSERT_EQUAL_INT(i / 4, steer(25, 1000));
    }
}

/* The last command was reached while time added up: from there on time counts anew. */
void test_time_does_not_add_up_while_the_command_is_followed(void) {
    config.steering_slew_ddeg_s = 10;
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_EQUAL_INT(0, steer(25, 0));
    }
    TEST_ASSERT_EQUAL_INT(0, steer(25, 1000));
}

/* The slew limit begins anew: from the measured angle of now, with the time of one cycle. */
/* Shows: TOP-2 */
void test_after_a_restart_the_slew_limit_starts_from_the_measured_angle(void) {
    config.steering_slew_ddeg_s = 4000;
    vehicle.angle_known = true;
    vehicle.angle_raw = 9000;
    TEST_ASSERT_EQUAL_INT(100, steer(0, 500));
    vehicle.angle_raw = 9000 - 300;
    TEST_ASSERT_EQUAL_INT(200, steer(25, 500));
    agv_gateway_restart(&gateway);
    TEST_ASSERT_EQUAL_INT(-200, steer(0, 500));
}

/* Commands that the gateway passes on, by state and mode; reserved bits; the envelope. */
#include "transmit/gateway.h"

#include <string.h>

#include "unity.h"

static agv_gateway_t gateway;
static agv_config_t config;
static agv_vehicle_t vehicle;
static agv_gateway_facts_t facts;
static bool limited;
static uint8_t data[8 + 1]; /* a command, and a byte behind it, which must stay */

void setUp(void) {
    gateway = (agv_gateway_t){0};
    vehicle = (agv_vehicle_t){0};
    agv_config_defaults(&config);
    config.topology = AGV_TOPOLOGY_GATEWAY;
    facts = (agv_gateway_facts_t){.config = &config,
                                  .vehicle = &vehicle,
                                  .state = AGV_STATE_ACTIVE,
                                  .now_ms = 1000,
                                  .gear_fresh = true,
                                  .angle_fresh = true,
                                  .autopilot = true};
    vehicle.wheels_fresh = true;
    vehicle.eps_in_angle_mode = true;
    vehicle.gear = 1;
    vehicle.angle_raw = 9000;
}

/* Adapters to the module: all tests use these functions. */
static bool passes(unsigned command, uint8_t first_byte) {
    const uint8_t payload[8] = {first_byte};
    return agv_gateway_passes(&gateway, &facts, command, payload);
}

static bool may_wait(unsigned command) {
    return agv_gateway_may_wait(&facts, command);
}

static void limit(agv_message_t command) {
    data[8] = 0xFF;
    limited = agv_gateway_limit(&gateway, &facts, command, data);
    TEST_ASSERT_EQUAL_HEX8(0xFF, data[8]);
}

/* Pass 8 bytes to the module and compare the result. */
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
    facts.now_ms += after_ms;
    limit(AGV_MSG_STEERING_COMMAND);
    return (data[0] | data[1] << 8) - 9000;
}

/* ---- Permitted commands ---- */

/* Motion commands in ACTIVE with autopilot reported, with `all` in STANDBY without it; 43Fh always. All bits of the state. */
/* Shows: TOP-2 */
void test_which_commands_pass_in_which_state_and_mode(void) {
    for (unsigned value = 0; value < 512; value++) {
        for (unsigned command = 0; command < 4; command++) {
            const bool active = (value & 0xFF) == 0x3C;
            const bool standby = (value & 0xFF) == 0x33;
            facts.state = (agv_state_t)(value & 0xFF);
            facts.autopilot = value > 0xFF;
            config.gateway_in_manual = AGV_IN_MANUAL_HEARTBEAT;
            const bool motion = active && facts.autopilot;
            TEST_ASSERT_EQUAL(motion || ((active || standby) && command == 0), passes(command, 1));
            TEST_ASSERT_EQUAL(motion || ((active || standby) && command == 0), may_wait(command));
            config.gateway_in_manual = AGV_IN_MANUAL_ALL;
            const bool manual = standby && !facts.autopilot;
            TEST_ASSERT_EQUAL(motion || manual || ((active || standby) && command == 0), passes(command, 1));
            TEST_ASSERT_EQUAL(motion || manual || ((active || standby) && command == 0), may_wait(command));
        }
    }
}

/* D or R other than 0A3h reports: 1 D, 2 R, 4 N, 8 P, 0 none known. */
/* Shows: TOP-2 */
void test_a_change_of_gear_waits_for_standstill(void) {
    static const uint8_t gears[] = {1, 2, 4, 8, 0};
    for (unsigned wanted = 0; wanted < 4; wanted++) {
        for (unsigned is = 0; is < 5; is++) {
            vehicle.gear = gears[is];
            config.gear_change = AGV_GEAR_CHANGE_AT_STANDSTILL;
            facts.standstill = false;
            TEST_ASSERT_EQUAL(wanted >= 2 || wanted == is, passes(AGV_MSG_GEAR_COMMAND, gears[wanted]));
            facts.standstill = true;
            TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, gears[wanted]));
            facts.standstill = false;
            config.gear_change = AGV_GEAR_CHANGE_ANY;
            TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, gears[wanted]));
        }
    }
}

/* 0A3h is silent and only warns: the gear that was sent passes, another waits for standstill. */
/* Shows: TOP-2 */
void test_with_a_silent_0a3h_the_gear_does_not_change_in_motion(void) {
    facts.gear_fresh = false;
    vehicle.gear = 1;
    facts.gear_sent = 2;
    TEST_ASSERT_FALSE(passes(AGV_MSG_GEAR_COMMAND, 1));
    TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, 2));
    facts.standstill = true;
    TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, 1));
}

/* The first byte of other commands is not a gear. Standstill alone does not permit a command. */
/* Shows: TOP-2 */
void test_only_168h_changes_the_gear(void) {
    vehicle.gear = 8;
    TEST_ASSERT_TRUE(passes(AGV_MSG_THROTTLE_COMMAND, 1));
    TEST_ASSERT_TRUE(passes(AGV_MSG_STEERING_COMMAND, 2));
    TEST_ASSERT_TRUE(passes(AGV_MSG_TURN_SIGNAL_COMMAND, 2));
    facts.standstill = true;
    facts.state = AGV_STATE_STANDBY;
    TEST_ASSERT_FALSE(passes(AGV_MSG_GEAR_COMMAND, 1));
    config.gateway_in_manual = AGV_IN_MANUAL_ALL;
    facts.autopilot = false;
    TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, 1));
    facts.standstill = false;
    TEST_ASSERT_FALSE(passes(AGV_MSG_GEAR_COMMAND, 1));
}

/* ---- Changes to a command ---- */

/* P14: the document does not define the other bits. */
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
        TEST_ASSERT_FALSE(limited); /* unchanged by the envelope */
    }
}

/* 250 counts are 100 %. */
/* Shows: TOP-2 */
void test_the_throttle_ceiling(void) {
    TEST_ASSERT_EQUAL_UINT(250, throttle(250));
    TEST_ASSERT_FALSE(limited);
    config.throttle_ceiling_pct = 30;
    TEST_ASSERT_EQUAL_UINT(75, throttle(250));
    TEST_ASSERT_TRUE(limited);
    TEST_ASSERT_EQUAL_UINT(75, throttle(75));
    TEST_ASSERT_FALSE(limited);
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
    facts.state = AGV_STATE_STANDBY;
    TEST_ASSERT_EQUAL_UINT(0, throttle(250));
    TEST_ASSERT_TRUE(limited);
    TEST_ASSERT_EQUAL_UINT(0, throttle(0));
    TEST_ASSERT_FALSE(limited);
}

/* ACTIVE is 3Ch. Any other state, valid or not, allows no throttle. */
/* Shows: TOP-2 */
void test_only_active_allows_throttle(void) {
    for (unsigned value = 0; value < 256; value++) {
        facts.state = (agv_state_t)value;
        TEST_ASSERT_EQUAL_UINT((value == 0x3C) ? 250 : 0, throttle(250));
    }
}

/* A received 168h: 1 D, 2 R, 4 N, 8 P. */
static void gear_commanded(uint8_t gear) {
    const uint8_t payload[8] = {gear};
    agv_gateway_follow_gear(&gateway, &facts, AGV_MSG_GEAR_COMMAND, payload);
}

/* Until standstill the throttle would drive the vehicle on in the gear that the AI computer wants to leave. */
/* Shows: TOP-2 */
void test_while_a_gear_waits_for_standstill_the_throttle_is_0(void) {
    facts.gear_sent = 1;
    gear_commanded(1);
    TEST_ASSERT_EQUAL_UINT(75, throttle(75));
    gear_commanded(2);
    TEST_ASSERT_EQUAL_UINT(0, throttle(75));
    TEST_ASSERT_TRUE(limited);
    TEST_ASSERT_EQUAL_UINT(0, throttle(0));
    TEST_ASSERT_FALSE(limited);
    facts.standstill = true;
    gear_commanded(2);
    TEST_ASSERT_EQUAL_UINT(75, throttle(75));
}

/* Engaged in R, and the AI computer begins with D. It may take it back, or ask for N or P, which do not wait. */
/* Shows: TOP-2 */
void test_which_gears_wait(void) {
    static const uint8_t taken_back[] = {2, 4, 8};
    vehicle.gear = 2;
    for (unsigned i = 0; i < 3; i++) {
        agv_gateway_restart(&gateway);
        gear_commanded(1);
        TEST_ASSERT_EQUAL_UINT(0, throttle(75));
        gear_commanded(taken_back[i]);
        TEST_ASSERT_EQUAL_UINT(75, throttle(75));
    }
    config.gear_change = AGV_GEAR_CHANGE_ANY;
    gear_commanded(1);
    TEST_ASSERT_EQUAL_UINT(75, throttle(75));
}

/* The VCU of such a vehicle does not guard P against speed. */
/* Shows: TOP-2, FSM-1 */
void test_with_park_at_standstill_p_waits_too(void) {
    config.park = AGV_PARK_AT_STANDSTILL;
    vehicle.gear = 1;
    facts.gear_sent = 1;
    TEST_ASSERT_FALSE(passes(AGV_MSG_GEAR_COMMAND, 8));
    TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, 4));
    gear_commanded(8);
    TEST_ASSERT_EQUAL_UINT(0, throttle(75));
    facts.standstill = true;
    TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, 8));
    facts.standstill = false;
    config.gear_change = AGV_GEAR_CHANGE_ANY; /* of D and R */
    TEST_ASSERT_FALSE(passes(AGV_MSG_GEAR_COMMAND, 8));
    TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, 2));
    config.park = AGV_PARK_AT_ONCE;
    TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, 8));
}

/* A wrong 0A3h does not let P pass in motion. In a vehicle that rolls away in P, a P that passed before may pass again. */
/* Shows: TOP-2, FSM-1 */
void test_p_does_not_depend_on_0a3h_alone(void) {
    config.park = AGV_PARK_AT_STANDSTILL;
    vehicle.gear = 8;
    facts.gear_sent = 1;
    TEST_ASSERT_FALSE(passes(AGV_MSG_GEAR_COMMAND, 8));
    facts.gear_sent = 8;
    TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, 8));
    vehicle.gear = 1; /* since then the operator has engaged D */
    TEST_ASSERT_FALSE(passes(AGV_MSG_GEAR_COMMAND, 8));
}

/* The mode flickers. */
/* Shows: TOP-2 */
void test_a_gear_waits_on_when_the_state_changes(void) {
    vehicle.gear = 1;
    facts.gear_sent = 1;
    gear_commanded(2);
    agv_gateway_restart(&gateway);
    TEST_ASSERT_EQUAL_UINT(0, throttle(75));
    gear_commanded(1);
    TEST_ASSERT_EQUAL_UINT(75, throttle(75));
}

/* A vehicle that leaves the gear by itself deviates from its command (SUP-11). */
/* Shows: TOP-2, SUP-11 */
void test_a_gear_that_was_sent_does_not_wait(void) {
    facts.gear_sent = 1;
    vehicle.gear = 2;
    gear_commanded(1);
    TEST_ASSERT_EQUAL_UINT(75, throttle(75));
    facts.gear_sent = 2;
    gear_commanded(1);
    TEST_ASSERT_EQUAL_UINT(0, throttle(75));
}

/* It does not depend on the gear that the vehicle reports, 0 being an invalid one. */
/* Shows: TOP-2 */
void test_another_gear_waits_whatever_is_reported(void) {
    static const uint8_t gears[] = {2, 4, 8, 0};
    for (unsigned i = 0; i < 4; i++) {
        for (unsigned k = 0; k < 4; k++) {
            facts.gear_sent = gears[i];
            vehicle.gear = gears[k];
            gear_commanded(1);
            TEST_ASSERT_EQUAL_UINT(0, throttle(75));
        }
    }
}

/* A 168h that may not pass, or another command, changes nothing. */
/* Shows: TOP-2 */
void test_only_a_gear_that_may_pass_waits(void) {
    const uint8_t payload[8] = {2};
    agv_gateway_follow_gear(&gateway, &facts, AGV_MSG_THROTTLE_COMMAND, payload);
    TEST_ASSERT_EQUAL_UINT(75, throttle(75));
    facts.autopilot = false;
    gear_commanded(2);
    TEST_ASSERT_EQUAL_UINT(75, throttle(75));
}

/* ---- Throttle rise ---- */

/* 100 % a second: 25 counts in the 100 ms of a cycle. The first one starts at 0 and may use one cycle. */
/* Shows: TOP-2 */
void test_the_throttle_rises_at_its_rate(void) {
    config.throttle_rise_pct_s = 100;
    TEST_ASSERT_EQUAL_UINT(25, throttle(250));
    TEST_ASSERT_TRUE(limited);
    facts.now_ms += 100;
    TEST_ASSERT_EQUAL_UINT(50, throttle(250));
    facts.now_ms += 50;
    TEST_ASSERT_EQUAL_UINT(62, throttle(250)); /* 12.5 */
    facts.now_ms += 100;
    TEST_ASSERT_EQUAL_UINT(70, throttle(70));
    TEST_ASSERT_FALSE(limited);
}

/* The throttle falls at once, and rises again from there. */
/* Shows: TOP-2 */
void test_the_throttle_falls_at_once(void) {
    config.throttle_rise_pct_s = 100;
    for (unsigned i = 1; i <= 10; i++) {
        TEST_ASSERT_EQUAL_UINT(25 * i, throttle(250));
        facts.now_ms += 100;
    }
    TEST_ASSERT_EQUAL_UINT(3, throttle(3));
    TEST_ASSERT_FALSE(limited);
    facts.now_ms += 100;
    TEST_ASSERT_EQUAL_UINT(28, throttle(250));
}

/* 1 % a second: a count takes 400 ms, and must not be lost by rounding in cycles of 100 ms. */
/* Shows: TOP-2 */
void test_a_slow_rise_adds_up(void) {
    config.throttle_rise_pct_s = 1;
    for (unsigned i = 1; i <= 40; i++) {
        TEST_ASSERT_EQUAL_UINT(i / 4, throttle(250));
        facts.now_ms += 100;
    }
}

/* While the throttle stays where it is, no rise is saved up for later. */
/* Shows: TOP-2 */
void test_a_held_throttle_saves_up_no_rise(void) {
    config.throttle_rise_pct_s = 1;
    for (unsigned i = 0; i < 11; i++) {
        TEST_ASSERT_EQUAL_UINT(0, throttle(0));
        facts.now_ms += 100;
    }
    TEST_ASSERT_EQUAL_UINT(0, throttle(250));
}

/* 59 % a second are 147.5 counts: 8.9975 in 61 ms, 9.9999 in 67.796 ms. */
/* Shows: TOP-2 */
void test_the_rise_is_rounded_down_and_the_rest_is_kept(void) {
    config.throttle_rise_pct_s = 59;
    TEST_ASSERT_EQUAL_UINT(0, throttle(0));
    facts.now_ms += 61;
    TEST_ASSERT_EQUAL_UINT(8, throttle(250));
    facts.now_ms += 1;
    TEST_ASSERT_EQUAL_UINT(9, throttle(250));
    facts.now_ms += 5; /* 67 ms in all */
    TEST_ASSERT_EQUAL_UINT(9, throttle(250));
    facts.now_ms += 1;
    TEST_ASSERT_EQUAL_UINT(10, throttle(250));
}

/* 10 % a second are 2.5 counts in a cycle of 100 ms: 25 counts in a second, not 20. */
/* Shows: TOP-2 */
void test_a_rise_of_half_counts_loses_nothing(void) {
    config.throttle_rise_pct_s = 10;
    (void)throttle(0);
    for (unsigned i = 1; i <= 10; i++) {
        facts.now_ms += 100;
        TEST_ASSERT_EQUAL_UINT(i * 5 / 2, throttle(250));
    }
}

/* The rest of a rise that was reached is not kept: 100 ms are 2.5 counts, 2 are wanted; 40 ms later 1 more. */
/* Shows: TOP-2 */
void test_a_throttle_that_is_reached_keeps_no_rest(void) {
    config.throttle_rise_pct_s = 10;
    (void)throttle(0);
    facts.now_ms += 100;
    TEST_ASSERT_EQUAL_UINT(2, throttle(2));
    facts.now_ms += 39;
    TEST_ASSERT_EQUAL_UINT(2, throttle(250));
    facts.now_ms += 1;
    TEST_ASSERT_EQUAL_UINT(3, throttle(250));
}

/* A pause counts as at most one second: 125 counts, limited by the ceiling. 12.5 and 124.9 counts make 137. */
/* Shows: TOP-2, TIM-2 */
void test_a_pause_gives_at_most_a_second_of_rise(void) {
    config.throttle_rise_pct_s = 50;
    facts.now_ms = 0xFFFFFF00u;
    TEST_ASSERT_EQUAL_UINT(12, throttle(250));
    facts.now_ms += 999;
    TEST_ASSERT_EQUAL_UINT(137, throttle(250));
    TEST_ASSERT_EQUAL_UINT(0, throttle(0));
    facts.now_ms += 5000;
    TEST_ASSERT_EQUAL_UINT(125, throttle(250));
    config.throttle_ceiling_pct = 52;
    facts.now_ms += 5000;
    TEST_ASSERT_EQUAL_UINT(130, throttle(250));
}

/* 1000 % a second is 250 counts in 100 ms: the largest rate overflows nothing. */
void test_the_largest_rise(void) {
    config.throttle_rise_pct_s = 1000;
    facts.now_ms += 4000;
    TEST_ASSERT_EQUAL_UINT(250, throttle(250));
    TEST_ASSERT_EQUAL_UINT(0, throttle(0));
    facts.now_ms += 4000;
    TEST_ASSERT_EQUAL_UINT(250, throttle(250));
}

/* Shows: TOP-2 */
void test_after_a_restart_the_rise_starts_at_0(void) {
    config.throttle_rise_pct_s = 100;
    (void)throttle(250);
    facts.now_ms += 100;
    TEST_ASSERT_EQUAL_UINT(50, throttle(250));
    agv_gateway_restart(&gateway);
    TEST_ASSERT_EQUAL_UINT(25, throttle(250));
}

/* ---- Steering above a speed ---- */

static void wheels(int32_t left_mm_s, int32_t right_mm_s) {
    vehicle.wheels = (agv_wheel_speed_t){.left_mm_s = left_mm_s, .right_mm_s = right_mm_s};
}

/* In both directions. One fast wheel is enough, forwards or backwards. The speed limit itself is not fast. */
/* Shows: TOP-2 */
void test_steering_is_limited_above_a_speed(void) {
    static const int32_t fast[] = {1001, -1001, 20000, INT32_MAX};
    config.steering_fast_max_ddeg = 100;
    config.fast_mm_s = 1000;
    wheels(1000, -1000);
    TEST_ASSERT_EQUAL_INT(9000, steer(25, 9000));
    TEST_ASSERT_FALSE(limited);
    for (unsigned i = 0; i < 4; i++) {
        wheels(fast[i], 0);
        TEST_ASSERT_EQUAL_INT(100, steer(25, 9000));
        TEST_ASSERT_TRUE(limited);
        wheels(0, fast[i]);
        TEST_ASSERT_EQUAL_INT(-100, steer(25, -101));
        TEST_ASSERT_TRUE(limited);
        TEST_ASSERT_EQUAL_INT(-100, steer(25, -100));
        TEST_ASSERT_FALSE(limited);
        TEST_ASSERT_EQUAL_INT(100, steer(25, 100));
    }
}

/* Shows: TOP-2 */
void test_stale_wheel_speeds_count_as_fast(void) {
    config.steering_fast_max_ddeg = 100;
    config.fast_mm_s = 20000;
    TEST_ASSERT_EQUAL_INT(500, steer(25, 500));
    vehicle.wheels_fresh = false;
    TEST_ASSERT_EQUAL_INT(100, steer(25, 500));
    config.steering_fast_max_ddeg = 0; /* off */
    TEST_ASSERT_EQUAL_INT(500, steer(25, 500));
}

/* The VCU's speed only warns when it contradicts 101h (SUP-12, P7): it limits no steering. */
/* Shows: TOP-2, SUP-12 */
void test_wheel_speeds_in_doubt_are_not_fast(void) {
    config.steering_fast_max_ddeg = 100;
    config.fast_mm_s = 1000;
    vehicle.wheels_doubted = true;
    wheels(1000, 1000);
    TEST_ASSERT_EQUAL_INT(500, steer(25, 500));
    wheels(1001, 1001);
    TEST_ASSERT_EQUAL_INT(100, steer(25, 500));
}

/* The limit is reached at the slew rate: 10.0 degrees a cycle. */
/* Shows: TOP-2 */
void test_slew_applies_to_the_limit_above_a_speed(void) {
    config.steering_slew_ddeg_s = 4000;
    config.steering_fast_max_ddeg = 100;
    config.fast_mm_s = 1000;
    vehicle.angle_raw = 9000 + 400;
    TEST_ASSERT_EQUAL_INT(400, steer(0, 400));
    wheels(1001, 1001);
    TEST_ASSERT_EQUAL_INT(300, steer(25, 400));
    TEST_ASSERT_EQUAL_INT(200, steer(25, 400));
    TEST_ASSERT_EQUAL_INT(100, steer(25, 400));
    TEST_ASSERT_EQUAL_INT(100, steer(25, 400));
    TEST_ASSERT_TRUE(limited);
}

/* ---- Steering slew ---- */

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
    vehicle.angle_raw = 9000 - 200;
    TEST_ASSERT_EQUAL_INT(-100, steer(0, 500)); /* the first one may use one cycle */
    TEST_ASSERT_EQUAL_INT(0, steer(25, 500));
    TEST_ASSERT_EQUAL_INT(40, steer(10, 500));
    TEST_ASSERT_EQUAL_INT(100, steer(25, 100));
    TEST_ASSERT_EQUAL_INT(0, steer(25, -9000));
    TEST_ASSERT_EQUAL_INT(-100, steer(25, -9000));
}

/* At a hand-over the operator may still steer, for as long as the EPS is not in angle control. An engagement that continues one
 * is judged from its start. */
/* Shows: TOP-2 */
TEST_CASE(false)
TEST_CASE(true)
void test_the_slew_limit_starts_anew_until_the_eps_is_in_angle_control(bool continues) {
    config.steering_slew_ddeg_s = 4000;
    facts.judged = continues;
    vehicle.eps_in_angle_mode = false;
    TEST_ASSERT_EQUAL_INT(0, steer(25, 0));
    vehicle.angle_raw = 9000 + 600;
    TEST_ASSERT_EQUAL_INT(500, steer(25, 0));
    TEST_ASSERT_EQUAL_INT(500, steer(1000, 0));
    vehicle.eps_in_angle_mode = true;
    TEST_ASSERT_EQUAL_INT(500, steer(25, 0)); /* the operator may have steered until now */
    vehicle.angle_raw = 9000 + 900;
    TEST_ASSERT_EQUAL_INT(400, steer(25, 0));
}

/* 167h still reports angle control at the first 065h; then the EPS assists, and the operator steers. */
/* Shows: TOP-2 */
void test_the_slew_limit_starts_anew_when_the_eps_leaves_angle_control_again(void) {
    config.steering_slew_ddeg_s = 4000;
    TEST_ASSERT_EQUAL_INT(0, steer(25, 0));
    vehicle.eps_in_angle_mode = false;
    vehicle.angle_raw = 9000 + 600;
    TEST_ASSERT_EQUAL_INT(100, steer(25, 600)); /* the EPS follows no angle now */
    TEST_ASSERT_EQUAL_INT(600, steer(25, 600));
    vehicle.eps_in_angle_mode = true;
    TEST_ASSERT_EQUAL_INT(600, steer(25, 600));
}

/* A start at an angle of another time would turn the steering there. Only a slew limit has a start. */
/* Shows: TOP-2 */
void test_the_slew_limit_does_not_start_from_an_angle_that_is_out_of_date(void) {
    facts.angle_fresh = false;
    TEST_ASSERT_TRUE(passes(AGV_MSG_STEERING_COMMAND, 0));
    config.steering_slew_ddeg_s = 4000;
    TEST_ASSERT_FALSE(passes(AGV_MSG_STEERING_COMMAND, 0));
    TEST_ASSERT_TRUE(passes(AGV_MSG_THROTTLE_COMMAND, 0));
    TEST_ASSERT_TRUE(passes(AGV_MSG_GEAR_COMMAND, 1));
    TEST_ASSERT_TRUE(passes(AGV_MSG_TURN_SIGNAL_COMMAND, 0));
    facts.angle_fresh = true;
    TEST_ASSERT_TRUE(passes(AGV_MSG_STEERING_COMMAND, 0));
}

/* Once a 065h has passed in angle control, the commands go on from the last one. */
/* Shows: TOP-2 */
void test_a_slew_limit_that_has_started_needs_no_measured_angle(void) {
    config.steering_slew_ddeg_s = 4000;
    vehicle.eps_in_angle_mode = false;
    (void)steer(25, 0);
    facts.angle_fresh = false;
    TEST_ASSERT_FALSE(passes(AGV_MSG_STEERING_COMMAND, 0));
    vehicle.eps_in_angle_mode = true;
    TEST_ASSERT_FALSE(passes(AGV_MSG_STEERING_COMMAND, 0));
    facts.angle_fresh = true;
    (void)steer(25, 0);
    facts.angle_fresh = false;
    TEST_ASSERT_TRUE(passes(AGV_MSG_STEERING_COMMAND, 0));
}

/* A longer pause counts as at most one second: 50.0 degrees. */
/* Shows: TOP-2, TIM-2 */
void test_a_pause_gives_at_most_a_second_of_slew(void) {
    config.steering_slew_ddeg_s = 500;
    facts.now_ms = 0xFFFFFF00u;
    vehicle.angle_raw = 0;
    TEST_ASSERT_EQUAL_INT(-9000, steer(0, -9000));
    TEST_ASSERT_EQUAL_INT(-8500, steer(1000, 9000));
    TEST_ASSERT_EQUAL_INT(-8000, steer(5000, 9000));
}

/* 900.0 degrees a second: a millisecond more would be 0.9 degrees more. */
/* Shows: TOP-2 */
void test_a_second_of_slew_is_exact(void) {
    config.steering_slew_ddeg_s = 9000;
    vehicle.angle_raw = 0;
    TEST_ASSERT_EQUAL_INT(-9000, steer(0, -9000));
    TEST_ASSERT_EQUAL_INT(-9, steer(999, 9000));
    TEST_ASSERT_EQUAL_INT(8991, steer(1000, 9000));
    TEST_ASSERT_EQUAL_INT(-9, steer(1001, -9000));
}

/* 1.0 degree a second: a tenth takes 100 ms, and must not be lost by rounding in cycles of 25 ms. */
/* Shows: TOP-2 */
void test_a_slow_slew_adds_up(void) {
    config.steering_slew_ddeg_s = 10;
    (void)steer(0, 0);
    for (int i = 1; i <= 40; i++) {
        TEST_ASSERT_EQUAL_INT(i / 4, steer(25, 1000));
    }
}

/* 7.9 degrees a second are 1.975 tenths in 25 ms: 79 tenths in a second, not 40. */
/* Shows: TOP-2 */
void test_a_slew_of_broken_tenths_loses_nothing(void) {
    config.steering_slew_ddeg_s = 79;
    (void)steer(0, 0);
    for (int i = 1; i < 40; i++) {
        (void)steer(25, -1000);
    }
    TEST_ASSERT_EQUAL_INT(-79, steer(25, -1000));
}

/* The rest of a slew that was reached is not kept: 25 ms are 0.5 tenths more than the one that was wanted. */
/* Shows: TOP-2 */
void test_an_angle_that_is_reached_keeps_no_rest(void) {
    config.steering_slew_ddeg_s = 60;
    (void)steer(0, 0);
    TEST_ASSERT_EQUAL_INT(1, steer(25, 1));
    TEST_ASSERT_EQUAL_INT(1, steer(16, 1000));
    TEST_ASSERT_EQUAL_INT(2, steer(1, 1000));
}

/* When the last command is reached, the collected time is cleared. */
void test_time_does_not_add_up_while_the_command_is_followed(void) {
    config.steering_slew_ddeg_s = 10;
    for (int i = 0; i < 100; i++) {
        TEST_ASSERT_EQUAL_INT(0, steer(25, 0));
    }
    TEST_ASSERT_EQUAL_INT(0, steer(25, 1000));
}

/* The slew limit restarts from the current measured angle, with the time of one cycle. */
/* Shows: TOP-2 */
void test_after_a_restart_the_slew_limit_starts_from_the_measured_angle(void) {
    config.steering_slew_ddeg_s = 4000;
    TEST_ASSERT_EQUAL_INT(100, steer(0, 500));
    vehicle.angle_raw = 9000 - 300;
    TEST_ASSERT_EQUAL_INT(200, steer(25, 500));
    agv_gateway_restart(&gateway);
    TEST_ASSERT_EQUAL_INT(-200, steer(0, 500));
}

/* An EPS that is stuck at the centre, and now and then reports another mode: the commands leave its angle all the same. */
/* Shows: TOP-2, SUP-10 */
void test_while_driving_is_judged_the_mode_of_the_eps_does_not_restart_the_slew_limit(void) {
    config.steering_slew_ddeg_s = 4000;
    facts.judged = true;
    TEST_ASSERT_EQUAL_INT(100, steer(0, 500));
    TEST_ASSERT_EQUAL_INT(200, steer(25, 500));
    vehicle.eps_in_angle_mode = false;
    TEST_ASSERT_EQUAL_INT(300, steer(25, 500));
    TEST_ASSERT_EQUAL_INT(400, steer(25, 500));
    vehicle.eps_in_angle_mode = true;
    TEST_ASSERT_EQUAL_INT(500, steer(25, 500));
    agv_gateway_restart(&gateway); /* the next engagement begins before the EPS takes angles */
    facts.judged = false;
    vehicle.eps_in_angle_mode = false;
    TEST_ASSERT_EQUAL_INT(100, steer(25, 500));
    TEST_ASSERT_EQUAL_INT(100, steer(25, 500));
}

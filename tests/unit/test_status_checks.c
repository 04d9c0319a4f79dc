/* Faults that the content of frames is: bits, modes, values, gaps; how many frames in a row each takes. */
#include "observe/status_checks.h"

#include "observe/liveness.h"
#include "unity.h"

enum { NONE = AGV_FAULT_NONE };

static agv_status_checks_t checks;
static agv_fault_monitor_t faults;
static agv_timers_t timers;
static agv_config_t config;
static agv_status_facts_t facts;

void setUp(void) {
    agv_config_defaults(&config);
    agv_timers_start(&timers, &config);
    checks = (agv_status_checks_t){0};
    faults = (agv_fault_monitor_t){0};
    facts = (agv_status_facts_t){.config = &config, .engaged = true, .settled = true, .ai_alive = true};
}

void tearDown(void) {
}

/* This fault is active, and no other. */
static void expect_only(unsigned fault) {
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        TEST_ASSERT_EQUAL(i == fault, agv_fault_monitor_is_active(&faults, i));
    }
}

/* 167h after so many ms: mode in byte 4, fault bits in byte 8. */
static void eps_after(uint32_t gap_ms, unsigned mode, unsigned bits) {
    const uint8_t data[8] = {0xFF, 0xFF, 0xFF, (uint8_t)mode, 0xFF, 0xFF, 0xFF, (uint8_t)bits};
    agv_status_checks_frame(&checks, AGV_MSG_EPS_STATUS, gap_ms);
    agv_status_checks_eps(&checks, &faults, &facts, data, mode <= 3 || mode == 0xFF);
}

static void eps(unsigned mode, unsigned bits) {
    eps_after(10, mode, bits);
}

/* 363h: alarms in byte 5, level 2 in byte 6. */
static void vcu(unsigned alarms, unsigned level_2) {
    const uint8_t data[8] = {0xFF, 0xFF, 0xFF, 0xFF, (uint8_t)alarms, (uint8_t)level_2, 0xFF, 0xFF};
    agv_status_checks_frame(&checks, AGV_MSG_VEHICLE_STATUS, 10);
    agv_status_checks_vehicle(&checks, &faults, &facts, data);
}

static void value(agv_message_t message, bool valid) {
    agv_status_checks_frame(&checks, message, agv_message_cycle_ms(message));
    agv_status_checks_value(&checks, &faults, &facts, message, valid);
}

/* ---- 167h ---- */

/* Under voltage, over voltage, excessive current. */
/* Shows: SUP-4 */
void test_bits_of_the_supply_count_three_frames_and_the_others_one(void) {
    static const unsigned fault_of[8] = {AGV_FAULT_EPS_UNDER_VOLTAGE,     AGV_FAULT_EPS_OVER_VOLTAGE,
                                         AGV_FAULT_EPS_EXCESSIVE_CURRENT, AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN,
                                         AGV_FAULT_EPS_TEMP_ABOVE_110,    AGV_FAULT_EPS_TEMP_ABOVE_120,
                                         AGV_FAULT_EPS_MOTOR_ENCODER,     AGV_FAULT_EPS_POSITION_ENCODER};
    for (unsigned bit = 0; bit < 8; bit++) {
        setUp();
        eps(1, 1u << bit);
        expect_only(bit < 3 ? (unsigned)NONE : fault_of[bit]);
        eps(1, 1u << bit);
        expect_only(bit < 3 ? (unsigned)NONE : fault_of[bit]);
        eps(1, 1u << bit);
        expect_only(fault_of[bit]);
        eps(1, 0);
        expect_only(NONE);
    }
}

/* Shows: SUP-4 */
void test_a_good_frame_between_bad_ones_begins_the_count_anew(void) {
    eps(1, 1);
    eps(1, 1);
    eps(1, 0);
    eps(1, 1);
    eps(1, 1);
    expect_only(NONE);
    eps(1, 1);
    expect_only(AGV_FAULT_EPS_UNDER_VOLTAGE);
}

/* More than two cycles: what was before is no row with what comes after. */
/* Shows: SUP-4 */
TEST_CASE(20, 3)
TEST_CASE(21, 4)
TEST_CASE(0xFFFFFFFF, 4)
void test_a_long_gap_begins_the_count_anew(uint32_t gap_ms, unsigned frames) {
    eps(1, 1);
    eps_after(gap_ms, 1, 1);
    for (unsigned i = 2; i < frames - 1; i++) {
        eps(1, 1);
        expect_only(NONE);
    }
    eps(1, 1);
    expect_only(AGV_FAULT_EPS_UNDER_VOLTAGE);
}

/* Shows: SUP-4 */
void test_what_has_counted_goes_on_across_gaps(void) {
    for (unsigned i = 0; i < 3; i++) {
        eps(1, 1);
    }
    eps_after(AGV_AGE_MAX, 1, 1);
    expect_only(AGV_FAULT_EPS_UNDER_VOLTAGE);
}

/* However often; the bits of one frame are counted apart. */
void test_a_count_does_not_overflow(void) {
    for (unsigned i = 0; i < 1000; i++) {
        eps(1, 1);
    }
    expect_only(AGV_FAULT_EPS_UNDER_VOLTAGE);
    eps(1, 2);
    eps(1, 2);
    expect_only(NONE);
    eps(1, 2);
    expect_only(AGV_FAULT_EPS_OVER_VOLTAGE);
}

/* Shows: SUP-4 */
void test_how_many_frames_of_the_supply_is_a_setting(void) {
    config.eps_supply_fault_frames = 1;
    eps(1, 2);
    expect_only(AGV_FAULT_EPS_OVER_VOLTAGE);
}

/* FFh is off; 0, 2 and 3 are other modes; the rest is none. */
/* Shows: SUP-5 */
TEST_CASE(0xFF, AGV_FAULT_EPS_MODE_OFF)
TEST_CASE(4, AGV_FAULT_EPS_MODE_INVALID)
TEST_CASE(0xFE, AGV_FAULT_EPS_MODE_INVALID)
TEST_CASE(0, AGV_FAULT_EPS_MODE_NOT_ANGLE)
TEST_CASE(2, AGV_FAULT_EPS_MODE_NOT_ANGLE)
TEST_CASE(3, AGV_FAULT_EPS_MODE_NOT_ANGLE)
void test_a_mode_that_is_not_angle_control_counts_five_frames(unsigned mode, unsigned fault) {
    for (unsigned i = 0; i < 4; i++) {
        eps(mode, 0);
        expect_only(NONE);
    }
    eps(mode, 0);
    expect_only(fault);
    eps(1, 0);
    expect_only(NONE);
}

/* Shows: SUP-5 */
void test_the_mode_is_named_after_the_last_frame(void) {
    eps(0, 0);
    eps(2, 0);
    eps(0xFF, 0);
    eps(7, 0);
    eps(3, 0);
    expect_only(AGV_FAULT_EPS_MODE_NOT_ANGLE);
    eps(0xFF, 0);
    expect_only(AGV_FAULT_EPS_MODE_OFF);
}

/* Shows: SUP-5 */
void test_before_the_grace_is_over_no_mode_counts(void) {
    facts.settled = false;
    for (unsigned i = 0; i < 10; i++) {
        eps(0xFF, 0);
    }
    expect_only(NONE);
    facts.settled = true;
    for (unsigned i = 0; i < 4; i++) {
        eps(0xFF, 0);
        expect_only(NONE);
    }
    eps(0xFF, 0);
    expect_only(AGV_FAULT_EPS_MODE_OFF);
}

/* ---- 363h ---- */

/* Bits 3 and 7 mean nothing; bit 4 has a test of its own. */
/* Shows: SUP-4 */
void test_an_alarm_counts_at_once(void) {
    static const unsigned fault_of[8] = {
        AGV_FAULT_REMOTE_SIGNAL_LOST,     AGV_FAULT_REMOTE_POWER_LOST,     NONE, NONE,
        AGV_FAULT_VCU_EPS_HARDWARE_FAULT, AGV_FAULT_VCU_EPS_CAN_BUS_FAULT, NONE, AGV_FAULT_S_DRIVER_ALARM};
    for (unsigned bit = 0; bit < 8; bit++) {
        setUp();
        vcu(1u << bit, 0);
        expect_only(fault_of[bit]);
        vcu(0, 0);
        expect_only(NONE);
    }
}

/* Shows: SUP-4, VCU_LEVEL2_ALARM */
void test_any_level_2_alarm(void) {
    for (unsigned bit = 0; bit < 8; bit++) {
        vcu(0, 1u << bit);
        expect_only(AGV_FAULT_VCU_LEVEL2_ALARM);
    }
    vcu(0, 0);
    expect_only(NONE);
}

/* Shows: SUP-8, VCU_AI_CAN_LOST */
void test_the_alarm_of_the_ai_computer_counts_once_it_was_clear_with_the_ai_alive(void) {
    vcu(0x08, 0);
    expect_only(NONE); /* never clear */
    facts.ai_alive = false;
    vcu(0, 0);
    vcu(0x08, 0);
    expect_only(NONE); /* clear without the AI */
    facts.ai_alive = true;
    vcu(0x80, 0); /* another alarm leaves it clear */
    facts.ai_alive = false;
    vcu(0x08, 0);
    expect_only(AGV_FAULT_VCU_AI_CAN_LOST);
    facts.engaged = false;
    vcu(0x08, 0);
    expect_only(NONE);
    facts.engaged = true;
    vcu(0x08, 0);
    expect_only(AGV_FAULT_VCU_AI_CAN_LOST);
    agv_status_checks_forget_ai(&checks);
    vcu(0x08, 0);
    expect_only(NONE);
}

/* ---- Values, gaps, disengagement ---- */

/* Shows: SUP-5 */
TEST_CASE(AGV_MSG_GEAR_STATUS, AGV_FAULT_GEAR_STATUS_INVALID)
TEST_CASE(AGV_MSG_THROTTLE_STATUS, AGV_FAULT_THROTTLE_STATUS_INVALID)
TEST_CASE(AGV_MSG_STEERING_STATUS, AGV_FAULT_STEERING_ANGLE_INVALID)
void test_a_value_that_is_invalid_counts_three_frames(unsigned message, unsigned fault) {
    value((agv_message_t)message, false);
    value((agv_message_t)message, false);
    expect_only(NONE);
    value((agv_message_t)message, true);
    value((agv_message_t)message, false);
    value((agv_message_t)message, false);
    expect_only(NONE);
    value((agv_message_t)message, false);
    expect_only(fault);
    facts.settled = false; /* not while it does not count */
    value((agv_message_t)message, false);
    expect_only(NONE);
}

/* Half a cycle: 50 ms, and 13 ms of 25. */
/* Shows: SUP-6, COMMAND_TOO_FAST */
TEST_CASE(AGV_MSG_TURN_SIGNAL_COMMAND, 50)
TEST_CASE(AGV_MSG_GEAR_COMMAND, 50)
TEST_CASE(AGV_MSG_THROTTLE_COMMAND, 50)
TEST_CASE(AGV_MSG_STEERING_COMMAND, 13)
void test_ten_gaps_under_half_a_cycle_are_too_fast(unsigned command, uint32_t half_ms) {
    for (unsigned i = 0; i < 9; i++) {
        agv_status_checks_rate(&checks, &faults, &timers, &config, command, half_ms - 1);
    }
    agv_status_checks_rate(&checks, &faults, &timers, &config, command, half_ms);
    for (unsigned i = 0; i < 9; i++) {
        agv_status_checks_rate(&checks, &faults, &timers, &config, command, 0);
    }
    expect_only(NONE);
    agv_status_checks_rate(&checks, &faults, &timers, &config, command, half_ms - 1);
    expect_only(AGV_FAULT_COMMAND_TOO_FAST);
}

/* Each command has its own count. */
/* Shows: SUP-6 */
void test_gaps_of_two_commands_are_not_added_up(void) {
    for (unsigned i = 0; i < 9; i++) {
        agv_status_checks_rate(&checks, &faults, &timers, &config, AGV_MSG_GEAR_COMMAND, 1);
        agv_status_checks_rate(&checks, &faults, &timers, &config, AGV_MSG_STEERING_COMMAND, 1);
    }
    expect_only(NONE);
}

/* What counts only while engaged; the bits of 167h and the other alarms stay. */
/* Shows: SUP-5 */
void test_a_disengagement_ends_what_only_counts_while_engaged(void) {
    vcu(0, 0);
    vcu(0x88, 0);
    for (unsigned i = 0; i < 5; i++) {
        eps(0, 0x80);
        value(AGV_MSG_GEAR_STATUS, false);
        value(AGV_MSG_THROTTLE_STATUS, false);
        value(AGV_MSG_STEERING_STATUS, false);
    }
    agv_status_checks_disengage(&checks, &faults);
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        const bool stays = i == AGV_FAULT_S_DRIVER_ALARM || i == AGV_FAULT_EPS_POSITION_ENCODER;
        TEST_ASSERT_EQUAL(stays, agv_fault_monitor_is_active(&faults, i));
    }
    agv_fault_monitor_set(&faults, AGV_FAULT_S_DRIVER_ALARM, false);
    for (unsigned i = 0; i < 4; i++) { /* engaged anew, they count from the beginning */
        eps(0, 0);
        expect_only(NONE);
    }
    eps(0, 0);
    expect_only(AGV_FAULT_EPS_MODE_NOT_ANGLE);
}

/* Faults in the content of status frames: bits, alarms, modes, values; their scores. */
#include "observe/status_checks.h"

#include "unity.h"

enum { NONE = AGV_FAULT_NONE };

static agv_status_checks_t checks;
static agv_fault_monitor_t faults;
static agv_config_t config;
static bool engaged;
static bool judged;
static bool ai_alive;

void setUp(void) {
    agv_config_defaults(&config);
    checks = (agv_status_checks_t){0};
    faults = (agv_fault_monitor_t){0};
    engaged = true;
    judged = true;
    ai_alive = true;
}

static void evaluate(void) {
    agv_status_checks_evaluate(&checks, &faults, engaged, judged);
}

/* Exactly this fault is active. */
static void expect_only(unsigned fault) {
    evaluate();
    for (unsigned i = 0; i < AGV_FAULT_COUNT; i++) {
        TEST_ASSERT_EQUAL(i == fault, agv_fault_monitor_is_active(&faults, i));
    }
}

/* 167h: mode in byte 4, fault bits in byte 8. */
static void eps(unsigned mode, unsigned bits) {
    const uint8_t data[8] = {0xFF, 0xFF, 0xFF, (uint8_t)mode, 0xFF, 0xFF, 0xFF, (uint8_t)bits};
    agv_status_checks_eps(&checks, &faults, &config, data, mode <= 3 || mode == 0xFF, judged);
}

static void expect_only_after_eps(unsigned mode, unsigned bits, unsigned fault) {
    eps(mode, bits);
    expect_only(fault);
}

static void eps_frames(unsigned count, unsigned mode, unsigned bits) {
    for (unsigned i = 0; i < count; i++) {
        eps(mode, bits);
    }
}

/* 363h: alarms in byte 5, level 2 in byte 6. */
static void vcu(unsigned alarms, unsigned level_2) {
    const uint8_t data[8] = {0xFF, 0xFF, 0xFF, 0xFF, (uint8_t)alarms, (uint8_t)level_2, 0xFF, 0xFF};
    agv_status_checks_vehicle(&checks, &faults, data, ai_alive);
}

static void expect_only_after_vcu(unsigned alarms, unsigned level_2, unsigned fault) {
    vcu(alarms, level_2);
    expect_only(fault);
}

static void value(unsigned message, bool valid) {
    agv_status_checks_value(&checks, &config, message, valid, judged);
}

/* ---- 167h ---- */

/* Under voltage, over voltage, excessive current: N = 3, so that six good ones end it. */
/* Shows: SUP-4 */
void test_bits_of_the_supply_are_scored_and_the_others_count_at_once(void) {
    static const unsigned fault_of[8] = {AGV_FAULT_EPS_UNDER_VOLTAGE,     AGV_FAULT_EPS_OVER_VOLTAGE,
                                         AGV_FAULT_EPS_EXCESSIVE_CURRENT, AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN,
                                         AGV_FAULT_EPS_TEMP_ABOVE_110,    AGV_FAULT_EPS_TEMP_ABOVE_120,
                                         AGV_FAULT_EPS_MOTOR_ENCODER,     AGV_FAULT_EPS_POSITION_ENCODER};
    for (unsigned bit = 0; bit < 8; bit++) {
        setUp();
        expect_only_after_eps(1, 1u << bit, bit < 3 ? (unsigned)NONE : fault_of[bit]);
        expect_only_after_eps(1, 1u << bit, bit < 3 ? (unsigned)NONE : fault_of[bit]);
        expect_only_after_eps(1, 1u << bit, fault_of[bit]);
        eps_frames(5, 1, 0);
        expect_only(bit < 3 ? fault_of[bit] : (unsigned)NONE);
        expect_only_after_eps(1, 0, NONE);
    }
}

/* Bits of the supply that flicker: 2 1 3 2 4 3 5 4 6. */
/* Shows: SUP-4 */
void test_every_second_frame_bad_is_a_fault(void) {
    for (unsigned i = 0; i < 8; i++) {
        expect_only_after_eps(1, (i % 2 == 0) ? 2 : 0, NONE);
    }
    expect_only_after_eps(1, 2, AGV_FAULT_EPS_OVER_VOLTAGE);
}

/* The bits of a frame have separate scores. */
/* Shows: SUP-4 */
void test_two_bits_are_not_added_up(void) {
    for (unsigned i = 0; i < 100; i++) {
        eps(1, 1);
        eps(1, 0);
        eps(1, 2);
        expect_only_after_eps(1, 0, NONE);
    }
}

/* Shows: SUP-4 */
void test_the_number_of_supply_frames_is_a_setting(void) {
    config.eps_supply_fault_frames = 1;
    expect_only_after_eps(1, 2, AGV_FAULT_EPS_OVER_VOLTAGE);
    expect_only_after_eps(1, 0, NONE);
}

/* The bits count always, judged or not. */
/* Shows: SUP-4 */
void test_fault_bits_count_always(void) {
    engaged = false;
    judged = false;
    eps_frames(3, 0xFF, 0x84);
    evaluate();
    TEST_ASSERT_TRUE(agv_fault_monitor_is_active(&faults, AGV_FAULT_EPS_EXCESSIVE_CURRENT));
    TEST_ASSERT_TRUE(agv_fault_monitor_is_active(&faults, AGV_FAULT_EPS_POSITION_ENCODER));
    TEST_ASSERT_FALSE(agv_fault_monitor_is_active(&faults, AGV_FAULT_EPS_MODE_OFF));
}

/* FFh is off; 0, 2 and 3 are other modes; all other values are invalid. N = 5. */
/* Shows: SUP-5 */
TEST_CASE(0xFF, AGV_FAULT_EPS_MODE_OFF)
TEST_CASE(4, AGV_FAULT_EPS_MODE_INVALID)
TEST_CASE(0xFE, AGV_FAULT_EPS_MODE_INVALID)
TEST_CASE(0, AGV_FAULT_EPS_MODE_NOT_ANGLE)
TEST_CASE(2, AGV_FAULT_EPS_MODE_NOT_ANGLE)
TEST_CASE(3, AGV_FAULT_EPS_MODE_NOT_ANGLE)
void test_a_mode_that_is_not_angle_control_counts_five_frames(unsigned mode, unsigned fault) {
    eps_frames(4, mode, 0);
    expect_only(NONE);
    expect_only_after_eps(mode, 0, fault);
    eps_frames(9, 1, 0);
    expect_only(fault); /* keeps its name */
    expect_only_after_eps(1, 0, NONE);
}

/* All wrong modes add to one score. */
/* Shows: SUP-5 */
void test_the_mode_is_named_after_the_last_bad_frame(void) {
    eps(0, 0);
    eps(2, 0);
    eps(0xFF, 0);
    eps(7, 0);
    expect_only_after_eps(3, 0, AGV_FAULT_EPS_MODE_NOT_ANGLE);
    expect_only_after_eps(0xFF, 0, AGV_FAULT_EPS_MODE_OFF);
    expect_only_after_eps(1, 0, AGV_FAULT_EPS_MODE_OFF);
    expect_only_after_eps(0x80, 0, AGV_FAULT_EPS_MODE_INVALID);
}

/* The score is paused, and the fault ends when it is not judged any more. */
/* Shows: SUP-5 */
void test_while_not_judged_no_mode_counts(void) {
    eps_frames(4, 0xFF, 0);
    judged = false;
    eps_frames(10, 0xFF, 0);
    eps_frames(20, 1, 0);
    expect_only(NONE);
    judged = true;
    expect_only(NONE);
    expect_only_after_eps(0xFF, 0, AGV_FAULT_EPS_MODE_OFF);
    judged = false;
    expect_only(NONE);
    judged = true;
    expect_only(AGV_FAULT_EPS_MODE_OFF);
}

/* ---- 363h ---- */

/* Bits 2 and 6 mean nothing; bit 3 has a test of its own. */
/* Shows: SUP-4 */
void test_an_alarm_counts_at_once(void) {
    static const unsigned fault_of[8] = {
        AGV_FAULT_REMOTE_SIGNAL_LOST,     AGV_FAULT_REMOTE_POWER_LOST,     NONE, NONE,
        AGV_FAULT_VCU_EPS_HARDWARE_FAULT, AGV_FAULT_VCU_EPS_CAN_BUS_FAULT, NONE, AGV_FAULT_S_DRIVER_ALARM};
    for (unsigned bit = 0; bit < 8; bit++) {
        setUp();
        expect_only_after_vcu(1u << bit, 0, fault_of[bit]);
        expect_only_after_vcu(0, 0, NONE);
    }
}

/* Shows: SUP-4, VCU_LEVEL2_ALARM */
void test_any_level_2_alarm(void) {
    for (unsigned bit = 0; bit < 8; bit++) {
        expect_only_after_vcu(0, 1u << bit, AGV_FAULT_VCU_LEVEL2_ALARM);
    }
    expect_only_after_vcu(0, 0, NONE);
}

/* Once armed the alarm stays armed: a reset forgets only that the AI was alive. */
/* Shows: SUP-8, FSM-11, VCU_AI_CAN_LOST */
void test_the_alarm_of_the_ai_computer_counts_once_it_was_clear_with_the_ai_alive(void) {
    expect_only_after_vcu(0x08, 0, NONE); /* never clear */
    ai_alive = false;
    vcu(0, 0);
    expect_only_after_vcu(0x08, 0, NONE); /* clear without the AI */
    ai_alive = true;
    vcu(0x04, 0); /* another bit leaves it clear */
    ai_alive = false;
    expect_only_after_vcu(0x08, 0, AGV_FAULT_VCU_AI_CAN_LOST);
    engaged = false;
    expect_only(NONE);
    engaged = true;
    judged = false; /* engaged is enough */
    expect_only(AGV_FAULT_VCU_AI_CAN_LOST);
    agv_status_checks_engage(&checks);
    expect_only(AGV_FAULT_VCU_AI_CAN_LOST);
    expect_only_after_vcu(0, 0, NONE);
}

/* ---- Values ---- */

/* Shows: SUP-5 */
TEST_CASE(AGV_MSG_GEAR_STATUS, AGV_FAULT_GEAR_STATUS_INVALID)
TEST_CASE(AGV_MSG_THROTTLE_STATUS, AGV_FAULT_THROTTLE_STATUS_INVALID)
TEST_CASE(AGV_MSG_STEERING_STATUS, AGV_FAULT_STEERING_ANGLE_INVALID)
void test_a_value_that_is_invalid_counts_three_frames(unsigned message, unsigned fault) {
    value(message, false);
    value(message, false);
    expect_only(NONE);
    value(message, true);
    expect_only(NONE);
    value(message, false); /* 5 */
    expect_only(NONE);
    value(message, false);
    expect_only(fault);
    judged = false; /* not counted now, and the score is paused */
    expect_only(NONE);
    for (unsigned i = 0; i < 10; i++) {
        value(message, true);
    }
    judged = true;
    expect_only(fault);
    for (unsigned i = 0; i < 6; i++) {
        expect_only(fault);
        value(message, true);
    }
    expect_only(NONE);
}

/* Shows: SUP-5 */
void test_the_values_are_scored_apart(void) {
    for (unsigned i = 0; i < 2; i++) {
        value(AGV_MSG_GEAR_STATUS, false);
        value(AGV_MSG_THROTTLE_STATUS, false);
        value(AGV_MSG_STEERING_STATUS, false);
    }
    expect_only(NONE);
}

/* For the hold the score of the angle always counts, and no engagement clears it. */
/* Shows: FSM-10, STEERING_ANGLE_INVALID */
void test_the_angle_is_usable_until_three_invalid_ones(void) {
    judged = false;
    value(AGV_MSG_GEAR_STATUS, false);
    value(AGV_MSG_THROTTLE_STATUS, false);
    value(AGV_MSG_STEERING_STATUS, false);
    value(AGV_MSG_STEERING_STATUS, false);
    TEST_ASSERT_TRUE(agv_status_checks_angle_is_usable(&checks));
    value(AGV_MSG_STEERING_STATUS, false);
    TEST_ASSERT_FALSE(agv_status_checks_angle_is_usable(&checks));
    expect_only(NONE);
    agv_status_checks_engage(&checks);
    TEST_ASSERT_FALSE(agv_status_checks_angle_is_usable(&checks));
    for (unsigned i = 0; i < 6; i++) {
        TEST_ASSERT_FALSE(agv_status_checks_angle_is_usable(&checks));
        value(AGV_MSG_STEERING_STATUS, true);
    }
    TEST_ASSERT_TRUE(agv_status_checks_angle_is_usable(&checks));
}

/* ---- One engagement ---- */

/* An engagement clears the scores that are judged, but not those of the bits of 167h. */
/* Shows: SUP-5 */
void test_an_engagement_begins_what_is_judged_anew(void) {
    eps_frames(5, 0, 0);
    eps_frames(2, 0, 1);
    for (unsigned message = AGV_MSG_GEAR_STATUS; message <= AGV_MSG_STEERING_STATUS; message++) {
        value(message, false);
        value(message, false);
        value(message, false);
    }
    agv_status_checks_engage(&checks);
    expect_only(NONE);
    value(AGV_MSG_GEAR_STATUS, false);
    value(AGV_MSG_GEAR_STATUS, false);
    eps_frames(4, 1, 1);
    expect_only(AGV_FAULT_EPS_UNDER_VOLTAGE);
}

/* The score starts at exactly 0: a good frame among the bad ones delays the fault. */
/* Shows: SUP-5 */
void test_an_engagement_begins_each_score_at_0(void) {
    config.eps_mode_frames = 3;
    agv_status_checks_engage(&checks);
    for (unsigned message = AGV_MSG_GEAR_STATUS; message <= AGV_MSG_THROTTLE_STATUS; message++) {
        value(message, false);
        value(message, true);
        value(message, false);
        value(message, false); /* 2, 1, 3, 5 of 6 */
        expect_only(NONE);
    }
    eps(0, 0);
    eps(1, 0);
    eps_frames(2, 0, 0);
    expect_only(NONE);
}

/* A fault that a stored latch has set stays until one of these checks finds something. */
/* Shows: FSM-7 */
void test_without_a_finding_no_fault_is_touched(void) {
    agv_fault_monitor_set(&faults, AGV_FAULT_GEAR_STATUS_INVALID, true);
    expect_only(AGV_FAULT_GEAR_STATUS_INVALID);
}

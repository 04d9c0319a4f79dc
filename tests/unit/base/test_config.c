/* The configuration: defaults, refused values and their reasons, checksum. */
#include "agv/config.h"

#include <string.h>

#include "agv/names.h"
#include "unity.h"

static agv_config_t config;

void setUp(void) {
    agv_config_defaults(&config);
}

static void expect_problem(agv_config_problem_t problem, uint16_t setting) {
    const agv_config_verdict_t verdict = agv_config_check(&config);
    TEST_ASSERT_EQUAL(problem, verdict.problem);
    TEST_ASSERT_EQUAL_UINT16(setting, verdict.setting);
}

static void expect_good(void) {
    expect_problem(AGV_CONFIG_OK, AGV_SETTING_COUNT);
}

/* By hand from the rows SUP-2 to SUP-12, FSM-1 to FSM-12, TOP-1 to TOP-3, TIM-4, and the words. */
/* Shows: SUP-2, SUP-3, INT-2 */
void test_the_defaults_are_those_of_the_requirements(void) {
    expect_good();
    TEST_ASSERT_EQUAL_UINT16(50, config.vcu_heartbeat_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(50, config.eps_heartbeat_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(350, config.ai_heartbeat_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(350, config.gear_command_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(350, config.throttle_command_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(125, config.steering_command_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(125, config.gear_status_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(60, config.throttle_status_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(60, config.eps_status_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(60, config.steering_position_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(60, config.wheel_speed_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(500, config.steering_deviation_ddeg);
    TEST_ASSERT_EQUAL_UINT16(100, config.tx_stalled_ms);
    TEST_ASSERT_EQUAL_UINT16(500, config.ai_never_seen_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(3000, config.park_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(500, config.confirm_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(1000, config.reset_hold_ms);
    TEST_ASSERT_EQUAL_UINT16(5, config.override_gap_ms);
    TEST_ASSERT_EQUAL_UINT16(100, config.watchdog_period_ms);
    TEST_ASSERT_EQUAL_UINT16(AGV_TOPOLOGY_SHARED, config.topology);
    TEST_ASSERT_EQUAL_UINT16(AGV_PARK_AT_ONCE, config.park);
    TEST_ASSERT_EQUAL_UINT16(0x7F0, config.status_frame_id);
    TEST_ASSERT_EQUAL_UINT16(100, config.status_frame_period_ms);
}

/* Shows: SUP-4, SUP-5, SUP-6, SUP-9, SUP-10, SUP-11, SUP-12 */
void test_the_defaults_of_engagements_scores_and_budgets(void) {
    TEST_ASSERT_EQUAL_UINT16(500, config.engaged_grace_ms);
    TEST_ASSERT_EQUAL_UINT16(3, config.mode_frames);
    TEST_ASSERT_EQUAL_UINT16(100, config.reengage_ms);
    TEST_ASSERT_EQUAL_UINT16(5000, config.mode_flapping_ms);
    TEST_ASSERT_EQUAL_UINT16(500, config.mode_none_ms);
    TEST_ASSERT_EQUAL_UINT16(3, config.eps_supply_fault_frames);
    TEST_ASSERT_EQUAL_UINT16(5, config.eps_mode_frames);
    TEST_ASSERT_EQUAL_UINT16(3, config.status_invalid_frames);
    TEST_ASSERT_EQUAL_UINT16(10, config.command_too_fast_gaps);
    TEST_ASSERT_EQUAL_UINT16(500, config.steering_deviation_ms);
    TEST_ASSERT_EQUAL_UINT16(250, config.steering_gain_ddeg);
    TEST_ASSERT_EQUAL_UINT16(25, config.throttle_deviation_counts);
    TEST_ASSERT_EQUAL_UINT16(500, config.throttle_deviation_ms);
    TEST_ASSERT_EQUAL_UINT16(1000, config.gear_deviation_ms);
    TEST_ASSERT_EQUAL_UINT16(1000, config.autopilot_off_ms);
    TEST_ASSERT_EQUAL_UINT16(200, config.throttle_in_park_ms);
    TEST_ASSERT_EQUAL_UINT16(2, config.throttle_idle_counts);
    TEST_ASSERT_EQUAL_UINT16(1000, config.speed_implausible_ms);
}

/* Shows: FSM-3, FSM-4, FSM-7, FSM-10, FSM-12, SUP-2, TOP-2 */
void test_the_defaults_of_the_safe_state_and_the_envelope(void) {
    TEST_ASSERT_EQUAL_UINT16(500, config.park_confirm_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(5000, config.confirmed_ms);
    TEST_ASSERT_EQUAL_UINT16(5000, config.stop_timeout_ms);
    TEST_ASSERT_EQUAL_UINT16(50, config.hold_age_ms);
    TEST_ASSERT_EQUAL_UINT16(5000, config.hold_standstill_ms);
    TEST_ASSERT_EQUAL_UINT16(5000, config.reset_hold_max_ms);
    TEST_ASSERT_EQUAL_UINT16(180, config.standstill_vcu_counts);
    TEST_ASSERT_EQUAL_UINT16(50, config.standstill_speed_mm_s);
    TEST_ASSERT_EQUAL_UINT16(100, config.standstill_ms);
    TEST_ASSERT_EQUAL_UINT16(AGV_COUNTER_ANY, config.vcu_counter);
    TEST_ASSERT_EQUAL_UINT16(AGV_AFTER_POWER_ON_INIT, config.after_power_on);
    TEST_ASSERT_EQUAL_UINT16(AGV_GEAR_CHANGE_AT_STANDSTILL, config.gear_change);
    TEST_ASSERT_EQUAL_UINT16(100, config.throttle_ceiling_pct);
    TEST_ASSERT_EQUAL_UINT16(0, config.throttle_rise_pct_s);
    TEST_ASSERT_EQUAL_UINT16(0, config.steering_slew_ddeg_s);
    TEST_ASSERT_EQUAL_UINT16(0, config.steering_fast_max_ddeg);
}

/* Three cycles of 10, 25 or 100 ms; both limits by hand. */
/* Shows: INT-2 */
void test_a_deadline_under_three_cycles_is_refused(void) {
    static const struct {
        uint16_t setting;
        uint16_t three_cycles_ms;
        uint16_t highest_ms;
    } deadlines[] = {
        {AGV_SETTING_vcu_heartbeat_timeout_ms, 30, 500},      {AGV_SETTING_eps_heartbeat_timeout_ms, 30, 500},
        {AGV_SETTING_ai_heartbeat_timeout_ms, 300, 2000},     {AGV_SETTING_gear_command_timeout_ms, 300, 2000},
        {AGV_SETTING_throttle_command_timeout_ms, 300, 2000}, {AGV_SETTING_steering_command_timeout_ms, 75, 1000},
        {AGV_SETTING_gear_status_timeout_ms, 75, 1000},       {AGV_SETTING_throttle_status_timeout_ms, 30, 500},
        {AGV_SETTING_eps_status_timeout_ms, 30, 500},         {AGV_SETTING_steering_position_timeout_ms, 30, 500},
        {AGV_SETTING_wheel_speed_timeout_ms, 30, 500},
    };
    for (size_t i = 0; i < sizeof deadlines / sizeof deadlines[0]; i++) {
        setUp();
        TEST_ASSERT_TRUE(agv_config_set(&config, deadlines[i].setting, deadlines[i].three_cycles_ms));
        expect_good();
        TEST_ASSERT_TRUE(agv_config_set(&config, deadlines[i].setting, (uint16_t)(deadlines[i].three_cycles_ms - 1)));
        expect_problem(AGV_CONFIG_OUT_OF_RANGE, deadlines[i].setting);
        TEST_ASSERT_TRUE(agv_config_set(&config, deadlines[i].setting, deadlines[i].highest_ms));
        expect_good();
        TEST_ASSERT_TRUE(agv_config_set(&config, deadlines[i].setting, (uint16_t)(deadlines[i].highest_ms + 1)));
        expect_problem(AGV_CONFIG_OUT_OF_RANGE, deadlines[i].setting);
    }
}

/* The documented limits are accepted, values beyond them are refused. All are tried in the gateway, because some need
 * it. For the limits of a press the other limit is moved out of the way. */
/* Shows: INT-2 */
void test_every_setting_is_held_to_its_range(void) {
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *info = agv_setting_info(i);
        setUp();
        config.topology = AGV_TOPOLOGY_GATEWAY;
        config.reset_hold_ms = 500;
        config.reset_hold_max_ms = 30000;
        (void)agv_config_set(&config, i, info->lowest);
        expect_good();
        (void)agv_config_set(&config, i, info->highest);
        expect_good();
        if (info->highest < UINT16_MAX) {
            (void)agv_config_set(&config, i, (uint16_t)(info->highest + 1));
            expect_problem(AGV_CONFIG_OUT_OF_RANGE, i);
        }
        if (info->lowest > 0) {
            (void)agv_config_set(&config, i, (uint16_t)(info->lowest - 1));
            expect_problem(AGV_CONFIG_OUT_OF_RANGE, i);
        }
    }
}

/* Shows: INT-2 */
void test_a_period_count_or_time_of_zero_is_refused(void) {
    static const uint16_t never_zero[] = {
        AGV_SETTING_status_frame_period_ms, AGV_SETTING_watchdog_period_ms,    AGV_SETTING_eps_supply_fault_frames,
        AGV_SETTING_eps_mode_frames,        AGV_SETTING_status_invalid_frames, AGV_SETTING_command_too_fast_gaps,
        AGV_SETTING_reset_hold_ms,          AGV_SETTING_confirm_timeout_ms,    AGV_SETTING_park_timeout_ms,
        AGV_SETTING_init_hold_ms,           AGV_SETTING_standstill_speed_mm_s, AGV_SETTING_standstill_ms,
        AGV_SETTING_tx_stalled_ms,          AGV_SETTING_bus_off_recovery_ms,   AGV_SETTING_override_gap_ms,
        AGV_SETTING_event_hold_ms};
    for (size_t i = 0; i < sizeof never_zero / sizeof never_zero[0]; i++) {
        setUp();
        (void)agv_config_set(&config, never_zero[i], 0);
        expect_problem(AGV_CONFIG_OUT_OF_RANGE, never_zero[i]);
    }
}

/* Shows: INT-2 */
void test_a_choice_beyond_its_words_is_refused(void) {
    for (uint16_t i = AGV_SETTING_topology; i <= AGV_SETTING_gear_change; i++) {
        setUp();
        (void)agv_config_set(&config, i, 2);
        expect_problem(AGV_CONFIG_OUT_OF_RANGE, i);
    }
}

/* Of the 2048 identifiers the 13 of the two sets are taken. */
/* Shows: INT-2, TOP-3 */
void test_the_status_frame_may_not_have_an_identifier_of_the_protocol(void) {
    static const uint16_t taken[] = {0x43F, 0x201, 0x363, 0x203, 0x168, 0x075, 0x065,
                                     0x0A3, 0x050, 0x067, 0x167, 0x267, 0x101};
    for (uint16_t id = 0; id <= 0x7FF; id++) {
        bool is_taken = false;
        for (size_t i = 0; i < sizeof taken / sizeof taken[0]; i++) {
            is_taken = is_taken || taken[i] == id;
        }
        config.status_frame_id = id;
        config.id_set = AGV_ID_SET_TABLE;
        TEST_ASSERT_EQUAL(is_taken ? AGV_CONFIG_ID_TWICE : AGV_CONFIG_OK, agv_config_check(&config).problem);
        config.id_set = AGV_ID_SET_HEADING;
        TEST_ASSERT_EQUAL(is_taken ? AGV_CONFIG_ID_TWICE : AGV_CONFIG_OK, agv_config_check(&config).problem);
    }
    config.status_frame_id = 0x201;
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_status_frame_id);
    config.status_frame_id = 0x800; /* no 11-bit identifier */
    expect_problem(AGV_CONFIG_OUT_OF_RANGE, AGV_SETTING_status_frame_id);
}

/* By hand: an identifier follows the ID set unless it was changed. */
/* Shows: P1 */
void test_the_set_is_the_preset_of_the_identifiers(void) {
    static const uint16_t heading[] = {0x43F, 0x168, 0x075, 0x065, 0x363, 0x0A3, 0x050, 0x067, 0x167, 0x267, 0x101};
    static const uint16_t table[] = {0x201, 0x168, 0x075, 0x065, 0x203, 0x0A3, 0x050, 0x067, 0x167, 0x267, 0x101};
    agv_ids_t ids;
    agv_config_ids(&config, &ids);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(heading, ids.of, AGV_MSG_COUNT);
    config.id_set = AGV_ID_SET_TABLE;
    agv_config_ids(&config, &ids);
    TEST_ASSERT_EQUAL_HEX16_ARRAY(table, ids.of, AGV_MSG_COUNT);
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        agv_config_defaults(&config);
        config.id_set = AGV_ID_SET_TABLE;
        TEST_ASSERT_EQUAL_HEX16(heading[i], agv_config_get(&config, AGV_SETTING_ID + i));
        TEST_ASSERT_TRUE(agv_config_set(&config, AGV_SETTING_ID + i, 0x7FF));
        agv_config_ids(&config, &ids);
        expect_good();
        for (unsigned k = 0; k < AGV_MSG_COUNT; k++) {
            TEST_ASSERT_EQUAL_HEX16((k == i) ? 0x7FF : table[k], ids.of[k]);
        }
    }
}

/* Two messages must not have the same identifier; the error names the second one. */
/* Shows: INT-2, P1 */
void test_an_identifier_twice_is_refused(void) {
    for (uint16_t first = 0; first < AGV_MSG_COUNT; first++) {
        for (uint16_t second = (uint16_t)(first + 1); second < AGV_MSG_COUNT; second++) {
            setUp();
            (void)agv_config_set(&config, AGV_SETTING_ID + first, 0x300);
            (void)agv_config_set(&config, AGV_SETTING_ID + second, 0x300);
            expect_problem(AGV_CONFIG_ID_TWICE, (uint16_t)(AGV_SETTING_ID + second));
        }
    }
}

/* 201h is free in the set `heading` and used in `table`. Two swapped identifiers are no conflict. */
/* Shows: INT-2, P1 */
void test_which_identifiers_are_taken_depends_on_the_set(void) {
    config.id_gear_command = 0x201;
    expect_good();
    config.id_set = AGV_ID_SET_TABLE;
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_id_gear_command);
    setUp();
    config.id_gear_command = 0x075;
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_id_throttle_command);
    config.id_throttle_command = 0x168;
    expect_good();
}

/* Shows: INT-2, TOP-3 */
void test_the_status_frame_may_not_have_an_identifier_that_was_changed(void) {
    config.id_eps_status = 0x300;
    config.status_frame_id = 0x300;
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_status_frame_id);
    config.status_frame_id = 0x167; /* free on this vehicle, but part of the protocol */
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_status_frame_id);
    config.status_frame_id = 0x301;
    expect_good();
}

/* By hand: settings without effect on a shared bus are refused there, all others are accepted. */
/* Shows: FSM-8, TOP-2, INT-2 */
void test_settings_without_effect_on_a_shared_bus_are_refused(void) {
    static const uint16_t gateway_only[] = {AGV_SETTING_own_heartbeat,
                                            AGV_SETTING_gateway_in_manual,
                                            AGV_SETTING_gear_change,
                                            AGV_SETTING_throttle_ceiling_pct,
                                            AGV_SETTING_throttle_rise_pct_s,
                                            AGV_SETTING_steering_slew_ddeg_s,
                                            AGV_SETTING_steering_fast_max_ddeg,
                                            AGV_SETTING_fast_mm_s};
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        const agv_setting_info_t *const info = agv_setting_info(i);
        bool needs_gateway = false;
        for (unsigned k = 0; k < sizeof gateway_only / sizeof gateway_only[0]; k++) {
            needs_gateway = needs_gateway || gateway_only[k] == i;
        }
        setUp();
        (void)agv_config_set(&config, i, (info->preset == info->highest) ? info->lowest : info->highest);
        config.reset_hold_ms = 500;
        config.reset_hold_max_ms = 30000;
        TEST_ASSERT_EQUAL(needs_gateway, info->gateway_only);
        if (needs_gateway) {
            expect_problem(AGV_CONFIG_NEEDS_GATEWAY, i);
            config.topology = AGV_TOPOLOGY_GATEWAY;
        }
        expect_good();
    }
}

/* The error names the first of several settings. */
/* Shows: INT-2 */
void test_the_first_setting_without_effect_is_named(void) {
    config.fast_mm_s = 1;
    config.throttle_ceiling_pct = 50;
    expect_problem(AGV_CONFIG_NEEDS_GATEWAY, AGV_SETTING_throttle_ceiling_pct);
    config.throttle_ceiling_pct = 101; /* out of range is the more specific problem */
    expect_problem(AGV_CONFIG_OUT_OF_RANGE, AGV_SETTING_throttle_ceiling_pct);
}

/* No press could be long enough without being too long. */
/* Shows: FSM-3, INT-2 */
TEST_CASE(1000, 1000, 0)
TEST_CASE(5001, 5000, 0)
TEST_CASE(10000, 1000, 0)
TEST_CASE(1000, 1001, 1)
TEST_CASE(10000, 10001, 1)
void test_a_press_that_is_too_short_is_refused(unsigned hold_ms, unsigned most_ms, int good) {
    config.reset_hold_ms = (uint16_t)hold_ms;
    config.reset_hold_max_ms = (uint16_t)most_ms;
    if (good) {
        expect_good();
    } else {
        expect_problem(AGV_CONFIG_PRESS_TOO_SHORT, AGV_SETTING_reset_hold_max_ms);
    }
}

/* The status frame is on by default: its identifier is taken. */
/* Shows: INT-2, TOP-3 */
void test_a_message_may_not_have_the_identifier_of_the_status_frame(void) {
    config.id_eps_status = 0x7F0;
    expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_status_frame_id);
    config.status_frame_id = 0;
    expect_good();
}

/* ---- Values that weaken the supervision ---- */

/* By hand, one or more of each kind: a value below, the default, a value above. */
static const struct {
    uint16_t setting;
    uint16_t lower;
    uint16_t higher;
    bool lower_weakens;
    bool higher_weakens;
} WEAKENING[] = {
    {AGV_SETTING_vcu_heartbeat_timeout_ms, 49, 51, false, true},
    {AGV_SETTING_steering_deviation_ddeg, 499, 501, false, true},
    {AGV_SETTING_steering_gain_ddeg, 249, 251, true, false},
    {AGV_SETTING_throttle_deviation_counts, 24, 26, false, true},
    {AGV_SETTING_mode_flapping_ms, 4999, 5001, true, false},
    {AGV_SETTING_mode_frames, 2, 4, true, false},
    {AGV_SETTING_reengage_ms, 99, 101, true, false},
    {AGV_SETTING_init_hold_ms, 499, 501, true, false},
    {AGV_SETTING_standstill_ms, 99, 101, true, false},
    {AGV_SETTING_standstill_vcu_counts, 179, 65535, false, true},
    {AGV_SETTING_reset_hold_ms, 999, 1001, true, false},
    {AGV_SETTING_reset_hold_max_ms, 4999, 5001, false, true},
    {AGV_SETTING_confirm_timeout_ms, 499, 501, false, true},
    {AGV_SETTING_hold_age_ms, 49, 51, false, true},
    {AGV_SETTING_confirmed_ms, 4999, 5001, true, false},
    {AGV_SETTING_stop_timeout_ms, 4999, 5001, false, true},
    {AGV_SETTING_hold_standstill_ms, 4999, 5001, true, false},
    {AGV_SETTING_status_frame_id, 0, 0x7F1, true, false},
    {AGV_SETTING_status_frame_id, 1, 0x7FF, false, false},
    {AGV_SETTING_throttle_ceiling_pct, 0, 100, false, false},
    {AGV_SETTING_topology, 0, 1, false, false},
    {AGV_SETTING_shadow, 0, 1, false, true},
    {AGV_SETTING_park, 0, 1, false, true},
    {AGV_SETTING_ai_lost_in_manual, 0, 1, false, false},
    {AGV_SETTING_gateway_in_manual, 0, 1, false, true},
    {AGV_SETTING_gear_change, 0, 1, false, true},
    {AGV_SETTING_vcu_counter, 0, 1, false, false},
    {AGV_SETTING_after_power_on, 0, 1, false, false},
    {AGV_SETTING_id_gear_command, 1, 0x7FF, false, false},
};

/* Shows: INT-2 */
void test_which_values_weaken_the_supervision(void) {
    for (unsigned i = 0; i < sizeof WEAKENING / sizeof WEAKENING[0]; i++) {
        setUp();
        (void)agv_config_set(&config, WEAKENING[i].setting, WEAKENING[i].lower);
        TEST_ASSERT_EQUAL(WEAKENING[i].lower_weakens, agv_config_weakens(&config, WEAKENING[i].setting));
        (void)agv_config_set(&config, WEAKENING[i].setting, WEAKENING[i].higher);
        TEST_ASSERT_EQUAL(WEAKENING[i].higher_weakens, agv_config_weakens(&config, WEAKENING[i].setting));
    }
}

/* Shows: INT-2 */
void test_no_default_weakens_and_nothing_beyond_the_last_setting(void) {
    for (uint32_t i = 0; i < AGV_SETTING_COUNT; i++) {
        TEST_ASSERT_FALSE(agv_config_weakens(&config, i));
    }
    memset(&config, 0xFF, sizeof config);
    TEST_ASSERT_FALSE(agv_config_weakens(&config, AGV_SETTING_COUNT));
    TEST_ASSERT_FALSE(agv_config_weakens(&config, UINT32_MAX));
}

/* By hand. All others are trips for good: faults of the heartbeats of VCU and EPS, of the AI computer while engaged, of the EPS,
 * and of the supervisor. */
static bool may_be_a_warning(unsigned fault) {
    static const agv_fault_t may[] = {
        AGV_FAULT_EPS_TEMP_ABOVE_110,
        AGV_FAULT_S_DRIVER_ALARM,
        AGV_FAULT_REMOTE_SIGNAL_LOST,
        AGV_FAULT_REMOTE_POWER_LOST,
        AGV_FAULT_VCU_LEVEL2_ALARM,
        AGV_FAULT_GEAR_STATUS_TIMEOUT,
        AGV_FAULT_THROTTLE_STATUS_TIMEOUT,
        AGV_FAULT_WHEEL_SPEED_TIMEOUT,
        AGV_FAULT_STEERING_POSITION_TIMEOUT,
        AGV_FAULT_GEAR_STATUS_INVALID,
        AGV_FAULT_THROTTLE_STATUS_INVALID,
        AGV_FAULT_THROTTLE_DEVIATION,
        AGV_FAULT_GEAR_DEVIATION,
        AGV_FAULT_AUTOPILOT_OFF_IGNORED,
        AGV_FAULT_THROTTLE_IN_PARK,
        AGV_FAULT_COMMAND_TOO_FAST,
        AGV_FAULT_SPEED_IMPLAUSIBLE,
        AGV_FAULT_STATUS_ID_IN_USE,
        AGV_FAULT_STARTUP_TIMEOUT,
        AGV_FAULT_RX_OVERRUN,
        AGV_FAULT_ERROR_PASSIVE,
        AGV_FAULT_AI_BUS_OFF,
        AGV_FAULT_WRONG_ID_SET,
        AGV_FAULT_STORE_INVALID,
    };
    for (size_t i = 0; i < sizeof may / sizeof may[0]; i++) {
        if (may[i] == fault) {
            return true;
        }
    }
    return false;
}

/* Shows: INT-2 */
void test_which_faults_may_be_made_warnings(void) {
    for (unsigned fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        const bool may = may_be_a_warning(fault);
        const char *const name = agv_fault_name((agv_fault_t)fault);
        setUp();
        TEST_ASSERT_TRUE_MESSAGE(may || agv_config_is_trip(&config, fault), name);
        agv_fault_set_put(&config.trips, fault, false);
        TEST_ASSERT_FALSE_MESSAGE(agv_config_is_trip(&config, fault), name);
        const agv_config_verdict_t verdict = agv_config_check(&config);
        TEST_ASSERT_EQUAL_MESSAGE(may ? AGV_CONFIG_OK : AGV_CONFIG_CLASS_FIXED, verdict.problem, name);
        TEST_ASSERT_EQUAL_MESSAGE(may ? AGV_FAULT_NONE : fault, verdict.fault, name);
    }
    TEST_ASSERT_FALSE(agv_config_is_trip(&config, AGV_FAULT_NONE));
}

void test_the_highest_ranking_weak_fault_is_named(void) {
    config.trips = (agv_fault_set_t){0};
    TEST_ASSERT_EQUAL(AGV_FAULT_SELF_TEST_FAILED, agv_config_check(&config).fault);
}

/* A wrong setting is reported before a weak fault; the fault is named as well. */
void test_a_setting_is_reported_before_a_weak_fault(void) {
    config.trips = (agv_fault_set_t){0};
    config.mode_frames = 0;
    expect_problem(AGV_CONFIG_OUT_OF_RANGE, AGV_SETTING_mode_frames);
    TEST_ASSERT_EQUAL(AGV_FAULT_SELF_TEST_FAILED, agv_config_check(&config).fault);
}

/* Shows: INT-2 */
void test_every_fault_but_two_may_be_made_a_trip(void) {
    for (unsigned fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        if ((fault != AGV_FAULT_STARTUP_TIMEOUT) && (fault != AGV_FAULT_AI_BUS_OFF)) {
            agv_fault_set_put(&config.trips, fault, true);
            TEST_ASSERT_TRUE_MESSAGE(agv_config_is_trip(&config, fault), agv_fault_name((agv_fault_t)fault));
            expect_good();
        }
    }
}

/* As a trip it would keep INIT, which keeps the fault: a healthy vehicle could never be released. */
/* Shows: INT-2 */
void test_a_late_start_must_not_be_a_trip(void) {
    agv_fault_set_put(&config.trips, AGV_FAULT_STARTUP_TIMEOUT, true);
    expect_problem(AGV_CONFIG_CLASS_FIXED, AGV_SETTING_COUNT);
    TEST_ASSERT_EQUAL(AGV_FAULT_STARTUP_TIMEOUT, agv_config_check(&config).fault);
}

/* A shared bus has no AI side that could be bus-off. */
/* Shows: INT-2 */
void test_an_ai_side_that_is_bus_off_trips_on_a_gateway_only(void) {
    agv_fault_set_put(&config.trips, AGV_FAULT_AI_BUS_OFF, true);
    expect_problem(AGV_CONFIG_CLASS_FIXED, AGV_SETTING_COUNT);
    TEST_ASSERT_EQUAL(AGV_FAULT_AI_BUS_OFF, agv_config_check(&config).fault);
    config.topology = AGV_TOPOLOGY_GATEWAY;
    expect_good();
}

/* Shows: INT-2 */
void test_bits_beyond_the_faults_are_refused(void) {
    for (unsigned bit = AGV_FAULT_COUNT; bit < 32 * AGV_FAULT_WORDS; bit++) {
        setUp();
        config.trips.words[bit / 32] |= 1u << (bit % 32);
        expect_problem(AGV_CONFIG_NO_SUCH_FAULT, AGV_SETTING_COUNT);
    }
}

void test_there_is_no_setting_beyond_the_last(void) {
    agv_config_t before = config;
    TEST_ASSERT_FALSE(agv_config_set(&config, AGV_SETTING_COUNT, 1));
    TEST_ASSERT_EQUAL_UINT16(0, agv_config_get(&config, AGV_SETTING_COUNT));
    TEST_ASSERT_EQUAL_MEMORY(&before, &config, sizeof config);
    TEST_ASSERT_EQUAL_UINT16(50, agv_config_get(&config, AGV_SETTING_vcu_heartbeat_timeout_ms));
    memset(&config, 0xFF, sizeof config); /* and bits beyond the last fault */
    TEST_ASSERT_EQUAL_UINT16(0, agv_config_get(&config, AGV_SETTING_COUNT));
}

/* CRC-32 as zlib's, a bit at a time. */
static uint32_t crc_bytes(uint32_t crc, uint32_t value, unsigned bytes) {
    for (unsigned bit = 0; bit < 8 * bytes; bit++) {
        const uint32_t low = (crc ^ (value >> bit)) & 1;
        crc = (crc >> 1) ^ (low * 0xEDB88320u);
    }
    return crc;
}

/* Over the settings, two bytes each, and the classes, four bytes a word, the low byte first. */
/* Shows: TOP-3 */
void test_the_checksum_is_a_crc_32_of_the_settings_and_classes(void) {
    uint32_t crc = UINT32_MAX;
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        crc = crc_bytes(crc, agv_config_get(&config, i), 2);
    }
    for (unsigned i = 0; i < AGV_FAULT_WORDS; i++) {
        crc = crc_bytes(crc, config.trips.words[i], 4);
    }
    TEST_ASSERT_EQUAL_HEX32(~crc, agv_config_checksum(&config));
    TEST_ASSERT_EQUAL_HEX32(0xCBF43926u,
                            ~crc_bytes(crc_bytes(crc_bytes(UINT32_MAX, 0x34333231u, 4), 0x38373635u, 4), 0x39, 1));
}

/* Shows: INT-5 */
void test_every_flipped_bit_changes_the_checksum(void) {
    const uint32_t checksum = agv_config_checksum(&config);
    for (uint16_t i = 0; i < AGV_SETTING_COUNT; i++) {
        for (unsigned bit = 0; bit < 16; bit++) {
            const uint16_t value = agv_config_get(&config, i);
            (void)agv_config_set(&config, i, (uint16_t)(value ^ (1u << bit)));
            TEST_ASSERT_TRUE(agv_config_checksum(&config) != checksum);
            (void)agv_config_set(&config, i, value);
        }
    }
    for (unsigned bit = 0; bit < 32 * AGV_FAULT_WORDS; bit++) {
        config.trips.words[bit / 32] ^= 1u << (bit % 32);
        TEST_ASSERT_TRUE(agv_config_checksum(&config) != checksum);
        config.trips.words[bit / 32] ^= 1u << (bit % 32);
    }
    TEST_ASSERT_EQUAL_HEX32(checksum, agv_config_checksum(&config));
}

/* An invalid configuration is refused with its reason, and a supervisor that gets one trips. */
#include <string.h>

#include "expect.h"
#include "fixture.h"
#include "unity.h"
#include "walk.h"

static fixture_t f;
static agv_config_t config;

void setUp(void) {
    fixture_init(&f);
    agv_config_defaults(&config);
}

static void expect_problem(agv_config_problem_t problem, uint16_t setting, const char *what) {
    const agv_config_verdict_t verdict = agv_config_check(&config);
    TEST_ASSERT_EQUAL_INT_MESSAGE(problem, verdict.problem, what);
    TEST_ASSERT_EQUAL_UINT16_MESSAGE(setting, verdict.setting, what);
}

static void expect_too_weak(agv_fault_t fault) {
    const agv_config_verdict_t verdict = agv_config_check(&config);
    TEST_ASSERT_EQUAL_INT(AGV_CONFIG_FAULT_TOO_WEAK, verdict.problem);
    TEST_ASSERT_EQUAL_INT(fault, verdict.fault);
}

static void expect_good(const char *what) {
    TEST_ASSERT_EQUAL_INT_MESSAGE(AGV_CONFIG_OK, agv_config_check(&config).problem, what);
}

static void expect_bounds(uint16_t setting, uint16_t lowest, uint16_t highest) {
    const char *name = agv_setting_info(setting)->name;
    agv_config_defaults(&config);
    config.topology = agv_setting_info(setting)->gateway_only ? AGV_TOPOLOGY_GATEWAY : AGV_TOPOLOGY_SHARED;
    config.reset_hold_ms = 500;
    config.reset_hold_max_ms = 30000;
    TEST_ASSERT_TRUE(agv_config_set(&config, setting, lowest));
    expect_good(name);
    (void)agv_config_set(&config, setting, highest);
    expect_good(name);
    if (lowest > 0) {
        (void)agv_config_set(&config, setting, (uint16_t)(lowest - 1u));
        expect_problem(AGV_CONFIG_OUT_OF_RANGE, setting, name);
    }
    if (highest == UINT16_MAX) {
        return;
    }
    (void)agv_config_set(&config, setting, (uint16_t)(highest + 1u));
    expect_problem(AGV_CONFIG_OUT_OF_RANGE, setting, name);
    (void)agv_config_set(&config, setting, UINT16_MAX);
    expect_problem(AGV_CONFIG_OUT_OF_RANGE, setting, name);
}

/* Shows: INT-2 */
void test_the_defaults_are_valid(void) {
    expect_good("shared bus");
    config.topology = AGV_TOPOLOGY_GATEWAY;
    expect_good("gateway");
    config.id_set = AGV_ID_SET_TABLE;
    expect_good("gateway, table");
}

/* Three cycles of 10, 25 or 100 ms. */
/* Shows: INT-2 */
void test_a_deadline_under_three_cycles_is_refused(void) {
    expect_bounds(AGV_SETTING_vcu_heartbeat_timeout_ms, 30, 500);
    expect_bounds(AGV_SETTING_eps_heartbeat_timeout_ms, 30, 500);
    expect_bounds(AGV_SETTING_ai_heartbeat_timeout_ms, 300, 2000);
    expect_bounds(AGV_SETTING_gear_command_timeout_ms, 300, 2000);
    expect_bounds(AGV_SETTING_throttle_command_timeout_ms, 300, 2000);
    expect_bounds(AGV_SETTING_steering_command_timeout_ms, 75, 1000);
    expect_bounds(AGV_SETTING_gear_status_timeout_ms, 75, 1000);
    expect_bounds(AGV_SETTING_throttle_status_timeout_ms, 30, 500);
    expect_bounds(AGV_SETTING_eps_status_timeout_ms, 30, 500);
    expect_bounds(AGV_SETTING_steering_position_timeout_ms, 30, 500);
    expect_bounds(AGV_SETTING_wheel_speed_timeout_ms, 30, 500);
}

/* Shows: INT-2 */
void test_a_period_count_or_time_of_zero_is_refused(void) {
    static const uint16_t NEVER_ZERO[] = {
        AGV_SETTING_status_frame_period_ms, AGV_SETTING_watchdog_period_ms,    AGV_SETTING_eps_supply_fault_frames,
        AGV_SETTING_eps_mode_frames,        AGV_SETTING_status_invalid_frames, AGV_SETTING_command_too_fast_gaps,
        AGV_SETTING_reset_hold_ms,          AGV_SETTING_confirm_timeout_ms,    AGV_SETTING_park_timeout_ms,
        AGV_SETTING_init_hold_ms,           AGV_SETTING_standstill_speed_mm_s, AGV_SETTING_standstill_ms,
        AGV_SETTING_tx_stalled_ms,          AGV_SETTING_bus_off_recovery_ms,   AGV_SETTING_override_gap_ms,
        AGV_SETTING_event_hold_ms};
    for (unsigned i = 0; i < sizeof NEVER_ZERO / sizeof NEVER_ZERO[0]; i++) {
        agv_config_defaults(&config);
        (void)agv_config_set(&config, NEVER_ZERO[i], 0);
        expect_problem(AGV_CONFIG_OUT_OF_RANGE, NEVER_ZERO[i], agv_setting_info(NEVER_ZERO[i])->name);
    }
}

/* Shows: INT-2 */
void test_a_choice_beyond_its_words_is_refused(void) {
    for (uint16_t setting = AGV_SETTING_topology; setting <= AGV_SETTING_gear_change; setting++) {
        agv_config_defaults(&config);
        (void)agv_config_set(&config, setting, 2);
        expect_problem(AGV_CONFIG_OUT_OF_RANGE, setting, agv_setting_info(setting)->name);
    }
}

/* Shows: INT-2 */
void test_every_setting_is_checked_at_both_ends(void) {
    for (uint16_t setting = 0; setting < AGV_SETTING_COUNT; setting++) {
        const agv_setting_info_t *info = agv_setting_info(setting);
        expect_bounds(setting, info->lowest, info->highest);
    }
    TEST_ASSERT_FALSE(agv_config_set(&config, AGV_SETTING_COUNT, 0));
    TEST_ASSERT_EQUAL_UINT16(0, agv_config_get(&config, AGV_SETTING_COUNT));
    TEST_ASSERT_NULL(agv_setting_info(AGV_SETTING_COUNT));
}

/* Settings without effect on a shared bus: only the default is accepted there. */
/* Shows: INT-2, FSM-8, TOP-2 */
void test_a_setting_without_effect_is_refused(void) {
    static const struct {
        uint16_t setting;
        uint16_t value;
    } ROWS[] = {{AGV_SETTING_throttle_ceiling_pct, 99},
                {AGV_SETTING_throttle_rise_pct_s, 1},
                {AGV_SETTING_steering_slew_ddeg_s, 1},
                {AGV_SETTING_steering_fast_max_ddeg, 1},
                {AGV_SETTING_fast_mm_s, 1},
                {AGV_SETTING_gear_change, AGV_GEAR_CHANGE_ANY},
                {AGV_SETTING_gateway_in_manual, AGV_IN_MANUAL_ALL},
                {AGV_SETTING_own_heartbeat, AGV_OWN_HEARTBEAT_FROZEN}};
    unsigned gateway_only = 0;
    for (unsigned i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        setUp();
        (void)agv_config_set(&config, ROWS[i].setting, ROWS[i].value);
        expect_problem(AGV_CONFIG_NEEDS_GATEWAY, ROWS[i].setting, agv_setting_info(ROWS[i].setting)->name);
        config.topology = AGV_TOPOLOGY_GATEWAY;
        expect_good(agv_setting_info(ROWS[i].setting)->name);
    }
    for (uint16_t setting = 0; setting < AGV_SETTING_COUNT; setting++) {
        gateway_only += agv_setting_info(setting)->gateway_only ? 1u : 0u;
    }
    TEST_ASSERT_EQUAL_UINT32(sizeof ROWS / sizeof ROWS[0], gateway_only); /* no others */
}

/* No press could ever reset. */
/* Shows: INT-2, FSM-3 */
void test_a_longest_press_that_is_not_longer_is_refused(void) {
    config.reset_hold_ms = 2000;
    config.reset_hold_max_ms = 2000;
    TEST_ASSERT_EQUAL_INT(AGV_CONFIG_PRESS_TOO_SHORT, agv_config_check(&config).problem);
    config.reset_hold_max_ms = 2001;
    expect_good("longer");
}

static void expect_weakens(uint16_t setting, uint16_t value, bool weakens) {
    setUp();
    (void)agv_config_set(&config, setting, value);
    TEST_ASSERT_EQUAL_INT_MESSAGE(weakens, agv_config_weakens(&config, setting), agv_setting_info(setting)->name);
}

/* The direction that weakens: longer deadlines, shorter waits, wider limits. */
/* Shows: INT-2, TOP-3 */
void test_which_direction_weakens(void) {
    expect_weakens(AGV_SETTING_vcu_heartbeat_timeout_ms, 51, true);
    expect_weakens(AGV_SETTING_vcu_heartbeat_timeout_ms, 49, false);
    expect_weakens(AGV_SETTING_reset_hold_ms, 999, true);
    expect_weakens(AGV_SETTING_reset_hold_ms, 1001, false);
    expect_weakens(AGV_SETTING_reset_hold_max_ms, 5001, true);
    expect_weakens(AGV_SETTING_confirm_timeout_ms, 501, true);
    expect_weakens(AGV_SETTING_confirmed_ms, 4999, true);
    expect_weakens(AGV_SETTING_stop_timeout_ms, 5001, true);
    expect_weakens(AGV_SETTING_hold_age_ms, 51, true);
    expect_weakens(AGV_SETTING_mode_frames, 2, true);
    expect_weakens(AGV_SETTING_mode_flapping_ms, 4999, true);
    expect_weakens(AGV_SETTING_throttle_deviation_counts, 26, true);
    expect_weakens(AGV_SETTING_steering_gain_ddeg, 249, true);
    expect_weakens(AGV_SETTING_standstill_vcu_counts, 65535, true);
    expect_weakens(AGV_SETTING_status_frame_id, 0, true);
    expect_weakens(AGV_SETTING_status_frame_id, 0x123, false);
    expect_weakens(AGV_SETTING_gear_change, AGV_GEAR_CHANGE_ANY, true);
    expect_weakens(AGV_SETTING_after_power_on, AGV_AFTER_POWER_ON_TRIPPED, false);
    expect_weakens(AGV_SETTING_ai_counter, AGV_COUNTER_INCREMENTS, false);
    expect_weakens(AGV_SETTING_throttle_ceiling_pct, 50, false);
    for (uint16_t setting = 0; setting < AGV_SETTING_COUNT; setting++) {
        expect_weakens(setting, agv_setting_info(setting)->preset, false);
    }
}

/* Shows: INT-2, TOP-3, P1 */
void test_an_identifier_twice_is_refused(void) {
    static const uint16_t TAKEN[] = {0x43F, 0x201, 0x168, 0x075, 0x065, 0x363, 0x203,
                                     0x0A3, 0x050, 0x067, 0x167, 0x267, 0x101};
    for (unsigned i = 0; i < sizeof TAKEN / sizeof TAKEN[0]; i++) {
        config.status_frame_id = TAKEN[i];
        expect_problem(AGV_CONFIG_ID_TWICE, AGV_SETTING_status_frame_id, "taken");
    }
    config.status_frame_id = 0x102;
    expect_good("free");
    config.status_frame_id = 0x800;
    expect_problem(AGV_CONFIG_OUT_OF_RANGE, AGV_SETTING_status_frame_id, "no 11-bit identifier");
}

/* ---- Classes ---- */

/* Mandatory: faults of the heartbeats of VCU and EPS, of the AI while engaged, of the EPS, and of the supervisor
 * itself. */
static const agv_fault_t FIXED[] = {
    AGV_FAULT_SELF_TEST_FAILED,
    AGV_FAULT_MEMORY_CORRUPTED,
    AGV_FAULT_CONFIG_INVALID,
    AGV_FAULT_SUPERVISOR_RESET,
    AGV_FAULT_TX_GATE_REFUSED,
    AGV_FAULT_STEP_OVERRUN,
    AGV_FAULT_BUS_OFF,
    AGV_FAULT_TX_STALLED,
    AGV_FAULT_VCU_HEARTBEAT_LOST,
    AGV_FAULT_VCU_HEARTBEAT_STUCK,
    AGV_FAULT_EPS_HEARTBEAT_LOST,
    AGV_FAULT_EPS_HEARTBEAT_STUCK,
    AGV_FAULT_AI_HEARTBEAT_LOST,
    AGV_FAULT_AI_HEARTBEAT_STUCK,
    AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN,
    AGV_FAULT_EPS_TEMP_ABOVE_120,
    AGV_FAULT_EPS_MOTOR_ENCODER,
    AGV_FAULT_EPS_POSITION_ENCODER,
    AGV_FAULT_EPS_UNDER_VOLTAGE,
    AGV_FAULT_EPS_OVER_VOLTAGE,
    AGV_FAULT_EPS_EXCESSIVE_CURRENT,
    AGV_FAULT_VCU_EPS_HARDWARE_FAULT,
    AGV_FAULT_VCU_EPS_CAN_BUS_FAULT,
    AGV_FAULT_VCU_AI_CAN_LOST,
    AGV_FAULT_EPS_STATUS_TIMEOUT,
    AGV_FAULT_GEAR_COMMAND_TIMEOUT,
    AGV_FAULT_THROTTLE_COMMAND_TIMEOUT,
    AGV_FAULT_STEERING_COMMAND_TIMEOUT,
    AGV_FAULT_AI_COMMAND_OUT_OF_RANGE,
    AGV_FAULT_EPS_MODE_OFF,
    AGV_FAULT_EPS_MODE_INVALID,
    AGV_FAULT_EPS_MODE_NOT_ANGLE,
    AGV_FAULT_STEERING_ANGLE_INVALID,
    AGV_FAULT_STEERING_DEVIATION,
    AGV_FAULT_FOREIGN_COMMAND_SENDER,
    AGV_FAULT_SAFE_STATE_UNCONFIRMED,
};

/* Shows: INT-2 */
void test_a_fault_made_weaker_than_it_may_be_is_refused(void) {
    for (unsigned i = 0; i < sizeof FIXED / sizeof FIXED[0]; i++) {
        agv_config_defaults(&config);
        agv_fault_set_put(&config.trips, FIXED[i], false);
        expect_too_weak(FIXED[i]);
    }
    agv_config_defaults(&config);
    config.trips = (agv_fault_set_t){0};
    expect_too_weak(AGV_FAULT_SELF_TEST_FAILED); /* the highest-ranking one is named */
}

/* Shows: INT-2, S_DRIVER_ALARM, EPS_TEMP_ABOVE_110 */
void test_others_may_be_made_weaker_and_warnings_stronger(void) {
    agv_fault_set_put(&config.trips, AGV_FAULT_S_DRIVER_ALARM, false);
    agv_fault_set_put(&config.trips, AGV_FAULT_EPS_TEMP_ABOVE_110, true);
    expect_good("other classes");
    f.config = config;
    fixture_active(&f);
    walk_alarm(&f, ALARM_S_DRIVER);
    expect_fault_after(&f, 100, AGV_FAULT_S_DRIVER_ALARM, true);
    expect_state(&f, AGV_STATE_ACTIVE);
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0x10;
    expect_tripped_after(&f, 10, AGV_FAULT_EPS_TEMP_ABOVE_110);
}

/* Shows: INT-2 */
void test_a_class_for_no_fault_is_refused(void) {
    for (unsigned bit = AGV_FAULT_COUNT; bit < 32u * AGV_FAULT_WORDS; bit++) {
        agv_config_defaults(&config);
        config.trips.words[bit / 32u] |= 1u << (bit % 32u);
        TEST_ASSERT_EQUAL_INT(AGV_CONFIG_NO_SUCH_FAULT, agv_config_check(&config).problem);
    }
}

/* ---- The start with such a configuration ---- */

static void expect_refused_at_start(const char *what) {
    f.what = what;
    f.config = config;
    fixture_start(&f);
    expect_tripped(&f, AGV_FAULT_CONFIG_INVALID);
    expect_output(&f, false);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(3, f.sent_count, what);
    TEST_ASSERT_EQUAL_INT_MESSAGE(AGV_CONFIG_OK, agv_config_check(agv_supervisor_config(&f.supervisor)).problem, what);
    setUp();
}

/* Shows: INT-2, CONFIG_INVALID, FSM-9 */
void test_a_supervisor_with_an_invalid_configuration_trips_and_uses_the_defaults(void) {
    config.tx_stalled_ms = 0;
    expect_refused_at_start("out of range");
    config.topology = 7;
    expect_refused_at_start("no topology");
    config.id_set = 9;
    expect_refused_at_start("no ID set");
    config.id_throttle_command = 0x168;
    expect_refused_at_start("an identifier twice");
    config.own_heartbeat = AGV_OWN_HEARTBEAT_FROZEN;
    expect_refused_at_start("needs the gateway");
    agv_fault_set_put(&config.trips, AGV_FAULT_BUS_OFF, false);
    expect_refused_at_start("too weak");
    memset(&config.trips, 0xFF, sizeof config.trips);
    expect_refused_at_start("no such fault");
}

/* Shows: INT-2 */
void test_the_checksum_of_the_defaults_depends_on_every_setting(void) {
    const uint32_t defaults = agv_config_checksum(&config);
    for (uint16_t setting = 0; setting < AGV_SETTING_COUNT; setting++) {
        agv_config_defaults(&config);
        (void)agv_config_set(&config, setting, (uint16_t)(agv_config_get(&config, setting) ^ 1u));
        TEST_ASSERT_NOT_EQUAL(defaults, agv_config_checksum(&config));
    }
    agv_config_defaults(&config);
    config.trips.words[0] ^= 1u;
    TEST_ASSERT_NOT_EQUAL(defaults, agv_config_checksum(&config));
}

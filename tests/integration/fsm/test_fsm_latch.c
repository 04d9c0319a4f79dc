/* Unresettable faults, and the alive counter of the supervisor's 43Fh. */
#include <stddef.h>

#include "one_fixture.h"
#include "walk.h"

static void press_for(uint32_t ms) {
    fixture_button(&f, false);
    fixture_run(&f, 20);
    fixture_press(&f, ms);
}

/* ---- Unresettable faults ---- */

static void start_with_failed_self_test(void) {
    f.self_test_passed = false;
    fixture_start(&f);
    f.self_test_passed = true;
}

static void start_with_invalid_config(void) {
    f.config.vcu_heartbeat_timeout_ms = 29; /* less than three cycles */
    fixture_start(&f);
    f.config.vcu_heartbeat_timeout_ms = 50;
}

static void corrupt_memory(void) {
    fixture_active(&f);
    fixture_flip_bit(&f, 1000);
    fixture_send_now(&f, AGV_MSG_WHEEL_SPEED);
}

static void expect_cannot_be_reset(agv_fault_t fault) {
    uint16_t missing = 0;
    const uint32_t refusals = walk_refusals(&f, &missing);
    f.long_run = true;
    expect_tripped(&f, fault);
    expect_output(&f, false);
    fixture_vehicle_confirms(&f);
    fixture_mute_ai(&f, true);
    expect_state_after(&f, 2000, AGV_STATE_SAFE);
    press_for(3000);
    expect_state(&f, AGV_STATE_SAFE);
    expect_reason(&f, fault);
    expect_output(&f, false);
    expect_refusals(&f, refusals + 1, AGV_MISSING_TRIP_CAUSE);
}

/* Shows: FSM-9, FSM-7, INT-2, INT-5, SELF_TEST_FAILED, CONFIG_INVALID, MEMORY_CORRUPTED */
void test_an_unresettable_fault_outlives_every_reset_but_a_power_on(void) {
    static const struct {
        void (*cause)(void);
        agv_fault_t fault;
    } ROWS[] = {{start_with_failed_self_test, AGV_FAULT_SELF_TEST_FAILED},
                {start_with_invalid_config, AGV_FAULT_CONFIG_INVALID},
                {corrupt_memory, AGV_FAULT_MEMORY_CORRUPTED}};
    for (unsigned i = 0; i < 3; i++) {
        fixture_init(&f);
        ROWS[i].cause();
        expect_cannot_be_reset(ROWS[i].fault);
        for (unsigned cause = HAL_RESET_WATCHDOG; cause <= HAL_RESET_UNKNOWN; cause++) {
            fixture_button(&f, false);
            fixture_restart(&f, (hal_reset_cause_t)cause);
            expect_cannot_be_reset(ROWS[i].fault);
        }
        fixture_restart(&f, HAL_RESET_POWER_ON);
        expect_state(&f, AGV_STATE_INIT);
        expect_state_after(&f, 600, AGV_STATE_STANDBY);
        expect_output(&f, true);
    }
}

/* Detected in TRIPPED: the first reason stays, and now only a power-on ends the safe state. */
/* Shows: FSM-5, FSM-9, MEMORY_CORRUPTED */
void test_corrupted_memory_keeps_the_reason_of_an_earlier_trip(void) {
    walk_to_safe(&f);
    fixture_flip_bit(&f, 1000);
    fixture_send_now(&f, AGV_MSG_WHEEL_SPEED);
    expect_fault(&f, AGV_FAULT_MEMORY_CORRUPTED, true);
    expect_cannot_be_reset(AGV_FAULT_S_DRIVER_ALARM);
}

static void expect_what_fits_the_vehicle(const agv_config_t *config) {
    TEST_ASSERT_EQUAL_INT(AGV_CONFIG_OK, agv_config_check(config).problem);
    TEST_ASSERT_EQUAL_UINT16(AGV_TOPOLOGY_GATEWAY, config->topology);
    TEST_ASSERT_EQUAL_UINT16(AGV_ID_SET_TABLE, config->id_set);
    TEST_ASSERT_EQUAL_UINT16(AGV_PARK_AT_STANDSTILL, config->park);
}

static void expect_the_identifiers(const agv_config_t *config) {
    TEST_ASSERT_EQUAL_HEX16(0x169, config->id_gear_command);
    TEST_ASSERT_EQUAL_HEX16(0x102, config->id_wheel_speed);
    TEST_ASSERT_EQUAL_HEX16(0x43F, config->id_turn_signal_command);
}

/* Each bit of the configuration in turn. */
static void expect_after_a_flipped_bit(void (*expect_kept)(const agv_config_t *config)) {
    f.long_run = true;
    fixture_active(&f);
    const agv_supervisor_t intact = f.supervisor;
    const size_t at = (size_t)((const uint8_t *)agv_supervisor_config(&f.supervisor) - (const uint8_t *)&f.supervisor);
    for (size_t bit = 0; bit < 8 * sizeof(agv_config_t); bit++) {
        f.supervisor = intact;
        fixture_flip_bit(&f, 8 * at + bit);
        fixture_send_now(&f, AGV_MSG_WHEEL_SPEED);
        expect_fault(&f, AGV_FAULT_MEMORY_CORRUPTED, true);
        expect_kept(agv_supervisor_config(&f.supervisor));
    }
}

/* The defaults are used, with this vehicle's identifiers, topology and P: the VCU does not guard P against speed. */
/* Shows: FSM-9, FSM-1, INT-5, MEMORY_CORRUPTED, P1 */
void test_a_corrupted_configuration_is_replaced_by_one_that_fits_the_vehicle(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.config.id_set = AGV_ID_SET_TABLE;
    f.config.park = AGV_PARK_AT_STANDSTILL;
    expect_after_a_flipped_bit(expect_what_fits_the_vehicle);
}

/* Identifiers that were changed one by one are kept, too. */
/* Shows: FSM-9, INT-5, MEMORY_CORRUPTED, P1 */
void test_a_corrupted_configuration_keeps_identifiers_that_were_changed(void) {
    f.config.id_gear_command = 0x169;
    f.config.id_wheel_speed = 0x102;
    f.other_ids = true;
    expect_after_a_flipped_bit(expect_the_identifiers);
}

static void expect_identifiers_beside_the_status_frame(const agv_config_t *config) {
    TEST_ASSERT_EQUAL_INT(AGV_CONFIG_OK, agv_config_check(config).problem);
    TEST_ASSERT_EQUAL_HEX16(0x7F0, config->id_gear_command);
    TEST_ASSERT_EQUAL_HEX16(0x43F, config->id_steering_command);
    TEST_ASSERT_EQUAL_HEX16(0x23F, config->id_turn_signal_command);
    TEST_ASSERT_EQUAL_HEX16(0x6F0, config->status_frame_id);
}

/* 168h has the identifier that the status frame has by default, 065h that of another command. */
/* Shows: FSM-9, INT-5, MEMORY_CORRUPTED, P1, TOP-3 */
void test_a_corrupted_configuration_keeps_the_identifier_of_the_status_frame(void) {
    f.config.id_gear_command = 0x7F0;
    f.config.id_steering_command = 0x43F;
    f.config.id_turn_signal_command = 0x23F;
    f.config.status_frame_id = 0x6F0;
    f.other_ids = true;
    expect_after_a_flipped_bit(expect_identifiers_beside_the_status_frame);
}

/* The status frame is off then, and the commands keep the identifiers of this vehicle. */
/* Shows: FSM-9, CONFIG_INVALID, P1, TOP-3 */
void test_the_identifier_of_the_status_frame_twice(void) {
    f.config.id_gear_command = 0x169;
    f.config.status_frame_id = 0x169;
    f.log_status = true;
    fixture_start(&f);
    expect_reason(&f, AGV_FAULT_CONFIG_INVALID);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x169));
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT16(0, agv_supervisor_config(&f.supervisor)->status_frame_id);
}

/* With an invalid identifier all identifiers fall back to those of the ID set. */
/* Shows: FSM-9, CONFIG_INVALID, P1 */
void test_an_identifier_twice_falls_back_to_those_of_the_set(void) {
    f.config.id_set = AGV_ID_SET_TABLE;
    f.config.id_gear_command = 0x075;
    fixture_start(&f);
    expect_reason(&f, AGV_FAULT_CONFIG_INVALID);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x201));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_INT(AGV_CONFIG_OK, agv_config_check(agv_supervisor_config(&f.supervisor)).problem);
}

/* Shows: FSM-9 */
void test_both_at_the_start_the_left_one_is_the_first(void) {
    f.self_test_passed = false;
    f.config.vcu_heartbeat_timeout_ms = 0;
    fixture_start(&f);
    expect_reason(&f, AGV_FAULT_SELF_TEST_FAILED);
    expect_fault(&f, AGV_FAULT_CONFIG_INVALID, true);
}

/* The event of the self-test has the parts that failed; that of another fault has none. */
/* Shows: INT-3 */
void test_the_parts_that_failed_are_named_with_their_fault_alone(void) {
    agv_event_t event;
    f.self_test_passed = false;
    f.config.vcu_heartbeat_timeout_ms = 0;
    fixture_start(&f);
    TEST_ASSERT_TRUE(fixture_last_raised(&f, AGV_FAULT_SELF_TEST_FAILED, &event));
    TEST_ASSERT_EQUAL_HEX16(HAL_SELF_TEST_FLASH, event.missing);
    TEST_ASSERT_TRUE(fixture_last_raised(&f, AGV_FAULT_CONFIG_INVALID, &event));
    TEST_ASSERT_EQUAL_HEX16(0, event.missing);
}

/* Sent from constants, with the identifiers of this vehicle as far as they are valid. */
/* Shows: FSM-9, P1 */
void test_an_invalid_configuration_still_sends_on_the_vehicles_identifiers(void) {
    f.config.id_set = AGV_ID_SET_TABLE;
    f.config.reset_hold_ms = 0;
    fixture_start(&f);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x201));
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x43F));
    fixture_init(&f);
    f.config.id_set = 2;
    fixture_start(&f);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x43F));
    expect_reason(&f, AGV_FAULT_CONFIG_INVALID);
}

/* ---- The alive counter of the supervisor's 43Fh ---- */

/* Overrides count, too: no two successive frames have the same value. */
/* Shows: FSM-8 */
void test_the_own_heartbeat_runs(void) {
    fixture_active(&f);
    walk_trip(&f);
    fixture_run(&f, 30000); /* the AI computer still sends its own */
    const uint32_t count = fixture_count_sent(&f, 0x43F);
    TEST_ASSERT_TRUE(count > 300);
    for (uint32_t n = 1; n < count; n++) {
        const uint8_t before = fixture_nth_sent(&f, 0x43F, n - 1)->data[7];
        TEST_ASSERT_EQUAL_HEX8((uint8_t)(before + 1), fixture_nth_sent(&f, 0x43F, n)->data[7]);
    }
}

/* Shows: FSM-8 */
void test_the_own_heartbeat_is_frozen_if_so_chosen(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.config.own_heartbeat = AGV_OWN_HEARTBEAT_FROZEN;
    f.long_run = true;
    walk_to_safe(&f);
    fixture_forget_sent(&f);
    expect_count_after(&f, 3000, 0x43F, 30);
    for (uint32_t n = 1; n < 30; n++) {
        TEST_ASSERT_EQUAL_HEX8(fixture_nth_sent(&f, 0x43F, 0)->data[7], fixture_nth_sent(&f, 0x43F, n)->data[7]);
    }
}

/*
 * States that no frame and no tick can cause: the test changes the supervisor's memory and corrects its seal. The last
 * checks must still detect it.
 */
#include "supervisor/supervisor_internal.h"

#include "agv/checksum.h"
#include "expect.h"
#include "fixture.h"
#include "keep/latch.h"
#include "unity.h"
#include "walk.h"

enum { STATUS_ID = 0x123 };

static fixture_t f;
static agv_core_t *core;

void setUp(void) {
    fixture_init(&f);
    core = agv_core_of(&f.supervisor);
}

static void seal(void) {
    f.supervisor.seal = agv_seal(f.supervisor.memory, sizeof f.supervisor.memory);
}

/* Start with an unchecked configuration in memory. */
static void begin(void) {
    agv_core_begin(core, &f.ports, 0);
    seal();
}

/* 20000 is not a valid angle. The fault is active at once, and reported in the next call. */
/* Shows: INT-4, FSM-10, TX_GATE_REFUSED */
void test_an_override_that_the_gate_refuses_is_a_fault(void) {
    static const uint8_t other_angle[8] = {1};
    walk_to_tripped(&f);
    fixture_forget_sent(&f);
    core->hold = (agv_hold_t){.raw = 20000, .check = (uint16_t)~20000u};
    seal();
    fixture_frame(&f, AGV_MSG_STEERING_COMMAND, other_angle);
    expect_fault(&f, AGV_FAULT_TX_GATE_REFUSED, true);
    expect_silence(&f);
    TEST_ASSERT_EQUAL_UINT32(1, agv_supervisor_counters(&f.supervisor)->gate_refused);
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, AGV_FAULT_TX_GATE_REFUSED));
}

/* Shows: INT-4, TX_GATE_REFUSED */
void test_a_frame_of_its_own_that_the_gate_refuses_trips(void) {
    static const uint8_t drive[8] = {1};
    fixture_standby(&f);
    const agv_tx_orders_t orders = agv_core_orders(core, &f.ports);
    agv_transmitter_pass(&core->transmitter, &orders, AGV_MSG_GEAR_COMMAND,
                         drive); /* shared bus: this may not be sent */
    agv_core_take_tx_report(core);
    TEST_ASSERT_TRUE((agv_core_decide(core, &f.ports, 0).actions.what & AGV_ACTION_TRIP) != 0);
    expect_state(&f, AGV_STATE_TRIPPED);
    expect_reason(&f, AGV_FAULT_TX_GATE_REFUSED);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_HEX8(GEAR_P, fixture_nth_sent(&f, 0x168, 0)->data[0]);
}

/* 168h has the identifier of 43Fh, so the gate checks it as 43Fh: P is not sent. */
/* Shows: INT-4, FSM-9, SELF_TEST_FAILED */
void test_a_gate_that_refuses_p_fails_the_self_test(void) {
    agv_event_t event;
    fixture_start(&f);
    fixture_forget_sent(&f);
    core->config.id_gear_command = 0x43F;
    begin();
    expect_state(&f, AGV_STATE_TRIPPED);
    expect_reason(&f, AGV_FAULT_SELF_TEST_FAILED);
    TEST_ASSERT_TRUE(fixture_last_raised(&f, AGV_FAULT_SELF_TEST_FAILED, &event));
    TEST_ASSERT_EQUAL_HEX16(HAL_SELF_TEST_CORE, event.missing); /* this part alone */
    expect_output(&f, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x43F)); /* the status frame, not P */
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(1, agv_supervisor_counters(&f.supervisor)->gate_refused);
}

/* The checksum fits, but the configuration is invalid: the defaults are used. */
/* Shows: INT-2, INT-5, MEMORY_CORRUPTED */
void test_a_corrupted_configuration_whose_checksum_fits_is_not_used(void) {
    f.config.tx_stalled_ms = 200;
    fixture_standby(&f);
    core->config.override_gap_ms = 0;
    core->config_checksum = agv_config_checksum(&core->config);
    fixture_run(&f, 1);
    expect_reason(&f, AGV_FAULT_MEMORY_CORRUPTED);
    TEST_ASSERT_EQUAL_UINT16(5, agv_supervisor_config(&f.supervisor)->override_gap_ms);
    TEST_ASSERT_EQUAL_UINT16(100, agv_supervisor_config(&f.supervisor)->tx_stalled_ms);
}

/* Other memory is corrupted: the integrator's configuration stays in use. */
/* Shows: INT-5, MEMORY_CORRUPTED */
void test_an_intact_configuration_is_kept(void) {
    f.config.tx_stalled_ms = 200;
    fixture_standby(&f);
    core->vehicle.angle_raw ^= 1;
    fixture_run(&f, 1);
    expect_reason(&f, AGV_FAULT_MEMORY_CORRUPTED);
    TEST_ASSERT_EQUAL_UINT16(200, agv_supervisor_config(&f.supervisor)->tx_stalled_ms);
}

/* Corrupted memory is no restart: SUPERVISOR_RESET is not raised. */
/* Shows: FSM-7, INT-5, MEMORY_CORRUPTED */
void test_corrupted_memory_raises_no_other_fault(void) {
    fixture_standby(&f);
    core->vehicle.angle_raw ^= 1;
    fixture_send_now(&f, AGV_MSG_STEERING_POSITION);
    const agv_fault_set_t active = agv_supervisor_active_faults(&f.supervisor);
    for (unsigned fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        TEST_ASSERT_EQUAL(fault == AGV_FAULT_MEMORY_CORRUPTED, agv_fault_is_in(&active, fault));
    }
}

/* A flipped bit may start any timer, that of a bus-off too. In the frame that detects it the safe commands go out. */
/* Shows: INT-5, FSM-2, MEMORY_CORRUPTED */
void test_a_timer_that_a_flipped_bit_starts_holds_no_safe_command_back(void) {
    fixture_standby(&f);
    const agv_supervisor_t healthy = f.supervisor;
    for (unsigned i = 0; i < 8 * AGV_TIMER_COUNT; i++) {
        f.supervisor = healthy;
        sim_store_init(&f.store);
        fixture_forget_sent(&f);
        core->timers.phase[i / 8] ^= (uint8_t)(1u << (i % 8));
        fixture_send_now(&f, AGV_MSG_STEERING_POSITION);
        expect_tripped(&f, AGV_FAULT_MEMORY_CORRUPTED);
        expect_safe_commands(&f, f.call, NO_HOLD);
    }
}

/* An unresettable fault must outlive the next reset, although the state does not change any more. */
/* Shows: FSM-9, FSM-7 */
void test_an_unresettable_fault_that_comes_while_tripped_is_stored(void) {
    agv_latch_t latch;
    walk_to_tripped(&f);
    TEST_ASSERT_EQUAL(AGV_LATCH_VALID, agv_latch_read(&f.hal, &latch));
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_NONE, latch.unresettable);
    agv_fault_monitor_set(&core->faults, AGV_FAULT_SELF_TEST_FAILED, true);
    seal();
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL(AGV_LATCH_VALID, agv_latch_read(&f.hal, &latch));
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_SELF_TEST_FAILED, latch.unresettable);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_S_DRIVER_ALARM, latch.first_reason); /* FSM-5 */
    expect_output(&f, false);
}

/* A controller in bus-off gets no frame, not even the status frame. */
/* Shows: SUP-7, TOP-3 */
void test_in_bus_off_no_frame_is_passed_to_the_controller(void) {
    f.config.status_frame_id = STATUS_ID;
    f.config.status_frame_period_ms = 10;
    f.log_status = true;
    fixture_standby(&f);
    const uint32_t before = f.status_count;
    fixture_run(&f, 50);
    TEST_ASSERT_EQUAL_UINT32(5, f.status_count - before);
    const uint32_t refused = f.hal.can[HAL_CAN_VEHICLE].refused;
    fixture_forget_sent(&f);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    fixture_run(&f, 50);
    expect_silence(&f);
    TEST_ASSERT_EQUAL_UINT32(refused, f.hal.can[HAL_CAN_VEHICLE].refused);
}

/* Another state, or a cleared latch, with a correct seal: state and latch are inconsistent. */
/* Shows: INT-5, MEMORY_CORRUPTED */
void test_state_and_latch_that_do_not_fit_are_corrupted_memory(void) {
    static const struct {
        uint8_t state;
        uint8_t latched;
    } pairs[] = {{AGV_STATE_STANDBY, AGV_LATCH_CLOSED}, {AGV_STATE_TRIPPED, AGV_LATCH_OPEN}, {0x54, AGV_LATCH_CLOSED}};
    for (unsigned i = 0; i < 3; i++) {
        fixture_init(&f);
        walk_to_tripped(&f);
        core->machine.state = pairs[i].state;
        core->machine.latched = pairs[i].latched;
        seal();
        fixture_run(&f, 1);
        expect_state(&f, AGV_STATE_TRIPPED);
        expect_fault(&f, AGV_FAULT_MEMORY_CORRUPTED, true);
        expect_reason(&f, AGV_FAULT_S_DRIVER_ALARM); /* as stored */
        expect_output(&f, false);
    }
}

static void foreign_drive_at(uint32_t ms, uint16_t us) {
    const hal_can_frame_t frame = {.id = 0x168, .time_ms = ms, .time_us = us, .length = 8, .data = {GEAR_D}};
    agv_supervisor_frame(&f.supervisor, &f.ports, HAL_CAN_VEHICLE, &frame);
}

/* A stamp of 4294967 ms ago: 1000 times that is 2^32 but for 296 microseconds, which is no later moment of now. */
/* Shows: TIM-2 */
void test_a_stamp_of_a_turn_of_the_microseconds_ago_is_old(void) {
    f.now_ms = 5000000;
    fixture_standby(&f);
    foreign_drive_at(f.now_ms - 4294967, 0);
    TEST_ASSERT_EQUAL_UINT32(f.now_ms, core->timers.now_ms);
}

/* From the start, and from a restart on: 1234567 ms are 1234567000 us. */
void test_both_clocks_agree(void) {
    f.now_ms = 1234567;
    fixture_start(&f);
    TEST_ASSERT_EQUAL_UINT32(1234567000, core->timers.now_us);
    fixture_jump(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(1234568000, core->timers.now_us);
    foreign_drive_at(1234568, 999);
    TEST_ASSERT_EQUAL_UINT32(1234568999, core->timers.now_us);
    core->timers.now_us = 5;
    fixture_jump(&f, 1); /* detected as corrupted */
    expect_fault(&f, AGV_FAULT_MEMORY_CORRUPTED, true);
    TEST_ASSERT_EQUAL_UINT32(1234569000, core->timers.now_us);
}

/* The identifiers in use are copied from the configuration. A flipped bit in them is detected, and they are copied
 * again. */
/* Shows: INT-5, P1, MEMORY_CORRUPTED */
void test_a_flipped_bit_in_the_identifiers_is_repaired(void) {
    fixture_standby(&f);
    core->ids.of[AGV_MSG_GEAR_COMMAND] ^= 1;
    fixture_run(&f, 1);
    expect_reason(&f, AGV_FAULT_MEMORY_CORRUPTED);
    TEST_ASSERT_EQUAL_HEX16(0x168, core->ids.of[AGV_MSG_GEAR_COMMAND]);
}

/* A frame without effect does not repeat the reports of the previous call. */
/* Shows: INT-3 */
void test_a_frame_of_no_message_after_a_fault_records_nothing(void) {
    fixture_standby(&f);
    f.traffic[AGV_MSG_EPS_STATUS].data[7] = 0x10; /* EPS_TEMP_ABOVE_110 warns */
    fixture_send_now(&f, AGV_MSG_EPS_STATUS);
    expect_fault(&f, AGV_FAULT_EPS_TEMP_ABOVE_110, true);
    const uint32_t recorded = agv_recorder_next_sequence(&f.recorder);
    TEST_ASSERT_EQUAL_UINT32(1, agv_supervisor_counters(&f.supervisor)->warnings);
    for (unsigned i = 0; i < 10; i++) {
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x700, .length = 8});
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x363, .length = 7});
    }
    TEST_ASSERT_EQUAL_UINT32(recorded, agv_recorder_next_sequence(&f.recorder));
    TEST_ASSERT_EQUAL_UINT32(1, agv_supervisor_counters(&f.supervisor)->warnings);
}

/* No pointer is kept: two supervisors with the same input have the same memory, wherever they and their ports are. */
/* Shows: INT-5 */
void test_two_supervisors_with_the_same_input_are_equal(void) {
    static fixture_t other;
    fixture_init(&other);
    other.now_ms = f.now_ms;
    fixture_active(&f);
    fixture_active(&other);
    TEST_ASSERT_EQUAL_MEMORY(f.supervisor.memory, other.supervisor.memory, sizeof f.supervisor.memory);
}

/* Shows: SUP-1 */
void test_the_readers_of_ages_and_of_the_time(void) {
    fixture_start(&f);
    fixture_mute_vcu(&f, true);
    TEST_ASSERT_EQUAL_UINT32(f.now_ms, agv_supervisor_tick_ms(&f.supervisor));
    TEST_ASSERT_FALSE(agv_supervisor_is_fresh(&f.supervisor, AGV_MSG_VEHICLE_STATUS));
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    TEST_ASSERT_TRUE(agv_supervisor_is_fresh(&f.supervisor, AGV_MSG_VEHICLE_STATUS));
    fixture_run(&f, 50);
    TEST_ASSERT_EQUAL_UINT32(50, agv_supervisor_age_ms(&f.supervisor, AGV_MSG_VEHICLE_STATUS));
    TEST_ASSERT_TRUE(agv_supervisor_is_fresh(&f.supervisor, AGV_MSG_VEHICLE_STATUS));
    TEST_ASSERT_EQUAL_UINT32(f.now_ms, agv_supervisor_tick_ms(&f.supervisor));
    fixture_run(&f, 1);
    TEST_ASSERT_FALSE(agv_supervisor_is_fresh(&f.supervisor, AGV_MSG_VEHICLE_STATUS));
    TEST_ASSERT_TRUE(agv_supervisor_has_fault(&f.supervisor, AGV_FAULT_VCU_HEARTBEAT_LOST));
    TEST_ASSERT_FALSE(agv_supervisor_has_fault(&f.supervisor, AGV_FAULT_NONE));
    TEST_ASSERT_EQUAL(AGV_FAULT_VCU_HEARTBEAT_LOST, agv_supervisor_first_active(&f.supervisor));
    const agv_fault_set_t active = agv_supervisor_active_faults(&f.supervisor);
    TEST_ASSERT_TRUE(agv_fault_is_in(&active, AGV_FAULT_VCU_HEARTBEAT_LOST));
    TEST_ASSERT_FALSE(agv_fault_is_in(&active, AGV_FAULT_BUS_OFF));
    fixture_run(&f, 6000);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, agv_supervisor_age_ms(&f.supervisor, AGV_MSG_VEHICLE_STATUS));
}

/* Shows: SUP-3 */
void test_a_message_that_does_not_exist_has_no_age(void) {
    fixture_standby(&f);
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, agv_supervisor_age_ms(&f.supervisor, AGV_MSG_NONE));
    TEST_ASSERT_EQUAL_UINT32(UINT32_MAX, agv_supervisor_age_ms(&f.supervisor, AGV_MSG_COUNT));
    TEST_ASSERT_FALSE(agv_supervisor_is_fresh(&f.supervisor, AGV_MSG_NONE));
    TEST_ASSERT_FALSE(agv_supervisor_is_fresh(&f.supervisor, AGV_MSG_COUNT));
    for (unsigned message = 32; message < 32 + AGV_MSG_COUNT; message++) { /* no number modulo 32 either */
        TEST_ASSERT_FALSE(agv_supervisor_is_fresh(&f.supervisor, (agv_message_t)message));
    }
}

/* A stored latch with a right checksum that names a fault as unresettable; then a restart by the watchdog. */
static void restart_with(uint8_t unresettable) {
    fixture_standby(&f);
    agv_latch_write(&f.hal, AGV_LATCH_OPEN, AGV_FAULT_NONE, unresettable);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
}

/* Shows: FSM-7 */
void test_a_fault_of_the_latch_stays_until_its_check_finds_something(void) {
    restart_with(AGV_FAULT_GEAR_STATUS_INVALID);
    expect_fault(&f, AGV_FAULT_GEAR_STATUS_INVALID, true);
    expect_fault_after(&f, 100, AGV_FAULT_GEAR_STATUS_INVALID, true);
}

/* Shows: FSM-7, SUP-8 */
TEST_CASE(AGV_AI_LOST_WARN, 1)
TEST_CASE(AGV_AI_LOST_TRIP, 0)
void test_a_lost_ai_computer_in_the_latch_has_the_class_of_manual(int class_in_manual, uint32_t warnings) {
    f.config.ai_lost_in_manual = (uint16_t)class_in_manual;
    restart_with(AGV_FAULT_AI_HEARTBEAT_LOST);
    const agv_fault_set_t trips = agv_supervisor_active_trips(&f.supervisor);
    TEST_ASSERT_EQUAL(warnings == 0, agv_fault_is_in(&trips, AGV_FAULT_AI_HEARTBEAT_LOST));
    TEST_ASSERT_EQUAL_UINT32(warnings, agv_supervisor_counters(&f.supervisor)->warnings);
}

/* Every fault of the table: name, rank, default class, LED code, by hand; and each of them is raised, as what it is. */
#include <stddef.h>
#include <string.h>

#include "agv/names.h"
#include "one_fixture.h"
#include "walk.h"

/* This byte (1..8) of the message, for so long. */
static void report(agv_message_t message, unsigned byte, uint8_t value, uint32_t ms) {
    f.traffic[message].data[byte - 1] = value;
    fixture_run(&f, ms);
}

static void silence(agv_message_t message, uint32_t ms) {
    f.traffic[message].muted = true;
    fixture_run(&f, ms);
}

/* ---- How each is raised ---- */

static void self_test_failed(void) {
    f.self_test_passed = false;
    fixture_start(&f);
}

static void memory_corrupted(void) {
    fixture_active(&f);
    ((uint8_t *)&f.supervisor)[sizeof f.supervisor / 2u] ^= 0x01u;
    fixture_send_now(&f, AGV_MSG_WHEEL_SPEED);
}

static void config_invalid(void) {
    f.config.vcu_heartbeat_timeout_ms = 29;
    fixture_start(&f);
}

static void supervisor_reset(void) {
    f.reset_cause = HAL_RESET_WATCHDOG;
    fixture_start(&f);
}

static sim_hal_sink_fn *fixtures_sink;

/* While 43Fh leaves, a bit flips in the 065h that waits (5B 2A). */
static void flip_what_waits(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    static const uint8_t WAITING[8] = {0x5B, 0x2A};
    uint8_t *memory = (uint8_t *)&f.supervisor;
    for (size_t at = 0; frame->id == 0x43F && at + sizeof WAITING <= sizeof f.supervisor; at++) {
        memory[at + 1] ^= memcmp(&memory[at], WAITING, sizeof WAITING) == 0 ? 0x80u : 0u;
    }
    fixtures_sink(ctx, side, frame);
}

static void tx_gate_refused(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    fixture_run_before(&f, AGV_MSG_TURN_SIGNAL_COMMAND);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    fixture_command_angle(&f, 0x2A5B);
    fixture_run(&f, 5);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    fixtures_sink = f.hal.sink;
    f.hal.sink = flip_what_waits;
    fixture_run(&f, 2);
}

static void step_overrun(void) {
    fixture_active(&f);
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    fixture_run_without_ticks(&f, 102);
    fixture_jump(&f, 0);
}

static void bus_off(void) {
    fixture_active(&f);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    fixture_run(&f, 1);
}

static void tx_stalled(void) {
    fixture_active(&f);
    sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, 101);
    fixture_run(&f, 1);
}

static void vcu_heartbeat_lost(void) {
    fixture_active(&f);
    silence(AGV_MSG_VEHICLE_STATUS, 70);
}

static void vcu_heartbeat_stuck(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_VEHICLE_STATUS].frozen = true;
    fixture_run(&f, 70);
}

static void eps_heartbeat_lost(void) {
    fixture_active(&f);
    silence(AGV_MSG_STEERING_STATUS, 70);
}

static void eps_heartbeat_stuck(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_STEERING_STATUS].frozen = true;
    fixture_run(&f, 70);
}

static void ai_heartbeat_lost(void) {
    fixture_active(&f);
    silence(AGV_MSG_TURN_SIGNAL_COMMAND, 500);
}

static void ai_heartbeat_stuck(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_TURN_SIGNAL_COMMAND].frozen = true;
    fixture_run(&f, 500);
}

static void eps_over_current_shutdown(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 8, 0x08, 40);
}

static void eps_temp_above_120(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 8, 0x20, 40);
}

static void eps_motor_encoder(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 8, 0x40, 40);
}

static void eps_position_encoder(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 8, 0x80, 40);
}

static void eps_under_voltage(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 8, 0x01, 40);
}

static void eps_over_voltage(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 8, 0x02, 40);
}

static void eps_excessive_current(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 8, 0x04, 40);
}

static void eps_temp_above_110(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 8, 0x10, 40);
}

static void vcu_eps_hardware_fault(void) {
    fixture_active(&f);
    report(AGV_MSG_VEHICLE_STATUS, 5, 0x10, 10);
}

static void vcu_eps_can_bus_fault(void) {
    fixture_active(&f);
    report(AGV_MSG_VEHICLE_STATUS, 5, 0x20, 10);
}

static void s_driver_alarm(void) {
    fixture_active(&f);
    report(AGV_MSG_VEHICLE_STATUS, 5, 0x80, 10);
}

static void remote_signal_lost(void) {
    fixture_active(&f);
    report(AGV_MSG_VEHICLE_STATUS, 5, 0x01, 10);
}

static void remote_power_lost(void) {
    fixture_active(&f);
    report(AGV_MSG_VEHICLE_STATUS, 5, 0x02, 10);
}

static void vcu_ai_can_lost(void) {
    fixture_active(&f);
    report(AGV_MSG_VEHICLE_STATUS, 5, 0x08, 10);
}

static void vcu_level2_alarm(void) {
    fixture_active(&f);
    report(AGV_MSG_VEHICLE_STATUS, 6, 0x01, 10);
}

static void mode_invalid(void) {
    fixture_active(&f);
    fixture_mode(&f, MODE_BOTH);
    fixture_run(&f, 70);
}

static void mode_flapping(void) {
    fixture_standby(&f);
    for (unsigned i = 0; i < 4; i++) {
        fixture_mode(&f, MODE_ENGAGED);
        fixture_run(&f, 200);
        fixture_mode(&f, MODE_MANUAL);
        fixture_run(&f, 300);
    }
}

static void mode_none(void) {
    fixture_standby(&f);
    fixture_drive(&f, 1000);
    fixture_mode(&f, MODE_NEITHER);
    fixture_run(&f, 600);
}

static void eps_status_timeout(void) {
    fixture_active(&f);
    silence(AGV_MSG_EPS_STATUS, 460);
}

static void gear_status_timeout(void) {
    fixture_active(&f);
    silence(AGV_MSG_GEAR_STATUS, 460);
}

static void throttle_status_timeout(void) {
    fixture_active(&f);
    silence(AGV_MSG_THROTTLE_STATUS, 460);
}

static void wheel_speed_timeout(void) {
    fixture_active(&f);
    silence(AGV_MSG_WHEEL_SPEED, 460);
}

static void steering_position_timeout(void) {
    fixture_active(&f);
    silence(AGV_MSG_STEERING_POSITION, 460);
}

static void gear_command_timeout(void) {
    fixture_active(&f);
    silence(AGV_MSG_GEAR_COMMAND, 460);
}

static void throttle_command_timeout(void) {
    fixture_active(&f);
    silence(AGV_MSG_THROTTLE_COMMAND, 460);
}

static void steering_command_timeout(void) {
    fixture_active(&f);
    silence(AGV_MSG_STEERING_COMMAND, 460);
}

static void ai_command_out_of_range(void) {
    fixture_active(&f);
    report(AGV_MSG_GEAR_COMMAND, 1, 3, 100);
}

static void eps_mode_off(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 4, 0xFF, 60);
}

static void eps_mode_invalid(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 4, 0x04, 60);
}

static void eps_mode_not_angle(void) {
    fixture_active(&f);
    report(AGV_MSG_EPS_STATUS, 4, 0x02, 60);
}

static void gear_status_invalid(void) {
    fixture_active(&f);
    report(AGV_MSG_GEAR_STATUS, 1, 3, 90);
}

static void throttle_status_invalid(void) {
    fixture_active(&f);
    report(AGV_MSG_THROTTLE_STATUS, 1, 251, 40);
}

static void steering_angle_invalid(void) {
    fixture_active(&f);
    fixture_angle(&f, 18001);
    fixture_run(&f, 40);
}

static void steering_deviation(void) {
    fixture_active(&f);
    fixture_command_angle(&f, ANGLE_CENTRE + 501);
    fixture_run(&f, 600);
}

static void throttle_deviation(void) {
    fixture_active(&f);
    fixture_throttle(&f, 26);
    fixture_run(&f, 600);
}

static void gear_deviation(void) {
    fixture_active(&f);
    fixture_throttle(&f, 3);
    /* the command is P, the status D */ fixture_run(&f, 1100);
}

static void autopilot_off_ignored(void) {
    fixture_active(&f);
    report(AGV_MSG_TURN_SIGNAL_COMMAND, 5, 0xC0, 1200);
}

static void throttle_in_park(void) {
    fixture_active(&f);
    fixture_gear(&f, GEAR_P);
    fixture_throttle(&f, 3);
    fixture_run(&f, 300);
}

static void foreign_command_sender(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x168, .length = 8, .data = {GEAR_P}});
}

static void safe_state_unconfirmed(void) {
    walk_to_tripped(&f);
    fixture_run(&f, 600);
}

static void vehicle_not_stopping(void) {
    walk_to_tripped_driving(&f, 1000);
    fixture_run(&f, 5000);
}

static void moving_while_safe(void) {
    walk_to_safe(&f);
    fixture_drive(&f, 100);
    fixture_run(&f, 300);
}

static void command_too_fast(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_GEAR_COMMAND].cycle_ms = 25;
    fixture_run(&f, 400);
}

static void speed_implausible(void) {
    fixture_active(&f);
    fixture_speed(&f, 3600);
    fixture_run(&f, 1100);
}

static void status_id_in_use(void) {
    fixture_active(&f);
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x7F0, .length = 8});
}

static void startup_timeout(void) {
    fixture_mode(&f, MODE_NEITHER);
    fixture_start(&f);
    fixture_run(&f, 10001);
}

static void rx_overrun(void) {
    fixture_active(&f);
    sim_hal_add_overrun(&f.hal, HAL_CAN_VEHICLE);
    fixture_run(&f, 1);
}

static void error_passive(void) {
    fixture_active(&f);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_PASSIVE);
    fixture_run(&f, 1);
}

static void ai_bus_off(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_standby(&f);
    sim_hal_set_can_state(&f.hal, HAL_CAN_AI, HAL_CAN_BUS_OFF);
    fixture_run(&f, 1);
}

static void wrong_id_set(void) {
    fixture_start(&f);
    f.traffic[AGV_MSG_VEHICLE_STATUS].id = 0x203;
    fixture_run(&f, 600);
}

static void store_invalid(void) {
    fixture_standby(&f);
    f.store.keep_latch = true;
    TEST_ASSERT_TRUE(sim_store_corrupt_latch(&f.store, 0, 0x10));
    fixture_restart(&f, HAL_RESET_POWER_ON);
}

/* ---- The table ---- */

typedef struct {
    const char *name;
    bool trip;
    uint8_t led;
    void (*raise)(void);
} row_t;

/* By hand: the order is the rank. NULL: needs an input that the port does not have yet. */
static const row_t ROWS[] = {
    {"SELF_TEST_FAILED", true, 0, self_test_failed},
    {"MEMORY_CORRUPTED", true, 0, memory_corrupted},
    {"CONFIG_INVALID", true, 0, config_invalid},
    {"OUTPUT_FEEDBACK", true, 0, NULL},
    {"SUPERVISOR_RESET", true, 0, supervisor_reset},
    {"EMERGENCY_STOP", true, 0, NULL},
    {"TX_GATE_REFUSED", true, 0, tx_gate_refused},
    {"STEP_OVERRUN", true, 0, step_overrun},
    {"CLOCK_DEVIATION", true, 0, NULL},
    {"BUS_OFF", true, 14, bus_off},
    {"TX_STALLED", true, 14, tx_stalled},
    {"VCU_HEARTBEAT_LOST", true, 0, vcu_heartbeat_lost},
    {"VCU_HEARTBEAT_STUCK", true, 0, vcu_heartbeat_stuck},
    {"EPS_HEARTBEAT_LOST", true, 12, eps_heartbeat_lost},
    {"EPS_HEARTBEAT_STUCK", true, 12, eps_heartbeat_stuck},
    {"AI_HEARTBEAT_LOST", true, 14, ai_heartbeat_lost},
    {"AI_HEARTBEAT_STUCK", true, 14, ai_heartbeat_stuck},
    {"EPS_OVER_CURRENT_SHUTDOWN", true, 13, eps_over_current_shutdown},
    {"EPS_TEMP_ABOVE_120", true, 13, eps_temp_above_120},
    {"EPS_MOTOR_ENCODER", true, 13, eps_motor_encoder},
    {"EPS_POSITION_ENCODER", true, 13, eps_position_encoder},
    {"EPS_UNDER_VOLTAGE", true, 13, eps_under_voltage},
    {"EPS_OVER_VOLTAGE", true, 13, eps_over_voltage},
    {"EPS_EXCESSIVE_CURRENT", true, 13, eps_excessive_current},
    {"EPS_TEMP_ABOVE_110", false, 13, eps_temp_above_110},
    {"VCU_EPS_HARDWARE_FAULT", true, 13, vcu_eps_hardware_fault},
    {"VCU_EPS_CAN_BUS_FAULT", true, 12, vcu_eps_can_bus_fault},
    {"S_DRIVER_ALARM", true, 8, s_driver_alarm},
    {"REMOTE_SIGNAL_LOST", true, 17, remote_signal_lost},
    {"REMOTE_POWER_LOST", true, 16, remote_power_lost},
    {"VCU_AI_CAN_LOST", true, 14, vcu_ai_can_lost},
    {"VCU_LEVEL2_ALARM", false, 0, vcu_level2_alarm},
    {"MODE_INVALID", true, 0, mode_invalid},
    {"MODE_FLAPPING", true, 0, mode_flapping},
    {"MODE_NONE", true, 0, mode_none},
    {"EPS_STATUS_TIMEOUT", true, 12, eps_status_timeout},
    {"GEAR_STATUS_TIMEOUT", true, 8, gear_status_timeout},
    {"THROTTLE_STATUS_TIMEOUT", true, 7, throttle_status_timeout},
    {"WHEEL_SPEED_TIMEOUT", true, 8, wheel_speed_timeout},
    {"STEERING_POSITION_TIMEOUT", false, 12, steering_position_timeout},
    {"GEAR_COMMAND_TIMEOUT", true, 14, gear_command_timeout},
    {"THROTTLE_COMMAND_TIMEOUT", true, 14, throttle_command_timeout},
    {"STEERING_COMMAND_TIMEOUT", true, 14, steering_command_timeout},
    {"AI_COMMAND_OUT_OF_RANGE", true, 14, ai_command_out_of_range},
    {"EPS_MODE_OFF", true, 13, eps_mode_off},
    {"EPS_MODE_INVALID", true, 13, eps_mode_invalid},
    {"EPS_MODE_NOT_ANGLE", true, 13, eps_mode_not_angle},
    {"GEAR_STATUS_INVALID", true, 8, gear_status_invalid},
    {"THROTTLE_STATUS_INVALID", true, 7, throttle_status_invalid},
    {"STEERING_ANGLE_INVALID", true, 13, steering_angle_invalid},
    {"STEERING_DEVIATION", true, 13, steering_deviation},
    {"THROTTLE_DEVIATION", true, 7, throttle_deviation},
    {"GEAR_DEVIATION", true, 8, gear_deviation},
    {"AUTOPILOT_OFF_IGNORED", true, 0, autopilot_off_ignored},
    {"THROTTLE_IN_PARK", true, 7, throttle_in_park},
    {"FOREIGN_COMMAND_SENDER", true, 14, foreign_command_sender},
    {"SAFE_STATE_UNCONFIRMED", true, 0, safe_state_unconfirmed},
    {"VEHICLE_NOT_STOPPING", true, 0, vehicle_not_stopping},
    {"MOVING_WHILE_SAFE", true, 0, moving_while_safe},
    {"COMMAND_TOO_FAST", false, 14, command_too_fast},
    {"SPEED_IMPLAUSIBLE", false, 8, speed_implausible},
    {"STATUS_ID_IN_USE", false, 0, status_id_in_use},
    {"STARTUP_TIMEOUT", false, 0, startup_timeout},
    {"RX_OVERRUN", false, 14, rx_overrun},
    {"ERROR_PASSIVE", false, 14, error_passive},
    {"AI_BUS_OFF", false, 14, ai_bus_off},
    {"WRONG_ID_SET", false, 0, wrong_id_set},
    {"STORE_INVALID", false, 0, store_invalid},
};
enum { ROW_COUNT = sizeof ROWS / sizeof ROWS[0] };

/* Shows: FSM-5, LED-1, SUP-4 */
void test_names_ranks_classes_and_led_codes(void) {
    TEST_ASSERT_EQUAL_INT(ROW_COUNT, AGV_FAULT_COUNT);
    for (unsigned i = 0; i < ROW_COUNT; i++) {
        TEST_ASSERT_EQUAL_STRING(ROWS[i].name, agv_fault_name((agv_fault_t)i));
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(i, agv_fault_from_name(ROWS[i].name), ROWS[i].name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(ROWS[i].trip, agv_fault_is_in(&f.config.trips, i), ROWS[i].name);
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(ROWS[i].led, agv_fault_led_code(i), ROWS[i].name);
    }
}

/* These are raised in TRIPPED or SAFE: another fault was the first. */
static bool comes_after_a_trip(agv_fault_t fault) {
    return fault == AGV_FAULT_SAFE_STATE_UNCONFIRMED || fault == AGV_FAULT_VEHICLE_NOT_STOPPING ||
           fault == AGV_FAULT_MOVING_WHILE_SAFE;
}

static void expect_raised(agv_fault_t fault, const row_t *row) {
    agv_event_t event;
    TEST_ASSERT_TRUE_MESSAGE(fixture_last_raised(&f, fault, &event), row->name);
    TEST_ASSERT_EQUAL_INT_MESSAGE(row->trip ? AGV_CLASS_TRIP : AGV_CLASS_WARN, event.b, row->name);
    const agv_state_t state = agv_supervisor_state(&f.supervisor);
    TEST_ASSERT_EQUAL_INT_MESSAGE(row->trip, state == AGV_STATE_TRIPPED || state == AGV_STATE_SAFE, row->name);
    if (!row->trip) {
        expect_reason(&f, AGV_FAULT_NONE);
    } else if (!comes_after_a_trip(fault)) {
        expect_reason(&f, fault);
    } else {
        expect_reason(&f, AGV_FAULT_S_DRIVER_ALARM);
        expect_output(&f, false);
    }
}

/* Shows: SELF_TEST_FAILED, MEMORY_CORRUPTED, CONFIG_INVALID, SUPERVISOR_RESET, TX_GATE_REFUSED, STEP_OVERRUN,
   BUS_OFF, TX_STALLED, VCU_HEARTBEAT_LOST, VCU_HEARTBEAT_STUCK, EPS_HEARTBEAT_LOST, EPS_HEARTBEAT_STUCK,
   AI_HEARTBEAT_LOST, AI_HEARTBEAT_STUCK, EPS_OVER_CURRENT_SHUTDOWN, EPS_TEMP_ABOVE_120, EPS_MOTOR_ENCODER,
   EPS_POSITION_ENCODER, EPS_UNDER_VOLTAGE, EPS_OVER_VOLTAGE, EPS_EXCESSIVE_CURRENT, EPS_TEMP_ABOVE_110,
   VCU_EPS_HARDWARE_FAULT, VCU_EPS_CAN_BUS_FAULT, S_DRIVER_ALARM, REMOTE_SIGNAL_LOST, REMOTE_POWER_LOST,
   VCU_AI_CAN_LOST, VCU_LEVEL2_ALARM, MODE_INVALID, MODE_FLAPPING, MODE_NONE, EPS_STATUS_TIMEOUT,
   GEAR_STATUS_TIMEOUT, THROTTLE_STATUS_TIMEOUT, WHEEL_SPEED_TIMEOUT, STEERING_POSITION_TIMEOUT,
   GEAR_COMMAND_TIMEOUT, THROTTLE_COMMAND_TIMEOUT, STEERING_COMMAND_TIMEOUT, AI_COMMAND_OUT_OF_RANGE, EPS_MODE_OFF,
   EPS_MODE_INVALID, EPS_MODE_NOT_ANGLE, GEAR_STATUS_INVALID, THROTTLE_STATUS_INVALID, STEERING_ANGLE_INVALID,
   STEERING_DEVIATION, THROTTLE_DEVIATION, GEAR_DEVIATION, AUTOPILOT_OFF_IGNORED, THROTTLE_IN_PARK,
   FOREIGN_COMMAND_SENDER, SAFE_STATE_UNCONFIRMED, VEHICLE_NOT_STOPPING, MOVING_WHILE_SAFE, COMMAND_TOO_FAST,
   SPEED_IMPLAUSIBLE, STATUS_ID_IN_USE, STARTUP_TIMEOUT, RX_OVERRUN, ERROR_PASSIVE, AI_BUS_OFF, WRONG_ID_SET,
   STORE_INVALID */
void test_each_is_raised_as_what_it_is(void) {
    unsigned raised = 0;
    for (unsigned i = 0; i < ROW_COUNT; i++) {
        if (ROWS[i].raise != NULL) {
            fixture_init(&f);
            f.what = ROWS[i].name;
            f.long_run = true;
            ROWS[i].raise();
            expect_raised((agv_fault_t)i, &ROWS[i]);
            raised++;
        }
    }
    TEST_ASSERT_EQUAL_UINT32(ROW_COUNT - 3, raised);
}

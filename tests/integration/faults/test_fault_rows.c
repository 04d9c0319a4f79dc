/* Every fault of the table: name, rank, default class and LED code, by hand. Faults that no other test of this folder and
 * its neighbours raises with its class are raised here. */
#include <stddef.h>
#include <string.h>

#include "agv/names.h"
#include "causes.h"
#include "one_fixture.h"
#include "walk.h"

/* ---- Causes ---- */

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

/* While 43Fh is sent, a bit flips in the waiting 065h (5B 2A). */
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

static void ai_heartbeat_stuck(void) {
    fixture_active(&f);
    f.traffic[AGV_MSG_TURN_SIGNAL_COMMAND].frozen = true;
    fixture_run(&f, 500);
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

static void steering_deviation(void) {
    fixture_active(&f);
    fixture_command_angle(&f, ANGLE_CENTRE + 501);
    fixture_run(&f, 600);
}

static void gear_deviation(void) {
    fixture_active(&f);
    fixture_throttle(&f, 3);
    /* the command is P, the status D */ fixture_run(&f, 1100);
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

static void wrong_id_set(void) {
    fixture_start(&f);
    f.traffic[AGV_MSG_VEHICLE_STATUS].id = 0x203;
    fixture_run(&f, 600);
}

/* ---- The table ---- */

typedef void raise_fn(void);

static raise_fn *const RAISE[FAULT_ROWS] = {
    [AGV_FAULT_SELF_TEST_FAILED] = self_test_failed,
    [AGV_FAULT_MEMORY_CORRUPTED] = memory_corrupted,
    [AGV_FAULT_CONFIG_INVALID] = config_invalid,
    [AGV_FAULT_SUPERVISOR_RESET] = supervisor_reset,
    [AGV_FAULT_TX_GATE_REFUSED] = tx_gate_refused,
    [AGV_FAULT_AI_HEARTBEAT_STUCK] = ai_heartbeat_stuck,
    [AGV_FAULT_MODE_FLAPPING] = mode_flapping,
    [AGV_FAULT_MODE_NONE] = mode_none,
    [AGV_FAULT_STEERING_DEVIATION] = steering_deviation,
    [AGV_FAULT_GEAR_DEVIATION] = gear_deviation,
    [AGV_FAULT_FOREIGN_COMMAND_SENDER] = foreign_command_sender,
    [AGV_FAULT_SAFE_STATE_UNCONFIRMED] = safe_state_unconfirmed,
    [AGV_FAULT_VEHICLE_NOT_STOPPING] = vehicle_not_stopping,
    [AGV_FAULT_MOVING_WHILE_SAFE] = moving_while_safe,
    [AGV_FAULT_COMMAND_TOO_FAST] = command_too_fast,
    [AGV_FAULT_SPEED_IMPLAUSIBLE] = speed_implausible,
    [AGV_FAULT_STATUS_ID_IN_USE] = status_id_in_use,
    [AGV_FAULT_WRONG_ID_SET] = wrong_id_set,
};

/* Shows: FSM-5, LED-1, SUP-4 */
void test_names_ranks_classes_and_led_codes(void) {
    TEST_ASSERT_EQUAL_INT(FAULT_ROWS, AGV_FAULT_COUNT);
    for (unsigned i = 0; i < FAULT_ROWS; i++) {
        TEST_ASSERT_EQUAL_STRING(FAULT_ROW[i].name, agv_fault_name((agv_fault_t)i));
        TEST_ASSERT_EQUAL_UINT32_MESSAGE(i, agv_fault_from_name(FAULT_ROW[i].name), FAULT_ROW[i].name);
        TEST_ASSERT_EQUAL_INT_MESSAGE(FAULT_ROW[i].trip, agv_fault_is_in(&f.config.trips, i), FAULT_ROW[i].name);
        TEST_ASSERT_EQUAL_UINT8_MESSAGE(FAULT_ROW[i].led, agv_fault_led_code(i), FAULT_ROW[i].name);
    }
}

/* These are raised in TRIPPED or SAFE: another fault was the first. */
static bool comes_after_a_trip(agv_fault_t fault) {
    return fault == AGV_FAULT_SAFE_STATE_UNCONFIRMED || fault == AGV_FAULT_VEHICLE_NOT_STOPPING ||
           fault == AGV_FAULT_MOVING_WHILE_SAFE;
}

static void expect_raised(agv_fault_t fault, const fault_row_t *row) {
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

/* Shows: SELF_TEST_FAILED, MEMORY_CORRUPTED, CONFIG_INVALID, SUPERVISOR_RESET, TX_GATE_REFUSED, AI_HEARTBEAT_STUCK,
   MODE_FLAPPING, MODE_NONE, STEERING_DEVIATION, GEAR_DEVIATION, FOREIGN_COMMAND_SENDER, SAFE_STATE_UNCONFIRMED,
   VEHICLE_NOT_STOPPING, MOVING_WHILE_SAFE, COMMAND_TOO_FAST, SPEED_IMPLAUSIBLE, STATUS_ID_IN_USE, WRONG_ID_SET */
void test_each_is_raised_with_its_class(void) {
    unsigned raised = 0;
    for (unsigned i = 0; i < FAULT_ROWS; i++) {
        if (RAISE[i] != NULL) {
            fixture_init(&f);
            f.what = FAULT_ROW[i].name;
            f.long_run = true;
            RAISE[i]();
            expect_raised((agv_fault_t)i, &FAULT_ROW[i]);
            raised++;
        }
    }
    TEST_ASSERT_EQUAL_UINT32(18, raised);
}

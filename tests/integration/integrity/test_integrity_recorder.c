/* The flight recorder: its content, the resets that it outlives, and its copy in flash. */
#include <stddef.h>
#include <string.h>

#include "one_fixture.h"
#include "walk.h"

static uint32_t next_sequence(void) {
    return agv_recorder_next_sequence(&f.recorder);
}

static bool is_there(uint32_t sequence) {
    agv_event_t event;
    return agv_recorder_get(&f.recorder, sequence, &event);
}

static agv_event_t event_at(uint32_t sequence) {
    agv_event_t event = {0};
    TEST_ASSERT_TRUE(agv_recorder_get(&f.recorder, sequence, &event));
    TEST_ASSERT_EQUAL_UINT32(sequence, event.sequence);
    return event;
}

/* A warning comes and goes: two events, of the four that one fault may have in a second. */
static void two_events(void) {
    uint8_t *level2 = &f.traffic[AGV_MSG_VEHICLE_STATUS].data[5];
    *level2 = 1;
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    *level2 = 0;
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
}

/* This many of them, all recorded. */
static void events(unsigned pairs) {
    for (unsigned i = 0; i < pairs; i++) {
        fixture_run(&f, 500);
        two_events();
    }
}

/* ---- Content ---- */

/* Shows: INT-3, FSM-5 */
void test_an_event_has_time_state_and_reason(void) {
    fixture_active(&f);
    const uint32_t first = next_sequence();
    walk_trip(&f);
    const agv_event_t raised = event_at(first);
    TEST_ASSERT_EQUAL_UINT32(f.now_ms, raised.time_ms);
    TEST_ASSERT_EQUAL_UINT8(AGV_EVENT_FAULT, raised.kind);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_S_DRIVER_ALARM, raised.a);
    TEST_ASSERT_EQUAL_UINT8(AGV_CLASS_TRIP, raised.b);
    TEST_ASSERT_EQUAL_UINT8(1, raised.c);
    TEST_ASSERT_EQUAL_UINT16(0, raised.missing);
    const agv_event_t tripped = event_at(first + 1);
    TEST_ASSERT_EQUAL_UINT8(AGV_EVENT_STATE, tripped.kind);
    TEST_ASSERT_EQUAL_HEX8(AGV_STATE_ACTIVE, tripped.a);
    TEST_ASSERT_EQUAL_HEX8(AGV_STATE_TRIPPED, tripped.b);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_S_DRIVER_ALARM, tripped.c);
    TEST_ASSERT_EQUAL_HEX8(AGV_STATE_TRIPPED, tripped.state);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_S_DRIVER_ALARM, tripped.first_reason);
    TEST_ASSERT_EQUAL_UINT32(first + 2, next_sequence()); /* these two and no other */
}

/* Shows: INT-3, FSM-4 */
void test_the_safety_output_is_recorded_when_it_closes_and_opens(void) {
    agv_event_t event = {0};
    fixture_standby(&f);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_events(&f, AGV_EVENT_OUTPUT, 1, ANY, &event));
    TEST_ASSERT_EQUAL_UINT32(f.now_ms, event.time_ms);
    TEST_ASSERT_EQUAL_HEX8(AGV_STATE_STANDBY, event.state);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_events(&f, AGV_EVENT_OUTPUT, 0, ANY, &event)); /* at the start */
    TEST_ASSERT_EQUAL_UINT8(0, event.b);                                               /* no further parameter */
    TEST_ASSERT_EQUAL_UINT8(0, event.c);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    fixture_run(&f, 500);
    TEST_ASSERT_EQUAL_UINT32(2, fixture_events(&f, AGV_EVENT_OUTPUT, 0, ANY, &event));
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_BUS_OFF, event.first_reason);
    TEST_ASSERT_EQUAL_UINT8(0, event.b);
    TEST_ASSERT_EQUAL_UINT8(0, event.c);
}

/* Shows: INT-3 */
void test_an_event_holds_the_last_payload_of_each_message(void) {
    /* a byte of each message that may have any value (101h: 0.01 m/s) */
    static const uint8_t FREE[AGV_MSG_COUNT] = {1, 3, 4, 5, 2, 6, 7, 5, 1, 7, 0};
    fixture_active(&f);
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        f.traffic[i].data[FREE[i]] = (uint8_t)(i + 1);
        fixture_send_now(&f, (agv_message_t)i);
    }
    const uint32_t sequence = next_sequence();
    walk_alarm(&f, ALARM_S_DRIVER);
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    const agv_event_t event = event_at(sequence);
    TEST_ASSERT_EQUAL_HEX16(0x7FF, event.seen);
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        TEST_ASSERT_EQUAL_HEX8_ARRAY(f.traffic[i].data, event.frames[i], 8);
    }
}

/* Shows: INT-3 */
void test_a_message_that_was_not_received_is_not_in_the_snapshot(void) {
    f.traffic[AGV_MSG_STEERING_POSITION].muted = true;
    fixture_mute_ai(&f, true);
    fixture_standby(&f);
    walk_trip(&f);
    const agv_event_t event = event_at(next_sequence() - 1);
    TEST_ASSERT_EQUAL_HEX16(0x7FF & ~0x20F, event.seen); /* bits 0..3: the commands; bit 9: 267h */
}

/* ---- Resets ---- */

/* Shows: INT-3, FSM-7 */
void test_events_outlive_a_restart(void) {
    walk_to_safe(&f);
    const uint32_t before = next_sequence();
    const agv_event_t last = event_at(before - 1);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    TEST_ASSERT_TRUE(next_sequence() > before);
    for (uint32_t i = 0; i < before; i++) {
        TEST_ASSERT_TRUE(is_there(i));
    }
    const agv_event_t first = event_at(before);
    TEST_ASSERT_EQUAL_UINT8(AGV_EVENT_STATE, first.kind);
    TEST_ASSERT_EQUAL_HEX8(0, first.a); /* a run starts here */
    TEST_ASSERT_EQUAL_HEX8(AGV_STATE_TRIPPED, first.b);
    TEST_ASSERT_EQUAL_UINT8((uint8_t)(last.run + 1), first.run);
    TEST_ASSERT_EQUAL_HEX16(0, first.seen);
}

/* ---- Flash ---- */

static uint32_t appended(void) {
    return f.hal.op_calls[SIM_HAL_OP_STORE_APPEND];
}

/* Longer than one write a second needs. */
static void expect_not_written(agv_state_t state) {
    const uint32_t before = appended();
    for (unsigned i = 0; i < 50; i++) {
        two_events();
        fixture_run(&f, 100);
    }
    expect_state(&f, state);
    TEST_ASSERT_EQUAL_UINT32(before, appended());
}

/* Shows: INT-3 */
void test_flash_is_not_written_in_init_active_and_tripped(void) {
    fixture_mode(&f, MODE_NEITHER);
    fixture_start(&f);
    expect_not_written(AGV_STATE_INIT);
    fixture_init(&f);
    fixture_active(&f);
    expect_not_written(AGV_STATE_ACTIVE);
    fixture_init(&f);
    walk_to_tripped(&f);
    expect_not_written(AGV_STATE_TRIPPED);
}

/* Nothing is written from now on. */
static void drive_on(void) {
    fixture_wheels(&f, 800, 800);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
}

/* Shows: INT-3 */
void test_flash_is_written_in_standby_at_standstill_only(void) {
    fixture_standby(&f);
    drive_on();
    const uint32_t before = appended();
    expect_not_written(AGV_STATE_STANDBY);
    fixture_wheels(&f, 0, 0);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    fixture_run(&f, 99);
    TEST_ASSERT_EQUAL_UINT32(before, appended());
    fixture_run(&f, 1); /* the unused writes */
    TEST_ASSERT_EQUAL_UINT32(before + 1, appended());
    fixture_run(&f, 40000);
    TEST_ASSERT_EQUAL_UINT32(next_sequence(), appended());
}

static void expect_log_holds(uint32_t count) {
    agv_event_t stored;
    for (uint32_t i = 0; i < count; i++) {
        const agv_event_t event = event_at(i);
        TEST_ASSERT_EQUAL_UINT32(sizeof stored, sim_store_read_record(&f.store, i, &stored, sizeof stored));
        TEST_ASSERT_EQUAL_MEMORY(&event, &stored, sizeof stored);
    }
    TEST_ASSERT_EQUAL_UINT32(count, f.store.count);
}

/* Shows: INT-3 */
void test_in_safe_each_event_is_copied_once_and_in_order(void) {
    walk_to_safe(&f);
    fixture_run(&f, 20000);
    expect_log_holds(next_sequence());
    fixture_restart(&f, HAL_RESET_WATCHDOG); /* RAM has the number of the last event in flash */
    expect_state_after(&f, 20000, AGV_STATE_SAFE);
    expect_log_holds(next_sequence());
}

/* A VCU that engages P at speed. */
static void safe_while_driving(void) {
    walk_to_tripped_driving(&f, 3000);
    fixture_vehicle_confirms(&f);
    fixture_drive(&f, 3000);
    (void)walk_until(&f, AGV_STATE_SAFE, 100);
}

/* Shows: INT-3 */
void test_in_safe_flash_is_not_written_before_standstill(void) {
    safe_while_driving();
    const uint32_t before = appended();
    expect_state_after(&f, 4000, AGV_STATE_SAFE);
    TEST_ASSERT_EQUAL_UINT32(before, appended());
    fixture_drive(&f, 0);
    expect_state_after(&f, 20000, AGV_STATE_SAFE);
    TEST_ASSERT_EQUAL_UINT32(next_sequence(), appended());
}

/* The speed in 363h hangs at 2000 m/h, 0.56 m/s: no standstill, and not enough to contradict the wheels. */
/* Shows: INT-3 */
void test_in_safe_flash_is_written_when_the_wheels_stand_without_standstill(void) {
    safe_while_driving();
    fixture_wheels(&f, 0, 0);
    fixture_speed(&f, 2000);
    expect_state_after(&f, 20000, AGV_STATE_SAFE);
    TEST_ASSERT_TRUE(agv_supervisor_output_closed(&f.supervisor));
    TEST_ASSERT_EQUAL_UINT32(next_sequence(), appended());
}

/* The output opens 5 s after the trip (FSM-12). */
/* Shows: INT-3 */
void test_in_safe_flash_is_written_when_the_output_is_open(void) {
    safe_while_driving();
    const uint32_t before = appended();
    agv_event_t trip = {0};
    TEST_ASSERT_TRUE(agv_recorder_get_trip(&f.recorder, 0, &trip));
    walk_run_to(&f, trip.time_ms + 4999);
    TEST_ASSERT_EQUAL_UINT32(before, appended());
    TEST_ASSERT_TRUE(agv_supervisor_output_closed(&f.supervisor));
    fixture_run(&f, 1);
    TEST_ASSERT_FALSE(agv_supervisor_output_closed(&f.supervisor));
    TEST_ASSERT_EQUAL_UINT32(before + 1, appended());
    expect_state_after(&f, 20000, AGV_STATE_SAFE);
    TEST_ASSERT_EQUAL_UINT32(next_sequence(), appended());
}

/* Shows: INT-3 */
void test_a_flash_that_accepts_nothing_changes_nothing_else(void) {
    walk_to_safe(&f);
    sim_store_fail_writes(&f.store, UINT32_MAX);
    for (unsigned i = 0; i < 30; i++) {
        two_events();
        fixture_run(&f, 100);
    }
    expect_state(&f, AGV_STATE_SAFE);
    TEST_ASSERT_EQUAL_UINT32(0, f.hal.bites);
    TEST_ASSERT_TRUE(is_there(next_sequence() - 1));
}

/* Later events and a restart do not replace it. */
/* Shows: INT-3, FSM-5 */
void test_a_trip_is_kept_after_the_reset(void) {
    agv_event_t trip = {0};
    fixture_standby(&f);
    TEST_ASSERT_FALSE(agv_recorder_get_trip(&f.recorder, 0, &trip));
    fixture_init(&f);
    walk_to_safe(&f);
    walk_reset(&f, 1050);
    events(200);
    TEST_ASSERT_FALSE(is_there(0));
    fixture_restart(&f, HAL_RESET_POWER_ON);
    TEST_ASSERT_TRUE(agv_recorder_get_trip(&f.recorder, 0, &trip));
    TEST_ASSERT_EQUAL_HEX8(AGV_STATE_TRIPPED, trip.b);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_S_DRIVER_ALARM, trip.c);
    TEST_ASSERT_EQUAL_HEX16(0x7FF, trip.seen);
}

/* The head of the recorder: sequence numbers, received messages, last payloads. The supervisor does not depend on it. */
/* Shows: INT-5, INT-3 */
void test_a_flipped_bit_in_the_head_of_the_recorder_changes_no_decision(void) {
    const size_t head = offsetof(agv_recorder_t, events);
    for (unsigned bit = 0; bit < 8 * head; bit += 101) {
        setUp();
        walk_to_safe(&f);
        ((uint8_t *)&f.recorder)[bit / 8] ^= (uint8_t)(1u << (bit % 8));
        expect_state_after(&f, 20, AGV_STATE_SAFE);
        walk_reset(&f, 1050);
    }
}

/* A change back to TRIPPED after a withdrawn confirmation is the same trip. */
/* Shows: INT-3, FSM-5 */
void test_a_confirmation_that_comes_and_goes_is_no_trip(void) {
    agv_event_t event = {0};
    walk_to_safe(&f);
    for (unsigned i = 0; i < 5; i++) {
        fixture_gear(&f, GEAR_D);
        expect_state_after(&f, 50, AGV_STATE_TRIPPED);
        fixture_gear(&f, GEAR_P);
        fixture_run(&f, 50);
    }
    TEST_ASSERT_TRUE(agv_recorder_get_trip(&f.recorder, 0, &event));
    TEST_ASSERT_FALSE(agv_recorder_get_trip(&f.recorder, 1, &event));
}

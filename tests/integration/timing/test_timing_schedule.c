/* Periodic sending, slots that are skipped, and silence for longer than the clock's range. */
#include "one_fixture.h"
#include "walk.h"

static uint32_t skipped(void) {
    return agv_supervisor_counters(&f.supervisor)->skipped_slots;
}

/* A sender of the same identifier in step with the supervisor would collide with each of its frames. */
/* Shows: TIM-1, SUP-7, ERROR_PASSIVE */
void test_while_error_passive_each_cycle_is_3_ms_longer(void) {
    walk_to_tripped(&f);
    const uint32_t trip_ms = f.now_ms;
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_PASSIVE);
    fixture_forget_sent(&f);
    fixture_run(&f, 210);
    TEST_ASSERT_EQUAL_UINT32(203, fixture_nth_sent(&f, 0x43F, 1)->time_ms - trip_ms);
    TEST_ASSERT_EQUAL_UINT32(169, fixture_nth_sent(&f, 0x168, 1)->time_ms - trip_ms);
    TEST_ASSERT_EQUAL_UINT32(136, fixture_nth_sent(&f, 0x075, 1)->time_ms - trip_ms);
    TEST_ASSERT_EQUAL_UINT32(53, fixture_nth_sent(&f, 0x065, 1)->time_ms - trip_ms);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    fixture_forget_sent(&f);
    fixture_run(&f, 200);
    TEST_ASSERT_EQUAL_UINT32(306, fixture_nth_sent(&f, 0x43F, 0)->time_ms - trip_ms);
    TEST_ASSERT_EQUAL_UINT32(406, fixture_nth_sent(&f, 0x43F, 1)->time_ms - trip_ms);
    TEST_ASSERT_EQUAL_UINT32(0, skipped());
}

/* Slots in states that send nothing do not count as skipped. */
/* Shows: TIM-1 */
void test_nothing_is_skipped_in_normal_operation(void) {
    fixture_active(&f);
    fixture_run(&f, 3000);
    walk_trip(&f);
    fixture_run(&f, 3000);
    fixture_vehicle_confirms(&f);
    fixture_run(&f, 1000);
    TEST_ASSERT_EQUAL_UINT32(0, skipped());
}

/* ---- Longer than the clock: 2^32 ms ---- */

/* Ticks only, in steps of 1000 s, to 300 ms before a full wrap of the clock; then every millisecond. */
static void go_round_the_clock(uint32_t since_ms, void (*look)(void)) {
    const uint32_t before_ms = since_ms - 300;
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    while (before_ms - f.now_ms > 1000000) {
        fixture_jump(&f, 1000000);
        look();
        fixture_forget_sent(&f);
    }
    fixture_jump(&f, before_ms - f.now_ms);
    for (unsigned i = 0; i < 900; i++) {
        fixture_jump(&f, 1);
        look();
    }
}

static void expect_still_in_init(void) {
    agv_event_t event;
    expect_state(&f, AGV_STATE_INIT);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_events(&f, AGV_EVENT_STARTUP, 0, ANY, &event));
    expect_fault(&f, AGV_FAULT_STARTUP_TIMEOUT, true);
}

/* Shows: TIM-2, STARTUP_TIMEOUT */
void test_init_without_a_vehicle_for_longer_than_the_clock(void) {
    fixture_mute_vcu(&f, true);
    fixture_mute_eps(&f, true);
    fixture_mute_ai(&f, true);
    f.long_run = true;
    fixture_start(&f);
    const uint32_t start_ms = f.now_ms;
    fixture_run(&f, 10100);
    expect_still_in_init();
    go_round_the_clock(start_ms, expect_still_in_init);
}

/* All messages once, then a tick, every 1000 s: fresh at every tick. */
static void look_in(uint32_t ms) {
    f.now_ms += ms;
    f.elapsed_ms += ms;
    sim_hal_set_now_ms(&f.hal, f.now_ms);
    for (unsigned message = AGV_MSG_VEHICLE_STATUS; message < AGV_MSG_COUNT; message++) {
        fixture_send_now(&f, (agv_message_t)message);
    }
    fixture_jump(&f, 0);
}

/* Shows: TIM-2, FSM-3 */
void test_a_vehicle_that_stands_in_safe_for_longer_than_the_clock_can_be_reset(void) {
    walk_to_safe(&f);
    f.long_run = true;
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    for (unsigned i = 0; i < 5000; i++) {
        look_in(1000000);
        expect_state(&f, AGV_STATE_SAFE);
    }
    fixture_run(&f, 1500);
    walk_reset(&f, 1050);
}

/* 065h is due 25 ms and 50 ms after the trip, 075h 33 ms: a step 60 ms after it skips one slot, although nothing is sent. */
/* Shows: TIM-1, SUP-7 */
void test_a_slot_that_a_late_step_skips_in_bus_off_is_counted(void) {
    f.config.eps_heartbeat_timeout_ms = 100;
    f.config.eps_status_timeout_ms = 100;
    walk_to_tripped(&f);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    fixture_run(&f, 1);
    const uint32_t before = skipped();
    fixture_jump(&f, 59);
    TEST_ASSERT_EQUAL_UINT32(before + 1, skipped());
}

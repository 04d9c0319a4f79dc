/* The alarm LED, millisecond by millisecond. */
#include "one_fixture.h"
#include "walk.h"

/* ---- Priority of faults ---- */

/* Shows: LED-1, FSM-5 */
void test_a_latched_trip_is_shown_until_the_reset(void) {
    f.long_run = true;
    walk_to_safe(&f);
    expect_state_after(&f, 20000, AGV_STATE_SAFE);
    expect_led(&f, 8);
    walk_reset(&f, 1050);
    expect_led_after(&f, 1, 0);
}

/* At once, also where a lost AI computer has the same class in manual as when engaged. */
/* Shows: LED-1, FSM-7 */
void test_a_latch_that_was_kept_is_shown_from_the_start(void) {
    f.config.ai_lost_in_manual = AGV_AI_LOST_TRIP;
    fixture_standby(&f);
    walk_trip(&f);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    expect_led(&f, 8);
}

/* The AI side's bus-off, a trip by choice, outlives the reset and trips with the engagement. It ends in the next tick. */
/* Shows: LED-1, FSM-11, AI_BUS_OFF */
void test_a_trip_of_one_instant_is_shown(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.config.ai_lost_in_manual = AGV_AI_LOST_TRIP;
    agv_fault_set_put(&f.config.trips, AGV_FAULT_AI_BUS_OFF, true);
    f.long_run = true;
    fixture_active(&f);
    walk_trip(&f);
    fixture_vehicle_confirms(&f);
    sim_hal_set_can_state(&f.hal, HAL_CAN_AI, HAL_CAN_BUS_OFF);
    expect_state_after(&f, 1000, AGV_STATE_SAFE);
    walk_reset(&f, 1050);
    expect_led_after(&f, 500, 14);
    walk_report(&f, MODE_ENGAGED);
    expect_tripped(&f, AGV_FAULT_AI_BUS_OFF);
    sim_hal_set_can_state(&f.hal, HAL_CAN_AI, HAL_CAN_ERROR_ACTIVE);
    fixture_jump(&f, 1); /* no frame in between */
    expect_fault(&f, AGV_FAULT_AI_BUS_OFF, false);
    expect_led_after(&f, 100, 14);
}

/* ---- Timing of the pattern ---- */

/* Shows: LED-1 */
void test_the_led_is_switched_when_it_changes_only(void) {
    fixture_standby(&f);
    fixture_run(&f, 10);
    const uint32_t calls = f.hal.op_calls[SIM_HAL_OP_LED_SET];
    fixture_run(&f, 10000);
    TEST_ASSERT_EQUAL_UINT32(calls + 10, f.hal.op_calls[SIM_HAL_OP_LED_SET]);
}

/* Shows: TOP-4, LED-1 */
void test_the_led_shows_shadow_mode(void) {
    unsigned lit_ms = 0;
    f.config.shadow = AGV_SHADOW_ON;
    fixture_standby(&f);
    for (unsigned ms = 0; ms < 2000; ms++) {
        fixture_run(&f, 1);
        lit_ms += f.hal.led.on ? 1 : 0;
    }
    TEST_ASSERT_TRUE(lit_ms > 0 && lit_ms < 500); /* healthy would be 1000 */
}

/* Shows: LED-1 */
void test_healthy_is_1_s_on_and_1_s_off(void) {
    fixture_start(&f);
    TEST_ASSERT_TRUE(f.hal.led.on); /* the pattern begins with the start */
    for (unsigned ms = 1; ms < 7000; ms++) {
        fixture_run(&f, 1);
        TEST_ASSERT_EQUAL_INT(ms % 2000 < 1000, f.hal.led.on);
    }
    expect_led(&f, 0);
}

/* Silence for longer than the clock's 49.7 days (TIM-2): an expired deadline stays expired when its age wraps. (The
 * silence of the VCU ends the engagement and the faults that count only while engaged.) The clock jumps in steps of the
 * longest watchdog period, but runs in milliseconds where ages wrap. */
#include "expect.h"
#include "unity.h"

static fixture_t f;

void setUp(void) {
    fixture_init(&f);
    f.long_run = true; /* more frames are sent than the log holds */
    f.config.watchdog_period_ms = 1000;
}

static const agv_fault_t SILENCES[] = {AGV_FAULT_VCU_HEARTBEAT_LOST,     AGV_FAULT_EPS_HEARTBEAT_LOST,
                                       AGV_FAULT_AI_HEARTBEAT_LOST,      AGV_FAULT_EPS_STATUS_TIMEOUT,
                                       AGV_FAULT_GEAR_STATUS_TIMEOUT,    AGV_FAULT_THROTTLE_STATUS_TIMEOUT,
                                       AGV_FAULT_WHEEL_SPEED_TIMEOUT,    AGV_FAULT_VEHICLE_NOT_STOPPING,
                                       AGV_FAULT_SAFE_STATE_UNCONFIRMED, AGV_FAULT_STEERING_POSITION_TIMEOUT};
enum { SILENCE_COUNT = sizeof SILENCES / sizeof SILENCES[0] };

static void expect_silences(void) {
    for (unsigned i = 0; i < SILENCE_COUNT; i++) {
        expect_fault(&f, SILENCES[i], true);
    }
}

static void fall_silent(void) {
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    fixture_mute_vcu(&f, true);
    fixture_mute_eps(&f, true);
    fixture_mute_ai(&f, true);
}

/* Run in milliseconds until this time after the given one, modulo a full wrap of the clock. */
static void run_until_after(uint32_t since_ms, uint32_t after_ms) {
    while (f.now_ms - since_ms != after_ms) {
        fixture_run(&f, 1);
        expect_silences();
    }
}

/* No event is recorded in that time. */
static void wait_for_49_7_days(uint32_t since_ms) {
    const uint32_t recorded = agv_recorder_next_sequence(&f.recorder);
    while (UINT32_MAX - (f.now_ms - since_ms) > 2000) {
        fixture_jump(&f, 1000);
    }
    run_until_after(since_ms, 100);
    TEST_ASSERT_EQUAL_UINT32(recorded, agv_recorder_next_sequence(&f.recorder));
}

/* 100 ms after all ages wrapped, the other set's 43Fh is received. The own 43Fh is silent for 49.7 days, not for 100
 * ms. */
/* Shows: TIM-2, SUP-2, SUP-3, WRONG_ID_SET */
void test_silence_of_more_than_49_7_days(void) {
    fixture_active(&f);
    fixture_wheels(&f, 800, 800);
    fixture_run(&f, 20);
    const uint32_t silent_ms = f.now_ms;
    fall_silent();
    fixture_run(&f, 6000);
    wait_for_49_7_days(silent_ms);
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x201, .length = 8});
    expect_fault_after(&f, 1, AGV_FAULT_WRONG_ID_SET, true);
    run_until_after(silent_ms, 2000);
    for (unsigned i = 0; i < SILENCE_COUNT; i++) {
        TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, SILENCES[i]));
    }
    expect_tripped(&f, AGV_FAULT_VCU_HEARTBEAT_LOST);
    expect_output(&f, false);
}

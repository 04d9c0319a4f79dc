/* Silence that lasts longer than the clock's 49.7 days stays silence (TIM-2): nothing that has expired un-expires when
 * its age wraps. The clock jumps in steps of the longest watchdog period, but goes by milliseconds where ages wrap. */
#include "expect.h"
#include "unity.h"

static fixture_t f;

void setUp(void) {
    fixture_init(&f);
    f.long_run = true; /* more is sent than the log holds */
    f.config.watchdog_period_ms = 1000;
}

void tearDown(void) {
}

enum { BEFORE_MS = 2000, AROUND_MS = 4000 };

static void fall_silent(void) {
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    fixture_mute_vcu(&f, true);
    fixture_mute_eps(&f, true);
    fixture_mute_ai(&f, true);
}

/* From now on 2^32 ms and a bit more. Nothing is recorded in all that time. */
static void wait_for_49_7_days(void) {
    const uint32_t since_ms = f.now_ms;
    const uint32_t recorded = agv_recorder_next_sequence(&f.recorder);
    const agv_fault_set_t active = agv_supervisor_active_faults(&f.supervisor);
    while (UINT32_MAX - (f.now_ms - since_ms) > BEFORE_MS) {
        fixture_jump(&f, 1000);
    }
    for (unsigned i = 0; i < AROUND_MS; i++) {
        fixture_run(&f, 1);
        TEST_ASSERT_EQUAL_UINT64(active, agv_supervisor_active_faults(&f.supervisor));
    }
    TEST_ASSERT_TRUE(f.now_ms - since_ms < AROUND_MS); /* it has wrapped */
    TEST_ASSERT_EQUAL_UINT32(recorded, agv_recorder_next_sequence(&f.recorder));
}

/* Shows: TIM-2, SUP-2, SUP-3 */
void test_silence_while_engaged(void) {
    static const agv_fault_t SILENCES[] = {
        AGV_FAULT_VCU_HEARTBEAT_LOST,       AGV_FAULT_EPS_HEARTBEAT_LOST,     AGV_FAULT_AI_HEARTBEAT_LOST,
        AGV_FAULT_EPS_STATUS_TIMEOUT,       AGV_FAULT_GEAR_STATUS_TIMEOUT,    AGV_FAULT_THROTTLE_STATUS_TIMEOUT,
        AGV_FAULT_WHEEL_SPEED_TIMEOUT,      AGV_FAULT_GEAR_COMMAND_TIMEOUT,   AGV_FAULT_THROTTLE_COMMAND_TIMEOUT,
        AGV_FAULT_STEERING_COMMAND_TIMEOUT, AGV_FAULT_SAFE_STATE_UNCONFIRMED, AGV_FAULT_STEERING_POSITION_TIMEOUT};
    fixture_active(&f);
    fall_silent();
    fixture_run(&f, 1000);
    wait_for_49_7_days();
    for (unsigned i = 0; i < sizeof SILENCES / sizeof SILENCES[0]; i++) {
        expect_fault(&f, SILENCES[i], true);
        TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, SILENCES[i]));
    }
    expect_state(&f, AGV_STATE_TRIPPED);
    expect_reason(&f, AGV_FAULT_VCU_HEARTBEAT_LOST);
    expect_output(&f, false);
}

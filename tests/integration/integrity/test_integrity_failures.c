/*
 * Failing calls of the HAL, quick version: a round through all states in which calls fail. There must be no forbidden
 * frame (oracle), no lost latch and no hang. Counters show that calls failed.
 */
#include <stdio.h>
#include <string.h>

#include "one_fixture.h"
#include "walk.h"

enum { ROUND_MS = 3400, CALLS_MAX = 200000 };
enum { START_MS = 700, ENGAGED_MS = 600, TRIPPED_MS = 300, SAFE_MS = 500, PRESSED_MS = 1200, RELEASED_MS = 20 };

static bool rare_call[CALLS_MAX]; /* numbers of the calls in steps with rarer operations than status and feed */
static uint32_t first_call;       /* of the start */
static uint32_t rounds;

static bool is_latched(void) {
    const agv_state_t state = agv_supervisor_state(&f.supervisor);
    return state == AGV_STATE_TRIPPED || state == AGV_STATE_SAFE;
}

static uint32_t rare_calls(void) {
    uint32_t sum = 0;
    for (unsigned op = 0; op < SIM_HAL_OP_COUNT; op++) {
        if (op != SIM_HAL_OP_CAN_STATUS && op != SIM_HAL_OP_WATCHDOG_FEED) {
            sum += f.hal.op_calls[op];
        }
    }
    return sum;
}

/* The calls since then, if rare operations were among them. */
static void note_rare_calls(uint32_t calls_before, uint32_t rare_before) {
    TEST_ASSERT_TRUE(f.hal.calls < CALLS_MAX);
    for (uint32_t call = calls_before + 1; rare_calls() > rare_before && call <= f.hal.calls; call++) {
        rare_call[call] = true;
    }
}

static void step(void) {
    const uint32_t calls = f.hal.calls;
    const uint32_t rare = rare_calls();
    fixture_run(&f, 1);
    note_rare_calls(calls, rare);
}

/* The latch must be kept in this period, which has no press of 1 s. */
static void run_and_watch(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        const bool before = is_latched();
        step();
        TEST_ASSERT_FALSE_MESSAGE(before && !is_latched(), "the latch is undone");
    }
}

/* A power-on whose calls can fail, too; the first of them has the number 1. */
static void start_with_failures(uint32_t first, uint32_t count, uint32_t ops) {
    fixture_start(&f);
    const uint32_t rare = rare_calls();
    first_call = f.hal.calls;
    sim_hal_fail_at(&f.hal, first == 0 ? 0 : first_call + first, count, ops);
    fixture_restart(&f, HAL_RESET_POWER_ON);
    note_rare_calls(first_call, rare);
}

/* From the start to ACTIVE, a trip, SAFE, the reset, and on in STANDBY. */
static void go_round(uint16_t topology, uint32_t first, uint32_t count, uint32_t ops) {
    setUp();
    f.config.topology = topology;
    f.config.status_frame_id = 0x6F0;
    f.long_run = true;
    start_with_failures(first, count, ops);
    run_and_watch(START_MS);
    fixture_mode(&f, MODE_ENGAGED);
    fixture_gear(&f, GEAR_D);
    run_and_watch(ENGAGED_MS);
    walk_alarm(&f, ALARM_S_DRIVER);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    walk_alarm(&f, ALARM_NONE);
    run_and_watch(TRIPPED_MS);
    fixture_vehicle_confirms(&f);
    run_and_watch(SAFE_MS);
    fixture_button(&f, true);
    for (uint32_t i = 0; i < PRESSED_MS; i++) {
        step();
    }
    fixture_button(&f, false);
    for (uint32_t i = 0; i < RELEASED_MS; i++) {
        step();
    }
    rounds++;
}

/* Also with the port's watchdog the round ends in STANDBY, latched, or held in reset with the output open. */
static void judge_the_end(void) {
    const agv_state_t state = agv_supervisor_state(&f.supervisor);
    TEST_ASSERT_TRUE(state == AGV_STATE_STANDBY || is_latched() || f.hal.held || state == AGV_STATE_INIT);
    if (f.hal.held) {
        TEST_ASSERT_FALSE(f.hal.safety_output.on);
    }
    TEST_ASSERT_TRUE(f.hal.failures > 0);
}

static void expect_no_harm(uint16_t topology, uint32_t first, uint32_t count, uint32_t ops) {
    go_round(topology, first, count, ops);
    judge_the_end();
}

/* Shows: INT-4, FSM-6 */
void test_without_failures_the_round_ends_in_standby(void) {
    for (uint16_t topology = AGV_TOPOLOGY_SHARED; topology <= AGV_TOPOLOGY_GATEWAY; topology++) {
        go_round(topology, 0, 0, 0);
        expect_state(&f, AGV_STATE_STANDBY);
        expect_output(&f, true);
        TEST_ASSERT_EQUAL_UINT32(0, f.hal.failures);
        TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->gate_refused);
    }
}

static void fail_each_rare_call(uint16_t topology) {
    memset(rare_call, 0, sizeof rare_call);
    go_round(topology, 0, 0, 0);
    static bool wanted[CALLS_MAX];
    memcpy(wanted, rare_call, sizeof wanted);
    for (uint32_t call = 0; call < CALLS_MAX; call++) {
        if (wanted[call]) {
            expect_no_harm(topology, call - first_call, 1, SIM_HAL_OP_ALL);
        }
    }
}

/* Shows: FSM-6, FSM-3 */
void test_each_call_that_is_not_made_at_every_tick_fails_once(void) {
    rounds = 0;
    fail_each_rare_call(AGV_TOPOLOGY_SHARED);
    (void)printf("one failing call each: %u rounds\n", (unsigned)rounds);
    TEST_ASSERT_TRUE(rounds >= 200);
}

/* Shows: FSM-6, FSM-3 */
void test_runs_of_failing_calls_anywhere(void) {
    static const uint32_t LENGTHS[] = {1, 7, 40, 300};
    rounds = 0;
    for (uint16_t topology = AGV_TOPOLOGY_SHARED; topology <= AGV_TOPOLOGY_GATEWAY; topology++) {
        for (unsigned i = 0; i < sizeof LENGTHS / sizeof LENGTHS[0]; i++) {
            for (uint32_t first = 1; first < 6500; first += 211) {
                expect_no_harm(topology, first, LENGTHS[i], SIM_HAL_OP_ALL);
            }
        }
    }
    (void)printf("runs of failing calls: %u rounds\n", (unsigned)rounds);
}

/* Operations that the round calls after its start. */
static const sim_hal_op_t OPS[] = {SIM_HAL_OP_CAN_SEND,     SIM_HAL_OP_CAN_PURGE,         SIM_HAL_OP_CAN_STATUS,
                                   SIM_HAL_OP_LED_SET,      SIM_HAL_OP_SAFETY_OUTPUT_SET, SIM_HAL_OP_STORE_WRITE_LATCH,
                                   SIM_HAL_OP_STORE_APPEND, SIM_HAL_OP_WATCHDOG_FEED};

/* Shows: FSM-6, FSM-3 */
void test_each_operation_fails_permanently(void) {
    for (uint16_t topology = AGV_TOPOLOGY_SHARED; topology <= AGV_TOPOLOGY_GATEWAY; topology++) {
        for (unsigned i = 0; i < sizeof OPS / sizeof OPS[0]; i++) {
            expect_no_harm(topology, 1, UINT32_MAX, 1u << OPS[i]);
        }
        expect_no_harm(topology, 1, UINT32_MAX, SIM_HAL_OP_ALL);
    }
}

/* ---- Effects of single failures ---- */

/* Shows: TX_STALLED, SUP-7 */
void test_a_controller_that_accepts_nothing_is_detected_after_a_trip(void) {
    walk_to_tripped(&f);
    sim_hal_fail_at(&f.hal, 1, UINT32_MAX, 1u << SIM_HAL_OP_CAN_SEND);
    fixture_run(&f, 300);
    expect_fault(&f, AGV_FAULT_TX_STALLED, true);
    expect_output(&f, false);
}

/* Shows: FSM-7 */
void test_a_reset_cause_that_cannot_be_read_is_no_power_on(void) {
    fixture_init(&f);
    fixture_start(&f);
    sim_hal_fail_at(&f.hal, 1, UINT32_MAX, 1u << SIM_HAL_OP_RESET_CAUSE);
    f.hal.config.reset_cause = HAL_RESET_POWER_ON;
    agv_supervisor_start(&f.supervisor, &f.ports, &f.config, true, f.now_ms);
    expect_state(&f, AGV_STATE_TRIPPED);
    expect_reason(&f, AGV_FAULT_SUPERVISOR_RESET);
}

/* Shows: FSM-7 */
void test_a_latch_that_cannot_be_read_is_tripped_after_a_restart(void) {
    walk_to_safe(&f);
    sim_hal_fail_at(&f.hal, 1, UINT32_MAX, 1u << SIM_HAL_OP_STORE_READ_LATCH);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    expect_state(&f, AGV_STATE_TRIPPED);
    expect_reason(&f, AGV_FAULT_SUPERVISOR_RESET);
}

/*
 * Makes the calls of the HAL fail. A round leads through all states, a bus-off and two restarts. Each call of the round is
 * made to fail once. All calls of the rarer operations, and some of the common ones, are also made to fail together with
 * the 24 calls after them, the same during a trip, and permanently. The supervisor must never send a frame that FSM-6
 * forbids, and only a reset under its conditions may end the latch. The counter of sent frames must be right, and a
 * controller that accepts nothing must be detected. rules.h checks this.
 *
 * usage: hal_failures [--shard I/N] [--every N]     only the calls of one shard, only every N-th call
 */
#define _POSIX_C_SOURCE 200809L
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "harm.h"
#include "part.h"
#include "testbed_state.h"

enum {
    FOLLOW_COMMON_MS = 120,
    FOLLOW_MS = 400,
    FOLLOW_LONG_MS = 700,
    RUN_OF_CALLS = 25,
    COMMON_EVERY = 16,
    HANG_S = 20
};

static const char *const NAMES[SIM_HAL_OP_COUNT] = {
    "can_send",      "can_purge",         "can_recover",      "can_status",        "clock_now",    "led_set",
    "reset_cause",   "safety_output_set", "store_read_latch", "store_write_latch", "store_append", "store_read_record",
    "watchdog_feed", "inputs_read",       "clock_second",     "self_test"};

/* ---- Checks ---- */

/* Rules that a failing operation may break: a frame is not sent, a pin does not change, a record is missing. */
typedef struct {
    sim_hal_op_t op;
    bool one_is_enough; /* false: a single failing call must not break the rule */
    const char *text;
} borne_t;

static const borne_t BORNE[] = {
    {SIM_HAL_OP_CAN_SEND, true, "FSM-2: "},
    {SIM_HAL_OP_CAN_SEND, false, "TIM-1: "},
    {SIM_HAL_OP_CAN_SEND, false, "TOP-1: "},
    {SIM_HAL_OP_CAN_STATUS, true, "FSM-4: the safety output is closed in bus-off"},
    {SIM_HAL_OP_CAN_STATUS, true, "TIM-1: "},
    {SIM_HAL_OP_CAN_STATUS, true, "TOP-1: "},
    {SIM_HAL_OP_CAN_STATUS, true, "FSM-2: "},
    {SIM_HAL_OP_SAFETY_OUTPUT_SET, true, "FSM-4: the safety output is closed"},
    /* The supervisor cannot detect it. A hardware watchdog would expire, but it is off here. */
    {SIM_HAL_OP_WATCHDOG_FEED, false, "FSM-4: the safety output is closed, and the watchdog has not been fed"},
    {SIM_HAL_OP_RESET_CAUSE, true, "FSM-7: "},
    {SIM_HAL_OP_STORE_READ_LATCH, true, "FSM-7: after a reset the first reason is"},
    {SIM_HAL_OP_STORE_WRITE_LATCH, true, "FSM-7: after a reset the first reason is"},
};

static struct {
    uint64_t calls; /* calls that were made to fail */
    uint64_t runs;
    uint64_t failures; /* all failed calls, also those of a series */
    uint64_t borne;
    uint64_t noticed; /* runs in which no frame was accepted any more, and TX_STALLED was raised */
    uint64_t frames;
    uint64_t resets;
    uint64_t of_op[SIM_HAL_OP_COUNT];
} sum;

static testbed_state_t saved; /* before the failing call */
static uint32_t failing_ops;
static uint32_t failing_count;
static bool is_failing; /* false: in the round without failures, in which no rule may break */

static void on_broken(void) {
    bool is_borne = false;
    for (unsigned i = 0; is_failing && (i < sizeof BORNE / sizeof BORNE[0]); i++) {
        is_borne = is_borne || ((((failing_ops >> BORNE[i].op) & 1) != 0) &&
                                (BORNE[i].one_is_enough || (failing_count > 1)) && harm_rule_is(BORNE[i].text));
    }
    sum.borne += is_borne ? 1 : 0;
    harm_take_rule(is_borne);
}

/* ---- One step of the round, and its failures ---- */

typedef enum { RUN, RESTART_WATCHDOG, RESTART_POWER_ON } act_t;

static void run_step(act_t what) {
    switch (what) {
    case RUN:
        testbed_run(1);
        break;
    case RESTART_WATCHDOG:
        testbed_restart(HAL_RESET_WATCHDOG);
        break;
    default:
        testbed_restart(HAL_RESET_POWER_ON);
        break;
    }
}

/* The counter of sent frames must be the number of frames that were sent. */
static void judge_counters(act_t what) {
    const uint32_t before = (what == RUN) ? agv_supervisor_counters(&saved.supervisor)->sent : 0;
    const uint32_t counted = agv_supervisor_counters(&testbed.supervisor)->sent - before;
    if (counted != (uint32_t)(testbed.rules.sent - saved.rules.sent)) {
        harm_note("the counter of sent frames is wrong");
    }
}

/* SUP-7: frames wait and are not accepted. */
static void judge_stalled(uint32_t count, uint32_t ops) {
    const bool dead = (count == UINT32_MAX) && (((ops >> SIM_HAL_OP_CAN_SEND) & 1) != 0);
    if (!dead || !testbed_is_latched() || testbed.rules.shadow || testbed_has(AGV_FAULT_BUS_OFF)) {
        return;
    }
    if (!testbed_has(AGV_FAULT_TX_STALLED) || testbed.hal.safety_output.on) {
        harm_note("no frame is accepted any more, and TX_STALLED is not raised");
    }
    sum.noticed++;
}

static void fail(const char *where, act_t what, uint32_t call, uint32_t count, uint32_t ops, uint32_t follow_ms,
                 bool trip) {
    const uint32_t before = saved.hal.failures;
    testbed_restore(&saved);
    testbed.traffic[M_VEHICLE].data[4] = trip ? 0x80 : testbed.traffic[M_VEHICLE].data[4]; /* the S-driver alarm */
    harm_begin();
    is_failing = true;
    failing_ops = ops;
    failing_count = count;
    sim_hal_fail_at(&testbed.hal, call, count, ops);
    run_step(what);
    testbed_run(follow_ms);
    is_failing = false;
    judge_counters(what);
    judge_stalled(count, ops);
    sum.runs++;
    sum.failures += testbed.hal.failures - before;
    sum.frames += testbed.rules.sent - saved.rules.sent;
    sum.resets += testbed.rules.resets - saved.rules.resets;
    if (testbed.hal.failures == before) {
        harm_note("no call has failed");
    }
    harm_report("%s, call %u (%s), %u in a row, operations %X", where, (unsigned)call, NAMES[testbed.hal.last_failed],
                (unsigned)count, (unsigned)ops);
}

/* A step of the round never takes as long as HANG_S, even on a busy computer. */
static void on_alarm(int number) {
    static const char TEXT[] = "HARM: a call does not return: it hangs\n";
    (void)number;
    _exit(write(STDOUT_FILENO, TEXT, sizeof TEXT - 1) > 0 ? 1 : 3);
}

static part_t part;
static unsigned call_number;

/* The operation of a call, by its number. */
static sim_hal_op_t find_op(act_t what, uint32_t call) {
    testbed_restore(&saved);
    is_failing = true;
    failing_ops = SIM_HAL_OP_ALL;
    failing_count = RUN_OF_CALLS;
    sim_hal_fail_at(&testbed.hal, call, 1, SIM_HAL_OP_ALL);
    run_step(what);
    is_failing = false;
    return testbed.hal.last_failed;
}

static void fail_one(const char *where, act_t what, uint32_t call) {
    const sim_hal_op_t op = find_op(what, call);
    const bool common = (op == SIM_HAL_OP_CAN_STATUS) || (op == SIM_HAL_OP_WATCHDOG_FEED);
    sum.calls++;
    sum.of_op[op]++;
    fail(where, what, call, 1, 1u << op, common ? FOLLOW_COMMON_MS : FOLLOW_MS, false);
    if (!common || (sum.of_op[op] % COMMON_EVERY == 0)) {
        fail(where, what, call, RUN_OF_CALLS, SIM_HAL_OP_ALL, FOLLOW_MS, false);
        fail(where, what, call, RUN_OF_CALLS, SIM_HAL_OP_ALL, FOLLOW_MS, true);
        fail(where, what, call, UINT32_MAX, 1u << op, FOLLOW_LONG_MS, false);
    }
}

static void step(const char *where, act_t what) {
    testbed_save(&saved);
    (void)alarm(HANG_S);
    const uint32_t calls = testbed.hal.calls;
    harm_begin();
    run_step(what);
    const uint32_t count = testbed.hal.calls - calls;
    harm_report("%s, without any failure", where);
    for (uint32_t i = 1; i <= count; i++) {
        const unsigned number = call_number++;
        if ((number % part.shards == part.shard) && ((number / part.shards) % part.every == 0)) {
            fail_one(where, what, calls + i);
        }
    }
    testbed_restore(&saved);
    run_step(what);
}

static void steps(const char *where, uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        step(where, RUN);
    }
}

/* ---- The round ---- */

static void vehicle(uint8_t mode, uint8_t gear, uint8_t wheels) {
    traffic_mode(testbed.traffic, mode);
    traffic_gear(testbed.traffic, gear);
    traffic_wheels(testbed.traffic, wheels, wheels);
}

static void alarm_and_trip(void) {
    testbed.traffic[M_VEHICLE].data[4] = 0x80;
    steps("trip", 10);
    testbed.traffic[M_VEHICLE].data[4] = 0;
    steps("TRIPPED", 150);
}

static void round_of(unsigned variant) {
    testbed_load(variant, 0);
    traffic_ai_drives(testbed.traffic);
    step("power-on", RESTART_POWER_ON);
    steps("INIT and STANDBY", 650);
    vehicle(MODE_ENGAGED, GEAR_D, 200);
    steps("ACTIVE", 300);
    alarm_and_trip();
    testbed_disturb(HAL_CAN_VEHICLE, 0, 2);
    steps("bus-off", 130);
    testbed_disturb(HAL_CAN_VEHICLE, 0, 0);
    steps("after bus-off", 40);
    vehicle(MODE_MANUAL, GEAR_P, 0);
    steps("SAFE", 150);
    step("restart in SAFE", RESTART_WATCHDOG);
    steps("after the restart", 250);
    traffic_button(testbed.traffic, true);
    steps("the button", 1050);
    traffic_button(testbed.traffic, false);
    steps("STANDBY again", 30);
    if (agv_supervisor_state(&testbed.supervisor) != AGV_STATE_STANDBY) {
        harm_note("the round does not end in STANDBY");
        harm_report("variant %u: the round itself", variant);
    }
}

int main(int argc, char **argv) {
    part = part_read("hal_failures", argc, argv);
    testbed_on_broken = on_broken;
    (void)signal(SIGALRM, on_alarm);
    for (unsigned variant = 0; variant < TESTBED_VARIANTS; variant++) {
        round_of(variant);
    }
    for (unsigned op = 0; op < SIM_HAL_OP_COUNT; op++) {
        (void)printf("%-18s %8llu calls\n", NAMES[op], (unsigned long long)sum.of_op[op]);
    }
    (void)printf(
        "%llu permitted broken rules, %llu dead controllers detected, %llu frames checked, %llu resets by the button\n",
        (unsigned long long)sum.borne, (unsigned long long)sum.noticed, (unsigned long long)sum.frames,
        (unsigned long long)sum.resets);
    (void)printf("%d rounds: %llu calls made to fail in %llu runs, %llu failures, harm: %llu\n", (int)TESTBED_VARIANTS,
                 (unsigned long long)sum.calls, (unsigned long long)sum.runs, (unsigned long long)sum.failures,
                 (unsigned long long)harm_count);
    return ((harm_count == 0) && (sum.calls > 0)) ? 0 : 1;
}

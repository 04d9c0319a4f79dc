/* Faults of the supervisor itself and of its start: class, reason, LED, safe commands in the same call, and end.
 * Restarts, and that no reset ends an unresettable fault: test_fsm_restart and test_fsm_latch. */
#include <stddef.h>
#include <string.h>

#include "one_fixture.h"

/* ---- At the start ---- */

static void expect_own_trip(agv_fault_t fault) {
    agv_event_t event;
    expect_tripped(&f, fault);
    expect_fault(&f, fault, true);
    TEST_ASSERT_TRUE(fixture_last_raised(&f, fault, &event));
    TEST_ASSERT_EQUAL_INT(AGV_CLASS_TRIP, event.b);
    expect_led(&f, -1);
    expect_output(&f, false);
    expect_safe_commands(&f, f.call, NO_HOLD); /* no angle is known */
}

/* Shows: FSM-9, SELF_TEST_FAILED */
void test_self_test_failed(void) {
    f.self_test_passed = false;
    fixture_start(&f);
    expect_own_trip(AGV_FAULT_SELF_TEST_FAILED);
}

/* 29 ms are less than three cycles. The built-in constants are used instead. */
/* Shows: FSM-9, INT-2, CONFIG_INVALID */
void test_config_invalid(void) {
    f.config.vcu_heartbeat_timeout_ms = 29;
    fixture_start(&f);
    expect_own_trip(AGV_FAULT_CONFIG_INVALID);
    TEST_ASSERT_EQUAL_UINT16(50, agv_supervisor_config(&f.supervisor)->vcu_heartbeat_timeout_ms);
}

/* A transient: it ends after a second, the trip stays. */
/* Shows: FSM-7, SUPERVISOR_RESET */
void test_supervisor_reset(void) {
    f.reset_cause = HAL_RESET_WATCHDOG;
    fixture_start(&f);
    expect_own_trip(AGV_FAULT_SUPERVISOR_RESET);
    expect_fault_after(&f, 999, AGV_FAULT_SUPERVISOR_RESET, true);
    expect_fault_after(&f, 1, AGV_FAULT_SUPERVISOR_RESET, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, AGV_FAULT_SUPERVISOR_RESET));
    expect_reason(&f, AGV_FAULT_SUPERVISOR_RESET);
    expect_led(&f, -1);
}

/* A latch that fails its checksum only warns at a power-on. */
/* Shows: FSM-7, STORE_INVALID */
void test_store_invalid(void) {
    fixture_standby(&f);
    TEST_ASSERT_TRUE(sim_store_corrupt_latch(&f.store, 0, 0x10));
    f.store.keep_latch = true;
    fixture_restart(&f, HAL_RESET_POWER_ON);
    expect_warning(&f, AGV_FAULT_STORE_INVALID, AGV_STATE_INIT);
    expect_led(&f, -1);
    expect_fault_after(&f, 999, AGV_FAULT_STORE_INVALID, true);
    expect_state(&f, AGV_STATE_STANDBY); /* it does not keep INIT */
    expect_fault_after(&f, 1, AGV_FAULT_STORE_INVALID, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, AGV_FAULT_STORE_INVALID));
    expect_led(&f, 0);
}

/* ---- MEMORY_CORRUPTED ---- */

/* Shows: INT-5, FSM-2, FSM-9, MEMORY_CORRUPTED */
void test_memory_corrupted(void) {
    fixture_active(&f);
    f.receive_path_dead = true; /* the tick detects it */
    fixture_mute_vcu(&f, true);
    fixture_mute_eps(&f, true);
    fixture_mute_ai(&f, true);
    fixture_flip_bit(&f, 1000);
    fixture_run(&f, 1);
    expect_own_trip(AGV_FAULT_MEMORY_CORRUPTED);
}

/* The receive path checks in between the flip and the tick that detects it. */
/* Shows: INT-5, MEMORY_CORRUPTED */
void test_memory_corrupted_before_the_receive_path_checks_in(void) {
    fixture_active(&f);
    fixture_mute_vcu(&f, true);
    fixture_mute_eps(&f, true);
    fixture_mute_ai(&f, true);
    fixture_flip_bit(&f, 1000);
    expect_tripped_after(&f, 1, AGV_FAULT_MEMORY_CORRUPTED);
}

/* A frame detects it as well. */
/* Shows: INT-5, FSM-2, MEMORY_CORRUPTED */
void test_memory_corrupted_is_found_by_a_frame(void) {
    fixture_active(&f);
    fixture_flip_bit(&f, 77);
    fixture_send_now(&f, AGV_MSG_WHEEL_SPEED);
    expect_tripped(&f, AGV_FAULT_MEMORY_CORRUPTED);
    expect_safe_commands(&f, f.call, NO_HOLD);
}

/* Every bit of the memory, in STANDBY and in ACTIVE, each in a healthy supervisor. */
static void flip_every_bit(void) {
    const agv_supervisor_t healthy = f.supervisor;
    const size_t bits = 8 * (offsetof(agv_supervisor_t, seal) + sizeof healthy.seal); /* padding may follow */
    for (size_t bit = 0; bit < bits; bit++) {
        f.supervisor = healthy;
        sim_store_init(&f.store);
        fixture_flip_bit(&f, bit);
        fixture_forget_sent(&f);
        agv_supervisor_tick(&f.supervisor, &f.ports, f.now_ms);
        expect_tripped(&f, AGV_FAULT_MEMORY_CORRUPTED);
        expect_output(&f, false);
        expect_safe_commands(&f, f.call, NO_HOLD);
    }
}

/* Shows: INT-5, MEMORY_CORRUPTED */
void test_every_flipped_bit_is_found(void) {
    fixture_standby(&f);
    flip_every_bit();
    fixture_init(&f);
    fixture_active(&f);
    flip_every_bit();
}

/* ---- TX_GATE_REFUSED ---- */

enum { WAITING_RAW = 10843 }; /* 2A5Bh */
static const uint8_t WAITING[8] = {0x5B, 0x2A};

/* A bit flips while frames are sent, after the memory was checked: the waiting steering command is then out of
 * range. */
static bool corrupt_what_waits(void) {
    uint8_t *memory = (uint8_t *)&f.supervisor;
    bool found = false;
    for (size_t at = 0; at + sizeof WAITING <= sizeof f.supervisor; at++) {
        if (memcmp(&memory[at], WAITING, sizeof WAITING) == 0) {
            memory[at + 1] ^= 0x80u;
            found = true;
        }
    }
    return found;
}

typedef struct {
    sim_hal_sink_fn *sink; /* sent by the fixture */
    bool corrupted;
} tamper_t;

static tamper_t tamper;

static void corrupt_and_pass_on(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    if (frame->id == 0x43F && !tamper.corrupted) {
        tamper.corrupted = corrupt_what_waits();
    }
    tamper.sink(ctx, side, frame);
}

/* 43Fh and 065h wait in the gateway. While the first is sent, the second is corrupted. */
/* Shows: INT-4, FSM-2, TX_GATE_REFUSED */
void test_the_gate_refuses_a_forbidden_frame(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    fixture_active(&f);
    fixture_run_before(&f, AGV_MSG_TURN_SIGNAL_COMMAND);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    fixture_command_angle(&f, WAITING_RAW);
    fixture_run(&f, 5);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    tamper = (tamper_t){.sink = f.hal.sink};
    f.hal.sink = corrupt_and_pass_on;
    fixture_forget_sent(&f);
    fixture_run(&f, 1);
    TEST_ASSERT_TRUE(tamper.corrupted);
    TEST_ASSERT_EQUAL_UINT32(1, agv_supervisor_counters(&f.supervisor)->gate_refused);
    expect_fault(&f, AGV_FAULT_TX_GATE_REFUSED, true);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x065));
    expect_led(&f, 0); /* faults are evaluated and shown once a call, before anything is sent */
    expect_reason_after(&f, 1, AGV_FAULT_TX_GATE_REFUSED);
    expect_state(&f, AGV_STATE_TRIPPED);
    const agv_fault_set_t trips = agv_supervisor_active_trips(&f.supervisor);
    TEST_ASSERT_TRUE(agv_fault_is_in(&trips, AGV_FAULT_TX_GATE_REFUSED));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x065)); /* the held angle, not the waiting command */
    const uint8_t hold[8] = {0x28, 0x23};
    TEST_ASSERT_EQUAL_HEX8_ARRAY(hold, fixture_nth_sent(&f, 0x065, 0)->data, 8);
    TEST_ASSERT_EQUAL_HEX8(0x70, fixture_nth_sent(&f, 0x43F, 1)->data[4]);
    TEST_ASSERT_EQUAL_HEX8(8, fixture_nth_sent(&f, 0x168, 0)->data[0]);
    expect_led(&f, -1);
    expect_fault_after(&f, 998, AGV_FAULT_TX_GATE_REFUSED, true);
    expect_fault_after(&f, 1, AGV_FAULT_TX_GATE_REFUSED, false); /* a transient */
    TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, AGV_FAULT_TX_GATE_REFUSED));
}

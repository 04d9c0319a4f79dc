/*
 * Each bit of the supervisor's memory is flipped, one at a time, in some situations of each state (INT-5). The oracle
 * checks every frame; nothing may end the latch. Flips are made between two steps: the next call may be that of the
 * receive path, of a frame or of a tick.
 */
#include <stddef.h>
#include <stdio.h>
#include <string.h>

#include "fixture.h"
#include "unity.h"
#include "walk.h"

enum { BITS = 8 * sizeof(agv_supervisor_t) };

static fixture_t f;

/* A saved state, without recorder and flash, which do not matter here. */
typedef struct {
    agv_supervisor_t supervisor;
    struct hal hal;
    oracle_t oracle;
    traffic_message_t traffic[AGV_MSG_COUNT];
    uint8_t latch[HAL_STORE_LATCH_SIZE_MAX];
    uint8_t latch_size;
    uint32_t now_ms;
    uint32_t elapsed_ms;
} state_t;

static state_t saved;
static uint32_t moments;
static uint32_t flips;
static uint32_t detected;
static uint32_t harmless;
static uint32_t judged;

void setUp(void) {
    fixture_init(&f);
    f.long_run = true;
}

static void save(void) {
    saved.supervisor = f.supervisor;
    saved.hal = f.hal;
    saved.oracle = f.oracle;
    memcpy(saved.traffic, f.traffic, sizeof f.traffic);
    memcpy(saved.latch, f.store.latch, sizeof f.store.latch);
    saved.latch_size = f.store.latch_size;
    saved.now_ms = f.now_ms;
    saved.elapsed_ms = f.elapsed_ms;
}

static void restore(void) {
    f.supervisor = saved.supervisor;
    f.hal = saved.hal;
    judged += f.oracle.judged - saved.oracle.judged;
    f.oracle = saved.oracle;
    memcpy(f.traffic, saved.traffic, sizeof f.traffic);
    memcpy(f.store.latch, saved.latch, sizeof f.store.latch);
    f.store.latch_size = saved.latch_size;
    f.now_ms = saved.now_ms;
    f.elapsed_ms = saved.elapsed_ms;
}

static bool is_latched(void) {
    const agv_state_t state = agv_supervisor_state(&f.supervisor);
    return state == AGV_STATE_TRIPPED || state == AGV_STATE_SAFE;
}

static bool is_found(void) {
    return fixture_has(&f, AGV_FAULT_MEMORY_CORRUPTED);
}

static void fail_at(unsigned bit, const char *why) {
    char text[120];
    (void)snprintf(text, sizeof text, "%s, bit %u (byte %u of %u): %s", f.what, bit, bit / 8,
                   (unsigned)sizeof(agv_supervisor_t), why);
    TEST_FAIL_MESSAGE(text);
}

/* Detected: latched until a power-on, whatever the button does. Some flips are followed for longer. */
static void follow_a_found_one(unsigned bit) {
    const uint32_t ms = bit % 499 == 0 ? 1200 : 3;
    for (uint32_t i = 0; i < ms; i++) {
        fixture_run(&f, 1);
        if (!is_latched()) {
            fail_at(bit, "found, but not latched");
        }
    }
    detected++;
}

/* Not detected within 1.2 s: the flip must have no effect. */
static void follow_a_harmless_one(unsigned bit, bool was_latched) {
    for (unsigned i = 0; i < 1200 && !is_found(); i++) {
        fixture_run(&f, 1);
        if (was_latched && !is_latched()) {
            fail_at(bit, "the latch is undone");
        }
    }
    harmless++;
}

static void flip(unsigned bit) {
    const bool was_latched = is_latched();
    ((uint8_t *)&f.supervisor)[bit / 8] ^= (uint8_t)(1u << (bit % 8));
    flips++;
    for (unsigned i = 0; i < 12 && !is_found(); i++) {
        fixture_run(&f, 1);
        if (was_latched && !is_latched()) {
            fail_at(bit, "the latch is undone");
        }
    }
    if (is_found()) {
        follow_a_found_one(bit);
    } else {
        follow_a_harmless_one(bit, was_latched);
    }
}

static void flip_each_bit(const char *what) {
    f.what = what;
    moments++;
    save();
    for (unsigned bit = 0; bit < BITS; bit++) {
        restore();
        flip(bit);
    }
    restore();
}

/* Before a step with frames, and before a step with only the receive path and the tick. */
static void flip_at_two_moments(const char *what) {
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
    flip_each_bit(what);
    fixture_run_before(&f,
                       AGV_MSG_STEERING_POSITION); /* at 6 of 10 ms; from 7 on but for 0A3h and 43Fh nothing is due */
    fixture_run(&f, 4);
    flip_each_bit(what);
}

static void init(void) {
    fixture_mode(&f, MODE_NEITHER);
    fixture_start(&f);
    fixture_run(&f, 700);
    flip_at_two_moments("INIT");
}

static void standby(void) {
    fixture_standby(&f);
    fixture_run(&f, 200);
    flip_at_two_moments("STANDBY");
}

static void active(void) {
    fixture_active(&f);
    flip_at_two_moments("ACTIVE");
}

/* The button is held since before the trip. Only a flipped bit could turn this into a valid press. */
static void tripped(void) {
    fixture_active(&f);
    fixture_button(&f, true);
    fixture_run(&f, 50);
    walk_trip(&f);
    fixture_mute_ai(&f, true);
    fixture_run(&f, 200);
    flip_at_two_moments("TRIPPED");
}

static void safe(void) {
    fixture_active(&f);
    fixture_button(&f, true);
    fixture_run(&f, 50);
    walk_trip(&f);
    fixture_mute_ai(&f, true);
    fixture_vehicle_confirms(&f);
    fixture_run(&f, 1700);
    flip_at_two_moments("SAFE");
    fixture_run_before(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_button(&f, false); /* all conditions of a reset hold, except that the press began before the trip */
    flip_each_bit("SAFE, the button is released");
}

/* Safe commands and overrides wait for a full queue. */
static void waiting(void) {
    static const uint8_t drive[8] = {GEAR_D};
    walk_to_tripped(&f);
    f.traffic[AGV_MSG_GEAR_COMMAND].side = HAL_CAN_VEHICLE;
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    fixture_run(&f, 40);
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, drive);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    flip_each_bit("safe commands wait");
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, drive);
    fixture_frame(&f, AGV_MSG_GEAR_COMMAND, drive);
    flip_each_bit("an answer waits for its 5 ms");
}

static void print_counts(const char *topology) {
    (void)printf("INT-5, %s: %u bits at %u moments: %u flips, %u detected, %u harmless, %u frames judged\n", topology,
                 (unsigned)BITS, (unsigned)moments, (unsigned)flips, (unsigned)detected, (unsigned)harmless,
                 (unsigned)judged);
    TEST_ASSERT_EQUAL_UINT32(flips, detected + harmless);
    moments = 0;
    flips = 0;
    detected = 0;
    harmless = 0;
    judged = 0;
}

static void flip_in_every_state(uint16_t topology, uint16_t id_set, const char *name) {
    static void (*const WALKS[])(void) = {init, standby, active, tripped, safe, waiting};
    for (unsigned i = 0; i < sizeof WALKS / sizeof WALKS[0]; i++) {
        setUp();
        f.config.topology = topology;
        f.config.id_set = id_set;
        WALKS[i]();
    }
    print_counts(name);
}

/* Shows: INT-5, FSM-6, MEMORY_CORRUPTED */
void test_each_flipped_bit_on_the_shared_bus(void) {
    flip_in_every_state(AGV_TOPOLOGY_SHARED, AGV_ID_SET_HEADING, "shared bus");
}

/* Also with a corrupted configuration the safe commands use 201h and go to the vehicle side. */
/* Shows: INT-5, FSM-6, FSM-9, MEMORY_CORRUPTED, P1 */
void test_each_flipped_bit_in_the_gateway_with_the_table_set(void) {
    flip_in_every_state(AGV_TOPOLOGY_GATEWAY, AGV_ID_SET_TABLE, "gateway, table set");
}

/* ---- The recorder ---- */

/* The head of the recorder: sequence numbers, received messages, last payloads. The supervisor does not depend on
 * it. */
/* Shows: INT-5, INT-3 */
void test_a_flipped_bit_in_the_head_of_the_recorder_changes_no_decision(void) {
    const size_t head = offsetof(agv_recorder_t, events);
    for (unsigned bit = 0; bit < 8 * head; bit += 29) {
        setUp();
        walk_to_safe(&f);
        ((uint8_t *)&f.recorder)[bit / 8] ^= (uint8_t)(1u << (bit % 8));
        fixture_run(&f, 20);
        expect_state(&f, AGV_STATE_SAFE);
        fixture_button(&f, true);
        fixture_run(&f, 1050);
        fixture_button(&f, false);
        fixture_run(&f, 10);
        expect_state(&f, AGV_STATE_STANDBY);
    }
}

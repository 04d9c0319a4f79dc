/*
 * Flips each bit of a supervisor's memory, one at a time, in every state (INT-5), between two calls of the supervisor. It
 * must never send a frame that FSM-6 forbids, and only a reset under its conditions may end the latch. A detected flip must
 * latch until a power-on, with the safety output open. rules.h checks this; it shares no code with the gate.
 *
 * usage: bit_flips [--shard I/N] [--every N]     only the situations of one shard, only every N-th bit
 */
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>

#include "harm.h"
#include "part.h"
#include "testbed_state.h"

enum { BITS = 8 * sizeof(agv_supervisor_t), SEALED_BITS = 8 * offsetof(agv_supervisor_t, receive_alive) };
enum { SHORT_MS = 40, LONG_MS = 1300, LONG_EVERY = 61 };

/* ---- Checks ---- */

static struct {
    uint64_t moments;
    uint64_t flips;
    uint64_t detected;
    uint64_t harmless;
    uint64_t late; /* detected, but after the first millisecond */
    uint64_t frames;
    uint64_t resets; /* by the button, under all conditions */
    uint64_t moments_of[TESTBED_STATES];
    uint64_t latched_flips;
} sum;

/* Rules that may break after a detected flip, because the supervisor restarts with built-in constants (FSM-9). */
static struct {
    const char *text;
    uint64_t seen;
} borne[] = {
    {"INT-5: memory corruption was detected", 0},
    {"INT-4: the gate refused", 0}, /* the flipped bit is in that counter */
    {"FSM-8: the own alive counter", 0},
    {"TOP-4: ", 0}, /* shadow is off in the built-in constants */
};

static testbed_state_t saved;
static const char *situation;

static void on_broken(void) {
    bool is_borne = false;
    for (unsigned i = 0; i < sizeof borne / sizeof borne[0]; i++) {
        if (harm_rule_is(borne[i].text)) {
            borne[i].seen++;
            is_borne = true;
        }
    }
    harm_take_rule(is_borne);
}

static bool is_found(void) {
    return testbed_has(AGV_FAULT_MEMORY_CORRUPTED);
}

enum { BUILT_IN_STATUS_ID = 0x7F0 };
static sim_hal_sink_fn *judge_sent;

/* After such a restart the status frame has the identifier of the built-in constants (FSM-9, TOP-3). */
static void on_sent(void *ctx, hal_can_side_t side, const hal_can_frame_t *frame) {
    const uint32_t configured = testbed.rules.oracle.own_status_id;
    if (is_found() && (frame->id == BUILT_IN_STATUS_ID)) {
        testbed.rules.oracle.own_status_id = frame->id;
    }
    judge_sent(ctx, side, frame);
    testbed.rules.oracle.own_status_id = configured;
}

/* FSM-9: memory corruption is unresettable. */
static void judge_found(void) {
    if (!testbed_is_latched()) {
        harm_note("memory corruption detected, but not latched");
    }
    if (testbed.hal.safety_output.on) {
        harm_note("memory corruption detected, but the safety output is closed");
    }
}

/* Fulfil all conditions of a reset: the vehicle obeys, and the operator presses the button. */
static void ask_for_reset(void) {
    traffic_mode(testbed.traffic, MODE_MANUAL);
    traffic_gear(testbed.traffic, GEAR_P);
    traffic_wheels(testbed.traffic, 0, 0);
    testbed.traffic[M_THROTTLE_STATUS].data[0] = 0;
    traffic_button(testbed.traffic, true);
}

static void run_found(uint32_t ms) {
    for (uint32_t i = 0; (i < ms) && (!harm_is_noted()); i++) {
        testbed_run(1);
        judge_found();
    }
}

static void follow(unsigned bit) {
    const bool for_long = (bit % LONG_EVERY) == (unsigned)(sum.moments % LONG_EVERY);
    testbed_run(1);
    if (!is_found()) {
        testbed_run(SHORT_MS);
        sum.late += is_found() ? 1 : 0;
    }
    if (is_found()) {
        sum.detected++;
        run_found(SHORT_MS);
        if (for_long) {
            ask_for_reset();
            run_found(LONG_MS);
            traffic_button(testbed.traffic, false);
            run_found(SHORT_MS);
        }
        return;
    }
    sum.harmless++;
    testbed_run(LONG_MS);
    traffic_button(testbed.traffic, false); /* a press counts at its release */
    testbed_run(SHORT_MS);
}

static void flip(unsigned bit) {
    ((uint8_t *)&testbed.supervisor)[bit / 8] ^= (uint8_t)(1u << (bit % 8));
    harm_begin();
    sum.flips++;
    sum.latched_flips += testbed_is_latched() ? 1 : 0;
    follow(bit);
    sum.frames += testbed.rules.sent - saved.rules.sent;
    sum.resets += testbed.rules.resets - saved.rules.resets;
    harm_report("%s, byte %u bit %u of %u bytes, after %u ms", situation, bit / 8, bit % 8,
                (unsigned)sizeof(agv_supervisor_t), (unsigned)(testbed.now_ms - saved.now_ms));
}

/* ---- Situations ---- */

static part_t part;
static unsigned moment_number;

static void flip_each_bit(const char *name, unsigned variant, unsigned state) {
    static char text[120];
    if (moment_number++ % part.shards != part.shard) {
        return;
    }
    (void)snprintf(text, sizeof text, "variant %u, state %u, %s", variant, state, name);
    situation = text;
    testbed_save(&saved);
    for (unsigned bit = (unsigned)(sum.moments % part.every); bit < BITS; bit += part.every) {
        testbed_restore(&saved);
        flip(bit);
    }
    testbed_restore(&saved);
    sum.moments++;
    sum.moments_of[state]++;
}

static void load(unsigned variant, unsigned state) {
    testbed_load(variant, state);
    if (testbed.hal.sink != on_sent) {
        judge_sent = testbed.hal.sink;
        testbed.hal.sink = on_sent;
    }
    traffic_ai_drives(testbed.traffic);
    testbed_run(30);
}

/* Several times within a cycle: some before a frame, some before a tick only. */
static void flip_within_a_cycle(unsigned variant, unsigned state) {
    static const unsigned STEPS_MS[] = {0, 1, 2, 5, 19, 41};
    load(variant, state);
    for (unsigned i = 0; i < sizeof STEPS_MS / sizeof STEPS_MS[0]; i++) {
        testbed_run(STEPS_MS[i]);
        flip_each_bit("healthy traffic", variant, state);
    }
}

static void foreign_gear(void) {
    testbed_frame(HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x168, .length = 8, .data = {GEAR_D}}, 0);
}

static void flip_while_a_command_waits(unsigned variant, unsigned state) {
    load(variant, state);
    testbed_disturb(HAL_CAN_VEHICLE, 1, 1);
    testbed_run(40);
    flip_each_bit("frames wait for a full queue", variant, state);
    testbed_disturb(HAL_CAN_VEHICLE, 1, 0);
    testbed_run(5);
    foreign_gear();
    foreign_gear();
    flip_each_bit("an override waits", variant, state);
}

static void flip_in_bus_off(unsigned variant, unsigned state) {
    load(variant, state);
    testbed_disturb(HAL_CAN_VEHICLE, 0, 2);
    testbed_run(50);
    flip_each_bit("in bus-off", variant, state);
}

static void flip_during_a_press(unsigned variant) {
    load(variant, 4);
    ask_for_reset();
    testbed_run(700);
    flip_each_bit("the button is held for 0.7 s", variant, 4);
}

static void flip_after_a_restart(unsigned variant, unsigned state) {
    load(variant, state);
    testbed_restart(HAL_RESET_WATCHDOG);
    testbed_run(30);
    flip_each_bit("after a watchdog reset", variant, 3);
}

/* The button is held since before the trip. Only a flipped bit could turn this into a valid press. */
static void flip_while_the_button_is_held(unsigned variant) {
    load(variant, 2);
    traffic_button(testbed.traffic, true);
    testbed_run(50);
    testbed.traffic[M_VEHICLE].data[4] = 0x80;
    testbed_run(20);
    testbed.traffic[M_VEHICLE].data[4] = 0;
    traffic_mode(testbed.traffic, MODE_MANUAL);
    traffic_gear(testbed.traffic, GEAR_P);
    traffic_wheels(testbed.traffic, 0, 0);
    testbed_run(900);
    flip_each_bit("the button is held since before the trip", variant, 4);
}

static void flip_in_all_cases(void) {
    for (unsigned variant = 0; variant < TESTBED_VARIANTS; variant++) {
        for (unsigned state = 0; state < TESTBED_STATES; state++) {
            flip_within_a_cycle(variant, state);
        }
        flip_while_a_command_waits(variant, 3);
        flip_in_bus_off(variant, 3);
        flip_during_a_press(variant);
        flip_after_a_restart(variant, 4);
        flip_while_the_button_is_held(variant);
    }
}

/* ---- */

int main(int argc, char **argv) {
    part = part_read("bit_flips", argc, argv);
    testbed_on_broken = on_broken;
    flip_in_all_cases();
    (void)printf(
        "situations: %llu INIT, %llu STANDBY, %llu ACTIVE, %llu TRIPPED, %llu SAFE; %u of %u bits are sealed\n",
        (unsigned long long)sum.moments_of[0], (unsigned long long)sum.moments_of[1],
        (unsigned long long)sum.moments_of[2], (unsigned long long)sum.moments_of[3],
        (unsigned long long)sum.moments_of[4], (unsigned)SEALED_BITS, (unsigned)BITS);
    for (unsigned i = 0; i < sizeof borne / sizeof borne[0]; i++) {
        (void)printf("permitted after a detected flip: %s... %llu times\n", borne[i].text,
                     (unsigned long long)borne[i].seen);
    }
    (void)printf("%llu frames checked, %llu flips in a latched state, %llu resets by the button, %llu detected late\n",
                 (unsigned long long)sum.frames, (unsigned long long)sum.latched_flips, (unsigned long long)sum.resets,
                 (unsigned long long)sum.late);
    (void)printf("%u bits in %llu situations: %llu flips, %llu detected, %llu harmless, forbidden: %llu\n",
                 (unsigned)BITS, (unsigned long long)sum.moments, (unsigned long long)sum.flips,
                 (unsigned long long)sum.detected, (unsigned long long)sum.harmless, (unsigned long long)harm_count);
    return ((harm_count == 0) && (sum.moments > 0)) ? 0 : 1;
}

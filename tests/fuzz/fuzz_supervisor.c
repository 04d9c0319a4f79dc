/*
 * Frames and ticks in any order, from any state, against the rules of rules.h.
 *
 * Byte 1: the first state; byte 2: the variant of the configuration. Then steps: a byte with the action (lower half)
 * and its variant (upper half), and its parameters.
 */
#include "input.h"
#include "testbed.h"

enum { STEPS_MAX = 64, RUN_MAX_MS = 3000 };

static const uint16_t IDS[16] = {0x43F, 0x168, 0x075, 0x065, 0x363, 0x0A3, 0x050, 0x067,
                                 0x167, 0x267, 0x101, 0x201, 0x203, 0x700, 0x001, 0x000};

static uint32_t ran_ms; /* an input runs for at most RUN_MAX_MS in all */

static void run(uint32_t ms) {
    const uint32_t left = RUN_MAX_MS - ran_ms;
    const uint32_t now = (ms < left) ? ms : left;
    ran_ms += now;
    testbed_run(now);
}

/* Any frame: how & 1 the AI side, how & 2 any identifier, how & 4 any kind and length, how & 8 another stamp. */
static void any_frame(input_t *input, unsigned how) {
    hal_can_frame_t frame = {.length = 8};
    const uint8_t which = input_byte(input);
    int32_t ahead_ms = 0;
    frame.id = IDS[which & 15];
    if ((how & 2) != 0) {
        frame.id = ((uint32_t)which | ((uint32_t)input_byte(input) << 8)) & 0x7FFu;
    }
    if ((how & 4) != 0) {
        frame.flags = input_byte(input) & 0x0Fu;
        frame.length = input_byte(input) % 65;
    }
    if ((how & 8) != 0) {
        ahead_ms = (int8_t)input_byte(input);
    }
    input_bytes(input, frame.data, (frame.length < 8) ? frame.length : 8);
    testbed_frame(((how & 1) != 0) ? HAL_CAN_AI : HAL_CAN_VEHICLE, frame, ahead_ms);
}

static void change_message(input_t *input, unsigned how) {
    traffic_message_t *m = &testbed.traffic[input_byte(input) % (unsigned)TRAFFIC_MESSAGES];
    uint8_t where = 0;
    switch (how & 3) {
    case 0:
        where = (uint8_t)((how >> 2) | (input_byte(input) & 4));
        m->data[where] = input_byte(input);
        break;
    case 1:
        m->muted = !m->muted;
        break;
    case 2:
        m->frozen = !m->frozen;
        break;
    default:
        m->flags = (how >> 2) == 3 ? input_byte(input) & 15 : 0;
        m->length = input_byte(input) % 65;
        break;
    }
}

/* The vehicle as a whole. */
static void change_vehicle(unsigned how) {
    switch (how & 7) {
    case 0:
        traffic_heal(testbed.traffic);
        break;
    case 1: /* on autopilot */
        traffic_mode(testbed.traffic, 0x80);
        traffic_gear(testbed.traffic, 1);
        traffic_wheels(testbed.traffic, 200, 200);
        break;
    case 2: /* obeys */
        traffic_mode(testbed.traffic, 0x40);
        traffic_gear(testbed.traffic, 8);
        traffic_wheels(testbed.traffic, 0, 0);
        break;
    case 3:
        traffic_button(testbed.traffic, true);
        break;
    case 4:
        traffic_button(testbed.traffic, false);
        break;
    case 5:
        traffic_mode(testbed.traffic, 0xC0);
        break;
    case 6:
        traffic_mode(testbed.traffic, 0x00);
        break;
    default:
        testbed.receive_path_dead = (how & 8) != 0;
        break;
    }
}

static void long_silence(input_t *input, unsigned how) {
    const uint32_t days[4] = {1, 1000, 86400000, 1000000000}; /* ms; a step is less than half of the clock's range */
    testbed_jump(days[how & 3] * (1 + (input_byte(input) & 1)));
}

static void step(input_t *input) {
    const unsigned what = input_byte(input);
    const unsigned how = what >> 4;
    switch (what & 15) {
    case 0:
    case 1:
    case 2:
        any_frame(input, how);
        break;
    case 3:
        testbed_send(input_byte(input) % TRAFFIC_MESSAGES);
        break;
    case 4:
        testbed_jump(how);
        break;
    case 5:
        run(how + 1);
        break;
    case 6:
        run(input_byte(input));
        break;
    case 7:
        run((uint32_t)input_byte(input) * 8);
        break;
    case 8:
    case 9:
        change_message(input, how);
        break;
    case 10:
    case 11:
    case 12:
        change_vehicle(how);
        break;
    case 13:
        testbed_disturb((how & 1) != 0 ? HAL_CAN_AI : HAL_CAN_VEHICLE, how >> 1, input_byte(input));
        break;
    case 14:
        testbed_restart((hal_reset_cause_t)(how % 6));
        break;
    default:
        long_silence(input, how);
        break;
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    input_t input = {.at = data, .left = size};
    const unsigned state = input_byte(&input) % TESTBED_STATES;
    const unsigned variant = input_byte(&input) % TESTBED_VARIANTS;
    testbed_load(variant, state);
    ran_ms = 0;
    for (unsigned i = 0; (i < STEPS_MAX) && (input.left > 0); i++) {
        step(&input);
    }
    run(20);
    return 0;
}

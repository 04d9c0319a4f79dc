/*
 * FSM-6 by brute force: random bytes as inputs of tests/fuzz/fuzz_supervisor.c, from every state of each topology. The
 * rules check every call.
 */
#include <stdio.h>
#include <string.h>

#include "input.h"
#include "testbed.h"
#include "unity.h"

enum { INPUTS = 150, INPUT_SIZE = 48, VARIANTS = 3 };

/* Steps that random bytes hardly make: a reset, and a vehicle that is engaged. */
static const struct {
    uint8_t size;
    uint8_t bytes[12];
} PHRASES[] = {{12, {0x0A, 0x2A, 0x4A, 0x07, 20, 0x3A, 0x07, 140, 0x4A, 0x06, 20, 0x0A}}, {4, {0x0A, 0x1A, 0x07, 100}}};

static uint32_t random_state;
static uint32_t ends_in[TESTBED_STATES];
static uint32_t resets;

static uint32_t draw(uint32_t below) {
    random_state = random_state * 1664525 + 1013904223;
    return (random_state >> 8) % below;
}

static void fail(void) {
    TEST_FAIL_MESSAGE(testbed.rules.broken);
}

void setUp(void) {
    testbed_on_broken = fail;
    memset(ends_in, 0, sizeof ends_in);
    resets = 0;
}

static void note_end(void) {
    static const agv_state_t STATES[] = {AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED,
                                         AGV_STATE_SAFE};
    for (unsigned i = 0; i < TESTBED_STATES; i++) {
        ends_in[i] += (agv_supervisor_state(&testbed.supervisor) == STATES[i]) ? 1 : 0;
    }
    resets += (uint32_t)testbed.rules.resets;
}

static void run_randomly(unsigned first_variant, uint32_t seed) {
    uint8_t bytes[INPUT_SIZE + sizeof PHRASES[0].bytes];
    random_state = seed;
    for (unsigned i = 0; i < INPUTS; i++) {
        size_t size = 2;
        bytes[0] = (uint8_t)draw(TESTBED_STATES);
        bytes[1] = (uint8_t)(first_variant + draw(VARIANTS));
        while (size < INPUT_SIZE) {
            const unsigned phrase = draw(20);
            if (phrase < sizeof PHRASES / sizeof PHRASES[0]) {
                memcpy(&bytes[size], PHRASES[phrase].bytes, PHRASES[phrase].size);
                size += PHRASES[phrase].size;
            } else {
                bytes[size++] = (uint8_t)draw(256);
            }
        }
        (void)LLVMFuzzerTestOneInput(bytes, size);
        note_end();
    }
    (void)printf("%u resets; ends in INIT %u, STANDBY %u, ACTIVE %u, TRIPPED %u, SAFE %u\n", (unsigned)resets,
                 (unsigned)ends_in[0], (unsigned)ends_in[1], (unsigned)ends_in[2], (unsigned)ends_in[3],
                 (unsigned)ends_in[4]);
    TEST_ASSERT_TRUE(resets >= 3);
    for (unsigned i = 0; i < TESTBED_STATES; i++) {
        TEST_ASSERT_TRUE_MESSAGE(ends_in[i] >= 3, "a state was hardly seen");
    }
}

/* Shows: FSM-6, FSM-3, FSM-4, FSM-7, FSM-11, INT-2 */
void test_random_input_on_the_shared_bus(void) {
    run_randomly(0, 20261121);
}

/* Shows: FSM-6, FSM-3, FSM-4, FSM-7, FSM-11, INT-2, TOP-2 */
void test_random_input_in_the_gateway(void) {
    run_randomly(3, 1121);
}

/* The states: codes far apart, and safe behaviour for invalid codes. */
#include "agv/state.h"

#include "keep/latch.h"
#include "unity.h"

static const uint8_t STATES[] = {AGV_STATE_INIT, AGV_STATE_STANDBY, AGV_STATE_ACTIVE, AGV_STATE_TRIPPED,
                                 AGV_STATE_SAFE};

static unsigned distance(unsigned a, unsigned b) {
    unsigned bits = 0;
    for (unsigned difference = a ^ b; difference != 0; difference >>= 1) {
        bits += difference & 1;
    }
    return bits;
}

/* Shows: INT-5 */
void test_states_and_latch_are_codes_far_apart(void) {
    for (unsigned i = 0; i < sizeof STATES; i++) {
        for (unsigned k = 0; k < i; k++) {
            TEST_ASSERT_GREATER_OR_EQUAL_UINT(4, distance(STATES[i], STATES[k]));
        }
    }
    TEST_ASSERT_EQUAL_UINT(8, distance(AGV_LATCH_OPEN, AGV_LATCH_CLOSED));
}

/* Of all 256 values only STANDBY (33h) and ACTIVE (3Ch) do not command the safe state; of the rest only INIT (0Fh) is not
 * latched. */
/* Shows: INT-5, FSM-6 */
void test_an_invalid_state_is_safe_and_latched(void) {
    for (unsigned value = 0; value < 256; value++) {
        const bool drives = value == 0x33 || value == 0x3C;
        TEST_ASSERT_EQUAL(!drives, agv_state_commands_safe((agv_state_t)value));
        TEST_ASSERT_EQUAL(!drives && value != 0x0F, agv_state_is_latched((agv_state_t)value));
    }
}

/* The oracle itself: which frames it allows in which state. That it judges what came before, such as the held angle and the
 * mode, is shown by the seeded faults of tests/proofs/explorer. */
#include "oracle.h"
#include "unity.h"

#include <stdio.h>

/* States that have the same rules; an invalid state code is latched, too. */
enum { INIT = 1, LATCHED = 2, STANDBY = 4, ACTIVE = 8, SAFE_ONES = INIT | LATCHED };

static const struct {
    agv_state_t state;
    uint8_t rules;
} STATES[] = {{AGV_STATE_INIT, INIT},       {AGV_STATE_TRIPPED, LATCHED}, {AGV_STATE_SAFE, LATCHED},
              {(agv_state_t)0x00, LATCHED}, {(agv_state_t)0x54, LATCHED}, {AGV_STATE_STANDBY, STANDBY},
              {AGV_STATE_ACTIVE, ACTIVE}};

/* Where it is allowed, while 363h reports autopilot and 067h an angle of 9000. */
static const struct {
    hal_can_frame_t frame;
    hal_can_side_t side;
    uint8_t shared;
    uint8_t gateway;
} ROWS[] = {
    {{.id = 0x43F, .length = 8, .data = {[4] = 0x70}}, HAL_CAN_VEHICLE, SAFE_ONES, SAFE_ONES | STANDBY | ACTIVE},
    {{.id = 0x43F, .length = 8, .data = {[4] = 0x70, [7] = 255}},
     HAL_CAN_VEHICLE,
     SAFE_ONES,
     SAFE_ONES | STANDBY | ACTIVE},
    {{.id = 0x43F, .length = 8, .data = {[4] = 0x30}}, HAL_CAN_VEHICLE, 0, STANDBY | ACTIVE}, /* autopilot not off */
    {{.id = 0x43F, .length = 8, .data = {[4] = 0xF0}}, HAL_CAN_VEHICLE, 0, STANDBY | ACTIVE}, /* headlight off */
    {{.id = 0x43F, .length = 8, .data = {[4] = 0x60}}, HAL_CAN_VEHICLE, 0, STANDBY | ACTIVE}, /* no hazard lights */
    {{.id = 0x43F, .length = 8, .data = {[4] = 0x71}}, HAL_CAN_VEHICLE, 0, 0},                /* a reserved bit */
    {{.id = 0x168, .length = 8, .data = {8}}, HAL_CAN_VEHICLE, SAFE_ONES, SAFE_ONES | ACTIVE},
    {{.id = 0x168, .length = 8, .data = {1}}, HAL_CAN_VEHICLE, 0, ACTIVE},
    {{.id = 0x168, .length = 8, .data = {2}}, HAL_CAN_VEHICLE, 0, ACTIVE},
    {{.id = 0x168, .length = 8, .data = {4}}, HAL_CAN_VEHICLE, 0, ACTIVE},
    {{.id = 0x168, .length = 8, .data = {3}}, HAL_CAN_VEHICLE, 0, 0},
    {{.id = 0x168, .length = 8, .data = {8, 1}}, HAL_CAN_VEHICLE, 0, 0},
    {{.id = 0x075, .length = 8}, HAL_CAN_VEHICLE, SAFE_ONES, SAFE_ONES | ACTIVE},
    {{.id = 0x075, .length = 8, .data = {250}}, HAL_CAN_VEHICLE, 0, ACTIVE},
    {{.id = 0x075, .length = 8, .data = {251}}, HAL_CAN_VEHICLE, 0, 0},
    {{.id = 0x075, .length = 1}, HAL_CAN_VEHICLE, 0, 0},
    {{.id = 0x075, .length = 8, .flags = HAL_CAN_EXTENDED}, HAL_CAN_VEHICLE, 0, 0},
    {{.id = 0x065, .length = 8, .data = {0x28, 0x23}}, HAL_CAN_VEHICLE, LATCHED, LATCHED | ACTIVE}, /* 9000 */
    {{.id = 0x065, .length = 8, .data = {0x50, 0x46}}, HAL_CAN_VEHICLE, 0, ACTIVE},                 /* 18000 */
    {{.id = 0x065, .length = 8, .data = {0x51, 0x46}}, HAL_CAN_VEHICLE, 0, 0},
    {{.id = 0x363, .length = 8}, HAL_CAN_VEHICLE, 0, 0},
    {{.id = 0x123, .length = 8}, HAL_CAN_VEHICLE, 0, 0},
    {{.id = 0x363, .length = 8}, HAL_CAN_AI, 0, SAFE_ONES | STANDBY | ACTIVE},
    {{.id = 0x168, .length = 8, .data = {8}}, HAL_CAN_AI, 0, 0},
};

static bool allows(bool gateway, agv_state_t state, unsigned row) {
    static const hal_can_frame_t AUTOPILOT = {.id = 0x363, .length = 8, .data = {[6] = 0x80}};
    static const hal_can_frame_t ANGLE = {.id = 0x067, .length = 8, .data = {[2] = 0x28, 0x23}};
    oracle_t oracle = {
        .gateway = gateway, .signal_id = 0x43F, .vehicle_id = 0x363, .hold_age_ms = 50, .angle_frames = 3};
    oracle_restart(&oracle);
    oracle_heard(&oracle, HAL_CAN_VEHICLE, &AUTOPILOT);
    oracle_heard(&oracle, HAL_CAN_VEHICLE, &ANGLE);
    oracle_sent(&oracle, ROWS[row].side, &ROWS[row].frame, state);
    return oracle.forbidden == 0;
}

/* Shows: FSM-6, FSM-10, TOP-2 */
void test_which_frames_it_allows(void) {
    char where[64];
    for (unsigned row = 0; row < sizeof ROWS / sizeof ROWS[0]; row++) {
        for (unsigned i = 0; i < sizeof STATES / sizeof STATES[0]; i++) {
            (void)snprintf(where, sizeof where, "row %u in state %02Xh", row, (unsigned)STATES[i].state);
            TEST_ASSERT_EQUAL_MESSAGE((ROWS[row].shared & STATES[i].rules) != 0, allows(false, STATES[i].state, row),
                                      where);
            TEST_ASSERT_EQUAL_MESSAGE((ROWS[row].gateway & STATES[i].rules) != 0, allows(true, STATES[i].state, row),
                                      where);
        }
    }
}

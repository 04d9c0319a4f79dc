/* What is noted of a case. Times by hand from the requirements: SUP-2 (50 ms), FSM-4 (500 ms), HW-2 (at once). */
#include <stdlib.h>

#include "agv/state.h"
#include "atlas/atlas_play.h"
#include "unity.h"

static atlas_play_t *play;

void setUp(void) {
    play = calloc(1, sizeof *play);
    TEST_ASSERT_NOT_NULL(play);
}

void tearDown(void) {
    free(play);
}

static const atlas_outcome_t *outcome_of(atlas_case_t pair) {
    TEST_ASSERT_TRUE(atlas_play(play, &pair));
    TEST_ASSERT_TRUE(play->outcome.ready);
    TEST_ASSERT_EQUAL(HAZARD_NONE, play->outcome.hazard);
    return &play->outcome;
}

void test_a_lost_vcu_alone(void) {
    const atlas_outcome_t *outcome =
        outcome_of((atlas_case_t){.first = campaign_row(AGV_FAULT_VCU_HEARTBEAT_LOST), .state = ATLAS_ACTIVE});
    TEST_ASSERT_EQUAL(AGV_FAULT_VCU_HEARTBEAT_LOST, outcome->reason);
    TEST_ASSERT_EQUAL(AGV_STATE_TRIPPED, outcome->state);     /* a VCU that is silent confirms nothing */
    TEST_ASSERT_INT32_WITHIN(10000, 51000, outcome->safe_us); /* the last frame was up to 10 ms before */
    TEST_ASSERT_INT32_WITHIN(10000, 551000, outcome->open_us);
}

void test_the_second_fault_alone_comes_later(void) {
    const atlas_outcome_t *outcome = outcome_of(
        (atlas_case_t){.second = campaign_row(AGV_FAULT_EMERGENCY_STOP), .state = ATLAS_ACTIVE, .distance = 3});
    TEST_ASSERT_EQUAL(AGV_FAULT_EMERGENCY_STOP, outcome->reason);
    TEST_ASSERT_EQUAL(AGV_STATE_SAFE, outcome->state);
    TEST_ASSERT_INT32_WITHIN(1000, 500000, outcome->open_us);
}

void test_states_in_which_nothing_new_trips(void) {
    static const atlas_state_t states[] = {ATLAS_TRIPPED, ATLAS_SAFE};
    for (size_t i = 0; i < sizeof states / sizeof states[0]; i++) {
        const atlas_outcome_t *outcome =
            outcome_of((atlas_case_t){.first = campaign_row(AGV_FAULT_S_DRIVER_ALARM), .state = states[i]});
        TEST_ASSERT_EQUAL(-1, outcome->reason);
        TEST_ASSERT_EQUAL(AGV_STATE_SAFE, outcome->state);
    }
}

void test_init_stays_init(void) {
    const atlas_outcome_t *outcome = outcome_of((atlas_case_t){.first = campaign_row(AGV_FAULT_VCU_HEARTBEAT_LOST),
                                                               .second = campaign_row(AGV_FAULT_EPS_HEARTBEAT_LOST),
                                                               .state = ATLAS_INIT});
    TEST_ASSERT_EQUAL(-1, outcome->reason);
    TEST_ASSERT_EQUAL(AGV_STATE_INIT, outcome->state);
    TEST_ASSERT_EQUAL(0, outcome->open_us);
    TEST_ASSERT_LESS_THAN_INT32(100000, outcome->safe_us); /* they go on, 168h every 100 ms */
}

/* Which pairs there are, and the text of one. */
#include <string.h>

#include "atlas/atlas_case.h"
#include "atlas/atlas_scenario.h"
#include "unity.h"

static text_t text;

void setUp(void) {
    text_clear(&text);
}

static bool exists(atlas_state_t state, bool gateway, agv_fault_t first, agv_fault_t second, uint32_t distance) {
    for (uint32_t number = 0; number < atlas_case_count(); number++) {
        atlas_case_t pair;
        if (atlas_case_get(number, &pair) && (pair.state == state) && (pair.gateway == gateway) &&
            (pair.first->fault == first) && (pair.second->fault == second) && (pair.distance == distance)) {
            return true;
        }
    }
    return false;
}

void test_every_state_and_distance_of_two_faults_that_can_always_come(void) {
    for (int state = 0; state < ATLAS_STATES; state++) {
        for (uint32_t distance = 0; distance < ATLAS_DISTANCES; distance++) {
            TEST_ASSERT_TRUE(
                exists((atlas_state_t)state, false, AGV_FAULT_VCU_HEARTBEAT_LOST, AGV_FAULT_S_DRIVER_ALARM, distance));
            TEST_ASSERT_TRUE(
                exists((atlas_state_t)state, true, AGV_FAULT_S_DRIVER_ALARM, AGV_FAULT_VCU_HEARTBEAT_LOST, distance));
        }
    }
}

void test_pairs_that_cannot_happen(void) {
    TEST_ASSERT_FALSE(exists(ATLAS_ACTIVE, false, AGV_FAULT_BUS_OFF, AGV_FAULT_BUS_OFF, 0));
    TEST_ASSERT_FALSE(
        exists(ATLAS_STANDBY, false, AGV_FAULT_AI_HEARTBEAT_LOST, AGV_FAULT_BUS_OFF, 0));       /* SUP-3: engaged */
    TEST_ASSERT_FALSE(exists(ATLAS_ACTIVE, false, AGV_FAULT_AI_BUS_OFF, AGV_FAULT_BUS_OFF, 0)); /* no AI side */
    TEST_ASSERT_FALSE(exists(ATLAS_ACTIVE, true, AGV_FAULT_SELF_TEST_FAILED, AGV_FAULT_BUS_OFF, 0)); /* at the start */
}

void test_a_pair_as_a_scenario(void) {
    const atlas_case_t pair = {.first = campaign_row(AGV_FAULT_EMERGENCY_STOP),
                               .second = campaign_row(AGV_FAULT_OUTPUT_FEEDBACK),
                               .state = ATLAS_ACTIVE,
                               .distance = 2};
    atlas_scenario_write(&text, &pair);
    TEST_ASSERT_EQUAL_STRING("name: ACTIVE, EMERGENCY_STOP, then OUTPUT_FEEDBACK after 50 ms\n"
                             "shows: [EMERGENCY_STOP]\n"
                             "topology: shared\n"
                             "board: [emergency_stop, output_feedback]\n"
                             "config:\n"
                             "  park: at_once\n"
                             "vehicle:\n"
                             "  ai_starts_ms: 0\n"
                             "duration_ms: 10500\n"
                             "steps:\n"
                             "  - {at_ms: 1000, ai: drive, gear: D, throttle_pct: 20, steer_deg: 5}\n"
                             "  - {at_ms: 1500, operator: engage}\n"
                             "  - {at_ms: 3000, board: open_emergency_stop}\n"
                             "  - {at_ms: 3050, board: invert_feedback}\n",
                             text.bytes);
}

void test_alarms_of_the_first_fault_stay_set(void) {
    const atlas_case_t pair = {.first = campaign_row(AGV_FAULT_VCU_EPS_HARDWARE_FAULT),
                               .second = campaign_row(AGV_FAULT_EPS_MOTOR_ENCODER),
                               .state = ATLAS_STANDBY,
                               .distance = 1};
    atlas_scenario_write(&text, &pair);
    TEST_ASSERT_NOT_NULL(strstr(text.bytes, "  - {at_ms: 3000, vcu: set, field: alarms, value: 10h}\n"
                                            "  - {at_ms: 3001, vcu: set, field: alarms, value: 10h}\n"
                                            "  - {at_ms: 3001, eps: set, field: faults, value: 40h}\n"));
}

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
        exists(ATLAS_STANDBY, false, AGV_FAULT_GEAR_COMMAND_TIMEOUT, AGV_FAULT_BUS_OFF, 0));    /* SUP-3: engaged */
    TEST_ASSERT_FALSE(exists(ATLAS_ACTIVE, false, AGV_FAULT_AI_BUS_OFF, AGV_FAULT_BUS_OFF, 0)); /* no AI side */
    TEST_ASSERT_FALSE(exists(ATLAS_ACTIVE, true, AGV_FAULT_SELF_TEST_FAILED, AGV_FAULT_BUS_OFF, 0)); /* at the start */
    TEST_ASSERT_FALSE(exists(ATLAS_INIT, true, AGV_FAULT_BUS_OFF, AGV_FAULT_SELF_TEST_FAILED, 0));
    TEST_ASSERT_FALSE(exists(ATLAS_INIT, false, AGV_FAULT_SELF_TEST_FAILED, AGV_FAULT_CONFIG_INVALID, 1));
}

void test_a_fault_of_the_safe_state_may_follow_each_trip(void) {
    TEST_ASSERT_TRUE(
        exists(ATLAS_STANDBY, true, AGV_FAULT_S_DRIVER_ALARM, AGV_FAULT_SAFE_STATE_UNCONFIRMED, 3)); /* FSM-4 */
    TEST_ASSERT_TRUE(
        exists(ATLAS_INIT, false, AGV_FAULT_SELF_TEST_FAILED, AGV_FAULT_VEHICLE_NOT_STOPPING, 0)); /* FSM-12 */
    TEST_ASSERT_FALSE(exists(ATLAS_STANDBY, true, AGV_FAULT_SAFE_STATE_UNCONFIRMED, AGV_FAULT_S_DRIVER_ALARM, 3));
    TEST_ASSERT_FALSE(exists(ATLAS_SAFE, true, AGV_FAULT_S_DRIVER_ALARM, AGV_FAULT_VEHICLE_NOT_STOPPING, 0));
}

/* The numbers that docs/atlas.md gives, by why a pair has no case. */
void test_how_many_pairs_have_no_case(void) {
    static bool has[AGV_FAULT_COUNT][AGV_FAULT_COUNT];
    uint32_t cases = 0;
    uint32_t at_start = 0;
    uint32_t after_start = 0;
    for (uint32_t number = 0; number < atlas_case_count(); number++) {
        atlas_case_t pair;
        if (atlas_case_get(number, &pair)) {
            has[pair.first->fault][pair.second->fault] = true;
            cases++;
        }
    }
    for (size_t first = 0; first < CAMPAIGN_ROW_COUNT; first++) {
        for (size_t second = 0; second < CAMPAIGN_ROW_COUNT; second++) {
            const bool starts = (CAMPAIGN_ROWS[first].flags & CAMPAIGN_START) != 0;
            if ((first == second) || has[CAMPAIGN_ROWS[first].fault][CAMPAIGN_ROWS[second].fault]) {
                continue;
            }
            TEST_ASSERT_TRUE(starts || ((CAMPAIGN_ROWS[second].flags & CAMPAIGN_START) != 0));
            after_start += starts ? 1 : 0;
            at_start += starts ? 0 : 1;
        }
    }
    TEST_ASSERT_EQUAL(92438, cases);
    TEST_ASSERT_EQUAL(126, at_start);
    TEST_ASSERT_EQUAL(36, after_start); /* 34: no engagement, or manual driving, after it; 2: on the gateway only */
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

static bool says(atlas_state_t state, agv_fault_t first, const char *line) {
    const atlas_case_t pair = {
        .first = campaign_row(first), .second = campaign_row(AGV_FAULT_EMERGENCY_STOP), .state = state};
    text_clear(&text);
    atlas_scenario_write(&text, &pair);
    return strstr(text.bytes, line) != NULL;
}

void test_what_else_a_fault_needs_in_manual(void) {
    static const char trips[] = "  ai_lost_in_manual: trip\n";
    static const char engaged[] = "  - {at_ms: 2000, operator: engage}\n  - {at_ms: 2400, operator: disengage}\n";
    TEST_ASSERT_TRUE(says(ATLAS_STANDBY, AGV_FAULT_AI_HEARTBEAT_LOST, trips)); /* SUP-8 */
    TEST_ASSERT_TRUE(says(ATLAS_SAFE, AGV_FAULT_AI_HEARTBEAT_STUCK, trips));
    TEST_ASSERT_FALSE(says(ATLAS_ACTIVE, AGV_FAULT_AI_HEARTBEAT_LOST, trips));
    TEST_ASSERT_TRUE(says(ATLAS_STANDBY, AGV_FAULT_MODE_FLAPPING, engaged)); /* SUP-9: three more come */
    TEST_ASSERT_FALSE(says(ATLAS_ACTIVE, AGV_FAULT_MODE_FLAPPING, engaged));
}

void test_the_drive_after_init_keeps_the_order_of_time(void) {
    TEST_ASSERT_TRUE(says(ATLAS_INIT, AGV_FAULT_TX_STALLED,
                          "  - {at_ms: 1500, operator: drive, gear: D, throttle_pct: 20}\n"
                          "  - {at_ms: 1700, supervisor: free_tx}\n"));
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

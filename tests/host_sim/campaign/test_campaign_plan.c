/* The runs of a campaign: every fault by its row, every run a scenario that is read, nothing but seed and number. */
#include "campaign/campaign_plan.h"

#include <string.h>

#include "agv/names.h"
#include "campaign/campaign_check.h"
#include "scenario/scenario.h"
#include "scratch.h"
#include "unity.h"

static const campaign_causes_t ANY = {0};
static const campaign_causes_t NEWLY_ENGAGED = {.newly_engaged = true};
static campaign_plan_t plan;
static campaign_plan_t other;
static scenario_t scenario;
static agv_config_t config;
static text_t text;

void setUp(void) {
    scratch_open();
    agv_config_defaults(&config);
}

static bool is_read(void) {
    text.used = 0;
    text_add(&text, "%sexpect: {states: []}\n", plan.head.bytes);
    return !plan.head.full && !text.full && scenario_read_text(&scenario, "run", text.bytes, NULL);
}

void test_every_run_of_every_fault_is_a_scenario(void) {
    for (size_t i = 0; i < CAMPAIGN_ROW_COUNT; i++) {
        for (uint64_t run = 0; run < 40; run++) {
            const campaign_causes_t causes = {.only = &CAMPAIGN_ROWS[i]};
            campaign_plan_make(&plan, 11, run, &causes);
            TEST_ASSERT_TRUE_MESSAGE(is_read(), plan.head.bytes);
            TEST_ASSERT_EQUAL(plan.bitrate, scenario.bitrate);
            TEST_ASSERT_EQUAL(plan.duration_ms, scenario.duration_ms);
            TEST_ASSERT_EQUAL(plan.gateway, scenario.vehicle.gateway);
            TEST_ASSERT_EQUAL(plan.tick_phase_us, scenario.tick_phase_us);
            TEST_ASSERT_EQUAL_HEX16(plan.renumbered ? 0x169 : 0x168, scenario.ids.of[AGV_MSG_GEAR_COMMAND]);
        }
    }
}

void test_the_last_step_is_the_cause_or_comes_after_it(void) {
    for (uint64_t run = 0; run < 500; run++) {
        campaign_plan_make(&plan, 12, run, &ANY);
        TEST_ASSERT_TRUE(is_read());
        if ((plan.row->flags & CAMPAIGN_START) != 0) {
            TEST_ASSERT_EQUAL(0, plan.cause_ms);
            continue;
        }
        const uint32_t later_ms = ((plan.row->flags & CAMPAIGN_LATER) != 0) ? plan.number : 0;
        TEST_ASSERT_TRUE(scenario.steps[scenario.step_count - 1].at_ms >= plan.cause_ms - later_ms);
        TEST_ASSERT_EQUAL(plan.cause_ms - later_ms, scenario.steps[2].at_ms);
        TEST_ASSERT_EQUAL(plan.steps_ms, scenario.steps[2].at_ms);
    }
}

/* Steps: the AI computer drives, the operator drives, the cause and the engagement. */
void test_a_cause_that_comes_with_an_engagement(void) {
    bool before = false;
    bool after = false;
    for (uint64_t run = 0; run < 500; run++) {
        campaign_plan_make(&plan, 13, run, &NEWLY_ENGAGED);
        TEST_ASSERT_TRUE(is_read());
        TEST_ASSERT_EQUAL_PTR(campaign_engagement(plan.row->fault), plan.engagement);
        TEST_ASSERT_NOT_NULL(plan.engagement);
        TEST_ASSERT_TRUE(plan.engaged);
        if (plan.engagement->never_seen) {
            TEST_ASSERT_EQUAL(0, plan.steps_ms);
            TEST_ASSERT_EQUAL(plan.engage_ms, plan.cause_ms);
            continue;
        }
        TEST_ASSERT_TRUE(plan.steps_ms + 50 >= plan.engage_ms);
        TEST_ASSERT_TRUE(plan.steps_ms <= plan.engage_ms + 500);
        before = before || (plan.steps_ms < plan.engage_ms);
        after = after || (plan.steps_ms > plan.engage_ms);
        TEST_ASSERT_EQUAL((plan.steps_ms > plan.engage_ms) ? plan.steps_ms : plan.engage_ms, plan.cause_ms);
    }
    TEST_ASSERT_TRUE(before && after);
}

void test_nothing_but_seed_and_number_makes_a_run(void) {
    campaign_plan_make(&plan, 1, 2, &ANY);
    memset(&other, 0xA5, sizeof other);
    campaign_plan_make(&other, 1, 2, &ANY);
    TEST_ASSERT_EQUAL_STRING(plan.head.bytes, other.head.bytes);
    campaign_plan_make(&other, 1, 3, &ANY);
    TEST_ASSERT_TRUE(strcmp(plan.head.bytes, other.head.bytes) != 0);
    campaign_plan_make(&other, 2, 1, &ANY);
    TEST_ASSERT_TRUE(strcmp(plan.head.bytes, other.head.bytes) != 0);
}

void test_a_row_is_found_by_its_fault(void) {
    size_t found = 0;
    for (int fault = 0; fault < AGV_FAULT_COUNT; fault++) {
        const campaign_row_t *row = campaign_row((agv_fault_t)fault);
        found += (row != NULL) ? 1 : 0;
        TEST_ASSERT_TRUE((row == NULL) || (row->fault == (agv_fault_t)fault));
    }
    TEST_ASSERT_EQUAL(CAMPAIGN_ROW_COUNT, found);
    TEST_ASSERT_NULL(campaign_row(AGV_FAULT_TX_GATE_REFUSED));
    TEST_ASSERT_NULL(campaign_row(AGV_FAULT_NONE));
}

void test_decision_times_worked_out_by_hand(void) {
    static const struct {
        agv_fault_t fault;
        uint32_t ms;
    } rows[] = {
        {AGV_FAULT_OUTPUT_FEEDBACK, 101},
        {AGV_FAULT_EMERGENCY_STOP, 1},
        {AGV_FAULT_CLOCK_DEVIATION, 2000},
        {AGV_FAULT_BUS_OFF, 1},
        {AGV_FAULT_SUPERVISOR_RESET, 0},
        {AGV_FAULT_VCU_HEARTBEAT_LOST, 51},
        {AGV_FAULT_AI_HEARTBEAT_STUCK, 351},
        {AGV_FAULT_EPS_MOTOR_ENCODER, 10},
        {AGV_FAULT_EPS_UNDER_VOLTAGE, 30},
        {AGV_FAULT_EPS_MODE_OFF, 50},
        {AGV_FAULT_GEAR_STATUS_INVALID, 75},
        {AGV_FAULT_MODE_INVALID, 62},
        {AGV_FAULT_STEERING_DEVIATION, 527},
        {AGV_FAULT_MODE_FLAPPING, 10},
        {AGV_FAULT_MODE_NONE, 512},
        {AGV_FAULT_THROTTLE_DEVIATION, 512},
        {AGV_FAULT_GEAR_DEVIATION, 1027},
        {AGV_FAULT_AUTOPILOT_OFF_IGNORED, 1102},
        {AGV_FAULT_SAFE_STATE_UNCONFIRMED, 627},
        {AGV_FAULT_VEHICLE_NOT_STOPPING, 5127},
        {AGV_FAULT_SPEED_IMPLAUSIBLE, 1012},
        {AGV_FAULT_STATUS_ID_IN_USE, 1},
        {AGV_FAULT_FOREIGN_COMMAND_SENDER, 0},
        {AGV_FAULT_COMMAND_TOO_FAST, 385},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(rows[i].ms, campaign_decision_ms(campaign_row(rows[i].fault), &config),
                                  agv_fault_name(rows[i].fault));
    }
}

void test_decision_times_after_an_engagement_worked_out_by_hand(void) {
    static const struct {
        agv_fault_t fault;
        uint32_t ms; /* 10 ms until 363h says it; then 500 ms, or the deadline; then what the fault itself takes */
    } rows[] = {
        {AGV_FAULT_AI_HEARTBEAT_LOST, 10 + 500 + 1},
        {AGV_FAULT_GEAR_COMMAND_TIMEOUT, 10 + 350 + 1},
        {AGV_FAULT_STEERING_COMMAND_TIMEOUT, 10 + 125 + 1},
        {AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, 10 + 100},
        {AGV_FAULT_EPS_MODE_OFF, 10 + 500 + 50},
        {AGV_FAULT_GEAR_STATUS_INVALID, 10 + 500 + 75},
        {AGV_FAULT_STEERING_DEVIATION, 10 + 500 + 25 + 500 + 2},
        {AGV_FAULT_THROTTLE_IN_PARK, 10 + 500 + 25 + 200 + 2},
        {AGV_FAULT_THROTTLE_DEVIATION, 10 + 500 + 10 + 500 + 2},
        {AGV_FAULT_AUTOPILOT_OFF_IGNORED, 10 + 500 + 100 + 1000 + 2},
    };
    for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
        TEST_ASSERT_EQUAL_MESSAGE(
            rows[i].ms,
            campaign_engaged_decision_ms(campaign_row(rows[i].fault), campaign_engagement(rows[i].fault), &config),
            agv_fault_name(rows[i].fault));
    }
    TEST_ASSERT_NULL(campaign_engagement(AGV_FAULT_VCU_HEARTBEAT_LOST));
    TEST_ASSERT_NULL(campaign_engagement(AGV_FAULT_GEAR_DEVIATION)); /* the gateway passes no 168h then: not judged */
}

void test_a_text_that_is_full_says_so(void) {
    text.used = 0;
    text.full = false;
    while (!text.full) {
        text_add(&text, "%s", "0123456789");
    }
    TEST_ASSERT_EQUAL(TEXT_MAX / 10 * 10, text.used);
    TEST_ASSERT_EQUAL(text.used, strlen(text.bytes));
    text.full = false;
}

void test_every_break_has_its_word(void) {
    TEST_ASSERT_EQUAL_STRING("", campaign_break_name(CAMPAIGN_SOUND));
    TEST_ASSERT_EQUAL_STRING("LATE", campaign_break_name(CAMPAIGN_LATE));
    TEST_ASSERT_EQUAL_STRING("NEVER_SETTLED", campaign_break_name(CAMPAIGN_NEVER_SETTLED));
}

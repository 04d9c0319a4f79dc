/* A fault has cases in the states in which its cause, alone, makes the supervisor report it: in these and no others. */
#include <stdio.h>
#include <stdlib.h>

#include "agv/names.h"
#include "agv/recorder.h"
#include "atlas/atlas_case.h"
#include "atlas/atlas_play.h"
#include "atlas/atlas_scenario.h"
#include "unity.h"

/** A run of one cause. */
typedef struct {
    agv_fault_t fault;
    uint32_t from_ms;
    bool raised; /**< at the cause, or after it */
    scenario_t scenario;
    scenario_testbed_t testbed;
} run_t;

static run_t *run;
static bool has_case[2][ATLAS_STATES][AGV_FAULT_COUNT];

void setUp(void) {
    run = calloc(1, sizeof *run);
    TEST_ASSERT_NOT_NULL(run);
}

void tearDown(void) {
    free(run);
}

static void on_event(void *ctx, const session_event_t *event) {
    run_t *of = ctx;
    const bool counts = !event->is_led && (event->recorded.kind == AGV_EVENT_FAULT) && (event->recorded.a == of->fault);
    if (counts && ((event->recorded.c == 1) || (event->t_ms < of->from_ms))) {
        of->raised = event->recorded.c == 1;
    }
}

/** The run ends when the fault is reported. */
static bool after_tick(void *ctx, uint64_t t_ms) {
    const run_t *of = ctx;
    return !of->raised || (t_ms < of->from_ms);
}

static void find_cases(void) {
    for (uint32_t number = 0; number < atlas_case_count(); number++) {
        atlas_case_t of;
        if (atlas_case_get(number, &of)) {
            has_case[of.gateway][of.state][of.first->fault] = true;
        }
    }
}

/** Whether the cause of a fault, alone in a state, makes the supervisor report the fault. */
static bool is_raised(const campaign_row_t *row, bool gateway, atlas_state_t state) {
    static text_t text;
    const atlas_case_t alone = {.first = row, .gateway = gateway, .state = state};
    const bool starts = (row->flags & CAMPAIGN_START) != 0;

    text_clear(&text);
    atlas_scenario_write(&text, &alone);
    text_add(&text, "expect: {states: any}\n");
    TEST_ASSERT_TRUE(scenario_read_text(&run->scenario, "one cause", text.bytes, NULL));
    TEST_ASSERT_TRUE(scenario_testbed_init(&run->testbed, &run->scenario));
    run->fault = row->fault;
    run->from_ms = starts ? 0 : atlas_first_ms(state);
    run->raised = false;
    const scenario_watch_t watch = {.on_event = on_event, .ctx = run};
    scenario_testbed_watch(&run->testbed, &watch);
    const scenario_play_t play = {
        .scenario = &run->scenario, .until_ms = run->scenario.duration_ms, .after_tick = after_tick, .ctx = run};
    scenario_testbed_start(&run->testbed);
    scenario_play(&run->testbed, &play);
    return run->raised;
}

/** Causes that come all the same, and raise no fault by themselves. */
static bool is_quiet(const campaign_row_t *row, atlas_state_t state) {
    if (row->fault == AGV_FAULT_SUPERVISOR_RESET) {
        return (state == ATLAS_TRIPPED) || (state == ATLAS_SAFE); /* FSM-7: the stored reason is taken up */
    }
    return (row->fault == AGV_FAULT_SPEED_IMPLAUSIBLE) && (state == ATLAS_INIT); /* SUP-12: the VCU's speed was 0 */
}

/** There from the start on: in no other state. Or of a side that the shared bus does not have. */
static bool is_elsewhere(const campaign_row_t *row, bool gateway, atlas_state_t state) {
    return (((row->flags & CAMPAIGN_START) != 0) && (state != ATLAS_INIT)) ||
           ((row->fault == AGV_FAULT_AI_BUS_OFF) && !gateway);
}

static void check(const campaign_row_t *row, bool gateway, atlas_state_t state) {
    char says[100];
    const bool has = has_case[gateway][state][row->fault];

    (void)snprintf(says, sizeof says, "%s, %s, %s", agv_fault_name(row->fault), gateway ? "gateway" : "shared",
                   atlas_state_name(state));
    if (is_elsewhere(row, gateway, state)) {
        TEST_ASSERT_FALSE_MESSAGE(has, says);
        return;
    }
    TEST_ASSERT_EQUAL_MESSAGE(has, is_raised(row, gateway, state) || is_quiet(row, state), says);
}

void test_each_fault_has_cases_where_it_is_reported(void) {
    find_cases();
    for (size_t i = 0; i < CAMPAIGN_ROW_COUNT; i++) {
        for (int state = 0; state < ATLAS_STATES; state++) {
            check(&CAMPAIGN_ROWS[i], false, (atlas_state_t)state);
            check(&CAMPAIGN_ROWS[i], true, (atlas_state_t)state);
        }
    }
}

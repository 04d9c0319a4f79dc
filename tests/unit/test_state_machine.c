/* The state machine by itself: facts in, states out. */
#include "agv/state_machine.h"

#include "agv/core.h"
#include "agv/latch.h"
#include "unity.h"

/* Facts and what a step did by name. missing: AGV_MISSING_* */
typedef struct {
    agv_fault_t raised;
    agv_fault_t cause;
    agv_fault_t forever;
    unsigned missing;
    bool ai_cause;
    bool engaged;
    bool ai_alive;
    bool autopilot_off;
    bool in_park;
    bool button;
    bool button_known;
    bool output_unsafe;
} situation_t;

typedef struct {
    uint8_t from;
    uint8_t missing;
    bool tripped;
    bool reset_accepted;
    bool reset_refused;
    bool startup_timed_out;
} step_t;

static agv_core_t core;
static situation_t facts;
static step_t did;

static uint32_t words_of_facts(void) {
    const uint32_t with_missing =
        AGV_FACT_VCU_ALIVE | AGV_FACT_EPS_ALIVE | AGV_FACT_STANDSTILL | AGV_FACT_MANUAL | AGV_FACT_MESSAGES;
    uint32_t words = with_missing & ~facts.missing;
    words |= facts.engaged ? AGV_FACT_ENGAGED : 0;
    words |= facts.ai_alive ? AGV_FACT_AI_ALIVE : 0;
    words |= facts.autopilot_off ? AGV_FACT_AUTOPILOT_OFF : 0;
    words |= facts.in_park ? AGV_FACT_IN_PARK : 0;
    words |= facts.button ? AGV_FACT_BUTTON_DOWN : 0;
    words |= (facts.button_known && !facts.button) ? AGV_FACT_BUTTON_UP : 0;
    words |= facts.output_unsafe ? AGV_FACT_OUTPUT_UNSAFE : 0;
    return words;
}

static void start(agv_fault_t reason) {
    const agv_config_t config = core.config;
    core = (agv_core_t){.config = config, .now_ms = core.now_ms};
    agv_state_machine_start(&core, reason);
}

/* A vehicle in manual that stands in P, all well. */
static void all_well(void) {
    facts = (situation_t){.raised = AGV_FAULT_NONE,
                          .cause = AGV_FAULT_NONE,
                          .forever = AGV_FAULT_NONE,
                          .ai_alive = true,
                          .autopilot_off = true,
                          .in_park = true,
                          .button_known = true};
}

void setUp(void) {
    core = (agv_core_t){0};
    agv_config_defaults(&core.config);
    all_well();
    core.now_ms = 0xFFFFFF00u; /* every test wraps */
    start(AGV_FAULT_NONE);
}

void tearDown(void) {
}

/* The adaptor to the module: everything below goes through these. */
static void step(uint32_t after_ms) {
    core.now_ms += after_ms;
    core.summary.raised = (uint8_t)facts.raised;
    core.summary.cause = (uint8_t)facts.cause;
    core.summary.forever = (uint8_t)facts.forever;
    core.summary.ai_cause = facts.ai_cause;
    did.from = core.machine.state;
    const uint32_t done = agv_state_machine_step(&core, words_of_facts());
    did.missing = (uint8_t)(done & AGV_MISSING_ALL);
    did.tripped = (done & AGV_STEP_TRIPPED) != 0;
    did.reset_accepted = (done & AGV_STEP_RESET_ACCEPTED) != 0;
    did.reset_refused = (done & AGV_STEP_RESET_REFUSED) != 0;
    did.startup_timed_out = (done & AGV_STEP_STARTUP_TIMED_OUT) != 0;
    TEST_ASSERT_TRUE(agv_state_machine_is_sound(&core.machine));
    facts.raised = AGV_FAULT_NONE; /* told once */
}

static void run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        step(1);
    }
}

static void expect_state(agv_state_t state) {
    TEST_ASSERT_EQUAL_HEX8(state, core.machine.state);
}

static void trip(agv_fault_t reason) {
    facts.raised = reason;
    step(1);
    expect_state(AGV_STATE_TRIPPED);
}

static void to_standby(void) {
    step(0);
    run(500);
    expect_state(AGV_STATE_STANDBY);
}

static void to_safe(void) {
    to_standby();
    trip(AGV_FAULT_BUS_OFF);
    step(1);
    expect_state(AGV_STATE_SAFE);
}

/* Shows: INT-5 */
void test_of_all_states_and_latches_five_pairs_are_sound(void) {
    unsigned sound = 0;
    for (unsigned pair = 0; pair < 65536; pair++) {
        core.machine.state = (uint8_t)(pair & 0xFF);
        core.machine.latched = (uint8_t)(pair >> 8);
        sound += agv_state_machine_is_sound(&core.machine) ? 1u : 0u;
    }
    TEST_ASSERT_EQUAL_UINT(5, sound);
}

/* Shows: FSM-4 */
void test_init_is_left_after_500_ms_without_a_break(void) {
    step(0);
    run(499);
    facts.missing = AGV_MISSING_MANUAL;
    step(1);
    facts.missing = 0;
    step(1);
    run(499);
    expect_state(AGV_STATE_INIT);
    TEST_ASSERT_FALSE(core.machine.output_closed);
    step(1);
    expect_state(AGV_STATE_STANDBY);
    TEST_ASSERT_TRUE(core.machine.output_closed);
    TEST_ASSERT_EQUAL_HEX8(AGV_LATCH_OPEN, core.machine.latched);
}

/* Standstill is not asked for; everything else that may be missing keeps it. */
void test_what_keeps_init(void) {
    static const uint8_t needed[] = {AGV_MISSING_VCU_HEARTBEAT, AGV_MISSING_EPS_HEARTBEAT, AGV_MISSING_MANUAL,
                                     AGV_MISSING_MESSAGES};
    for (unsigned i = 0; i < sizeof needed; i++) {
        setUp();
        facts.missing = needed[i];
        run(1000);
        expect_state(AGV_STATE_INIT);
    }
    setUp();
    facts.cause = AGV_FAULT_S_DRIVER_ALARM;
    run(1000);
    expect_state(AGV_STATE_INIT); /* no cause latches in INIT */
    setUp();
    facts.ai_cause = true;
    run(1000);
    expect_state(AGV_STATE_INIT);
    setUp();
    facts.missing = AGV_MISSING_STANDSTILL;
    run(1000);
    expect_state(AGV_STATE_STANDBY);
}

/* Shows: STARTUP_TIMEOUT */
void test_after_10_s_the_start_says_once_what_is_missing(void) {
    facts.missing = AGV_MISSING_EPS_HEARTBEAT | AGV_MISSING_STANDSTILL;
    facts.cause = AGV_FAULT_BUS_OFF;
    run(10000);
    TEST_ASSERT_FALSE(did.startup_timed_out);
    step(1);
    TEST_ASSERT_TRUE(did.startup_timed_out);
    TEST_ASSERT_EQUAL_HEX8(AGV_MISSING_EPS_HEARTBEAT | AGV_MISSING_TRIP_CAUSE, did.missing);
    step(1);
    TEST_ASSERT_FALSE(did.startup_timed_out);
}

/* Shows: FSM-9 */
void test_an_unresettable_fault_trips_in_init_and_is_never_reset(void) {
    facts.raised = AGV_FAULT_BUS_OFF; /* not this one */
    facts.forever = AGV_FAULT_MEMORY_CORRUPTED;
    step(1);
    expect_state(AGV_STATE_TRIPPED);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_MEMORY_CORRUPTED, core.machine.first_reason);
    facts.forever = AGV_FAULT_NONE; /* even if its cause were gone */
    run(10);
    facts.button = true;
    run(3000);
    expect_state(AGV_STATE_SAFE);
    TEST_ASSERT_FALSE(core.machine.output_closed);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_MEMORY_CORRUPTED, core.machine.unresettable);
}

void test_active_while_engaged_with_the_ai_alive(void) {
    to_standby();
    facts.engaged = true;
    facts.ai_alive = false;
    step(1);
    expect_state(AGV_STATE_STANDBY);
    facts.ai_alive = true;
    step(1);
    expect_state(AGV_STATE_ACTIVE);
    facts.ai_alive = false; /* its loss trips by its own fault */
    step(1);
    expect_state(AGV_STATE_ACTIVE);
    facts.engaged = false;
    step(1);
    expect_state(AGV_STATE_STANDBY);
}

/* Shows: FSM-5 */
void test_the_first_reason_stays(void) {
    to_standby();
    trip(AGV_FAULT_THROTTLE_IN_PARK);
    TEST_ASSERT_TRUE(did.tripped);
    facts.raised = AGV_FAULT_BUS_OFF;
    step(1);
    TEST_ASSERT_FALSE(did.tripped);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_THROTTLE_IN_PARK, core.machine.first_reason);
}

/* A cause that was there before the state could trip for it. */
void test_a_cause_that_stands_trips_as_well(void) {
    to_standby();
    facts.cause = AGV_FAULT_MODE_INVALID;
    step(1);
    expect_state(AGV_STATE_TRIPPED);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_MODE_INVALID, core.machine.first_reason);
}

/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_autopilot_off_that_is_not_confirmed_opens_the_output(void) {
    to_standby();
    facts.autopilot_off = false;
    trip(AGV_FAULT_BUS_OFF);
    run(500);
    TEST_ASSERT_TRUE(core.machine.output_closed);
    TEST_ASSERT_FALSE(core.machine.safe_state_unconfirmed);
    step(1);
    TEST_ASSERT_FALSE(core.machine.output_closed);
    TEST_ASSERT_TRUE(core.machine.safe_state_unconfirmed);
    facts.autopilot_off = true;
    step(1);
    expect_state(AGV_STATE_SAFE);
    TEST_ASSERT_FALSE(core.machine.safe_state_unconfirmed);
    TEST_ASSERT_FALSE(core.machine.output_closed); /* until the next STANDBY */
}

/* 500 ms from the first P, which here was sent 200 ms after the trip. */
/* Shows: FSM-4, SAFE_STATE_UNCONFIRMED */
void test_p_that_is_not_confirmed_opens_the_output(void) {
    to_standby();
    facts.in_park = false;
    trip(AGV_FAULT_BUS_OFF);
    run(200);
    agv_state_machine_park_sent(&core);
    run(100);
    agv_state_machine_park_sent(&core); /* the first one counts */
    run(400);
    TEST_ASSERT_TRUE(core.machine.output_closed);
    step(1);
    TEST_ASSERT_FALSE(core.machine.output_closed);
}

/* Shows: FSM-4 */
void test_a_withdrawn_confirmation_begins_the_500_ms_anew(void) {
    to_standby();
    trip(AGV_FAULT_BUS_OFF);
    agv_state_machine_park_sent(&core);
    run(2000);
    expect_state(AGV_STATE_SAFE);
    facts.in_park = false;
    step(1);
    expect_state(AGV_STATE_TRIPPED);
    run(500);
    TEST_ASSERT_TRUE(core.machine.output_closed);
    step(1);
    TEST_ASSERT_FALSE(core.machine.output_closed);
}

/* Shows: FSM-4 */
void test_what_is_unsafe_for_the_output_opens_it_at_once(void) {
    to_standby();
    facts.output_unsafe = true;
    step(1);
    TEST_ASSERT_FALSE(core.machine.output_closed);
    facts.output_unsafe = false;
    step(1);
    TEST_ASSERT_FALSE(core.machine.output_closed);
}

/* Shows: FSM-3 */
void test_a_press_of_a_second_in_safe_resets(void) {
    to_safe();
    facts.button = true;
    step(1);
    run(999);
    expect_state(AGV_STATE_SAFE);
    step(1);
    expect_state(AGV_STATE_STANDBY);
    TEST_ASSERT_TRUE(did.reset_accepted);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_NONE, core.machine.first_reason);
    TEST_ASSERT_TRUE(core.machine.output_closed);
}

/* Shows: FSM-3 */
void test_a_cause_of_the_ai_keeps_no_reset(void) {
    to_safe();
    facts.ai_cause = true;
    facts.ai_alive = false;
    facts.button = true;
    run(1001);
    expect_state(AGV_STATE_STANDBY);
}

/* Shows: FSM-3 */
void test_a_press_in_vain_is_reported_once_with_what_was_missing(void) {
    to_safe();
    facts.cause = AGV_FAULT_S_DRIVER_ALARM;
    facts.missing = AGV_MISSING_STANDSTILL;
    facts.button = true;
    step(1);
    facts.missing = AGV_MISSING_MANUAL;
    run(999);
    TEST_ASSERT_FALSE(did.reset_refused);
    step(1);
    TEST_ASSERT_TRUE(did.reset_refused);
    TEST_ASSERT_EQUAL_HEX8(AGV_MISSING_TRIP_CAUSE | AGV_MISSING_STANDSTILL | AGV_MISSING_MANUAL, did.missing);
    step(1);
    TEST_ASSERT_FALSE(did.reset_refused);
    facts.cause = AGV_FAULT_NONE; /* the button need not be released */
    facts.missing = 0;
    run(1000);
    expect_state(AGV_STATE_SAFE);
    step(1);
    expect_state(AGV_STATE_STANDBY);
}

/* Shows: FSM-3 */
void test_a_press_from_before_the_trip_does_not_count(void) {
    to_standby();
    facts.button = true;
    step(1);
    trip(AGV_FAULT_BUS_OFF);
    run(1001);
    expect_state(AGV_STATE_SAFE);
    TEST_ASSERT_TRUE(did.reset_refused);
    TEST_ASSERT_TRUE((did.missing & AGV_MISSING_BUTTON) != 0);
    facts.button = false;
    step(1);
    facts.button = true;
    run(1001);
    expect_state(AGV_STATE_STANDBY);
}

/* Shows: FSM-3, FSM-7 */
void test_a_press_from_before_a_restart_does_not_count(void) {
    start(AGV_FAULT_SUPERVISOR_RESET);
    facts.button_known = false;
    step(1);
    facts.button_known = true;
    facts.button = true;
    run(3000);
    expect_state(AGV_STATE_SAFE);
}

/* Shows: FSM-1 */
void test_p_waits_for_standstill_or_3_s(void) {
    core.config.park = AGV_PARK_AT_STANDSTILL;
    to_standby();
    facts.missing = AGV_MISSING_STANDSTILL;
    facts.in_park = false;
    trip(AGV_FAULT_BUS_OFF);
    run(2999);
    TEST_ASSERT_FALSE(core.machine.park_released);
    step(1);
    TEST_ASSERT_TRUE(core.machine.park_released);
    setUp();
    core.config.park = AGV_PARK_AT_STANDSTILL;
    to_standby();
    facts.missing = AGV_MISSING_STANDSTILL;
    trip(AGV_FAULT_BUS_OFF);
    run(100);
    TEST_ASSERT_FALSE(core.machine.park_released);
    facts.missing = 0;
    step(1);
    TEST_ASSERT_TRUE(core.machine.park_released);
    setUp();
    to_standby();
    facts.missing = AGV_MISSING_STANDSTILL;
    trip(AGV_FAULT_BUS_OFF);
    TEST_ASSERT_TRUE(core.machine.park_released); /* at_once */
}

/* Shows: FSM-7 */
void test_a_start_in_tripped(void) {
    start(AGV_FAULT_EPS_HEARTBEAT_LOST);
    expect_state(AGV_STATE_TRIPPED);
    TEST_ASSERT_EQUAL_HEX8(AGV_LATCH_CLOSED, core.machine.latched);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_EPS_HEARTBEAT_LOST, core.machine.first_reason);
    TEST_ASSERT_FALSE(core.machine.output_closed);
}

/* The state machine by itself: facts in, states out. */
#include "decide/state_machine.h"

#include "keep/latch.h"
#include "unity.h"

/* Facts by name. missing: AGV_MISSING_* */
typedef struct {
    agv_fault_t raised;
    agv_fault_t cause;
    agv_fault_t forever;
    unsigned missing;
    agv_fault_t ai_cause;
    bool engaged;
    bool ai_alive;
    bool autopilot_off;
    bool in_park;
    bool moving; /* wheels or VCU report a speed */
    bool wheels_turn;
    bool reset;
    bool output_unsafe;
} situation_t;

static agv_state_machine_t machine;
static agv_timers_t timers;
static agv_config_t config;
static situation_t facts;
static agv_actions_t did;

static bool has_done(uint32_t action) {
    return (did.what & action) != 0;
}

static unsigned missing(void) {
    return did.missing;
}

static uint32_t words_of_facts(void) {
    const uint32_t with_missing = AGV_FACT_VCU_ALIVE | AGV_FACT_EPS_ALIVE | AGV_FACT_STANDSTILL | AGV_FACT_MANUAL |
                                  AGV_FACT_MESSAGES | AGV_FACT_IDLE | AGV_FACT_OUTPUT_OPEN;
    uint32_t words = with_missing & ~facts.missing;
    words |= facts.engaged ? AGV_FACT_ENGAGED : 0;
    words |= facts.ai_alive ? AGV_FACT_AI_ALIVE : 0;
    words |= facts.autopilot_off ? AGV_FACT_AUTOPILOT_OFF : 0;
    words |= facts.in_park ? AGV_FACT_IN_PARK : 0;
    words |= facts.moving ? 0 : AGV_FACT_SLOW;
    words |= facts.wheels_turn ? 0 : AGV_FACT_WHEELS_STAND;
    words |= facts.reset ? AGV_FACT_RESET : 0;
    words |= facts.output_unsafe ? AGV_FACT_OUTPUT_UNSAFE : 0;
    return words;
}

static void start(agv_fault_t reason) {
    machine = (agv_state_machine_t){0};
    agv_timers_start(&timers);
    agv_state_machine_start(&machine, &timers, &config, reason);
}

/* A healthy vehicle in manual, at standstill in P. */
static void all_well(void) {
    facts = (situation_t){.raised = AGV_FAULT_NONE,
                          .cause = AGV_FAULT_NONE,
                          .forever = AGV_FAULT_NONE,
                          .ai_cause = AGV_FAULT_NONE,
                          .ai_alive = true,
                          .autopilot_off = true,
                          .in_park = true};
}

void setUp(void) {
    agv_config_defaults(&config);
    all_well();
    agv_timers_set_time(&timers, 0xFFFFFF00u); /* the clock wraps in every test */
    start(AGV_FAULT_NONE);
}

/* Adapter to the module: all tests use these functions. */
static agv_fault_summary_t summary(void) {
    return (agv_fault_summary_t){.raised = (uint8_t)facts.raised,
                                 .cause = (uint8_t)facts.cause,
                                 .ai_cause = (uint8_t)facts.ai_cause,
                                 .unresettable = (uint8_t)facts.forever};
}

static void step(uint32_t after_ms) {
    const agv_fault_summary_t faults = summary();
    const uint8_t from = machine.state;
    const uint8_t first_reason = machine.first_reason;
    agv_timers_advance(&timers, &config, timers.now_ms + after_ms, 0);
    did = agv_state_machine_step(&machine, &timers, &config, &faults, words_of_facts());
    TEST_ASSERT_EQUAL_HEX8(from, did.from);
    TEST_ASSERT_EQUAL_UINT8(first_reason, did.first_reason);
    TEST_ASSERT_EQUAL(machine.state != from, has_done(AGV_ACTION_STATE));
    TEST_ASSERT_TRUE(agv_state_machine_is_sound(&machine));
    facts.raised = AGV_FAULT_NONE; /* reported once */
}

static uint32_t lacks(void) {
    const agv_fault_summary_t faults = summary();
    return agv_state_machine_lacks_for_reset(&machine, &faults, words_of_facts());
}

static void run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        step(1);
    }
}

static void expect_state(agv_state_t state) {
    TEST_ASSERT_EQUAL_HEX8(state, machine.state);
}

static void expect_state_after(uint32_t ms, agv_state_t state) {
    run(ms);
    expect_state(state);
}

static void trip(agv_fault_t reason) {
    facts.raised = reason;
    expect_state_after(1, AGV_STATE_TRIPPED);
}

static void to_standby(void) {
    step(0);
    expect_state_after(500, AGV_STATE_STANDBY);
}

static void to_safe(void) {
    to_standby();
    trip(AGV_FAULT_BUS_OFF);
    expect_state_after(1, AGV_STATE_SAFE);
}

/* Shows: INT-5 */
void test_of_all_states_and_latches_five_pairs_are_sound(void) {
    unsigned sound = 0;
    for (unsigned pair = 0; pair < 65536; pair++) {
        machine.state = (uint8_t)(pair & 0xFF);
        machine.latched = (uint8_t)(pair >> 8);
        sound += agv_state_machine_is_sound(&machine) ? 1 : 0;
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
    expect_state_after(499, AGV_STATE_INIT);
    TEST_ASSERT_FALSE(machine.output_closed);
    expect_state_after(1, AGV_STATE_STANDBY);
    TEST_ASSERT_TRUE(machine.output_closed);
    TEST_ASSERT_EQUAL_HEX8(AGV_LATCH_OPEN, machine.latched);
}

/* Every missing condition keeps INIT. Speeds of a standstill are enough. */
void test_conditions_that_keep_init(void) {
    static const uint16_t needed[] = {AGV_MISSING_VCU_HEARTBEAT, AGV_MISSING_EPS_HEARTBEAT, AGV_MISSING_MANUAL,
                                      AGV_MISSING_MESSAGES, AGV_MISSING_THROTTLE};
    for (unsigned i = 0; i < sizeof needed / sizeof needed[0]; i++) {
        setUp();
        facts.missing = needed[i];
        expect_state_after(1000, AGV_STATE_INIT);
    }
    setUp();
    facts.moving = true;
    expect_state_after(1000, AGV_STATE_INIT);
    setUp();
    facts.cause = AGV_FAULT_S_DRIVER_ALARM;
    facts.raised = AGV_FAULT_S_DRIVER_ALARM;
    expect_state_after(1000, AGV_STATE_INIT); /* no cause latches in INIT */
    setUp();
    facts.ai_cause = AGV_FAULT_AI_HEARTBEAT_LOST;
    expect_state_after(1000, AGV_STATE_INIT);
    setUp();
    facts.engaged = true; /* of 363h, some report manual and others both modes */
    expect_state_after(1000, AGV_STATE_INIT);
    setUp();
    facts.missing = AGV_MISSING_STANDSTILL;
    facts.wheels_turn = true;
    expect_state_after(1000, AGV_STATE_STANDBY);
}

/* Shows: STARTUP_TIMEOUT */
void test_after_10_s_the_start_reports_once_what_is_missing(void) {
    facts.missing = AGV_MISSING_EPS_HEARTBEAT | AGV_MISSING_THROTTLE;
    facts.moving = true;
    facts.cause = AGV_FAULT_BUS_OFF;
    run(10000);
    TEST_ASSERT_FALSE(has_done(AGV_ACTION_STARTUP_LATE));
    step(1);
    TEST_ASSERT_TRUE(has_done(AGV_ACTION_STARTUP_LATE));
    TEST_ASSERT_FALSE(has_done(AGV_ACTION_TRIP));
    TEST_ASSERT_EQUAL_HEX16(
        AGV_MISSING_EPS_HEARTBEAT | AGV_MISSING_STANDSTILL | AGV_MISSING_TRIP_CAUSE | AGV_MISSING_THROTTLE, missing());
    step(1);
    TEST_ASSERT_FALSE(has_done(AGV_ACTION_STARTUP_LATE));
}

/* Shows: FSM-9 */
void test_an_unresettable_fault_trips_in_init_and_is_never_reset(void) {
    facts.raised = AGV_FAULT_BUS_OFF; /* not this one */
    facts.forever = AGV_FAULT_MEMORY_CORRUPTED;
    expect_state_after(1, AGV_STATE_TRIPPED);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_MEMORY_CORRUPTED, machine.first_reason);
    facts.forever = AGV_FAULT_NONE; /* even if its cause were gone */
    expect_state_after(10, AGV_STATE_SAFE);
    TEST_ASSERT_EQUAL_HEX32(AGV_MISSING_TRIP_CAUSE, lacks());
    TEST_ASSERT_FALSE(machine.output_closed);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_MEMORY_CORRUPTED, machine.unresettable);
}

void test_active_while_engaged_with_the_ai_alive(void) {
    to_standby();
    facts.engaged = true;
    facts.ai_alive = false;
    expect_state_after(1, AGV_STATE_STANDBY);
    facts.ai_alive = true;
    expect_state_after(1, AGV_STATE_ACTIVE);
    facts.ai_alive = false; /* a lost VCU trips by its own fault */
    expect_state_after(1, AGV_STATE_ACTIVE);
    facts.engaged = false;
    expect_state_after(1, AGV_STATE_STANDBY);
}

/* Shows: FSM-5 */
void test_the_first_reason_stays(void) {
    to_standby();
    trip(AGV_FAULT_THROTTLE_IN_PARK);
    TEST_ASSERT_TRUE(has_done(AGV_ACTION_TRIP));
    facts.raised = AGV_FAULT_BUS_OFF;
    step(1);
    TEST_ASSERT_FALSE(has_done(AGV_ACTION_TRIP));
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_THROTTLE_IN_PARK, machine.first_reason);
}

/* A cause from before the state in which it can trip. */
void test_a_cause_that_stands_trips_as_well(void) {
    to_standby();
    facts.cause = AGV_FAULT_MODE_INVALID;
    expect_state_after(1, AGV_STATE_TRIPPED);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_MODE_INVALID, machine.first_reason);
}

/* A cause of the AI computer that outlived a reset trips in manual only when it is raised again, otherwise at the
 * engagement. */
/* Shows: FSM-11 */
void test_a_cause_of_the_ai_trips_at_the_engagement(void) {
    to_standby();
    facts.ai_cause = AGV_FAULT_AI_COMMAND_OUT_OF_RANGE;
    expect_state_after(100, AGV_STATE_STANDBY);
    facts.engaged = true;
    expect_state_after(1, AGV_STATE_TRIPPED);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, machine.first_reason);
    setUp();
    to_standby();
    facts.ai_cause = AGV_FAULT_AI_COMMAND_OUT_OF_RANGE;
    run(100);
    trip(AGV_FAULT_AI_COMMAND_OUT_OF_RANGE); /* raised again, in manual */
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, machine.first_reason);
}

/* Order: raised faults, then lasting ones, then those of the AI that outlived a reset. */
/* Shows: FSM-5, FSM-11 */
void test_which_of_several_reasons_is_the_first(void) {
    to_standby();
    facts.engaged = true;
    facts.cause = AGV_FAULT_MODE_INVALID;
    facts.ai_cause = AGV_FAULT_AI_HEARTBEAT_LOST;
    trip(AGV_FAULT_MODE_NONE);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_MODE_NONE, machine.first_reason);
    setUp();
    to_standby();
    facts.engaged = true;
    facts.cause = AGV_FAULT_MODE_INVALID;
    facts.ai_cause = AGV_FAULT_AI_HEARTBEAT_LOST;
    step(1);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_MODE_INVALID, machine.first_reason);
}

/* SAFE needs both confirmations, and lasts as long as both. */
/* Shows: FSM-4 */
void test_safe_is_a_confirmed_state(void) {
    to_standby();
    facts.in_park = false;
    trip(AGV_FAULT_BUS_OFF);
    expect_state_after(10, AGV_STATE_TRIPPED);
    facts.in_park = true;
    facts.autopilot_off = false;
    expect_state_after(1, AGV_STATE_TRIPPED);
    facts.autopilot_off = true;
    expect_state_after(1, AGV_STATE_SAFE);
    TEST_ASSERT_TRUE(machine.output_closed);
    facts.in_park = false;
    expect_state_after(1, AGV_STATE_TRIPPED);
    TEST_ASSERT_FALSE(has_done(AGV_ACTION_TRIP)); /* it was */
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_BUS_OFF, machine.first_reason);
}

/* Shows: FSM-4 */
void test_an_unsafe_condition_opens_the_output_at_once(void) {
    to_standby();
    facts.output_unsafe = true;
    step(1);
    TEST_ASSERT_FALSE(machine.output_closed);
    facts.output_unsafe = false;
    step(1);
    TEST_ASSERT_FALSE(machine.output_closed);
}

/* Which presses reset: see reset_button.c. */
/* Shows: FSM-3 */
void test_a_press_that_resets(void) {
    to_safe();
    facts.reset = true;
    expect_state_after(1, AGV_STATE_STANDBY);
    TEST_ASSERT_TRUE(has_done(AGV_ACTION_RESET_ACCEPTED));
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_NONE, machine.first_reason);
    TEST_ASSERT_TRUE(machine.output_closed);
}

/* A reset closes the output that had opened in the safe state. */
/* Shows: FSM-3, FSM-4 */
void test_a_reset_closes_the_output(void) {
    to_safe();
    facts.output_unsafe = true;
    step(1);
    TEST_ASSERT_FALSE(machine.output_closed);
    facts.output_unsafe = false;
    facts.reset = true;
    step(1);
    TEST_ASSERT_TRUE(machine.output_closed);
    TEST_ASSERT_TRUE(has_done(AGV_ACTION_CLOSE_OUTPUT));
}

/* Each condition by itself. */
/* Shows: FSM-3 */
void test_the_conditions_of_a_reset(void) {
    static const uint16_t bits[] = {AGV_MISSING_VCU_HEARTBEAT, AGV_MISSING_EPS_HEARTBEAT, AGV_MISSING_STANDSTILL,
                                    AGV_MISSING_MANUAL,        AGV_MISSING_MESSAGES,      AGV_MISSING_THROTTLE};
    to_safe();
    TEST_ASSERT_EQUAL_HEX32(0, lacks());
    for (unsigned i = 0; i < sizeof bits / sizeof bits[0]; i++) {
        facts.missing = bits[i];
        TEST_ASSERT_EQUAL_HEX32(bits[i], lacks());
    }
    facts.missing = 0;
    facts.cause = AGV_FAULT_S_DRIVER_ALARM;
    TEST_ASSERT_EQUAL_HEX32(AGV_MISSING_TRIP_CAUSE, lacks());
    facts.cause = AGV_FAULT_NONE;
    facts.in_park = false; /* still in SAFE, but the confirmation is withdrawn by this frame */
    TEST_ASSERT_EQUAL_HEX32(AGV_MISSING_STATE, lacks());
    facts.in_park = true;
    facts.autopilot_off = false;
    TEST_ASSERT_EQUAL_HEX32(AGV_MISSING_STATE, lacks());
    step(1);
    facts.autopilot_off = true; /* confirmed now, and not SAFE before */
    TEST_ASSERT_EQUAL_HEX32(AGV_MISSING_STATE, lacks());
}

/* Shows: FSM-3 */
void test_a_cause_of_the_ai_keeps_no_reset(void) {
    to_safe();
    facts.ai_cause = AGV_FAULT_AI_HEARTBEAT_LOST;
    facts.ai_alive = false;
    TEST_ASSERT_EQUAL_HEX32(0, lacks());
    facts.reset = true;
    expect_state_after(1, AGV_STATE_STANDBY);
    facts.reset = false;
    run(100); /* and does not trip again at once */
    expect_state(AGV_STATE_STANDBY);
}

/* The wheels count, not the VCU's speed. */
/* Shows: FSM-1 */
void test_p_waits_for_standing_wheels_or_3_s(void) {
    config.park = AGV_PARK_AT_STANDSTILL;
    to_standby();
    facts.wheels_turn = true;
    facts.in_park = false;
    trip(AGV_FAULT_BUS_OFF);
    run(2999);
    TEST_ASSERT_FALSE(machine.park_released);
    step(1);
    TEST_ASSERT_TRUE(machine.park_released);
    setUp();
    config.park = AGV_PARK_AT_STANDSTILL;
    to_standby();
    facts.wheels_turn = true;
    trip(AGV_FAULT_BUS_OFF);
    run(100);
    TEST_ASSERT_FALSE(machine.park_released);
    facts.wheels_turn = false;
    facts.missing = AGV_MISSING_STANDSTILL;
    step(1);
    TEST_ASSERT_TRUE(machine.park_released);
    facts.wheels_turn = true; /* a released P stays released */
    step(1);
    TEST_ASSERT_TRUE(machine.park_released);
    setUp();
    to_standby();
    facts.wheels_turn = true;
    trip(AGV_FAULT_BUS_OFF);
    TEST_ASSERT_TRUE(machine.park_released); /* at_once */
}

/* In INIT, and after a restart: since the start. */
/* Shows: FSM-1 */
TEST_CASE(AGV_FAULT_NONE)
TEST_CASE(AGV_FAULT_SUPERVISOR_RESET)
void test_p_waits_at_a_start(unsigned reason) {
    config.park = AGV_PARK_AT_STANDSTILL;
    start((agv_fault_t)reason);
    facts.wheels_turn = true;
    facts.missing = AGV_MISSING_MANUAL;
    TEST_ASSERT_FALSE(machine.park_released);
    run(2999);
    TEST_ASSERT_FALSE(machine.park_released);
    step(1);
    TEST_ASSERT_TRUE(machine.park_released);
}

/* Shows: FSM-7 */
void test_a_start_in_tripped(void) {
    start(AGV_FAULT_EPS_HEARTBEAT_LOST);
    expect_state(AGV_STATE_TRIPPED);
    TEST_ASSERT_EQUAL_HEX8(AGV_LATCH_CLOSED, machine.latched);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_EPS_HEARTBEAT_LOST, machine.first_reason);
    TEST_ASSERT_FALSE(machine.output_closed);
}

/* ---- The list of actions ---- */

static const uint32_t SENDING = AGV_ACTION_DISCARD | AGV_ACTION_PURGE;

/* Shows: FSM-2, FSM-7 */
void test_the_actions_of_a_trip(void) {
    to_standby();
    trip(AGV_FAULT_BUS_OFF);
    TEST_ASSERT_EQUAL_HEX32(AGV_ACTION_TRIP | AGV_ACTION_STATE | SENDING | AGV_ACTION_STORE_LATCH, did.what);
    facts.output_unsafe = true;
    expect_state_after(1, AGV_STATE_SAFE);
    TEST_ASSERT_EQUAL_HEX32(AGV_ACTION_STATE | AGV_ACTION_OPEN_OUTPUT, did.what);
    step(1);
    TEST_ASSERT_EQUAL_HEX32(0, did.what);
}

/* Shows: FSM-4, FSM-7 */
void test_the_actions_of_the_end_of_init(void) {
    step(0);
    TEST_ASSERT_EQUAL_HEX32(0, did.what);
    run(500);
    TEST_ASSERT_EQUAL_HEX32(AGV_ACTION_STATE | SENDING | AGV_ACTION_UNLATCH | AGV_ACTION_CLOSE_OUTPUT, did.what);
}

/* The output is still closed; it opens only when the confirmation is late. */
/* Shows: FSM-3, FSM-7 */
void test_the_actions_of_a_reset(void) {
    to_safe();
    facts.reset = true;
    step(1);
    TEST_ASSERT_EQUAL_HEX32(
        AGV_ACTION_RESET_ACCEPTED | AGV_ACTION_STATE | SENDING | AGV_ACTION_UNLATCH | AGV_ACTION_STORE_LATCH, did.what);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_BUS_OFF, did.first_reason);
}

/* Shows: TOP-2 */
void test_from_active_to_standby_the_engagement_ends(void) {
    to_standby();
    facts.engaged = true;
    step(1);
    TEST_ASSERT_EQUAL_HEX32(AGV_ACTION_STATE, did.what);
    facts.engaged = false;
    step(1);
    TEST_ASSERT_EQUAL_HEX32(AGV_ACTION_STATE | AGV_ACTION_END_ENGAGEMENT, did.what);
    step(1);
    TEST_ASSERT_EQUAL_HEX32(0, did.what);
}

/* Shows: FSM-9 */
void test_an_unresettable_fault_that_comes_while_tripped_is_stored(void) {
    to_safe();
    facts.forever = AGV_FAULT_MEMORY_CORRUPTED;
    step(1);
    TEST_ASSERT_EQUAL_HEX32(AGV_ACTION_STORE_LATCH | AGV_ACTION_OPEN_OUTPUT, did.what);
}

/* Also one of a lower rank: OUTPUT_FEEDBACK, rank 3, after MEMORY_CORRUPTED, rank 1. */
/* Shows: FSM-9 */
void test_every_change_of_the_unresettable_fault_is_stored(void) {
    to_safe();
    facts.forever = AGV_FAULT_MEMORY_CORRUPTED;
    step(1);
    facts.forever = AGV_FAULT_OUTPUT_FEEDBACK;
    step(1);
    TEST_ASSERT_EQUAL_HEX32(AGV_ACTION_STORE_LATCH, did.what);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_OUTPUT_FEEDBACK, machine.unresettable);
    step(1);
    TEST_ASSERT_EQUAL_HEX32(0, did.what);
}

/* Shows: FSM-9 */
void test_conditions_that_prevent_a_reset(void) {
    agv_state_machine_forbid_reset(&machine, AGV_FAULT_NONE);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_NONE, machine.unresettable);
    agv_state_machine_forbid_reset(&machine, AGV_FAULT_CONFIG_INVALID);
    agv_state_machine_forbid_reset(&machine, AGV_FAULT_NONE);
    TEST_ASSERT_EQUAL_UINT8(AGV_FAULT_CONFIG_INVALID, machine.unresettable);
}

/* Of the 256 codes of a state only that of SAFE (5Ah) allows one. */
/* Shows: FSM-7, INT-5 */
void test_a_code_that_is_not_that_of_safe_allows_no_reset(void) {
    to_safe();
    for (unsigned code = 0; code < 256; code++) {
        machine.state = (uint8_t)code;
        TEST_ASSERT_EQUAL_HEX32((code == 0x5A) ? 0 : AGV_MISSING_STATE, lacks());
    }
}

/* INIT is 0Fh. */
static void expect_late_in_init_only(void) {
    const uint8_t state = machine.state;
    for (unsigned code = 0; code < 256; code++) {
        machine.state = (uint8_t)code;
        TEST_ASSERT_EQUAL(code == 0x0F, agv_state_machine_is_startup_late(&machine, &timers));
    }
    machine.state = state;
}

/* Shows: STARTUP_TIMEOUT */
void test_the_startup_is_late_in_init_only(void) {
    facts.missing = AGV_MISSING_MANUAL;
    run(10000);
    TEST_ASSERT_FALSE(agv_state_machine_is_startup_late(&machine, &timers));
    step(1);
    expect_late_in_init_only();
    facts.missing = 0;
    expect_state_after(501, AGV_STATE_STANDBY);
    TEST_ASSERT_FALSE(agv_state_machine_is_startup_late(&machine, &timers));
}

/* Pairs that are as strong as their worse baseline, and one for each way to be weaker. */
#include "agv/state.h"
#include "atlas/atlas_judge.h"
#include "unity.h"

/* The halves: the first trips after 50 ms and stops after 2 s, the second after 300 ms and 3 s. */
static const atlas_outcome_t FIRST = {
    .ready = true, .state = AGV_STATE_SAFE, .safe_us = 50000, .open_us = ATLAS_NEVER, .stop_us = 2000000};
static const atlas_outcome_t SECOND = {
    .ready = true, .state = AGV_STATE_TRIPPED, .safe_us = 300000, .open_us = 800000, .stop_us = 3000000};
static atlas_outcome_t pair;
static atlas_case_t of;

void setUp(void) {
    pair = SECOND;
    of = (atlas_case_t){.first = campaign_row(AGV_FAULT_S_DRIVER_ALARM),
                        .second = campaign_row(AGV_FAULT_BUS_OFF),
                        .state = ATLAS_ACTIVE};
}

static void expect(atlas_weakness_t weakness) {
    TEST_ASSERT_EQUAL(weakness, atlas_judge(&of, &pair, &FIRST, &SECOND));
    TEST_ASSERT_EQUAL(weakness, atlas_judge(&of, &pair, &SECOND, &FIRST));
}

void test_each_way_to_be_weaker(void) {
    static const struct {
        int32_t safe_us;
        int32_t open_us;
        int32_t stop_us;
        bool ready;
        atlas_weakness_t weakness;
    } rows[] = {
        {300000, 800000, 3000000, true, ATLAS_SOUND},      /* as the worse half */
        {330000, 800000, 3200000, true, ATLAS_SOUND},      /* what the wire may add */
        {300000, ATLAS_NEVER, 3000000, true, ATLAS_SOUND}, /* as it stays closed in a half */
        {330001, 800000, 3000000, true, ATLAS_LATE_FRAME}, {ATLAS_NEVER, 800000, 3000000, true, ATLAS_LATE_FRAME},
        {300000, 800000, 3200001, true, ATLAS_LATE_STOP},  {300000, 800000, 3000000, false, ATLAS_NOT_READY},
    };
    for (size_t r = 0; r < sizeof rows / sizeof rows[0]; r++) {
        pair.safe_us = rows[r].safe_us;
        pair.open_us = rows[r].open_us;
        pair.stop_us = rows[r].stop_us;
        pair.ready = rows[r].ready;
        expect(rows[r].weakness);
    }
}

void test_a_supervisor_that_is_silent_twice_may_take_400_ms_more(void) {
    of.first = campaign_row(AGV_FAULT_STEP_OVERRUN);
    pair.safe_us = 700000;
    TEST_ASSERT_EQUAL(ATLAS_SOUND, atlas_judge(&of, &pair, &FIRST, &SECOND));
    pair.safe_us = 700001;
    TEST_ASSERT_EQUAL(ATLAS_LATE_FRAME, atlas_judge(&of, &pair, &FIRST, &SECOND));
}

void test_a_stall_may_take_1600_ms_more_after_a_silent_supervisor(void) {
    of.first = campaign_row(AGV_FAULT_BUS_OFF);
    of.second = campaign_row(AGV_FAULT_TX_STALLED);
    pair.safe_us = 1900000;
    TEST_ASSERT_EQUAL(ATLAS_SOUND, atlas_judge(&of, &pair, &FIRST, &SECOND));
    pair.safe_us = 1900001;
    TEST_ASSERT_EQUAL(ATLAS_LATE_FRAME, atlas_judge(&of, &pair, &FIRST, &SECOND));
    of.first = campaign_row(AGV_FAULT_S_DRIVER_ALARM);
    pair.safe_us = 330001;
    TEST_ASSERT_EQUAL(ATLAS_LATE_FRAME, atlas_judge(&of, &pair, &FIRST, &SECOND));
}

void test_a_later_output_than_in_both_halves(void) {
    pair.open_us = ATLAS_NEVER;
    TEST_ASSERT_EQUAL(ATLAS_LATE_OUTPUT, atlas_judge(&of, &pair, &SECOND, &SECOND));
}

void test_a_pair_that_drives_on(void) {
    pair.state = AGV_STATE_ACTIVE;
    expect(ATLAS_NOT_LATCHED);
}

void test_a_fault_may_be_over_before_init_has_ended(void) {
    of.state = ATLAS_INIT;
    pair.state = AGV_STATE_STANDBY;
    expect(ATLAS_SOUND);
    pair.state = AGV_STATE_ACTIVE;
    expect(ATLAS_NOT_LATCHED);
}

void test_init_with_an_open_output_is_as_good_as_tripped(void) {
    pair.state = AGV_STATE_INIT;
    pair.open_us = 0;
    expect(ATLAS_SOUND);
    pair.open_us = 1;
    expect(ATLAS_NOT_LATCHED);
}

void test_a_hazard_that_neither_half_has(void) {
    atlas_outcome_t half = FIRST;
    pair.hazard = HAZARD_STEERING;
    expect(ATLAS_HAZARD);
    half.hazard = HAZARD_NOT_STOPPING;
    TEST_ASSERT_EQUAL(ATLAS_SOUND, atlas_judge(&of, &pair, &half, &SECOND));
}

void test_known_reasons(void) {
    TEST_ASSERT_NULL(atlas_known_reason(&of, ATLAS_HAZARD));
    of.first = campaign_row(AGV_FAULT_STEP_OVERRUN);
    of.second = campaign_row(AGV_FAULT_FOREIGN_COMMAND_SENDER);
    TEST_ASSERT_NOT_NULL(atlas_known_reason(&of, ATLAS_HAZARD));
    TEST_ASSERT_NULL(atlas_known_reason(&of, ATLAS_NOT_LATCHED));
    of.state = ATLAS_SAFE;
    TEST_ASSERT_NULL(atlas_known_reason(&of, ATLAS_HAZARD));
}

void test_a_known_reason_of_each_second_fault_that_silences_the_supervisor(void) {
    of.first = campaign_row(AGV_FAULT_AI_HEARTBEAT_LOST);
    of.state = ATLAS_TRIPPED;
    TEST_ASSERT_NOT_NULL(atlas_known_reason(&of, ATLAS_LATE_FRAME));
    of.second = campaign_row(AGV_FAULT_S_DRIVER_ALARM);
    TEST_ASSERT_NULL(atlas_known_reason(&of, ATLAS_LATE_FRAME));
}

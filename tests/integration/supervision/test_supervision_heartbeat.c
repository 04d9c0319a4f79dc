/* The heartbeats of VCU and EPS (SUP-1, SUP-2): lost, stuck, and frames that count as a heartbeat. Calculated by hand:
 * the deadline is 50 ms, so there is no fault 50 ms after the last change, and a trip in the tick 51 ms after it. */
#include "one_fixture.h"

typedef struct {
    const char *name;
    agv_message_t message;
    agv_fault_t lost;
    agv_fault_t stuck;
    int led;
    int32_t hold_raw; /* while engaged */
} node_t;

static const node_t VCU = {
    "VCU", AGV_MSG_VEHICLE_STATUS, AGV_FAULT_VCU_HEARTBEAT_LOST, AGV_FAULT_VCU_HEARTBEAT_STUCK, -1, ANGLE_CENTRE};
static const node_t EPS = {
    "EPS", AGV_MSG_STEERING_STATUS, AGV_FAULT_EPS_HEARTBEAT_LOST, AGV_FAULT_EPS_HEARTBEAT_STUCK, 12, NO_HOLD};

static void expect_no_trip(const node_t *node, agv_state_t state) {
    expect_nothing(&f, node->lost, state);
    expect_nothing(&f, node->stuck, state);
}

/* After a long silence an alive sender can become stuck again. */
/* Shows: SUP-2, VCU_HEARTBEAT_STUCK */
void test_stuck_after_a_long_silence(void) {
    fixture_start(&f);
    fixture_run(&f, 100);
    f.traffic[VCU.message].muted = true;
    expect_fault_after(&f, 60000, AGV_FAULT_VCU_HEARTBEAT_LOST, true);
    f.traffic[VCU.message].muted = false;
    fixture_run_past(&f, VCU.message);
    expect_no_trip(&VCU, AGV_STATE_INIT);
    f.traffic[VCU.message].frozen = true;
    fixture_run(&f, 50);
    expect_no_trip(&VCU, AGV_STATE_INIT);
    expect_fault_after(&f, 1, AGV_FAULT_VCU_HEARTBEAT_STUCK, true);
}

/* A repeat that is malformed is no valid frame: lost, not stuck. */
/* Shows: SUP-2, P15, VCU_HEARTBEAT_LOST */
void test_malformed_repeats_are_not_stuck(void) {
    fixture_standby(&f);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    f.traffic[AGV_MSG_VEHICLE_STATUS].frozen = true;
    f.traffic[AGV_MSG_VEHICLE_STATUS].length = 7;
    fixture_run(&f, 50);
    expect_no_trip(&VCU, AGV_STATE_STANDBY);
    expect_trip_after(&f, 1, AGV_FAULT_VCU_HEARTBEAT_LOST, NO_HOLD);
}

/* The very first frame is only the baseline: the deadline runs from the start, and a counter that never changes is
 * stuck. */
static void check_start(const node_t *node, agv_fault_t expected) {
    fixture_init(&f);
    f.what = node->name;
    f.traffic[node->message].frozen = true;
    fixture_start(&f);
    fixture_run(&f, 50);
    expect_no_trip(node, AGV_STATE_INIT);
    expect_fault_after(&f, 1, expected, true);
    expect_led(&f, node->led);
    expect_fault_after(&f, 2000, expected, true);
    expect_state(&f, AGV_STATE_INIT); /* a cause in INIT only keeps INIT from being left */
    expect_reason(&f, AGV_FAULT_NONE);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, expected));
}

/* Shows: SUP-2, P13, VCU_HEARTBEAT_STUCK, EPS_HEARTBEAT_STUCK */
void test_the_first_frame_is_only_the_baseline(void) {
    check_start(&VCU, AGV_FAULT_VCU_HEARTBEAT_STUCK);
    check_start(&EPS, AGV_FAULT_EPS_HEARTBEAT_STUCK);
}

/* A frame with an invalid angle still counts as a heartbeat (the angle is never used). */
/* Shows: SUP-5, EPS_HEARTBEAT_LOST */
void test_a_frame_with_an_invalid_angle_is_a_heartbeat(void) {
    fixture_standby(&f);
    fixture_angle(&f, 18001);
    expect_state_after(&f, 2000, AGV_STATE_STANDBY);
    TEST_ASSERT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_active(&f.supervisor));
    fixture_run_past(&f, EPS.message);
    f.traffic[EPS.message].muted = true;
    expect_trip_after(&f, 51, AGV_FAULT_EPS_HEARTBEAT_LOST, NO_HOLD);
}

/* An engagement starts only the deadlines of the three commands: 363h with a frozen counter reports autopilot. */
/* Shows: SUP-2, SUP-3, VCU_HEARTBEAT_STUCK */
void test_an_engagement_is_no_heartbeat_of_the_vcu(void) {
    fixture_standby(&f);
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    f.traffic[AGV_MSG_VEHICLE_STATUS].frozen = true;
    fixture_run(&f, 15);
    fixture_mode(&f, MODE_ENGAGED);
    expect_state_after(&f, 35, AGV_STATE_ACTIVE);
    expect_tripped_after(&f, 1, AGV_FAULT_VCU_HEARTBEAT_STUCK);
}

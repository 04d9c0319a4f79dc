/* Malformed frames (P15): each kind on each message is counted and refreshes nothing, so the missing valid frames trip.
 * A malformed data frame with the identifier of a command trips by itself while engaged (SUP-5). Reserved bits (P14)
 * are ignored. */
#include "causes.h"
#include "one_fixture.h"

typedef struct {
    const char *name;
    uint8_t flags;
    uint8_t length;
    agv_rejected_t counted;
} kind_t;

static const kind_t KINDS[] = {
    {"length 0", 0, 0, AGV_REJECTED_LENGTH},
    {"length 1", 0, 1, AGV_REJECTED_LENGTH},
    {"length 4", 0, 4, AGV_REJECTED_LENGTH},
    {"length 7", 0, 7, AGV_REJECTED_LENGTH},
    {"length 9", 0, 9, AGV_REJECTED_LENGTH}, /* of a port that does not know FD */
    {"FD with 8 bytes", HAL_CAN_FD, 8, AGV_REJECTED_FD},
    {"FD with 64 bytes", HAL_CAN_FD, 64, AGV_REJECTED_FD},
    {"FD with 7 bytes", HAL_CAN_FD, 7, AGV_REJECTED_FD},
    {"remote", HAL_CAN_REMOTE, 8, AGV_REJECTED_REMOTE},
    {"remote, none asked for", HAL_CAN_REMOTE, 0, AGV_REJECTED_REMOTE},
    {"remote FD", HAL_CAN_REMOTE | HAL_CAN_FD, 8, AGV_REJECTED_REMOTE},
    {"extended", HAL_CAN_EXTENDED, 8, AGV_REJECTED_EXTENDED},
    {"extended remote", HAL_CAN_EXTENDED | HAL_CAN_REMOTE, 8, AGV_REJECTED_EXTENDED},
    {"extended FD", HAL_CAN_EXTENDED | HAL_CAN_FD, 8, AGV_REJECTED_EXTENDED},
    {"error", HAL_CAN_ERROR, 8, AGV_REJECTED_ERROR},
    {"error of all kinds", HAL_CAN_ERROR | HAL_CAN_EXTENDED | HAL_CAN_REMOTE | HAL_CAN_FD, 3, AGV_REJECTED_ERROR},
};
enum { KIND_COUNT = sizeof KINDS / sizeof KINDS[0] };

static uint32_t rejected(agv_rejected_t kind) {
    return agv_supervisor_counters(&f.supervisor)->rejected[kind];
}

static uint32_t rejected_in_all(void) {
    uint32_t sum = 0;
    for (unsigned i = 0; i < AGV_REJECTED_KINDS; i++) {
        sum += rejected((agv_rejected_t)i);
    }
    return sum;
}

/* After a good frame only malformed ones, on their cycles and with running counters. They must have no effect. */
static void check(const kind_t *kind, agv_message_t message, uint32_t deadline_ms, agv_fault_t fault) {
    fixture_init(&f);
    f.what = kind->name;
    fixture_active(&f);
    fixture_run_past(&f, message);
    const uint32_t before = f.traffic[message].sent;
    f.traffic[message].flags = kind->flags;
    f.traffic[message].length = kind->length;
    expect_nothing_after(&f, deadline_ms, fault, AGV_STATE_ACTIVE);
    TEST_ASSERT_TRUE(f.traffic[message].sent > before);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(f.traffic[message].sent - before, rejected(kind->counted), f.what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(f.traffic[message].sent - before, rejected_in_all(), f.what);
    expect_silence(&f);
    expect_fault_after(&f, 1, fault, true);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, fault));
}

/* A VCU may obey it. */
static bool is_data_frame(const kind_t *kind) {
    return (kind->flags & (HAL_CAN_REMOTE | HAL_CAN_EXTENDED | HAL_CAN_ERROR)) == 0;
}

/* In manual it is only counted. While engaged it trips at once, and the deadline of its message runs on. */
static void check_no_command(const kind_t *kind, agv_message_t message, uint32_t deadline_ms, agv_fault_t fault) {
    fixture_init(&f);
    f.what = kind->name;
    fixture_standby(&f);
    f.traffic[message].flags = kind->flags;
    f.traffic[message].length = kind->length;
    fixture_send_now(&f, message);
    expect_nothing(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, AGV_STATE_STANDBY);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, rejected(kind->counted), f.what);
    fixture_init(&f);
    fixture_active(&f);
    fixture_run_past(&f, message);
    const uint32_t refreshed_ms = f.now_ms;
    f.traffic[message].flags = kind->flags;
    f.traffic[message].length = kind->length;
    fixture_send_now(&f, message);
    expect_trip(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, f.call, ANGLE_CENTRE);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, rejected(kind->counted), f.what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, rejected_in_all(), f.what);
    expect_fault_after(&f, deadline_ms - (f.now_ms - refreshed_ms), fault, false);
    expect_fault_after(&f, 1, fault, true);
}

/* A silent 267h only warns. */
static void check_all_kinds(const cause_t *cause) {
    for (unsigned i = 0; i < KIND_COUNT; i++) {
        if (cause->message < AGV_COMMAND_COUNT && is_data_frame(&KINDS[i])) {
            check_no_command(&KINDS[i], cause->message, cause_deadline_ms(cause), cause->fault);
        } else {
            check(&KINDS[i], cause->message, cause_deadline_ms(cause), cause->fault);
            expect_reason(&f, FAULT_ROW[cause->fault].trip ? cause->fault : AGV_FAULT_NONE);
        }
    }
}

/* Shows: P15, SUP-2, SUP-3, SUP-5, VCU_HEARTBEAT_LOST, EPS_HEARTBEAT_LOST, AI_HEARTBEAT_LOST, EPS_STATUS_TIMEOUT,
   GEAR_STATUS_TIMEOUT, THROTTLE_STATUS_TIMEOUT, WHEEL_SPEED_TIMEOUT, STEERING_POSITION_TIMEOUT, GEAR_COMMAND_TIMEOUT,
   THROTTLE_COMMAND_TIMEOUT, STEERING_COMMAND_TIMEOUT, AI_COMMAND_OUT_OF_RANGE */
void test_each_kind_of_each_message(void) {
    unsigned messages = 0;
    for (unsigned i = 0; i < CAUSES; i++) {
        if (cause_is_silence(&CAUSE[i])) {
            check_all_kinds(&CAUSE[i]);
            messages++;
        }
    }
    TEST_ASSERT_EQUAL_UINT32(AGV_MSG_COUNT, messages);
}

/* The same from the AI side of a gateway. */
/* Shows: P15, SUP-5, TOP-2, AI_COMMAND_OUT_OF_RANGE */
void test_malformed_commands_from_the_ai_side(void) {
    for (unsigned i = 0; i < KIND_COUNT; i++) {
        for (unsigned message = 0; message < AGV_COMMAND_COUNT; message++) {
            fixture_init(&f);
            f.config.topology = AGV_TOPOLOGY_GATEWAY;
            f.what = KINDS[i].name;
            fixture_active(&f);
            f.traffic[message].flags = KINDS[i].flags;
            f.traffic[message].length = KINDS[i].length;
            fixture_forget_sent(&f);
            fixture_send_now(&f, (agv_message_t)message);
            if (is_data_frame(&KINDS[i])) {
                expect_trip(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, f.call, ANGLE_CENTRE);
            } else {
                expect_nothing(&f, AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, AGV_STATE_ACTIVE);
                expect_silence(&f);
            }
        }
    }
}

/* ---- The content of malformed frames raises nothing ---- */

/* They do not count in a score either, neither as bad nor as good: two bad frames, two malformed ones, and the third
 * bad one. */
/* Shows: P15, SUP-4, EPS_UNDER_VOLTAGE */
void test_malformed_frames_are_not_scored(void) {
    fixture_standby(&f);
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    for (unsigned i = 0; i < 4; i++) {
        f.traffic[AGV_MSG_EPS_STATUS].data[7] = i % 2 == 0;
        f.traffic[AGV_MSG_EPS_STATUS].length = i % 2 == 0 ? 8 : 7;
        fixture_run_past(&f, AGV_MSG_EPS_STATUS);
        f.traffic[AGV_MSG_EPS_STATUS].data[7] = 1;
    }
    expect_nothing(&f, AGV_FAULT_EPS_UNDER_VOLTAGE, AGV_STATE_STANDBY);
    f.traffic[AGV_MSG_EPS_STATUS].length = 8;
    fixture_run_past(&f, AGV_MSG_EPS_STATUS);
    expect_trip(&f, AGV_FAULT_EPS_UNDER_VOLTAGE, f.traffic[AGV_MSG_EPS_STATUS].call, NO_HOLD);
}

/* ---- Reserved bits ---- */

/* All of them set, in all messages: byte 1 is the leftmost. */
/* Shows: P14 */
void test_reserved_bits_are_ignored(void) {
    static const uint8_t RESERVED[AGV_MSG_COUNT][8] = {
        [AGV_MSG_TURN_SIGNAL_COMMAND] = {0xFF, 0xFF, 0xFF, 0xFF, 0x0F, 0xFF, 0xFF, 0},
        [AGV_MSG_GEAR_COMMAND] = {0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF},
        [AGV_MSG_THROTTLE_COMMAND] = {0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF},
        [AGV_MSG_STEERING_COMMAND] = {0, 0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF},
        [AGV_MSG_VEHICLE_STATUS] = {0, 0, 0xFF, 0xFF, 0x44, 0, 0x0C, 0},
        [AGV_MSG_GEAR_STATUS] = {0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF},
        [AGV_MSG_THROTTLE_STATUS] = {0, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF, 0xFF},
        [AGV_MSG_EPS_STATUS] = {0xFF, 0xFF, 0xFF, 0, 0xFF, 0xFF, 0xFF, 0},
        [AGV_MSG_STEERING_POSITION] = {0, 0, 0, 0, 0, 0, 0xFF, 0xFF},
    };
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        for (unsigned byte = 0; byte < 8; byte++) {
            f.traffic[i].data[byte] |= RESERVED[i][byte];
        }
    }
    fixture_active(&f);
    expect_state_after(&f, 2000, AGV_STATE_ACTIVE);
    expect_silence(&f);
    TEST_ASSERT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_active(&f.supervisor));
    TEST_ASSERT_EQUAL_UINT32(0, rejected_in_all());
}

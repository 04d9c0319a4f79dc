/* The two identifier sets (P1): 43Fh and 363h, or 201h and 203h. Both sets are supervised alike. Traffic on the other
 * set's identifiers is never accepted, and is reported as WRONG_ID_SET. Also identifiers that are changed one by
 * one. */
#include "one_fixture.h"

static const agv_fault_t WRONG = AGV_FAULT_WRONG_ID_SET;

typedef struct {
    const char *name;
    agv_id_set_t id_set;
    uint32_t command_id; /* of this set */
    uint32_t status_id;
    uint32_t other_command_id; /* of the other one */
    uint32_t other_status_id;
} set_t;

static const set_t SETS[] = {{"heading", AGV_ID_SET_HEADING, 0x43F, 0x363, 0x201, 0x203},
                             {"table", AGV_ID_SET_TABLE, 0x201, 0x203, 0x43F, 0x363}};
enum { SET_COUNT = 2 };

static void init(const set_t *set) {
    fixture_init(&f);
    f.what = set->name;
    f.config.id_set = (uint16_t)set->id_set;
}

/* Shows: P1 */
void test_both_sets_work(void) {
    for (unsigned i = 0; i < SET_COUNT; i++) {
        init(&SETS[i]);
        fixture_active(&f);
        TEST_ASSERT_EQUAL_HEX32(SETS[i].status_id, f.traffic[AGV_MSG_VEHICLE_STATUS].id);
        TEST_ASSERT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_active(&f.supervisor));
        f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x01;
        fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
        expect_trip(&f, AGV_FAULT_REMOTE_SIGNAL_LOST, f.traffic[AGV_MSG_VEHICLE_STATUS].call, ANGLE_CENTRE);
        fixture_mute_ai(&f, true); /* otherwise its commands would be overridden, too */
        expect_count_after(&f, 1000, SETS[i].other_command_id, 0);
        TEST_ASSERT_EQUAL_UINT32(11, fixture_count_sent(&f, SETS[i].command_id)); /* at once, then each 100 ms */
    }
}

/* The AI computer uses the other identifiers from the start; there is no other fault. */
/* Shows: P1, WRONG_ID_SET */
void test_a_command_on_the_other_identifier(void) {
    for (unsigned i = 0; i < SET_COUNT; i++) {
        init(&SETS[i]);
        fixture_start(&f);
        f.traffic[AGV_MSG_TURN_SIGNAL_COMMAND].id = SETS[i].other_command_id;
        expect_fault_after(&f, 500, WRONG, false);
        fixture_run(&f, 1);
        expect_warning(&f, WRONG, agv_supervisor_state(&f.supervisor));
        expect_led(&f, -1);
        expect_state_after(&f, 10000, AGV_STATE_STANDBY);
        TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, WRONG));
        f.traffic[AGV_MSG_TURN_SIGNAL_COMMAND].id = SETS[i].command_id; /* corrected */
        fixture_run_before(&f, AGV_MSG_TURN_SIGNAL_COMMAND);
        expect_fault(&f, WRONG, true);
        expect_fault_after(&f, 1, WRONG, false);
        TEST_ASSERT_EQUAL_UINT32(1, fixture_ended(&f, WRONG));
        expect_led(&f, 0);
    }
}

/* The VCU uses the other identifiers: it counts as silent. */
/* Shows: P1, WRONG_ID_SET, VCU_HEARTBEAT_LOST */
void test_a_status_on_the_other_identifier_is_never_accepted(void) {
    for (unsigned i = 0; i < SET_COUNT; i++) {
        init(&SETS[i]);
        fixture_start(&f);
        f.traffic[AGV_MSG_VEHICLE_STATUS].id = SETS[i].other_status_id;
        expect_fault_after(&f, 500, WRONG, false);
        expect_fault(&f, AGV_FAULT_VCU_HEARTBEAT_LOST, true);
        expect_fault_after(&f, 1, WRONG, true);
        expect_state_after(&f, 3000, AGV_STATE_INIT);
        expect_fault(&f, AGV_FAULT_VCU_HEARTBEAT_LOST, true);
        TEST_ASSERT_EQUAL_UINT32(1, fixture_raised(&f, WRONG));
        TEST_ASSERT_EQUAL_UINT32(0, fixture_ended(&f, AGV_FAULT_VCU_HEARTBEAT_LOST));
    }
}

/* One more on the other identifier, while its own goes on, is not a wrong set. */
/* Shows: P1, WRONG_ID_SET */
void test_both_identifiers_at_once(void) {
    for (unsigned i = 0; i < SET_COUNT; i++) {
        init(&SETS[i]);
        fixture_active(&f);
        for (unsigned round = 0; round < 300; round++) {
            fixture_run(&f, 10);
            fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = SETS[i].other_command_id, .length = 8});
            fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = SETS[i].other_status_id, .length = 8});
        }
        TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, WRONG));
        expect_state(&f, AGV_STATE_ACTIVE);
    }
}

/* A malformed frame on the other identifier is no valid one. */
/* Shows: P1, P15, WRONG_ID_SET */
void test_malformed_frames_on_the_other_identifier(void) {
    static const hal_can_frame_t MALFORMED[] = {{.length = 7},
                                                {.length = 0},
                                                {.length = 9},
                                                {.length = 8, .flags = HAL_CAN_EXTENDED},
                                                {.length = 8, .flags = HAL_CAN_REMOTE},
                                                {.length = 8, .flags = HAL_CAN_FD},
                                                {.length = 8, .flags = HAL_CAN_ERROR}};
    init(&SETS[0]);
    f.traffic[AGV_MSG_TURN_SIGNAL_COMMAND].muted = true;
    fixture_standby(&f);
    for (unsigned round = 0; round < 300; round++) {
        hal_can_frame_t frame = MALFORMED[round % 7];
        frame.id = SETS[0].other_command_id;
        fixture_run(&f, 10);
        fixture_raw(&f, HAL_CAN_VEHICLE, frame);
    }
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, WRONG));
}

/* In a gateway the AI's identifier belongs on the AI side. */
/* Shows: P1, TOP-2, WRONG_ID_SET */
void test_wrong_set_in_a_gateway(void) {
    for (unsigned i = 0; i < SET_COUNT; i++) {
        init(&SETS[i]);
        f.config.topology = AGV_TOPOLOGY_GATEWAY;
        fixture_start(&f);
        f.traffic[AGV_MSG_TURN_SIGNAL_COMMAND].id = SETS[i].other_command_id;
        expect_fault_after(&f, 500, WRONG, false);
        expect_fault_after(&f, 1, WRONG, true);
        expect_count_after(&f, 200, SETS[i].other_command_id, 0); /* is not passed on */
    }
}

/* A VCU that is silent, and frames with unknown identifiers, or with an identifier of the other set that comes from the wrong
 * side, or with one that both sets have and that was changed: 267h. */
/* Shows: P1, WRONG_ID_SET */
void test_what_is_not_of_the_other_set(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    f.config.id_steering_position = 0x268;
    fixture_standby(&f);
    fixture_mute_vcu(&f, true);
    fixture_mute_ai(&f, true);
    for (unsigned i = 0; i < 400; i++) {
        fixture_run(&f, 10);
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x700, .length = 8});
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x267, .length = 8});
        fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x201, .length = 8});
        fixture_raw(&f, HAL_CAN_AI, (hal_can_frame_t){.id = 0x203, .length = 8});
    }
    TEST_ASSERT_EQUAL_UINT32(0, fixture_raised(&f, WRONG));
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x203, .length = 8});
    expect_fault_after(&f, 1, WRONG, true);
}

/* ---- Identifiers changed one by one: id_... ---- */

/* New identifiers outside the protocol; gear and throttle command are swapped. */
static const uint16_t OTHER[AGV_MSG_COUNT] = {0x301, 0x075, 0x168, 0x304, 0x305, 0x306,
                                              0x307, 0x308, 0x309, 0x30A, 0x30B};

static void change_ids(void) {
    for (unsigned i = 0; i < AGV_MSG_COUNT; i++) {
        (void)agv_config_set(&f.config, AGV_SETTING_ID + i, OTHER[i]);
    }
    f.other_ids = true;
}

/* The oracle checks the sent frames: only the changed identifiers are used. */
/* Shows: P1 */
void test_every_identifier_may_be_another_one(void) {
    change_ids();
    fixture_active(&f);
    TEST_ASSERT_EQUAL(AGV_FAULT_NONE, agv_supervisor_first_active(&f.supervisor));
    TEST_ASSERT_EQUAL_HEX32(0x305, f.traffic[AGV_MSG_VEHICLE_STATUS].id);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x01;
    fixture_run_past(&f, AGV_MSG_VEHICLE_STATUS);
    expect_trip(&f, AGV_FAULT_REMOTE_SIGNAL_LOST, f.traffic[AGV_MSG_VEHICLE_STATUS].call, ANGLE_CENTRE);
    fixture_mute_ai(&f, true);
    expect_count_after(&f, 1000, 0x43F, 11);
    TEST_ASSERT_EQUAL_UINT32(11, fixture_count_sent(&f, 0x168));
}

/* D on the identifier of the gear command is overridden; 43Fh and 065h are unknown identifiers now. */
/* Shows: P1, TOP-1 */
void test_a_foreign_command_is_one_on_the_changed_identifier(void) {
    change_ids();
    fixture_standby(&f);
    fixture_mute_ai(&f, true);
    f.traffic[AGV_MSG_VEHICLE_STATUS].data[4] = 0x01;
    expect_state_after(&f, 50, AGV_STATE_SAFE);
    fixture_forget_sent(&f);
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x43F, .length = 8});
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x065, .length = 8, .data = {1}});
    TEST_ASSERT_EQUAL_UINT32(0, f.sent_count);
    fixture_raw(&f, HAL_CAN_VEHICLE, (hal_can_frame_t){.id = 0x075, .length = 8, .data = {GEAR_D}});
    TEST_ASSERT_EQUAL_UINT32(1, f.sent_count);
    TEST_ASSERT_EQUAL_HEX32(0x168, f.sent[0].id); /* logged with the identifier of the protocol */
    TEST_ASSERT_EQUAL_HEX8(GEAR_P, f.sent[0].data[0]);
}

/* Shows: P1, TOP-2 */
void test_a_gateway_passes_on_the_changed_identifiers(void) {
    f.config.topology = AGV_TOPOLOGY_GATEWAY;
    change_ids();
    fixture_active(&f);
    expect_count_after(&f, 100, 0x43F, 1);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x075));
    TEST_ASSERT_EQUAL_UINT32(4, fixture_count_sent(&f, 0x065));
    TEST_ASSERT_EQUAL_UINT32(10, fixture_count_sent(&f, 0x363));
    TEST_ASSERT_EQUAL_UINT32(10, fixture_count_sent(&f, 0x101));
}

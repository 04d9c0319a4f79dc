/* When a cause began, by kind: frames and trips are fed by hand. */
#include "one_why.h"

#define AUTOPILOT "\0\0\0\0\0\0\x80"

/* With the configuration as it is now. */
static void begin_anew(void) {
    why_free(why);
    why = why_new(&config);
}

static const why_trip_t *trip_by(agv_fault_t fault, uint64_t t_ms) {
    feed_trip(why, (uint8_t)fault, t_ms);
    TEST_ASSERT_EQUAL_UINT(1, why_trip_count(why));
    return why_trip(why, 0);
}

/* Frames, then a trip: the kind of its cause, when it began, the last good frame before, the limit and its unit. */
typedef struct {
    const char *name;
    struct {
        uint32_t id; /* 0: no more */
        char bytes[8];
        uint64_t t_ms;
    } frames[9];
    struct {
        agv_fault_t fault;
        uint64_t trip_ms;
        why_kind_t kind;
        uint64_t cause_ms;
        uint64_t good_ms; /* NONE: there was none */
        int64_t limit;
        const char *unit;  /* NULL: no limit */
        const char *words; /* NULL: any */
    } trip;
} row_t;
enum { NONE = 0 };

static const row_t ROWS[] = {
    {"a command is silent from the engagement on",
     {{0x168, "\x08", 1000}, {0x363, AUTOPILOT, 5000}},
     {AGV_FAULT_GEAR_COMMAND_TIMEOUT, 5351, WHY_SILENCE, 5000, 1000, 350, "ms", NULL}},
    {"an AI computer that was never seen has its own deadline",
     {{0x363, AUTOPILOT, 5000}},
     {AGV_FAULT_AI_HEARTBEAT_LOST, 5501, WHY_SILENCE, 5000, NONE, 500, "ms", NULL}},
    {"a heartbeat of the AI computer that was lost before the engagement",
     {{0x43F, "\0\0\0\0\0\0\0\x01", 109}, {0x43F, "\0\0\0\0\0\0\0\x02", 209}, {0x363, AUTOPILOT, 1000}},
     {AGV_FAULT_AI_HEARTBEAT_LOST, 1000, WHY_SILENCE, 309, 209, 350, "ms",
      "43Fh turn_signal_command was silent: last at 0.209 s, deadline 350 ms, none since"}},
    {"a counter that is stuck",
     {{0x067, "\x01", 1000}, {0x067, "\x02", 1010}, {0x067, "\x02", 1020}, {0x067, "\x02", 1030}},
     {AGV_FAULT_EPS_HEARTBEAT_STUCK, 1061, WHY_STUCK, 1020, 1010, 50, "ms",
      "067h steering_status kept its alive counter from 1.020 s on [02 00 00 00 00 00 00 00]: last change at 1.010 s, "
      "deadline 50 ms"}},
    {"both modes at once",
     {{0x363, "\0\0\0\0\0\0\x40", 990}, {0x363, "\0\0\0\0\0\0\xC0\x01", 1000}},
     {AGV_FAULT_MODE_INVALID, 1051, WHY_MODE, 1000, 990, 50, "ms",
      "363h vehicle_status reported manual and autopilot together for 50 ms, from 1.000 s on"}},
    {"more throttle than commanded",
     {{0x363, AUTOPILOT, 1000}, {0x075, "\x0A", 1001}, {0x050, "\x0A", 1990}, {0x050, "\x64", 2000}},
     {AGV_FAULT_THROTTLE_DEVIATION, 2500, WHY_BUDGET, 2000, 1990, 25, "counts",
      "050h throttle_status was more than 25 counts above 075h throttle_command for 500 ms, from 2.000 s on"}},
    {"a bit began with the first frame that has it, since the last one without it",
     {{0x363, "\0\0\0\0\x01\0\x40", 900},
      {0x363, "\0\0\0\0\0\0\x40\x01", 1000},
      {0x363, "\0\0\0\0\x01\0\x40\x02", 1010},
      {0x363, "\0\0\0\0\x01\0\x40\x03", 1020}},
     {AGV_FAULT_REMOTE_SIGNAL_LOST, 1020, WHY_BIT, 1010, 1000, WHY_NO_LIMIT, NULL, NULL}},
    {"a score began where it left 0: 2 1 0 2 1 3 5 6",
     {{0x167, "\0\0\0\x01\0\0\0\x01", 1000},
      {0x167, "\0\0\0\x01", 1010},
      {0x167, "\0\0\0\x01", 1020},
      {0x167, "\0\0\0\x01\0\0\0\x01", 1030},
      {0x167, "\0\0\0\x01", 1040},
      {0x167, "\0\0\0\x01\0\0\0\x01", 1050},
      {0x167, "\0\0\0\x01\0\0\0\x01", 1060},
      {0x167, "\0\0\0\x01\0\0\0\x01", 1070}},
     {AGV_FAULT_EPS_UNDER_VOLTAGE, 1070, WHY_SCORE, 1030, 1020, 3, "frames", NULL}},
    {"a budget began with the condition: 50.1 degrees off",
     {{0x363, AUTOPILOT, 1000},
      {0x065, "\x28\x23", 1001},
      {0x067, "\x01\x64\x28\x23", 1990},
      {0x067, "\x02\x64\x1D\x25", 2000},
      {0x067, "\x03\x64\x1D\x25", 2490}},
     {AGV_FAULT_STEERING_DEVIATION, 2500, WHY_BUDGET, 2000, 1990, 500, "ddeg",
      "067h steering_status was more than 50.0 deg off 065h steering_command for 500 ms, from 2.000 s on"}},
    {"progress begins a budget anew: 204.8, then 102.4 degrees off",
     {{0x363, AUTOPILOT, 1000},
      {0x065, "\x28\x23", 1001},
      {0x067, "\x02\x64\x28\x2B", 2000},
      {0x067, "\x03\x64\x28\x27", 2300}},
     {AGV_FAULT_STEERING_DEVIATION, 2800, WHY_BUDGET, 2300, NONE, 500, "ddeg", NULL}},
    {"throttle in gear P before the engagement: no frame before was good",
     {{0x0A3, "\x08", 900},
      {0x050, "\xC8", 910},
      {0x050, "\xC8", 990},
      {0x363, AUTOPILOT, 1000},
      {0x050, "\xC8", 1010}},
     {AGV_FAULT_THROTTLE_IN_PARK, 2010, WHY_BUDGET, 1010, NONE, 200, "ms", NULL}},
    {"an angle that was off before the first command: no frame before was good",
     {{0x363, AUTOPILOT, 1000}, {0x067, "\x01\x64\x1D\x25", 1005}, {0x065, "\x28\x23", 1010}},
     {AGV_FAULT_STEERING_DEVIATION, 2010, WHY_BUDGET, 1010, NONE, 500, "ddeg", NULL}},
    {"a command was out of range before the engagement too: the last good one is older",
     {{0x065, "\x28\x23", 900}, {0x065, "\x51\x46", 950}, {0x363, AUTOPILOT, 1000}, {0x065, "\x51\x46", 1020}},
     {AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, 1020, WHY_VALUE, 1020, 900, 9000, "ddeg", NULL}},
    {"the command that is out of range: 18001",
     {{0x363, AUTOPILOT, 1000}, {0x065, "\x28\x23", 1020}, {0x065, "\x51\x46", 1045}},
     {AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, 1045, WHY_VALUE, 1045, 1020, 9000, "ddeg",
      NULL}}, /* on the wire 0 is -900.0 deg */
    {"the speeds are compared from the first one of 363h above 0 on: 1 m/h against 1000 mm/s",
     {{0x101, "\xE8\x03\0\0\xE8\x03", 1990},
      {0x363, "\0\0\0\0\0\0\x40", 2000},
      {0x363, "\x01\0\0\0\0\0\x40\x01", 3000}},
     {AGV_FAULT_SPEED_IMPLAUSIBLE, 4000, WHY_BUDGET, 3000, NONE, 1000, "ms", NULL}},
    {"a bit of 363h that counts while engaged only began with the engagement",
     {{0x363, "\0\0\0\0\0\0\x40", 900},
      {0x363, "\0\0\0\0\x08\0\x40\x01", 910},
      {0x363, "\0\0\0\0\x08\0\x80\x02", 1000},
      {0x363, "\0\0\0\0\x08\0\x80\x03", 1010}},
     {AGV_FAULT_VCU_AI_CAN_LOST, 1000, WHY_BIT, 1000, 900, WHY_NO_LIMIT, NULL, NULL}},
    {"of two frames with one stamp the second has the bit: the last good one came before",
     {{0x167, "\0\0\0\x01", 1000}, {0x167, "\0\0\0\x01", 1010}, {0x167, "\0\0\0\x01\0\0\0\x40", 1010}},
     {AGV_FAULT_EPS_MOTOR_ENCODER, 1010, WHY_BIT, 1010, 1000, WHY_NO_LIMIT, NULL, NULL}},
};

static void check_row(const row_t *row) {
    for (size_t i = 0; row->frames[i].id != 0; i++) {
        feed_frame(why, HAL_CAN_VEHICLE, row->frames[i].id, row->frames[i].bytes, row->frames[i].t_ms);
    }
    const why_trip_t *trip = trip_by(row->trip.fault, row->trip.trip_ms);
    TEST_ASSERT_EQUAL_MESSAGE(row->trip.kind, trip->kind, row->name);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE(row->trip.cause_ms * 1000, trip->cause_us, row->name);
    TEST_ASSERT_EQUAL_UINT64_MESSAGE((row->trip.good_ms == NONE) ? WHY_NEVER : row->trip.good_ms * 1000,
                                     trip->last_good_us, row->name);
    TEST_ASSERT_EQUAL_INT64_MESSAGE(row->trip.limit, trip->limit, row->name);
    TEST_ASSERT_EQUAL_STRING_MESSAGE(row->trip.unit, trip->unit, row->name);
    if (row->trip.words != NULL) {
        check_words(trip, row->trip.words);
    }
}

void test_causes(void) {
    for (size_t i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        tearDown();
        setUp();
        check_row(&ROWS[i]);
    }
}

void test_a_sentence_has_the_identifiers_of_the_configuration(void) {
    config.id_steering_command = 0x165;
    begin_anew();
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x165, "\x28\x23\0\0\0\0\0", 1010);
    check_words(trip_by(AGV_FAULT_STEERING_COMMAND_TIMEOUT, 1136),
                "165h steering_command was silent: last at 1.010 s, deadline 125 ms, none since");
}

void test_silence_begins_a_cycle_after_the_last_frame(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1025);
    const why_trip_t *trip = trip_by(AGV_FAULT_GEAR_STATUS_TIMEOUT, 1151);
    TEST_ASSERT_EQUAL(WHY_SILENCE, trip->kind);
    TEST_ASSERT_EQUAL_HEX32(0x0A3, trip->id);
    TEST_ASSERT_EQUAL_UINT64(1025000, trip->last_good_us);
    TEST_ASSERT_EQUAL_UINT64(1050000, trip->cause_us);
    TEST_ASSERT_EQUAL_INT64(125, trip->limit);
    TEST_ASSERT_EQUAL_UINT(2, trip->evidence_count);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->next_us);
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1300);
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1325);
    TEST_ASSERT_EQUAL_UINT64(1300000, why_trip(why, 0)->next_us);
    TEST_ASSERT_EQUAL_UINT(3, why_trip(why, 0)->evidence_count); /* the frame that ended it is shown too */
}

void test_a_frame_of_another_length_does_not_end_a_silence(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1000);
    const hal_can_frame_t shorter = {.id = 0x0A3, .length = 7};
    why_frame(why, HAL_CAN_VEHICLE, &shorter, 1020000);
    TEST_ASSERT_EQUAL_UINT64(1000000, trip_by(AGV_FAULT_GEAR_STATUS_TIMEOUT, 1126)->last_good_us);
}

void test_frames_in_another_form_during_a_silence(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1000);
    const hal_can_frame_t frames[] = {{.id = 0x0A3, .length = 7},
                                      {.id = 0x0A3, .length = 8, .flags = HAL_CAN_EXTENDED}};
    for (uint64_t i = 0; i < 4; i++) {
        why_frame(why, HAL_CAN_VEHICLE, &frames[i / 2], 1020000 + (i * 25000));
    }
    check_words(
        trip_by(AGV_FAULT_GEAR_STATUS_TIMEOUT, 1126),
        "0A3h gear_status was silent: last at 1.000 s, deadline 125 ms, none since; 4 frames came with a length of 7, "
        "the first at 1.020 s");
}

void test_extended_frames_during_a_silence(void) {
    const hal_can_frame_t frame = {.id = 0x0A3, .length = 8, .flags = HAL_CAN_EXTENDED};
    feed_frame(why, HAL_CAN_VEHICLE, 0x0A3, "\x08\0\0\0\0\0\0", 1000);
    why_frame(why, HAL_CAN_VEHICLE, &frame, 1025000);
    check_words(trip_by(AGV_FAULT_GEAR_STATUS_TIMEOUT, 1126), "0A3h gear_status was silent: last at 1.000 s, deadline "
                                                              "125 ms, none since; 1 extended frame came, the "
                                                              "first at 1.025 s");
}

void test_a_command_that_the_gateway_withheld(void) {
    config.topology = AGV_TOPOLOGY_GATEWAY;
    begin_anew();
    feed_mode(why, 0x80, 1000);
    for (uint64_t i = 0; i < 6; i++) { /* 363h reports manual after that of 1010 */
        feed_frame(why, HAL_CAN_AI, 0x065, "\0\0\0\0\0\0\0", 1010 + (i * 25));
        feed_mode(why, 0x80, 1020 + ((i * 25) / 10 * 10));
        feed_mode(why, 0x40, 1030 + ((i * 25) / 10 * 10));
    }
    const why_trip_t *trip = trip_by(AGV_FAULT_STEERING_COMMAND_TIMEOUT, 1136);
    TEST_ASSERT_EQUAL_UINT64(1010000, trip->last_good_us);
    TEST_ASSERT_EQUAL_UINT64(1035000, trip->cause_us);
    feed_mode(why, 0x80, 1170);
    feed_frame(why, HAL_CAN_AI, 0x065, "\0\0\0\0\0\0\0", 1180); /* does not end it: TRIPPED passes none on */
    check_words(trip,
                "065h steering_command was not passed on: last at 1.010 s, deadline 125 ms, none since; 5 frames came "
                "while the VCU did not report autopilot, the first at 1.035 s");
}

void test_of_two_frames_with_one_stamp_the_bad_one_is_shown(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0", 1010);
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0\x08", 1010);
    const why_trip_t *trip = trip_by(AGV_FAULT_EPS_OVER_CURRENT_SHUTDOWN, 1010);
    TEST_ASSERT_EQUAL_UINT(2, trip->evidence_count);
    TEST_ASSERT_EQUAL_HEX8(0x08, trip->evidence[1].frame.data[7]);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->last_good_us);
    check_words(trip, "167h eps_status reported EPS_OVER_CURRENT_SHUTDOWN at 1.010 s [00 00 00 01 00 00 00 08]");
}

void test_bad_frames_with_good_ones_between_them(void) {
    for (uint64_t i = 0; i < 9; i++) { /* score 2 1 3 2 4 3 5 4 6 */
        feed_frame(why, HAL_CAN_VEHICLE, 0x167, (i % 2 == 0) ? "\0\0\0\x01\0\0\0\x01" : "\0\0\0\x01\0\0\0",
                   1000 + (i * 10));
    }
    check_words(trip_by(AGV_FAULT_EPS_UNDER_VOLTAGE, 1080), "167h eps_status reported EPS_UNDER_VOLTAGE in 5 frames, "
                                                            "the first at 1.000 s [00 00 00 01 00 00 00 01]");
}

void test_bad_modes_of_several_kinds(void) {
    static const char *const modes[] = {"\0\0\0\0\0\0\0", "\0\0\0\x02\0\0\0", "\0\0\0\x03\0\0\0", "\0\0\0\x09\0\0\0",
                                        "\0\0\0\xFF\0\0\0"};
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000);
    for (uint64_t i = 0; i < 5; i++) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x167, modes[i], 2000 + (i * 10));
    }
    check_words(
        trip_by(AGV_FAULT_EPS_MODE_OFF, 2040),
        "167h eps_status reported an EPS mode other than angle control in 5 frames, the first at 2.000 s [00 00 "
        "00 00 00 00 00 00]");
}

void test_a_start_in_tripped_that_was_chosen(void) {
    config.after_power_on = AGV_AFTER_POWER_ON_TRIPPED;
    begin_anew();
    feed_state(why, 0, AGV_STATE_TRIPPED, AGV_FAULT_SUPERVISOR_RESET, 0);
    check_words(why_trip(why, 0), "a power-on (after_power_on: tripped), or the processor was reset during a run");
}

void test_a_message_that_never_came(void) {
    feed_state(why, 0, AGV_STATE_INIT, AGV_FAULT_NONE, 5);
    const why_trip_t *trip = trip_by(AGV_FAULT_EPS_STATUS_TIMEOUT, 100);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->last_good_us);
    TEST_ASSERT_EQUAL_UINT64(5000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT(0, trip->evidence_count);
}

void test_a_wrong_step_counts_as_stuck_where_the_counter_has_to_increment(void) {
    config.eps_counter = AGV_COUNTER_INCREMENTS;
    begin_anew();
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x01\0\0\0\0\0\0", 1000);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x02\0\0\0\0\0\0", 1010);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x20\0\0\0\0\0\0", 1020);
    feed_frame(why, HAL_CAN_VEHICLE, 0x067, "\x01\0\0\0\0\0\0", 1030);
    const why_trip_t *trip = trip_by(AGV_FAULT_EPS_HEARTBEAT_STUCK, 1061);
    TEST_ASSERT_EQUAL_UINT64(1020000, trip->cause_us);
    check_words(trip, "067h steering_status did not step its alive counter by 1 to 3 from 1.020 s on [20 00 00 "
                      "00 00 00 00 00]: last right step at 1.010 s, deadline 50 ms");
}

void test_a_mode_of_the_eps_counts_from_the_engagement_on(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\0\0\0\0", 900); /* assists, in manual */
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000);
    for (uint64_t t_ms = 1010; t_ms <= 1540; t_ms += 10) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\0\0\0\0", t_ms);
    }
    const why_trip_t *trip = trip_by(AGV_FAULT_EPS_MODE_NOT_ANGLE, 1540);
    TEST_ASSERT_EQUAL_UINT64(1000000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT64(WHY_NEVER, trip->last_good_us);
    check_words(trip, "167h eps_status reported an EPS mode other than angle control in 5 frames "
                      "since the engagement at 1.000 s; earlier frames were bad, too");
}

void test_the_last_good_mode_of_the_eps_is_a_good_one(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\x01\0\0\0", 800);
    feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\0\0\0\0", 900);
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000);
    for (uint64_t t_ms = 1010; t_ms <= 1540; t_ms += 10) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x167, "\0\0\0\0\0\0\0", t_ms);
    }
    TEST_ASSERT_EQUAL_UINT64(800000, trip_by(AGV_FAULT_EPS_MODE_NOT_ANGLE, 1540)->last_good_us);
}

void test_a_fourth_engagement(void) {
    for (uint64_t i = 0; i < 4; i++) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000 + (i * 1000));
        for (uint64_t off = 1; off <= 3; off++) {
            feed_frame(why, HAL_CAN_VEHICLE, 0x363, "\0\0\0\0\0\0\x40", 1000 + (i * 1000) + (off * 10));
        }
    }
    const why_trip_t *trip = trip_by(AGV_FAULT_MODE_FLAPPING, 4000);
    TEST_ASSERT_EQUAL_UINT64(1000000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT(4, trip->evidence_count);
}

void test_a_command_of_another_length(void) {
    feed_frame(why, HAL_CAN_VEHICLE, 0x363, AUTOPILOT, 1000);
    const hal_can_frame_t shorter = {.id = 0x075, .length = 2};
    why_frame(why, HAL_CAN_VEHICLE, &shorter, 1100000);
    const why_trip_t *trip = trip_by(AGV_FAULT_AI_COMMAND_OUT_OF_RANGE, 1100);
    TEST_ASSERT_EQUAL(AGV_MSG_THROTTLE_COMMAND, trip->message);
    TEST_ASSERT_EQUAL_INT64(WHY_NO_LIMIT, trip->limit);
}

void test_the_command_that_comes_too_fast(void) {
    for (uint64_t i = 0; i <= 10; i++) {
        feed_frame(why, HAL_CAN_VEHICLE, 0x168, "\x08\0\0\0\0\0\0", 1000 + (i * 30));
        feed_frame(why, HAL_CAN_VEHICLE, 0x075, "\0\0\0\0\0\0\0", 1000 + (i * 100));
    }
    const why_trip_t *trip = trip_by(AGV_FAULT_COMMAND_TOO_FAST, 1300);
    TEST_ASSERT_EQUAL(AGV_MSG_GEAR_COMMAND, trip->message);
    TEST_ASSERT_EQUAL_UINT64(1030000, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT64(1000000, trip->last_good_us);
    TEST_ASSERT_EQUAL_INT64(10, trip->limit);
}

/* 12.6 ms are 12 or 13 ms of whole stamps. Half the cycle of 065h is 12.5 ms: two gaps in five are too short. */
void test_gaps_are_measured_in_whole_ms(void) {
    hal_can_frame_t frame = {.id = 0x065, .length = 8};
    for (uint64_t i = 0; i <= 90; i++) {
        why_frame(why, HAL_CAN_VEHICLE, &frame, 1000000 + (i * 12600));
    }
    const why_trip_t *trip = trip_by(AGV_FAULT_COMMAND_TOO_FAST, 2134);
    TEST_ASSERT_EQUAL(AGV_MSG_STEERING_COMMAND, trip->message);
    TEST_ASSERT_EQUAL_UINT64(1012600, trip->cause_us);
    TEST_ASSERT_EQUAL_UINT64(1000000, trip->last_good_us);
}

void test_an_error_frame_shows_a_bus_off(void) {
    const hal_can_frame_t error = {.id = 0x40, .length = 8, .flags = HAL_CAN_ERROR};
    why_frame(why, HAL_CAN_VEHICLE, &error, 2000500);
    const why_trip_t *trip = trip_by(AGV_FAULT_BUS_OFF, 2001);
    TEST_ASSERT_EQUAL(WHY_BUS, trip->kind);
    TEST_ASSERT_EQUAL_UINT64(2000500, trip->cause_us);
    TEST_ASSERT_EQUAL_HEX32(WHY_NO_ID, trip->id);
}

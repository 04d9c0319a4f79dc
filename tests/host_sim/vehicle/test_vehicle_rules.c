/* The vehicle that does not do what it was told, or reports what is not so: what the rules of the supervisor are about. */
#include "vehicle_fixture.h"

void setUp(void) {
    vehicle_defaults(&config);
    connected = true;
    begin();
    run_until(1); /* the nodes have started */
}

static void do_it(vehicle_do_t what, bool on) {
    TEST_ASSERT_TRUE(act((vehicle_action_t){.what = what, .on = on}));
}

/* The AI computer drives at 30 %: 1200 mm/s from 3000 ms on. */
static void drive(uint8_t gear) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = gear, .throttle_permille = 300});
    do_it(VEHICLE_DO_ENGAGE, true);
    expect_speed_at(3000, (gear == AGV_GEAR_R) ? -1200 : 1200);
}

static void park(void) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_P, .throttle_permille = 0});
}

static uint8_t throttle_status(void) {
    return last_of(AGV_MSG_THROTTLE_STATUS)->frame.data[0];
}

static int32_t speed_m_per_h(void) {
    const uint8_t *data = last_of(AGV_MSG_VEHICLE_STATUS)->frame.data;
    return data[0] + (data[1] * 256);
}

static void expect_mode_at(uint64_t t_ms, uint8_t byte) {
    expect_byte_at(t_ms, AGV_MSG_VEHICLE_STATUS, 6, byte);
}

/* Frames of a message since `first` whose byte is not this. */
static size_t count_other(agv_message_t message, unsigned byte, uint8_t value, size_t first) {
    size_t count = 0;
    for (size_t i = first; i < sent_count; i++) {
        const bool is_it = sent[i].frame.id == config.ids.of[message];
        count += (is_it && (sent[i].frame.data[byte] != value)) ? 1 : 0;
    }
    return count;
}

void test_the_throttle_comes_down_at_its_rate(void) {
    drive(AGV_GEAR_D);
    TEST_ASSERT_EQUAL_UINT8(75, throttle_status());
    (void)act((vehicle_action_t){.what = VEHICLE_DO_VCU_RAMP, .count = 20}); /* 50 counts a second */
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 0});
    run_until(3068); /* 075h of 3067 commands 0 */
    TEST_ASSERT_EQUAL_UINT8(75, throttle_status());
    run_until(3568);
    TEST_ASSERT_UINT8_WITHIN(2, 50, throttle_status());
    run_until(4568);
    TEST_ASSERT_EQUAL_UINT8(0, throttle_status());
    (void)act((vehicle_action_t){.what = VEHICLE_DO_RECOVER, .node = VEHICLE_VCU});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 1000});
    run_until(5000);
    TEST_ASSERT_EQUAL_UINT8(250, throttle_status());
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 0});
    run_until(5168); /* 100 ms after the command: half of 200 */
    TEST_ASSERT_UINT8_WITHIN(13, 125, throttle_status());
    run_until(5275);
    TEST_ASSERT_EQUAL_UINT8(0, throttle_status());
}

/* Shows: P7 */
void test_363h_carries_the_speed_of_the_wheels(void) {
    drive(AGV_GEAR_R);
    TEST_ASSERT_EQUAL_INT32(4320, speed_m_per_h()); /* 1.2 m/s, without a sign */
    config.reported_speed_pct = 50;
    begin();
    run_until(1);
    drive(AGV_GEAR_D);
    TEST_ASSERT_EQUAL_INT32(2160, speed_m_per_h());
    config.reported_speed_pct = 10000;
    begin();
    run_until(1);
    drive(AGV_GEAR_D);
    TEST_ASSERT_EQUAL_INT32(65535, speed_m_per_h()); /* and no further */
}

static void hold_speed(uint16_t count, uint16_t every) {
    vehicle_action_t hold = {
        .what = VEHICLE_DO_HOLD, .message = AGV_MSG_VEHICLE_STATUS, .count = count, .every = every};
    memset(hold.keep, 0xFF, sizeof hold.keep);
    hold.keep[0] = 0;
    hold.keep[1] = 0;
    TEST_ASSERT_TRUE(act(hold));
}

void test_a_field_that_is_held_stays_at_what_it_was(void) {
    drive(AGV_GEAR_D);
    hold_speed(VEHICLE_FOREVER, 0);
    park();
    const uint8_t counter = last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[7];
    run_until(5000);
    TEST_ASSERT_EQUAL_INT32(4320, speed_m_per_h());
    TEST_ASSERT_EQUAL_INT32(0, look().speed_mm_s);
    TEST_ASSERT_EQUAL_UINT8((uint8_t)(counter + 200), last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[7]);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_UNPATCH, .message = AGV_MSG_VEHICLE_STATUS});
    run_until(5011);
    TEST_ASSERT_EQUAL_INT32(0, speed_m_per_h());
    hold_speed(2, 0);
    run_until(5031);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 300});
    run_until(8000);
    TEST_ASSERT_EQUAL_INT32(4320, speed_m_per_h()); /* the two frames are over */
}

void test_the_wheels_turn_on_in_park(void) {
    config.park_guard = false;
    begin();
    run_until(1);
    drive(AGV_GEAR_D);
    do_it(VEHICLE_DO_VCU_ROLL_ON, true);
    park();
    expect_gear_at(9000, AGV_GEAR_P);
    expect_speed_at(9000, 1200);
    TEST_ASSERT_EQUAL_UINT8(0, throttle_status());
    do_it(VEHICLE_DO_VCU_ROLL, false);
    expect_speed_at(9500, 0);
}

void test_it_rolls_away_after_it_stood(void) {
    run_until(2000);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_VCU_ROLL, .on = true, .speed_mm_s = -300});
    expect_speed_at(3000, -300);
    expect_gear_at(3000, AGV_GEAR_P);
    TEST_ASSERT_EQUAL_INT32(1080, speed_m_per_h());
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_VCU_ROLL, .on = true, .speed_mm_s = 20001}));
}

void test_park_is_refused_at_speed(void) {
    drive(AGV_GEAR_D);
    do_it(VEHICLE_DO_VCU_REFUSE_PARK, true);
    park();
    run_until(3900); /* throttle 0 since 3067: it coasts at 0.4 m/s2 to 0.8 m/s */
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_D, look().gear);
    TEST_ASSERT_GREATER_THAN_INT32(800, look().speed_mm_s);
    expect_gear_at(4500, AGV_GEAR_P);
    TEST_ASSERT_LESS_THAN_INT32(800, look().fastest_park_mm_s);
}

static hal_can_frame_t command_frame(uint32_t id, uint8_t length, uint8_t flags, uint8_t byte_0, uint8_t byte_4) {
    return (hal_can_frame_t){.id = id, .length = length, .flags = flags, .data = {byte_0, 0, 0, 0, byte_4}};
}

static void hear(hal_can_frame_t frame) {
    vehicle_receive(&vehicle, VEHICLE_VCU, now_ms, &frame);
}

void test_a_sloppy_vcu_obeys_what_bytes_are_there(void) {
    drive(AGV_GEAR_D);
    hear(command_frame(0x168u, 1, HAL_CAN_FD, AGV_GEAR_P, 0));
    expect_throttle_at(3010, 300); /* not yet sloppy */
    do_it(VEHICLE_DO_VCU_SLOPPY, true);
    hear(command_frame(0x075u, 0, 0, 0, 0)); /* no byte, no command */
    expect_throttle_at(3020, 300);
    hear(command_frame(0x075u, 3, 0, 250, 0));
    run_until(3060);
    TEST_ASSERT_GREATER_THAN_UINT16(400, look().throttle_permille);
    hear(command_frame(0x43Fu, 4, 0, 0, 0x40u)); /* cut off before the bits */
    TEST_ASSERT_TRUE(look().autopilot);
    hear(command_frame(0x43Fu, 64, HAL_CAN_FD, 0, 0x40u));
    TEST_ASSERT_FALSE(look().autopilot);
    do_it(VEHICLE_DO_VCU_SLOPPY, false);
    hear(command_frame(0x168u, 8, HAL_CAN_FD, AGV_GEAR_P, 0));
    expect_gear_at(4500, AGV_GEAR_D);
}

void test_a_short_43fh_is_no_sign_of_life(void) {
    config.obeys_short_frames = true;
    begin();
    run_until(1000);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_STOP, .node = VEHICLE_AI});
    for (uint8_t i = 0; i < 30; i++) {
        hear(command_frame(0x43Fu, 7, 0, i, 0));
        run_until(now_ms + 50);
    }
    TEST_ASSERT_EQUAL_HEX8(AGV_VCU_ALARM_AI_CAN_LOST, look().alarms);
}

void test_one_frame_in_so_many_carries_another_mode(void) {
    run_until(100);
    size_t first = sent_count;
    patch(AGV_MSG_VEHICLE_STATUS, 6, 0xC0u, 0x80u, 1, 40);
    expect_mode_at(101, 0x80u); /* the first one at once */
    expect_mode_at(111, 0x40u);
    run_until(4100); /* 400 frames */
    TEST_ASSERT_EQUAL_size_t(10, count_other(AGV_MSG_VEHICLE_STATUS, 6, 0x40u, first));
    first = sent_count;
    patch(AGV_MSG_VEHICLE_STATUS, 6, 0xC0u, 0x00u, 30, 40); /* manual is right for 100 ms of every 400 ms */
    run_until(8100);
    TEST_ASSERT_EQUAL_size_t(300, count_other(AGV_MSG_VEHICLE_STATUS, 6, 0x40u, first));
    (void)act((vehicle_action_t){.what = VEHICLE_DO_UNPATCH, .message = AGV_MSG_VEHICLE_STATUS});
    first = sent_count;
    run_until(9000);
    TEST_ASSERT_EQUAL_size_t(0, count_other(AGV_MSG_VEHICLE_STATUS, 6, 0x40u, first));
}

void test_a_message_is_lost_now_and_then(void) {
    run_until(100);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_MUTE, .message = AGV_MSG_EPS_STATUS, .count = 2, .every = 10});
    size_t first = sent_count;
    expect_count_at(1100, AGV_MSG_EPS_STATUS, first, 80);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_UNMUTE, .message = AGV_MSG_EPS_STATUS});
    first = sent_count;
    expect_count_at(2100, AGV_MSG_EPS_STATUS, first, 100);
}

void test_what_363h_carries_is_late_and_its_counter_is_not(void) {
    run_until(1000);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_DELAY, .message = AGV_MSG_VEHICLE_STATUS, .ms = 300});
    run_until(2000);
    const uint8_t counter = last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[7];
    do_it(VEHICLE_DO_ENGAGE, true); /* 363h of 2000 would say so */
    TEST_ASSERT_TRUE(look().autopilot);
    expect_mode_at(2300, 0x40u);
    expect_mode_at(2301, 0x80u);
    TEST_ASSERT_EQUAL_UINT8((uint8_t)(counter + 31), last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[7]);
    do_it(VEHICLE_DO_DISENGAGE, true);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_DELAY, .message = AGV_MSG_VEHICLE_STATUS, .ms = 0});
    expect_mode_at(2311, 0x40u);
    TEST_ASSERT_FALSE(act((vehicle_action_t){.what = VEHICLE_DO_DELAY, .message = AGV_MSG_VEHICLE_STATUS, .ms = 1001}));
}

void test_the_longest_delay_reaches_back_as_far_as_it_says(void) {
    run_until(100);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_DELAY, .message = AGV_MSG_VEHICLE_STATUS, .ms = 1000});
    run_until(3000);
    do_it(VEHICLE_DO_ENGAGE, true);
    expect_mode_at(4000, 0x40u);
    expect_mode_at(4001, 0x80u);
}

void test_a_command_that_is_ignored_changes_nothing(void) {
    drive(AGV_GEAR_D);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_IGNORE, .message = AGV_MSG_THROTTLE_COMMAND, .on = true});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_IGNORE, .message = AGV_MSG_GEAR_COMMAND, .on = true});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_IGNORE, .message = AGV_MSG_TURN_SIGNAL_COMMAND, .on = true});
    park();
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_AUTOPILOT_OFF, .on = true});
    run_until(6000);
    TEST_ASSERT_TRUE(look().autopilot);
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_D, look().gear);
    TEST_ASSERT_EQUAL_INT32(1200, look().speed_mm_s);
    TEST_ASSERT_EQUAL_HEX8(0, look().alarms); /* the AI computer is heard all the same */
    (void)act((vehicle_action_t){.what = VEHICLE_DO_IGNORE, .message = AGV_MSG_THROTTLE_COMMAND, .on = false});
    expect_throttle_at(6200, 0);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_RECOVER, .node = VEHICLE_VCU});
    run_until(6400);
    TEST_ASSERT_FALSE(look().autopilot);
}

void test_an_eps_that_ignores_065h_keeps_the_angle_that_it_was_told(void) {
    drive(AGV_GEAR_D);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_IGNORE, .message = AGV_MSG_STEERING_COMMAND, .on = true});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .angle_ddeg = 600});
    run_until(4000);
    TEST_ASSERT_EQUAL_INT32(0, measured_ddeg());
    (void)act((vehicle_action_t){.what = VEHICLE_DO_RECOVER, .node = VEHICLE_EPS});
    run_until(5000);
    TEST_ASSERT_EQUAL_INT32(600, measured_ddeg());
}

/* The lowest and highest angle of a message since `first`. */
static void range_of(agv_message_t message, unsigned byte, size_t first, int32_t range[2]) {
    range[0] = INT32_MAX;
    range[1] = INT32_MIN;
    for (size_t i = first; i < sent_count; i++) {
        if (sent[i].frame.id == config.ids.of[message]) {
            const int32_t ddeg = sent[i].frame.data[byte] + (sent[i].frame.data[byte + 1] * 256) - 9000;
            range[0] = (ddeg < range[0]) ? ddeg : range[0];
            range[1] = (ddeg > range[1]) ? ddeg : range[1];
        }
    }
}

void test_the_eps_hunts_around_the_command(void) {
    int32_t range[2];

    (void)act((vehicle_action_t){.what = VEHICLE_DO_EPS_HUNT, .angle_ddeg = 600, .ms = 400});
    run_until(1000);
    range_of(AGV_MSG_STEERING_STATUS, 2, 0, range);
    TEST_ASSERT_EQUAL_INT32(0, range[0]); /* in assist nothing commands it */
    TEST_ASSERT_EQUAL_INT32(0, range[1]);
    drive(AGV_GEAR_D);
    const size_t first = sent_count;
    run_until(5000);
    range_of(AGV_MSG_STEERING_STATUS, 2, first, range);
    TEST_ASSERT_INT32_WITHIN(30, -600, range[0]);
    TEST_ASSERT_INT32_WITHIN(30, 600, range[1]);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_EPS_HUNT});
    run_until(5010);
    TEST_ASSERT_EQUAL_INT32(0, measured_ddeg());
}

void test_the_ai_computer_weaves_and_the_steering_is_stuck(void) {
    int32_t range[2];

    drive(AGV_GEAR_D);
    (void)act((vehicle_action_t){
        .what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 300, .angle_ddeg = 100});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_WEAVE, .angle_ddeg = 300, .ms = 2000});
    size_t first = sent_count;
    run_until(7000);
    range_of(AGV_MSG_STEERING_COMMAND, 0, first, range);
    TEST_ASSERT_INT32_WITHIN(8, -200, range[0]);
    TEST_ASSERT_INT32_WITHIN(8, 400, range[1]);
    TEST_ASSERT_INT32_WITHIN(30, 100, measured_ddeg()); /* two periods: in the middle again */
    do_it(VEHICLE_DO_EPS_STUCK, true);
    first = sent_count;
    run_until(11000);
    range_of(AGV_MSG_STEERING_STATUS, 2, first, range);
    TEST_ASSERT_EQUAL_INT32(range[0], range[1]);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_WEAVE});
    expect_byte_at(11100, AGV_MSG_STEERING_COMMAND, 0, 0x8Cu); /* +10.0 degrees */
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .angle_ddeg = 9000});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_WEAVE, .angle_ddeg = 9000, .ms = 1000});
    first = sent_count;
    run_until(13000);
    range_of(AGV_MSG_STEERING_COMMAND, 0, first, range);
    TEST_ASSERT_EQUAL_INT32(9000, range[1]); /* never out of range */
}

void test_the_other_direction_is_taken_at_standstill_only(void) {
    drive(AGV_GEAR_D);
    const size_t first = sent_count;
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_R, .throttle_permille = 200});
    run_until(3200); /* the AI computer waits, with throttle 0 */
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_D, last_of(AGV_MSG_GEAR_COMMAND)->frame.data[0]);
    TEST_ASSERT_EQUAL_UINT8(0, last_of(AGV_MSG_THROTTLE_COMMAND)->frame.data[0]);
    expect_speed_at(9000, -800);
    int32_t speed_mm_s = 0;
    for (size_t i = first; i < sent_count; i++) {
        const hal_can_frame_t *frame = &sent[i].frame;
        if (frame->id == 0x101u) {
            speed_mm_s = (int16_t)(frame->data[0] + (frame->data[1] * 256));
        } else if ((frame->id == 0x168u) && (frame->data[0] == AGV_GEAR_R)) {
            TEST_ASSERT_LESS_THAN_INT32(50, speed_mm_s);
            return;
        } else {
            /* no matter */
        }
    }
    TEST_FAIL_MESSAGE("gear R was never commanded");
}

void test_a_vcu_that_is_told_to_change_direction_brakes_first(void) {
    drive(AGV_GEAR_D);
    do_it(VEHICLE_DO_AI_STUBBORN, true);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_R, .throttle_permille = 300});
    run_until(3300); /* 168h of 3037: it brakes with 3 m/s2 */
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_D, look().gear);
    TEST_ASSERT_INT32_WITHIN(30, 411, look().speed_mm_s);
    TEST_ASSERT_EQUAL_UINT8(0, throttle_status());
    expect_gear_at(3700, AGV_GEAR_R);
    expect_speed_at(6000, -1200);
}

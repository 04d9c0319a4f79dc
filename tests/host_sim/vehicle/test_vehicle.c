/* The vehicle that obeys: cycles, gear box, wheels, steering, modes, alarms. */
#include "vehicle_fixture.h"

#include "agv/config.h"

#define AUTOPILOT_OFF 0x40u

void setUp(void) {
    vehicle_defaults(&config);
    connected = false;
    begin();
    run_until(1); /* the nodes have started */
}

static void command_signals(uint8_t flags, uint8_t counter) {
    hal_can_frame_t frame = {.id = config.ids.of[AGV_MSG_TURN_SIGNAL_COMMAND], .length = AGV_DLC};
    frame.data[4] = flags;
    frame.data[7] = counter;
    vehicle_receive(&vehicle, VEHICLE_VCU, now_ms, &frame);
}

/* Engaged, with gear D and a throttle that keeps coming. */
static void drive(uint64_t until_ms, uint8_t throttle) {
    run_until(1);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
    while (now_ms < until_ms) {
        command(AGV_MSG_GEAR_COMMAND, AGV_GEAR_D, 0);
        command(AGV_MSG_THROTTLE_COMMAND, throttle, 0);
        command_signals(0, (uint8_t)now_ms);
        run_until((now_ms + 100 < until_ms) ? now_ms + 100 : until_ms);
    }
}

static void expect_alarms_at(uint64_t t_ms, uint8_t alarms) {
    run_until(t_ms);
    TEST_ASSERT_EQUAL_HEX8(alarms, look().alarms);
}

/* Shows: P16 */
void test_every_message_is_sent_on_its_cycle_by_its_node(void) {
    run_until(1000);
    for (int m = 0; m < AGV_MSG_COUNT; m++) {
        const agv_message_t message = (agv_message_t)m;
        TEST_ASSERT_EQUAL_size_t(1000 / agv_message_cycle_ms(message), count_of(message, 0));
        TEST_ASSERT_EQUAL(vehicle_sender_of(message), last_of(message)->from);
        TEST_ASSERT_EQUAL_UINT8(AGV_DLC, last_of(message)->frame.length);
        TEST_ASSERT_EQUAL_UINT8(0, last_of(message)->frame.flags);
    }
}

void test_at_most_two_frames_start_in_one_millisecond(void) {
    uint8_t per_ms[1000] = {0};

    run_until(1000);
    for (size_t i = 0; i < sent_count; i++) {
        per_ms[sent[i].t_ms]++;
        TEST_ASSERT_LESS_OR_EQUAL_UINT8(2, per_ms[sent[i].t_ms]);
    }
}

/* Shows: P1 */
void test_identifiers_are_those_of_the_configuration(void) {
    agv_config_t settings;
    agv_config_defaults(&settings);
    settings.id_set = AGV_ID_SET_TABLE;
    settings.id_gear_command = 0x169u;
    agv_config_ids(&settings, &config.ids);
    begin();
    run_until(100);
    TEST_ASSERT_EQUAL_HEX32(0x203u, last_of(AGV_MSG_VEHICLE_STATUS)->frame.id);
    TEST_ASSERT_EQUAL_HEX32(0x201u, last_of(AGV_MSG_TURN_SIGNAL_COMMAND)->frame.id);
    TEST_ASSERT_EQUAL_HEX32(0x169u, last_of(AGV_MSG_GEAR_COMMAND)->frame.id);
}

void test_only_the_ai_computer_of_a_gateway_is_on_the_ai_side(void) {
    config.gateway = true;
    begin();
    run_until(100);
    for (size_t i = 0; i < sent_count; i++) {
        TEST_ASSERT_EQUAL((sent[i].from == VEHICLE_AI) ? HAL_CAN_AI : HAL_CAN_VEHICLE, sent[i].side);
    }
    TEST_ASSERT_EQUAL(HAL_CAN_VEHICLE, vehicle_side_of(&vehicle, VEHICLE_ROGUE));
}

/* Shows: P13 */
void test_alive_counters_begin_at_0_and_wrap(void) {
    run_until(1);
    TEST_ASSERT_EQUAL_UINT8(0, last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[7]);
    run_until(2561);
    TEST_ASSERT_EQUAL_UINT8(0, last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[7]);
    run_until(2562);
    TEST_ASSERT_EQUAL_UINT8(0, last_of(AGV_MSG_STEERING_STATUS)->frame.data[0]);
}

void test_it_stands_in_park_and_manual_at_first(void) {
    run_until(100);
    const vehicle_view_t view = look();
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_P, view.gear);
    TEST_ASSERT_FALSE(view.autopilot);
    TEST_ASSERT_EQUAL_INT32(0, view.speed_mm_s);
    TEST_ASSERT_EQUAL_HEX8(0x40u, last_of(AGV_MSG_VEHICLE_STATUS)->frame.data[6]);
    TEST_ASSERT_EQUAL_HEX8(0x08u, last_of(AGV_MSG_GEAR_STATUS)->frame.data[0]);
}

void test_a_gear_takes_time_and_the_wheels_accelerate_with_the_throttle(void) {
    drive(119, 75);
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_P, look().gear);
    drive(130, 75);
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_D, look().gear);
    drive(620, 75);
    TEST_ASSERT_INT32_WITHIN(25, 500, look().speed_mm_s); /* 1 m/s2 for half a second */
    drive(3000, 75);
    TEST_ASSERT_EQUAL_INT32(1200, look().speed_mm_s); /* 30 % of 4 m/s */
    TEST_ASSERT_EQUAL_UINT16(300, look().throttle_permille);
}

void test_status_says_what_the_body_does(void) {
    drive(3000, 75);
    agv_wheel_speed_t wheels;
    agv_vehicle_status_t status;
    (void)agv_unpack_wheel_speed(&wheels, last_of(AGV_MSG_WHEEL_SPEED)->frame.data);
    (void)agv_unpack_vehicle_status(&status, last_of(AGV_MSG_VEHICLE_STATUS)->frame.data);
    TEST_ASSERT_EQUAL_INT32(1200, wheels.left_mm_s);
    TEST_ASSERT_EQUAL_INT32(1200, wheels.right_mm_s);
    TEST_ASSERT_EQUAL_UINT16(4320, status.speed_m_per_h);
    TEST_ASSERT_TRUE(status.autopilot_mode);
    TEST_ASSERT_FALSE(status.manual_mode);
    TEST_ASSERT_EQUAL_UINT8(75, last_of(AGV_MSG_THROTTLE_STATUS)->frame.data[0]);
}

void test_throttle_that_stays_away_is_throttle_0_after_500_ms(void) {
    drive(3000, 75); /* the last 075h comes at 2900 */
    for (; now_ms < 3398;) {
        command_signals(0, (uint8_t)now_ms);
        run_until(now_ms + 1);
    }
    TEST_ASSERT_EQUAL_UINT16(300, look().throttle_permille);
    run_until(3470); /* 30 % at 500 % a second: 60 ms */
    TEST_ASSERT_EQUAL_UINT16(0, look().throttle_permille);
    run_until(4401);
    TEST_ASSERT_INT32_WITHIN(10, 800, look().speed_mm_s); /* coasts at 0.4 m/s2 */
}

void test_with_the_guard_it_brakes_before_it_parks(void) {
    drive(3000, 75);
    command(AGV_MSG_GEAR_COMMAND, AGV_GEAR_P, 0);
    run_until(3100);
    TEST_ASSERT_INT32_WITHIN(10, 900, look().speed_mm_s); /* 3 m/s2 */
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_D, look().gear);
    run_until(3300); /* 134 ms to 0.8 m/s, 120 ms to shift */
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_P, look().gear);
    TEST_ASSERT_LESS_THAN_INT32(800, look().fastest_park_mm_s);
    expect_speed_at(4000, 0);
}

void test_without_the_guard_it_parks_at_speed(void) {
    config.park_guard = false;
    begin();
    drive(3000, 75);
    command(AGV_MSG_GEAR_COMMAND, AGV_GEAR_P, 0);
    expect_gear_at(3130, AGV_GEAR_P);
    TEST_ASSERT_GREATER_THAN_INT32(1100, look().fastest_park_mm_s);
}

void test_reverse_goes_backwards(void) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_DRIVE, .gear = AGV_GEAR_R, .throttle_permille = 200});
    expect_speed_at(3000, -800);
}

void test_autopilot_off_ends_autopilot_mode_and_holds_for_300_ms(void) {
    drive(3000, 75);
    command_signals(AUTOPILOT_OFF, 1);
    TEST_ASSERT_FALSE(look().autopilot);
    TEST_ASSERT_EQUAL_HEX8(AGV_GEAR_D, look().gear); /* that is another command's */
    expect_throttle_at(3061, 0);
    run_until(3299);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
    TEST_ASSERT_FALSE(look().autopilot);
    run_until(3301);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
    TEST_ASSERT_TRUE(look().autopilot);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_DISENGAGE});
    TEST_ASSERT_FALSE(look().autopilot);
}

void test_in_manual_it_obeys_park_and_nothing_else(void) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 200});
    run_until(3000);
    command(AGV_MSG_GEAR_COMMAND, AGV_GEAR_R, 0);
    command(AGV_MSG_THROTTLE_COMMAND, 250, 0);
    expect_speed_at(4000, 800);
    expect_gear_at(4000, AGV_GEAR_D);
    command(AGV_MSG_GEAR_COMMAND, AGV_GEAR_P, 0);
    expect_gear_at(4200, AGV_GEAR_P);
    run_until(4290); /* as long as P is commanded the remote controller moves nothing */
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 200});
    expect_gear_at(5000, AGV_GEAR_P);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 200});
    expect_gear_at(6000, AGV_GEAR_D);
}

void test_commands_out_of_range_are_not_obeyed(void) {
    drive(3000, 75);
    command(AGV_MSG_GEAR_COMMAND, 3, 0);
    command(AGV_MSG_THROTTLE_COMMAND, 251, 0);
    expect_gear_at(3010, AGV_GEAR_D);
    expect_throttle_at(3010, 300);
}

void test_short_frames_are_obeyed_only_where_the_vehicle_does_so(void) {
    hal_can_frame_t frame = {.id = 0x168u, .length = 1, .data = {AGV_GEAR_P}};
    drive(3000, 20);
    vehicle_receive(&vehicle, VEHICLE_VCU, now_ms, &frame);
    expect_gear_at(3200, AGV_GEAR_D);
    config.obeys_short_frames = true;
    begin();
    drive(3000, 20);
    vehicle_receive(&vehicle, VEHICLE_VCU, now_ms, &frame);
    expect_gear_at(3200, AGV_GEAR_P);
}

void test_what_is_no_classic_data_frame_is_not_heard(void) {
    hal_can_frame_t frame = {.id = 0x168u, .length = 8, .flags = HAL_CAN_EXTENDED, .data = {AGV_GEAR_P}};
    drive(3000, 20);
    vehicle_receive(&vehicle, VEHICLE_VCU, now_ms, &frame);
    vehicle_receive(&vehicle, VEHICLE_NODES, now_ms, &frame);
    expect_gear_at(3200, AGV_GEAR_D);
}

/* Shows: P18 */
void test_the_eps_changes_its_mode_and_follows_with_a_limited_rate(void) {
    connected = true;
    run_until(100);
    TEST_ASSERT_EQUAL_HEX8(AGV_EPS_MODE_ASSIST, look().eps_mode);
    (void)act((vehicle_action_t){
        .what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 200, .angle_ddeg = 900});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_ENGAGE}); /* 363h of 100 says so */
    run_until(299);
    TEST_ASSERT_EQUAL_HEX8(AGV_EPS_MODE_ASSIST, look().eps_mode);
    TEST_ASSERT_EQUAL_INT32(0, look().angle_ddeg);
    run_until(310);
    TEST_ASSERT_EQUAL_HEX8(AGV_EPS_MODE_ANGLE, look().eps_mode);
    run_until(510);
    TEST_ASSERT_INT32_WITHIN(40, 600, look().angle_ddeg); /* 300 degrees a second */
    run_until(1000);
    TEST_ASSERT_EQUAL_INT32(900, look().angle_ddeg);
    TEST_ASSERT_EQUAL_HEX8(0x01u, last_of(AGV_MSG_EPS_STATUS)->frame.data[3]);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_EPS_STUCK, .on = true});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_D, .angle_ddeg = -900});
    run_until(2000);
    TEST_ASSERT_EQUAL_INT32(900, look().angle_ddeg);
}

void test_in_assist_the_driver_steers(void) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_HAND_STEER, .angle_ddeg = -300});
    run_until(1000);
    TEST_ASSERT_EQUAL_INT32(-300, look().angle_ddeg);
    command(AGV_MSG_STEERING_COMMAND, 0x28u, 0x23u);
    run_until(2000);
    TEST_ASSERT_EQUAL_INT32(-300, look().angle_ddeg);
}

void test_the_vcu_raises_its_own_alarms(void) {
    connected = true;
    expect_alarms_at(500, 0);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_STOP, .node = VEHICLE_AI});  /* last 43Fh at 409 */
    (void)act((vehicle_action_t){.what = VEHICLE_DO_STOP, .node = VEHICLE_EPS}); /* last 067h at 491 */
    expect_alarms_at(591, AGV_VCU_ALARM_EPS_CAN_BUS);
    expect_alarms_at(1409, AGV_VCU_ALARM_EPS_CAN_BUS | AGV_VCU_ALARM_AI_CAN_LOST);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_START, .node = VEHICLE_AI});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_START, .node = VEHICLE_EPS});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_SIGNAL, .on = false});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_POWER, .on = false});
    expect_alarms_at(1600, AGV_VCU_ALARM_REMOTE_SIGNAL_LOST | AGV_VCU_ALARM_REMOTE_POWER_LOST);
    expect_byte_at(1600, AGV_MSG_VEHICLE_STATUS, 4, 0x03u);
}

void test_the_vcu_hears_of_faults_of_the_eps(void) {
    connected = true;
    patch(AGV_MSG_EPS_STATUS, 7, 0xFFu, AGV_EPS_FAULT_TEMP_ABOVE_110, VEHICLE_FOREVER, 0);
    expect_alarms_at(100, 0);
    patch(AGV_MSG_EPS_STATUS, 7, 0xFFu, AGV_EPS_FAULT_OVER_VOLTAGE, VEHICLE_FOREVER, 0);
    expect_alarms_at(200, AGV_VCU_ALARM_EPS_HARDWARE);
}

void test_without_the_ai_computer_the_vcu_takes_the_throttle_away(void) {
    drive(3000, 75); /* the last 43Fh comes at 2900 */
    while (now_ms < 3890) {
        command(AGV_MSG_THROTTLE_COMMAND, 75, 0);
        run_until(now_ms + 10);
    }
    TEST_ASSERT_EQUAL_UINT16(300, look().throttle_permille);
    expect_throttle_at(3970, 0);
    TEST_ASSERT_TRUE(look().autopilot);
}

void test_a_lost_remote_controller_brakes_in_manual(void) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_DRIVE, .gear = AGV_GEAR_D, .throttle_permille = 200});
    run_until(3000);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_SIGNAL, .on = false});
    expect_speed_at(3300, 0);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_SIGNAL, .on = true});
    run_until(5000); /* it does not drive off by itself */
    TEST_ASSERT_EQUAL_INT32(0, look().speed_mm_s);
}

void test_the_buttons_reach_363h_while_the_remote_controller_is_heard(void) {
    (void)act((vehicle_action_t){.what = VEHICLE_DO_BUTTON, .count = 1, .on = true});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_BUTTON, .count = 2, .on = true});
    expect_byte_at(11, AGV_MSG_VEHICLE_STATUS, 6, 0x43u);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_REMOTE_POWER, .on = false});
    expect_byte_at(21, AGV_MSG_VEHICLE_STATUS, 6, 0x40u);
}

void test_turn_signals_are_reported_back(void) {
    command_signals(0x30u, 1);
    expect_byte_at(11, AGV_MSG_VEHICLE_STATUS, 6, 0x70u);
}

void test_the_ai_computer_drives_only_while_engaged_unless_it_is_stubborn(void) {
    connected = true;
    (void)act((vehicle_action_t){
        .what = VEHICLE_DO_AI_DRIVE, .gear = AGV_GEAR_R, .throttle_permille = 1000, .angle_ddeg = 100});
    expect_byte_at(200, AGV_MSG_GEAR_COMMAND, 0, AGV_GEAR_N);
    TEST_ASSERT_EQUAL_UINT8(0, last_of(AGV_MSG_THROTTLE_COMMAND)->frame.data[0]);
    TEST_ASSERT_EQUAL_HEX8(0x28u, last_of(AGV_MSG_STEERING_COMMAND)->frame.data[0]);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_STUBBORN, .on = true});
    expect_byte_at(400, AGV_MSG_GEAR_COMMAND, 0, AGV_GEAR_R);
    TEST_ASSERT_EQUAL_UINT8(250, last_of(AGV_MSG_THROTTLE_COMMAND)->frame.data[0]);
    TEST_ASSERT_EQUAL_HEX8(0x8Cu, last_of(AGV_MSG_STEERING_COMMAND)->frame.data[0]);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_STUBBORN, .on = false});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_ENGAGE});
    expect_byte_at(600, AGV_MSG_GEAR_COMMAND, 0, AGV_GEAR_R);
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_IDLE});
    (void)act((vehicle_action_t){.what = VEHICLE_DO_AI_AUTOPILOT_OFF, .on = true});
    expect_byte_at(800, AGV_MSG_GEAR_COMMAND, 0, AGV_GEAR_N);
    expect_byte_at(800, AGV_MSG_TURN_SIGNAL_COMMAND, 4, 0x40u);
    TEST_ASSERT_FALSE(look().autopilot);
}

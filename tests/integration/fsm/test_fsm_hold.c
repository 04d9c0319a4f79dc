/* Steering hold: the angle of 065h in TRIPPED and SAFE, and when 065h is not sent. */
#include "one_fixture.h"
#include "spoil.h"
#include "walk.h"

/* 40 a second on a 25 ms cycle; all with this raw angle. */
static void expect_held_for_a_second(uint16_t raw) {
    fixture_forget_sent(&f);
    fixture_run(&f, 1000);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(40, fixture_count_sent(&f, 0x065), f.what);
    for (uint32_t n = 0; n < 40; n++) {
        const fixture_sent_t *sent = fixture_nth_sent(&f, 0x065, n);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(raw & 0xFFu, sent->data[0], f.what);
        TEST_ASSERT_EQUAL_HEX8_MESSAGE(raw >> 8, sent->data[1], f.what);
    }
}

static void expect_not_held_for_a_second(void) {
    fixture_forget_sent(&f);
    fixture_run(&f, 1000);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(0, fixture_count_sent(&f, 0x065), f.what);
}

static void trip_at(uint16_t raw) {
    fixture_angle(&f, raw);
    fixture_command_angle(&f, raw);
    walk_to_tripped(&f);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x065)); /* with the others, at once */
}

/* Shows: FSM-10 */
void test_the_angle_of_the_moment_of_the_trip_is_held(void) {
    static const uint16_t ANGLES[] = {0, 1, 9000, 9123, 17999, 18000};
    for (unsigned i = 0; i < sizeof ANGLES / sizeof ANGLES[0]; i++) {
        fixture_init(&f);
        trip_at(ANGLES[i]);
        fixture_angle(&f, 5000); /* the wheels go on turning */
        expect_held_for_a_second(ANGLES[i]);
    }
}

/* Shows: FSM-10 */
void test_safe_holds_the_same_angle(void) {
    trip_at(9123);
    fixture_vehicle_confirms(&f);
    fixture_mode(&f, MODE_NEITHER);
    fixture_angle(&f, 9400);
    expect_state_after(&f, 100, AGV_STATE_SAFE);
    expect_held_for_a_second(9123);
}

/* Shows: FSM-10, STEERING_ANGLE_INVALID */
void test_an_invalid_angle_drops_the_held_angle(void) {
    fixture_angle(&f, 9050);
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    fixture_angle(&f, 18001);
    expect_state_after(&f, 30, AGV_STATE_TRIPPED); /* three of them */
    expect_reason(&f, AGV_FAULT_STEERING_ANGLE_INVALID);
    expect_not_held_for_a_second(); /* no command to an EPS that reports no angle */
    fixture_angle(&f, 9400);
    fixture_run(&f, 100);           /* six good ones take the score from 6 to 0 */
    expect_held_for_a_second(9400); /* meanwhile the EPS may have turned */
}

/* ---- Only with a healthy EPS ---- */

static const spoil_t UNFIT[] = {
    {"EPS frozen", M_STEERING_STATUS, .how = FROZEN},
    {"no 067h", M_STEERING_STATUS, .how = SILENT},
    {"no 167h", M_EPS_STATUS, .how = SILENT},
    {"hardware fault reported by the VCU", M_VEHICLE, BYTE, 5, .value = ALARM_EPS_HARDWARE},
    {"CAN fault reported by the VCU", M_VEHICLE, BYTE, 5, .value = 0x20},
    {"over current", M_EPS_STATUS, BYTE, 8, .value = 0x08},
    {"position encoder", M_EPS_STATUS, BYTE, 8, .value = 0x80},
    {"under voltage", M_EPS_STATUS, BYTE, 8, .value = 0x01},
    {"steering assist", M_EPS_STATUS, BYTE, 4, .value = 0x00},
    {"speed control", M_EPS_STATUS, BYTE, 4, .value = 0x02},
    {"torque control", M_EPS_STATUS, BYTE, 4, .value = 0x03},
    {"EPS off", M_EPS_STATUS, BYTE, 4, .value = 0xFF},
    {"unknown mode", M_EPS_STATUS, BYTE, 4, .value = 0x11},
};

/* Meanwhile the steering may move: the angle of the trip would turn it back. */
/* Shows: FSM-10 */
void test_the_angle_is_held_only_while_the_eps_is_healthy(void) {
    for (unsigned i = 0; i < sizeof UNFIT / sizeof UNFIT[0]; i++) {
        fixture_init(&f);
        f.what = UNFIT[i].what;
        f.long_run = true;
        trip_at(9123);
        spoil_set(&f, &UNFIT[i], true);
        fixture_run(&f, 100);
        expect_not_held_for_a_second();
        fixture_angle(&f, 8700);
        spoil_set(&f, &UNFIT[i], false);
        fixture_run(&f, 100);
        expect_held_for_a_second(8700); /* not the angle of the trip */
    }
}

/* Shows: FSM-10 */
void test_it_ends_in_the_frame_that_reports_it(void) {
    static const uint8_t other[8] = {0x10, 0x27};
    trip_at(9123);
    fixture_run(&f, 30);
    fixture_frame(&f, AGV_MSG_STEERING_COMMAND, other); /* overridden, because 065h is sent */
    TEST_ASSERT_EQUAL_UINT32(f.call, f.sent[f.sent_count - 1].call);
    fixture_run(&f, 20);
    f.traffic[AGV_MSG_EPS_STATUS].data[3] = 0xFF;
    fixture_send_now(&f, AGV_MSG_EPS_STATUS);
    fixture_forget_sent(&f);
    fixture_frame(&f, AGV_MSG_STEERING_COMMAND, other);
    expect_silence(&f);
}

/* Shows: FSM-10 */
void test_a_trip_in_manual_driving_holds_nothing(void) {
    fixture_angle(&f, 9300);
    fixture_standby(&f);
    fixture_mute_ai(&f, true);
    walk_trip(&f);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x065));
    expect_not_held_for_a_second();
    fixture_angle(&f, 9700);
    fixture_run(&f, 50);
    fixture_mode(&f, MODE_NEITHER);
    fixture_run(&f, 50);
    fixture_angle(&f, 9100);
    expect_held_for_a_second(9700); /* the angle at the end of manual mode */
}

/* The operator has steered: the held angle is dropped, and the first valid 067h after manual is held. */
/* Shows: FSM-10 */
void test_manual_after_the_trip_drops_the_held_angle(void) {
    trip_at(9123);
    fixture_run(&f, 100);
    walk_report(&f, MODE_MANUAL);
    expect_not_held_for_a_second();
    fixture_mode(&f, MODE_ENGAGED);
    fixture_angle(&f, 18001);
    fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
    fixture_run(&f, 20);
    fixture_angle(&f, 8700);
    fixture_run_past(&f, AGV_MSG_STEERING_STATUS);
    fixture_angle(&f, 8800);
    fixture_run(&f, 50);
    expect_held_for_a_second(8700);
}

static uint32_t purges(void) {
    return f.hal.can[HAL_CAN_VEHICLE].purges;
}

/* The controller holds a frame for longer than tx_stalled_ms, which all frames are withdrawn for, and one of them stays. */
static void stall(uint32_t pending_ms) {
    for (unsigned i = 0; i < 2; i++) {
        sim_hal_set_tx_pending_ms(&f.hal, HAL_CAN_VEHICLE, pending_ms);
        fixture_run(&f, 1);
    }
}

/* When manual drops the angle, a waiting 065h is withdrawn from a stalled transmitter, but not from one that sends. */
/* Shows: FSM-10, SUP-7, TX_STALLED */
void test_manual_withdraws_an_angle_that_waits_in_a_stalled_transmitter(void) {
    static const uint32_t PENDING_MS[] = {100, 101};
    for (unsigned stalled = 0; stalled < 2; stalled++) {
        fixture_init(&f);
        trip_at(9123);
        fixture_run(&f, 100);
        stall(PENDING_MS[stalled]);
        fixture_run(&f, 98);
        const uint32_t purged = purges();
        walk_report(&f, MODE_MANUAL);
        fixture_send_now(&f, AGV_MSG_VEHICLE_STATUS);
        TEST_ASSERT_EQUAL_UINT32(purged + stalled, purges());
    }
}

/* The status frame that the controller accepted last is withdrawn with the angle, so it is sent again. */
/* Shows: FSM-10, TOP-3 */
void test_a_status_frame_that_is_withdrawn_with_the_angle_is_sent_again(void) {
    trip_at(9123);
    stall(101);
    const uint32_t before = f.status_count;
    while (f.status_count == before) {
        fixture_run(&f, 1);
    }
    const uint32_t purged = purges();
    walk_report(&f, MODE_MANUAL);
    TEST_ASSERT_EQUAL_UINT32(purged + 1, purges());
    fixture_run(&f, 1);
    TEST_ASSERT_EQUAL_UINT32(before + 2, f.status_count);
}

/* An angle that waits in a stalled transmitter for 2 s is withdrawn: later it would turn the wheels back. */
/* Shows: FSM-10, SUP-7, TX_STALLED */
void test_an_angle_that_waits_in_a_stalled_transmitter_for_2_s_is_withdrawn(void) {
    trip_at(9123);
    fixture_run(&f, 98);
    stall(101);
    const uint32_t purged = purges();
    fixture_run(&f, 1950);
    TEST_ASSERT_EQUAL_UINT32(purged, purges());
    fixture_run(&f, 100);
    TEST_ASSERT_EQUAL_UINT32(purged + 1, purges());
}

/*
 * A 065h leaves, and the next one is discarded by a bus-off. When that ends, the transmitter accepts nothing for a while.
 * In this time the wheels turn.
 */
static void expect_held_after_bus_off(uint32_t unsent_ms, uint16_t held) {
    fixture_init(&f);
    trip_at(9123);
    fixture_run(&f, 50); /* 065h at 25 and 50; the first has left */
    fixture_angle(&f, 8700);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_BUS_OFF);
    fixture_run(&f, 1000);
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, true);
    sim_hal_set_can_state(&f.hal, HAL_CAN_VEHICLE, HAL_CAN_ERROR_ACTIVE);
    fixture_run(&f, unsent_ms - 1000 - 24); /* the first left with the tick at 26 */
    sim_hal_set_full(&f.hal, HAL_CAN_VEHICLE, false);
    fixture_run(&f, 100);
    expect_held_for_a_second(held);
}

/* What a bus-off discards has not left: the 2 s run on. */
/* Shows: FSM-10, SUP-7, BUS_OFF */
void test_an_angle_that_a_bus_off_discards_has_not_left(void) {
    expect_held_after_bus_off(1990, 9123);
    expect_held_after_bus_off(2012, 8700);
}

/* ---- Frames that are handled late ---- */

/*
 * The supervisor hangs and then handles the frames of that time, with a trip among the first. Meanwhile the AI computer went on
 * steering. The angle of the trip would turn the wheels back.
 */
static void trip_among_late_frames(uint32_t late_ms) {
    fixture_init(&f);
    f.config.watchdog_period_ms = 1000;
    fixture_angle(&f, 9123);
    fixture_command_angle(&f, 9123);
    fixture_active(&f);
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    fixture_mute_ai(&f, true);
    walk_trip(&f);
    fixture_forget_sent(&f);
    fixture_angle(&f, 8000);
    fixture_run_without_ticks(&f, late_ms - 1);
    fixture_run(&f, 1);
}

/* The slots of 065h, 25 and 50 ms after the trip, are past: it goes out with the late tick. */
/* Shows: FSM-10, TIM-1, TIM-4 */
void test_after_a_late_step_the_newest_angle_is_held(void) {
    trip_among_late_frames(51);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x065));
    fixture_angle(&f, 7000);
    expect_held_for_a_second(8000);
    trip_among_late_frames(344);
    expect_held_for_a_second(8000);
    trip_among_late_frames(50);
    expect_held_for_a_second(9123);
}

/* ---- The wheels stand ---- */

/* Standing begins 100 ms after the first slow 101h. The last 065h is sent before its 5 s are over. */
/* Shows: FSM-10 */
void test_it_ends_when_the_wheels_have_stood_for_5_s(void) {
    f.long_run = true;
    walk_to_tripped_driving(&f, 1000);
    fixture_run(&f, 2000);
    fixture_drive(&f, 0);
    fixture_run_past(&f, AGV_MSG_WHEEL_SPEED);
    fixture_run(&f, 100 + 4000 - 1);
    expect_held_for_a_second(ANGLE_CENTRE);
    expect_not_held_for_a_second();
    fixture_wheels(&f, 50, 0);
    fixture_run(&f, 30);
    expect_held_for_a_second(ANGLE_CENTRE);
}

/* Shows: FSM-10 */
void test_a_trip_after_the_wheels_have_stood_for_5_s_holds_nothing(void) {
    fixture_active(&f);
    fixture_run(&f, 5000);
    fixture_mute_ai(&f, true);
    walk_trip(&f);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x065));
    expect_not_held_for_a_second();
    fixture_wheels(&f, 0, 60);
    fixture_run(&f, 30);
    expect_held_for_a_second(ANGLE_CENTRE);
}

/*
 * The wheels stand, then the EPS falls silent, and somebody turns them. It comes back with angles that are invalid, which is a
 * fault with the third one, while the wheels roll. No 065h may carry an angle from before the silence, whenever it comes back.
 */
/* Shows: FSM-10 */
void test_an_angle_from_before_a_silence_of_the_eps_is_not_sent_after_it(void) {
    for (uint32_t later_ms = 0; later_ms < 25; later_ms++) {
        fixture_init(&f);
        f.long_run = true;
        fixture_active(&f);
        fixture_run(&f, 5000);
        fixture_mute_ai(&f, true);
        walk_trip(&f);
        fixture_run(&f, 3000);
        fixture_mute_eps(&f, true);
        fixture_run(&f, 2000 + later_ms);
        fixture_wheels(&f, 0, 60);
        fixture_run(&f, 30);
        fixture_angle(&f, 18001);
        fixture_mute_eps(&f, false);
        expect_not_held_for_a_second();
    }
}

/* Shows: FSM-10, FSM-3 */
void test_a_press_in_vain_leaves_the_held_angle(void) {
    uint16_t missing = 0;
    trip_at(9123);
    fixture_angle(&f, 8700);
    fixture_press(&f, 1100);
    TEST_ASSERT_EQUAL_UINT32(1, walk_refusals(&f, &missing));
    expect_held_for_a_second(9123);
}

/* ---- After a restart ---- */

/* Shows: FSM-10, FSM-7 */
void test_after_a_restart_the_first_usable_angle_is_held(void) {
    f.long_run = true;
    fixture_angle(&f, 9100);
    fixture_command_angle(&f, 9100);
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x065));
    fixture_angle(&f, 18001);
    expect_count_after(&f, 200, 0x065, 0);
    fixture_angle(&f, 9210);
    fixture_run_past(&f, AGV_MSG_STEERING_STATUS);
    fixture_angle(&f, 9320); /* six good ones take the score from 6 to 0 */
    fixture_run(&f, 100);
    expect_held_for_a_second(9320);
}

/* The first counter after a start is only the baseline; LOST comes 50 ms later. */
/* Shows: FSM-10, FSM-7 */
void test_after_a_restart_nothing_is_held_before_the_eps_is_alive(void) {
    fixture_angle(&f, 9100);
    fixture_command_angle(&f, 9100);
    fixture_active(&f);
    fixture_mute_ai(&f, true);
    f.traffic[AGV_MSG_STEERING_STATUS].frozen = true;
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    expect_fault_after(&f, 45, AGV_FAULT_EPS_HEARTBEAT_STUCK, false); /* a slot of 065h is among them */
    TEST_ASSERT_EQUAL_UINT32(0, fixture_count_sent(&f, 0x065));
    f.traffic[AGV_MSG_STEERING_STATUS].frozen = false;
    fixture_run(&f, 100);
    expect_held_for_a_second(9100);
}

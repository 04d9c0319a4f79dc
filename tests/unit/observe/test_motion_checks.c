/* Whether the vehicle obeys its commands: steering, throttle, gear, autopilot off, P; and its two speeds. */
#include "observe/motion_checks.h"

#include "agv/codec.h"
#include "unity.h"

/* SUP-10: 50.0 degrees, 500 ms, 25.0 degrees. SUP-11: 25 counts, 500 ms; 1 s; 1 s. SUP-5: 200 ms. SUP-12: 1 s. */
static agv_motion_checks_t checks;
static agv_fault_monitor_t faults;
static agv_config_t config;
static agv_vehicle_t vehicle;
static agv_commands_t commands;
static agv_motion_facts_t facts;

void setUp(void) {
    agv_config_defaults(&config);
    checks = (agv_motion_checks_t){0};
    faults = (agv_fault_monitor_t){0};
    vehicle = (agv_vehicle_t){.angle_raw = 9000, .angle_known = true, .wheels_fresh = true, .vcu_alive = true};
    commands = (agv_commands_t){0};
    facts = (agv_motion_facts_t){
        .config = &config, .vehicle = &vehicle, .commands = &commands, .judged = true, .gear_fresh = true};
}

static void run(uint32_t ms) {
    for (uint32_t i = 0; i < ms; i++) {
        agv_motion_checks_tick(&checks, &facts, 1);
    }
    agv_motion_checks_evaluate(&checks, &faults, facts.judged);
}

static bool is_active(unsigned fault) {
    agv_motion_checks_evaluate(&checks, &faults, facts.judged);
    return agv_fault_monitor_is_active(&faults, fault);
}

/* A tick that sees the condition: it has lasted for 0 ms. The ms before it counts by what the last tick saw. */
static void begin(void) {
    run(1);
}

/* The fault must become active exactly this many ms after the next tick. */
static void expect_after(uint32_t ms, unsigned fault) {
    begin();
    run(ms - 1);
    TEST_ASSERT_FALSE(is_active(fault));
    run(1);
    TEST_ASSERT_TRUE(is_active(fault));
}

static void run_with_throttle(uint32_t ms, uint8_t counts) {
    vehicle.throttle = counts;
    run(ms);
}

static void expect_never(unsigned fault) {
    run(5000);
    TEST_ASSERT_FALSE(is_active(fault));
}

/* ---- Steering (SUP-10) ---- */

enum { STEERING = AGV_FAULT_STEERING_DEVIATION };

static void steer(unsigned raw) {
    agv_commands_take(&commands, AGV_MSG_STEERING_COMMAND,
                      (const uint8_t[8]){(uint8_t)(raw & 0xFFu), (uint8_t)(raw >> 8)});
}

/* A valid 067h with this angle. */
static void measured(unsigned raw) {
    const uint32_t before_raw = vehicle.angle_raw;
    vehicle.angle_raw = (uint16_t)raw;
    agv_motion_checks_angle(&checks, &facts, before_raw);
}

/* Shows: SUP-10, STEERING_DEVIATION */
TEST_CASE(9501)
TEST_CASE(8499)
TEST_CASE(18000)
TEST_CASE(0)
void test_more_than_50_degrees_for_500_ms(unsigned raw) {
    steer(raw);
    expect_after(500, STEERING);
}

/* Shows: SUP-10, STEERING_DEVIATION */
TEST_CASE(9500)
TEST_CASE(8500)
void test_50_degrees_are_not_too_much(unsigned raw) {
    steer(raw);
    expect_never(STEERING);
}

/* Shows: SUP-10, STEERING_DEVIATION */
void test_25_degrees_nearer_empty_the_budget(void) {
    steer(10000);
    begin();
    run(499);
    measured(9250);
    expect_after(500, STEERING);
    measured(9500); /* 25.0 nearer: the budget is empty, although 50.0 degrees are left */
    TEST_ASSERT_FALSE(is_active(STEERING));
}

/* Also a budget of 1 ms. */
/* Shows: SUP-10 */
void test_25_degrees_nearer_empty_a_budget_of_1_ms(void) {
    steer(10000);
    begin();
    run(1);
    measured(9250);
    expect_after(500, STEERING);
}

/* The other way round. */
/* Shows: SUP-10 */
void test_a_gain_to_the_other_side_counts_as_well(void) {
    steer(8000);
    begin();
    run(499);
    measured(8750);
    expect_after(500, STEERING);
}

/* Shows: SUP-10, STEERING_DEVIATION */
void test_a_gain_of_less_than_25_degrees_is_none(void) {
    steer(10000);
    run(400);
    measured(9249);
    expect_after(100, STEERING);
}

/* From one 067h to the next. */
/* Shows: SUP-10 */
void test_small_steps_add_up(void) {
    steer(18000);
    begin();
    run(400);
    for (unsigned raw = 9010; raw < 9250; raw += 10) {
        measured(raw);
    }
    run(99);
    TEST_ASSERT_FALSE(is_active(STEERING));
    measured(9250);
    expect_after(500, STEERING);
}

/* Motion there and back is no gain. */
/* Shows: SUP-10, STEERING_DEVIATION */
void test_steps_away_count_against_it(void) {
    steer(18000);
    run(400);
    for (unsigned i = 0; i < 20; i++) {
        measured(9240);
        measured(9000);
    }
    measured(8900);
    measured(9149); /* 24.9 degrees nearer, after the steps away */
    expect_after(100, STEERING);
}

/* At most 1800.0 degrees, the whole range of an angle, count against it. */
/* Shows: SUP-10 */
void test_steps_away_count_up_to_the_range_of_an_angle(void) {
    steer(0);
    begin();
    run(400);
    measured(18000);
    steer(18000);
    measured(0);
    steer(0);
    measured(18000); /* 4500.0 away */
    measured(0);     /* 1800.0 nearer */
    steer(9000);
    measured(249);
    run(99);
    TEST_ASSERT_FALSE(is_active(STEERING));
    measured(250);
    expect_after(500, STEERING);
}

/* Motion of the command is no motion of the steering. */
/* Shows: SUP-10, STEERING_DEVIATION */
void test_the_motion_of_the_command_does_not_count(void) {
    steer(18000);
    run(100);
    for (unsigned raw = 17000; raw >= 10000; raw -= 500) {
        steer(raw);
        measured(9000);
    }
    expect_after(400, STEERING);
}

/* A command that is near for 1 ms in each 20 ms. */
/* Shows: SUP-10, STEERING_DEVIATION */
void test_a_command_that_is_near_for_1_ms_in_20_restarts_nothing(void) {
    for (unsigned ms = 0; ms < 540; ms++) {
        TEST_ASSERT_FALSE(is_active(STEERING));
        steer((ms % 20 == 19) ? 9000 : 12000);
        run(1);
    }
    TEST_ASSERT_TRUE(is_active(STEERING)); /* 26 times 19 less 13, and 19, after the first tick */
}

/* 400.0 degrees off in 47 of 48 frames: the first good one clears the budget, the later ones are steps back and forth. */
/* Shows: SUP-10, STEERING_DEVIATION */
void test_one_good_angle_in_many_is_no_gain(void) {
    steer(9000);
    for (unsigned i = 0; i < 2; i++) {
        measured(13000);
        run(470);
        TEST_ASSERT_FALSE(is_active(STEERING));
        measured(9000);
        run(10);
    }
    measured(13000); /* 470 - 5 ms are spent */
    expect_after(35, STEERING);
}

/* 100.0 degrees to both sides, in steps of 10.0: half of the time is too far. */
/* Shows: SUP-10, STEERING_DEVIATION */
void test_a_steering_that_hunts_makes_no_gain(void) {
    steer(9000);
    unsigned swings = 0;
    while (!is_active(STEERING) && (swings < 20)) {
        for (unsigned step = 0; step < 40; step++) {
            const int32_t at = (step < 20) ? (1000 - (int32_t)(step * 100)) : (-1000 + (int32_t)((step - 20) * 100));
            measured((unsigned)(9000 + at));
            run(30);
        }
        swings++;
    }
    TEST_ASSERT_TRUE(is_active(STEERING));
    TEST_ASSERT_TRUE(swings > 1);
}

/* A steering that follows, whose command goes back and forth, makes a gain each time. */
/* Shows: SUP-10 */
void test_a_command_that_weaves_is_no_step_back(void) {
    measured(9000);
    for (unsigned i = 0; i < 20; i++) {
        steer(10000);
        run(400);
        measured(10000);
        run(10);
        steer(9000);
        run(400);
        measured(9000);
        run(10);
    }
    TEST_ASSERT_FALSE(is_active(STEERING));
}

/* After a gain, too: 0.1 degrees nearer, before the budget counts, are no part of the next 25.0. */
/* Shows: SUP-10 */
void test_after_a_gain_no_remainder_is_kept(void) {
    steer(9000);
    measured(9600);
    begin();
    run(1);
    measured(9300);
    steer(12000);
    measured(9301);
    run(400);
    measured(9550); /* 24.9 nearer */
    expect_after(100, STEERING);
}

/* While steps back count, too: motion beyond 50.0 degrees counts apart from that within. */
/* Shows: SUP-10 */
void test_motion_within_the_limit_takes_nothing_from_the_next_gain(void) {
    steer(9000);
    measured(9600);
    begin();
    run(1);
    measured(9100);
    for (unsigned i = 0; i < 10; i++) {
        measured(9500);
        steer(9400); /* follows it */
        steer(9000);
        measured(9100);
        measured(9500);
    }
    steer(12000);
    run(400);
    measured(9750); /* 25.0 nearer */
    expect_after(500, STEERING);
}

/* After a gain: from 60.0 degrees off, of which 10.0 are beyond the limit. */
/* Shows: SUP-10 */
TEST_CASE(9350, 500)
TEST_CASE(9349, 100)
void test_after_a_gain_the_way_within_the_limit_counts_too(unsigned raw, unsigned expected_ms) {
    steer(9000);
    measured(9600);
    begin();
    run(1);
    measured(9100);
    steer(9700);
    run(400);
    measured(raw);
    steer(18000);
    expect_after(expected_ms, STEERING);
}

/* Steps of 55.0 degrees, each of which the steering follows 200 ms later. */
/* Shows: SUP-10 */
void test_a_steering_that_follows_later_trips_nothing(void) {
    for (unsigned raw = 9000; raw <= 17800; raw += 550) {
        steer(raw);
        run(200);
        measured(raw);
        run(200);
    }
    TEST_ASSERT_FALSE(is_active(STEERING));
}

/* Away in steps of 10.0 degrees, of which the first five are within the limit; back in one. The first way back is a gain. */
/* Shows: SUP-10, STEERING_DEVIATION */
void test_away_in_small_steps_and_back_in_one_makes_no_gain(void) {
    steer(9000);
    for (unsigned i = 0; i < 4; i++) {
        for (unsigned raw = 9000; raw <= 9800; raw += 100) {
            measured(raw);
        }
        TEST_ASSERT_FALSE(is_active(STEERING));
        run(200);
        measured(9000);
    }
    TEST_ASSERT_TRUE(is_active(STEERING));
}

/* Frames that are not judged: before a gain no step counts, after one only a step away. */
/* Shows: SUP-10 */
void test_steps_that_are_not_judged(void) {
    steer(18000);
    run(400);
    facts.judged = false;
    measured(8900);
    facts.judged = true;
    measured(9150); /* 25.0 nearer: a gain */
    begin();
    run(400);
    facts.judged = false;
    measured(9400); /* none */
    facts.judged = true;
    run(99);
    TEST_ASSERT_FALSE(is_active(STEERING));
    run(1);
    TEST_ASSERT_TRUE(is_active(STEERING));
}

/* Within the limit for 700 ms, beyond it, and within it for 700 ms once more: the second begins anew. */
/* Shows: SUP-10 */
void test_the_second_begins_anew_with_each_deviation(void) {
    steer(9000);
    measured(9600);
    run(100);
    measured(9350);
    run(700);
    measured(9650);
    run(100);
    measured(9400);
    run(700);
    measured(9650);
    run(400);
    measured(9400);
    run(1);
    measured(9650);
    begin();
    run(99);
    TEST_ASSERT_FALSE(is_active(STEERING));
    run(1);
    TEST_ASSERT_TRUE(is_active(STEERING));
}

/* The step away falls into a frame that is not judged, the way back into one that is. The first one clears the budget. */
/* Shows: SUP-10, STEERING_DEVIATION */
void test_a_step_back_counts_in_a_frame_that_is_not_judged(void) {
    steer(9000);
    for (unsigned i = 0; i < 60; i++) {
        facts.judged = false;
        measured(12000);
        run(10);
        facts.judged = true;
        measured(12000);
        run(10);
        measured(9000);
        run(10);
    }
    run(1); /* 59 times 10 less 5 */
    TEST_ASSERT_EQUAL_UINT16(295, checks.budgets[AGV_BUDGET_STEERING].value_ms);
}

/* Steps back count after a gain that has cleared a budget, not after one without. */
/* Shows: SUP-10 */
void test_a_gain_without_a_budget_is_none(void) {
    steer(9000);
    measured(9400);
    measured(9100); /* 30.0 nearer, but within the limit */
    measured(9650); /* 55.0 away */
    run(400);
    measured(9400); /* 25.0 nearer: cleared */
    run(1);
    measured(9650);
    begin();
    run(100);
    TEST_ASSERT_FALSE(is_active(STEERING));
}

/* Within the limit for 1 s, the time for which a full budget decays: steps back are forgotten. */
/* Shows: SUP-10 */
TEST_CASE(1000, false)
TEST_CASE(999, true)
void test_steps_back_count_for_a_second(uint32_t within_ms, bool count) {
    steer(9000);
    measured(9600);
    run(100);
    measured(9350); /* the budget is cleared */
    run(within_ms);
    measured(9650); /* 30.0 away */
    run(400);
    measured(9400); /* 25.0 nearer */
    run(1);
    measured(9650);
    begin();
    run(99);
    TEST_ASSERT_FALSE(is_active(STEERING));
    run(1);
    TEST_ASSERT_EQUAL(count, is_active(STEERING));
}

/* Motion is measured against the current command: past it is away from it. */
/* Shows: SUP-10 */
void test_motion_past_the_command_is_no_gain(void) {
    steer(9600);
    run(400);
    measured(9849); /* 60.0 before it, 24.9 behind it: 35.1 nearer */
    steer(9000);
    begin();
    run(100);
    TEST_ASSERT_FALSE(is_active(STEERING));
    setUp();
    steer(9600);
    run(400);
    measured(10201); /* as far behind it and a tenth */
    expect_after(100, STEERING);
}

/* A remainder does not count for the next time. */
/* Shows: SUP-10, STEERING_DEVIATION */
void test_no_remainder_is_kept(void) {
    steer(18000);
    run(499);
    measured(9490);
    run(490);
    measured(9500);
    expect_after(10, STEERING);
}

/* Shows: SUP-10, STEERING_DEVIATION */
void test_motion_while_the_budget_is_empty_does_not_count(void) {
    steer(18000);
    measured(9240);
    begin();
    run(499);
    measured(9250);
    TEST_ASSERT_FALSE(is_active(STEERING));
    run(1);
    TEST_ASSERT_TRUE(is_active(STEERING));
    measured(9489); /* 10 + 239 */
    TEST_ASSERT_TRUE(is_active(STEERING));
    measured(9490);
    TEST_ASSERT_FALSE(is_active(STEERING));
}

/* A budget that was emptied by time clears the gain, too. */
/* Shows: SUP-10 */
void test_the_way_is_forgotten_when_time_has_emptied_the_budget(void) {
    steer(10000);
    run(10);
    measured(9200);
    steer(9200);
    run(20); /* 10 ms down */
    steer(10000);
    run(450);
    measured(9250);
    expect_after(50, STEERING);
}

/* Shows: SUP-10 */
void test_without_command_or_angle_nothing_is_compared(void) {
    measured(0);
    expect_never(STEERING);
    steer(18000);
    vehicle.angle_known = false;
    expect_never(STEERING);
    vehicle.angle_known = true;
    expect_after(500, STEERING);
}

/* Without a command there is no gain either. */
/* Shows: SUP-10 */
void test_without_command_there_is_no_gain(void) {
    steer(10000);
    run(400);
    agv_commands_forget(&commands);
    measured(9400);
    steer(10000);
    expect_after(100, STEERING);
}

/* Budget and gain are paused; the fault ends. */
/* Shows: SUP-10 */
void test_while_not_judged_all_budgets_are_paused(void) {
    steer(10000);
    run(300);
    facts.judged = false;
    run(1000);
    measured(9400);
    facts.judged = true;
    expect_after(200, STEERING);
    facts.judged = false;
    TEST_ASSERT_FALSE(is_active(STEERING));
    facts.judged = true;
    TEST_ASSERT_TRUE(is_active(STEERING));
}

/* ---- Throttle (SUP-11) ---- */

enum { THROTTLE = AGV_FAULT_THROTTLE_DEVIATION };

static void command_throttle(unsigned counts) {
    agv_commands_take(&commands, AGV_MSG_THROTTLE_COMMAND, (const uint8_t[8]){(uint8_t)counts});
}

/* A valid 050h. */
static void throttle(unsigned counts) {
    const uint32_t before = vehicle.throttle;
    vehicle.throttle = (uint8_t)counts;
    agv_motion_checks_throttle(&checks, &facts, before);
}

/* Shows: SUP-11, THROTTLE_DEVIATION */
TEST_CASE(0, 25)
TEST_CASE(100, 125)
TEST_CASE(220, 245)
void test_more_than_25_counts_above_the_command(unsigned commanded, unsigned most) {
    command_throttle(commanded);
    throttle(most);
    expect_never(THROTTLE);
    throttle(most + 1);
    expect_after(500, THROTTLE);
}

/* 225 and 25 are the extreme values. A throttle below the command is no fault. */
/* Shows: SUP-11 */
void test_cases_that_are_no_throttle_above_the_command(void) {
    throttle(250);
    expect_never(THROTTLE); /* none was commanded */
    command_throttle(225);
    expect_never(THROTTLE);
    command_throttle(250);
    throttle(0);
    expect_never(THROTTLE);
}

/* A falling throttle is no fault. */
/* Shows: SUP-11, THROTTLE_DEVIATION */
void test_a_drop_of_25_counts_empties_the_budget(void) {
    command_throttle(0);
    throttle(250);
    begin();
    run(499);
    throttle(225);
    begin();
    run(499);
    TEST_ASSERT_FALSE(is_active(THROTTLE));
    throttle(201); /* 24 are too few */
    run(1);
    TEST_ASSERT_TRUE(is_active(THROTTLE));
    throttle(200);
    TEST_ASSERT_FALSE(is_active(THROTTLE));
    for (unsigned counts = 200; counts >= 26; counts--) {
        throttle(counts);
        run(19);
    }
    TEST_ASSERT_FALSE(is_active(THROTTLE)); /* 25 counts in 475 ms */
}

/* The 25 counts are no setting, and a rise counts against them. */
/* Shows: SUP-11, THROTTLE_DEVIATION */
void test_a_rise_counts_against_the_drop(void) {
    config.throttle_deviation_counts = 50;
    command_throttle(0);
    throttle(200);
    begin();
    run(400);
    for (unsigned i = 0; i < 10; i++) {
        throttle(180);
        throttle(200);
    }
    throttle(210);
    throttle(176);
    run(99);
    TEST_ASSERT_FALSE(is_active(THROTTLE));
    throttle(175);
    expect_after(500, THROTTLE);
}

/* From 25 counts above the command to it. */
/* Shows: SUP-11 */
void test_a_drop_to_the_command_counts_in_full(void) {
    config.throttle_deviation_counts = 20;
    command_throttle(100);
    throttle(125);
    begin();
    run(499);
    throttle(100);
    throttle(125);
    expect_after(500, THROTTLE);
}

/* Full throttle in 47 of 48 frames, against 100 counts. The good ones are below the command, which is no further drop. */
/* Shows: SUP-11, THROTTLE_DEVIATION */
void test_one_good_throttle_in_many_is_no_drop(void) {
    command_throttle(100);
    for (unsigned i = 0; i < 2; i++) {
        throttle(250);
        run(470);
        TEST_ASSERT_FALSE(is_active(THROTTLE));
        throttle(0);
        run(10);
    }
    throttle(250);
    expect_after(35, THROTTLE);
}

/* Within the limit and above idle the time is subtracted: 400 ms, less 100 ms of 200 ms. */
/* Shows: SUP-11, THROTTLE_DEVIATION */
void test_a_throttle_within_the_limit_takes_from_the_budget(void) {
    command_throttle(0);
    throttle(26);
    begin();
    run(399);
    throttle(25);
    run(201);
    throttle(26);
    begin();
    expect_after(199, THROTTLE);
}

/* Shows: SUP-11, THROTTLE_DEVIATION */
void test_a_throttle_that_is_idle_by_a_setting_may_be_above_its_command(void) {
    config.throttle_idle_counts = 60;
    command_throttle(0);
    throttle(50);
    expect_after(500, THROTTLE);
}

/* A rise that follows the command is no step back: each ramp down is a drop again. */
/* Shows: SUP-11 */
void test_a_rise_with_the_command_does_not_count(void) {
    for (unsigned i = 0; i < 5; i++) {
        command_throttle(250);
        throttle(250);
        run(100);
        command_throttle(0);
        for (unsigned counts = 250; counts > 25; counts -= 25) {
            run(450);
            throttle(counts - 25);
        }
        run(100);
    }
    TEST_ASSERT_FALSE(is_active(THROTTLE));
}

/* The AI computer brakes: 27 counts less with each 075h, which 050h follows 90 ms later. */
/* Shows: SUP-11 */
void test_a_throttle_that_follows_later_trips_nothing(void) {
    for (unsigned i = 0; i < 10; i++) {
        command_throttle(250 - 27 * i);
        run(90);
        throttle(250 - 27 * i);
        run(10);
        TEST_ASSERT_FALSE(is_active(THROTTLE));
    }
}

/* Neither a remainder nor an earlier drop counts. */
/* Shows: SUP-11 */
void test_the_drop_begins_with_the_budget(void) {
    command_throttle(0);
    throttle(250);
    throttle(228);
    run(450);
    throttle(225);
    expect_after(50, THROTTLE);
    throttle(150); /* 3 + 75: once */
    TEST_ASSERT_FALSE(is_active(THROTTLE));
    run(450);
    throttle(126);
    expect_after(50, THROTTLE);
}

/* A budget that was emptied by time clears the drop, too. */
/* Shows: SUP-11 */
void test_the_drop_is_forgotten_when_time_has_emptied_the_budget(void) {
    command_throttle(0);
    throttle(100);
    run(10);
    throttle(90);
    command_throttle(100);
    run(20); /* 10 ms down */
    command_throttle(0);
    run(450);
    throttle(75);
    expect_after(50, THROTTLE);
}

/* Shows: SUP-11 */
void test_a_drop_while_not_judged_does_not_count(void) {
    command_throttle(0);
    throttle(250);
    run(300);
    facts.judged = false;
    throttle(100);
    run(1000);
    facts.judged = true;
    expect_after(200, THROTTLE);
}

/* ---- Gear (SUP-11) ---- */

enum { GEAR = AGV_FAULT_GEAR_DEVIATION };

/* Commanded, reported: only D and R move the vehicle. */
/* Shows: SUP-11, GEAR_DEVIATION */
void test_d_or_r_other_than_commanded_for_1_s(void) {
    static const unsigned gears[] = {1, 2, 4, 8, 0};
    for (unsigned wanted = 0; wanted < 4; wanted++) {
        for (unsigned is = 0; is < 5; is++) {
            setUp();
            agv_commands_take(&commands, AGV_MSG_GEAR_COMMAND, (const uint8_t[8]){(uint8_t)gears[wanted]});
            command_throttle(250);
            vehicle.gear = (uint8_t)gears[is];
            vehicle.throttle = 3;
            begin();
            run(999);
            TEST_ASSERT_FALSE(is_active(GEAR));
            run(1);
            TEST_ASSERT_EQUAL(is < 2 && is != wanted, is_active(GEAR));
        }
    }
}

/* Shows: SUP-11, GEAR_DEVIATION */
void test_idle_or_no_command_is_no_gear_deviation(void) {
    vehicle.gear = AGV_GEAR_R;
    vehicle.throttle = 250;
    expect_never(GEAR);
    agv_commands_take(&commands, AGV_MSG_GEAR_COMMAND, (const uint8_t[8]){AGV_GEAR_D});
    vehicle.throttle = 2;
    expect_never(GEAR);
    vehicle.throttle = 3;
    expect_after(1000, GEAR);
    static const agv_gear_t others[] = {AGV_GEAR_R, AGV_GEAR_N, AGV_GEAR_P};
    for (unsigned i = 0; i < sizeof others / sizeof others[0]; i++) {
        vehicle.gear = (uint8_t)others[i];
        vehicle.throttle = 2; /* idle does not say that the gear is right: the budget stays as it is */
        begin();
        run(5000);
        TEST_ASSERT_TRUE(is_active(GEAR));
    }
    vehicle.gear = AGV_GEAR_D;
    begin();
    run(1999);
    TEST_ASSERT_TRUE(is_active(GEAR)); /* until the budget is empty */
    run(1);
    TEST_ASSERT_FALSE(is_active(GEAR));
}

/* The vehicle ignores N while the AI computer lets it roll at idle: that time is taken away, and N is not awaited. */
/* Shows: SUP-11 */
void test_an_ignored_n_at_idle_adds_nothing(void) {
    vehicle.gear = AGV_GEAR_D;
    command_throttle(250);
    agv_commands_take(&commands, AGV_MSG_GEAR_COMMAND, (const uint8_t[8]){AGV_GEAR_N});
    for (unsigned i = 0; i < 20; i++) {
        run_with_throttle(300, 3);
        run_with_throttle(600, 2);
    }
    TEST_ASSERT_FALSE(is_active(GEAR));
}

/* 100 ms above idle in each second: 900 ms after 9 s, and the last 100 ms in the tenth. */
/* Shows: SUP-11, GEAR_DEVIATION */
TEST_CASE(AGV_GEAR_R, AGV_GEAR_D)
TEST_CASE(AGV_GEAR_D, AGV_GEAR_R)
void test_a_throttle_in_pulses_does_not_hide_another_gear(int gear, int commanded) {
    vehicle.gear = (uint8_t)gear;
    vehicle.throttle = 2;
    agv_commands_take(&commands, AGV_MSG_GEAR_COMMAND, (const uint8_t[8]){(uint8_t)commanded});
    command_throttle(250);
    begin();
    for (unsigned second = 0; second < 9; second++) {
        run_with_throttle(900, 2);
        run_with_throttle(100, 3);
        TEST_ASSERT_FALSE(is_active(GEAR));
    }
    run_with_throttle(900, 2);
    run_with_throttle(99, 3);
    TEST_ASSERT_FALSE(is_active(GEAR));
    run_with_throttle(2, 3);
    TEST_ASSERT_TRUE(is_active(GEAR));
}

/* ---- Autopilot off (SUP-11) ---- */

/* Shows: SUP-11, AUTOPILOT_OFF_IGNORED */
void test_autopilot_off_is_ignored_for_1_s(void) {
    static const uint8_t off[8] = {0, 0, 0, 0, 0x40};
    static const uint8_t on[8] = {0, 0, 0, 0, 0xBF};
    agv_commands_take(&commands, AGV_MSG_TURN_SIGNAL_COMMAND, off);
    agv_commands_forget(&commands);
    expect_never(AGV_FAULT_AUTOPILOT_OFF_IGNORED); /* of the previous engagement */
    agv_commands_take(&commands, AGV_MSG_TURN_SIGNAL_COMMAND, on);
    expect_never(AGV_FAULT_AUTOPILOT_OFF_IGNORED);
    agv_commands_take(&commands, AGV_MSG_TURN_SIGNAL_COMMAND, off);
    expect_after(1000, AGV_FAULT_AUTOPILOT_OFF_IGNORED);
}

/* ---- Throttle in P (SUP-5) ---- */

enum { IN_PARK = AGV_FAULT_THROTTLE_IN_PARK };

/* Shows: SUP-5, THROTTLE_IN_PARK */
void test_throttle_above_idle_in_park_for_200_ms(void) {
    vehicle.gear = AGV_GEAR_P;
    vehicle.throttle = 2;
    expect_never(IN_PARK);
    vehicle.throttle = 3;
    expect_after(200, IN_PARK);
}

/* Shows: SUP-5, THROTTLE_IN_PARK */
void test_each_condition_of_throttle_in_park_counts(void) {
    vehicle.throttle = 250;
    for (unsigned gear = 0; gear < 8; gear++) {
        vehicle.gear = (uint8_t)gear;
        expect_never(IN_PARK);
    }
    vehicle.gear = AGV_GEAR_P;
    facts.gear_fresh = false;
    expect_never(IN_PARK);
    facts.gear_fresh = true;
    run(100);
    facts.judged = false;
    run(1000);
    facts.judged = true;
    expect_after(100, IN_PARK);
}

/* 0A3h comes every 400 ms, and is fresh for 125 ms each time: 200 ms are complete in the second cycle. */
/* Shows: SUP-5, THROTTLE_IN_PARK */
void test_a_slow_0a3h_hides_no_throttle_in_park(void) {
    vehicle.gear = AGV_GEAR_P;
    vehicle.throttle = 100;
    begin();
    run(125);
    facts.gear_fresh = false;
    run(275);
    TEST_ASSERT_FALSE(is_active(IN_PARK));
    facts.gear_fresh = true;
    run(74);
    TEST_ASSERT_FALSE(is_active(IN_PARK));
    run(1);
    TEST_ASSERT_TRUE(is_active(IN_PARK));
}

/* Two of three 0A3h are invalid. */
/* Shows: SUP-5, SUP-11, THROTTLE_IN_PARK, GEAR_DEVIATION */
TEST_CASE(AGV_GEAR_P, AGV_FAULT_THROTTLE_IN_PARK, 200)
TEST_CASE(AGV_GEAR_D, AGV_FAULT_GEAR_DEVIATION, 1000)
void test_an_invalid_0a3h_now_and_then_hides_nothing(unsigned gear, unsigned fault, unsigned limit_ms) {
    agv_commands_take(&commands, AGV_MSG_GEAR_COMMAND, (const uint8_t[8]){AGV_GEAR_R});
    vehicle.throttle = 100;
    vehicle.gear = (uint8_t)gear;
    begin();
    for (unsigned valid_ms = 0; valid_ms < limit_ms; valid_ms += 50) {
        TEST_ASSERT_FALSE(is_active(fault));
        vehicle.gear = 0;
        run(100);
        TEST_ASSERT_FALSE(is_active(fault));
        vehicle.gear = (uint8_t)gear;
        run(50);
    }
    TEST_ASSERT_TRUE(is_active(fault));
}

/* ---- Two speeds (SUP-12) ---- */

enum { SPEED = AGV_FAULT_SPEED_IMPLAUSIBLE };

static void speeds(int left_mm_s, int right_mm_s, unsigned vcu_m_h) {
    vehicle.wheels = (agv_wheel_speed_t){.left_mm_s = left_mm_s, .right_mm_s = right_mm_s};
    vehicle.vcu_speed = (uint16_t)vcu_m_h;
    vehicle.vcu_speed_seen = true;
}

/* 500 mm/s and a quarter of the larger one: 667 against 0, 7200 m/h = 2000 mm/s against 1000. */
/* Shows: SUP-12, SPEED_IMPLAUSIBLE */
TEST_CASE(666, 666, 0, 0)
TEST_CASE(667, 667, 0, 1)
TEST_CASE(-667, -667, 0, 1)
TEST_CASE(667, 668, 0, 1)
TEST_CASE(0, 0, 2390, 0)
TEST_CASE(0, 0, 2410, 1)
TEST_CASE(1000, 1000, 7200, 0)
TEST_CASE(999, 999, 7200, 1)
TEST_CASE(3333, 3333, 7200, 0)
TEST_CASE(3335, 3335, 7200, 1)
TEST_CASE(5000, -5000, 0, 0)
TEST_CASE(2000, 0, 3600, 0)
TEST_CASE(-4000, 0, 7200, 0)
TEST_CASE(0x7FFFFFFF, 0x7FFFFFFF, 0, 1)
TEST_CASE(-0x7FFFFFFF, -0x7FFFFFFF, 65535, 1)
void test_how_much_two_speeds_may_differ(int left_mm_s, int right_mm_s, unsigned vcu_m_h, int differ) {
    speeds(left_mm_s, right_mm_s, vcu_m_h);
    begin();
    run(999);
    TEST_ASSERT_FALSE(is_active(SPEED));
    run(1);
    TEST_ASSERT_EQUAL(differ, is_active(SPEED));
}

/* A wheel faster than 1000 m/s counts as 1000 m/s. The other one turns backwards: their mean is 666 mm/s against 500 + 166, or
 * 667. */
/* Shows: SUP-12, SPEED_IMPLAUSIBLE */
TEST_CASE(2000000, -998667, false)
TEST_CASE(2000000, -998666, true)
TEST_CASE(-998667, 2000000, false)
TEST_CASE(-998666, 2000000, true)
TEST_CASE(-2000000, 998667, false)
TEST_CASE(-2000000, 998666, true)
TEST_CASE(998667, -2000000, false)
TEST_CASE(998666, -2000000, true)
void test_a_wheel_that_is_faster_than_a_vehicle_counts_as_1000_m_s(int32_t left_mm_s, int32_t right_mm_s, bool differ) {
    speeds(left_mm_s, right_mm_s, 0);
    run(5000);
    TEST_ASSERT_EQUAL(differ, is_active(SPEED));
}

/* Always, also while not judged. An engagement does not clear the budget. */
/* Shows: SUP-12 */
void test_speeds_are_compared_always(void) {
    facts.judged = false;
    speeds(5000, 5000, 0);
    run(500);
    agv_motion_checks_engage(&checks);
    expect_after(500, SPEED);
    agv_motion_checks_engage(&checks);
    TEST_ASSERT_TRUE(is_active(SPEED));
}

/* Shows: SUP-12 */
void test_both_measurements_are_needed(void) {
    speeds(5000, 5000, 0);
    vehicle.vcu_speed_seen = false;
    expect_never(SPEED);
    vehicle.vcu_speed_seen = true;
    vehicle.wheels_fresh = false;
    expect_never(SPEED);
    vehicle.wheels_fresh = true;
    vehicle.vcu_alive = false;
    expect_never(SPEED);
    vehicle.vcu_alive = true;
    expect_after(1000, SPEED);
}

/* 101h comes every 200 ms, and is fresh for 60 ms each time: 1000 ms are complete in the 17th cycle. */
/* Shows: SUP-12 */
void test_a_slow_101h_hides_no_contradiction(void) {
    speeds(0, 0, 7200);
    begin();
    for (unsigned cycle = 0; cycle < 16; cycle++) {
        vehicle.wheels_fresh = true;
        run(60);
        vehicle.wheels_fresh = false;
        run(140);
        TEST_ASSERT_FALSE(is_active(SPEED));
    }
    vehicle.wheels_fresh = true;
    run(39);
    TEST_ASSERT_FALSE(is_active(SPEED));
    run(1);
    TEST_ASSERT_TRUE(is_active(SPEED));
}

/* Until the two agree again, however long one of them is missing. */
/* Shows: SUP-12, FSM-12 */
void test_wheels_are_doubted_while_the_vcu_contradicts_them(void) {
    speeds(0, 0, 7200);
    begin();
    run(999);
    TEST_ASSERT_FALSE(agv_motion_checks_doubts_wheels(&checks, &vehicle));
    run(1);
    TEST_ASSERT_TRUE(agv_motion_checks_doubts_wheels(&checks, &vehicle));
    vehicle.vcu_alive = false;
    run(10000);
    speeds(0, 0, 0); /* the last reports agree, but one of them is old */
    TEST_ASSERT_TRUE(agv_motion_checks_doubts_wheels(&checks, &vehicle));
    vehicle.vcu_alive = true;
    run(1);
    TEST_ASSERT_TRUE(is_active(SPEED));
    TEST_ASSERT_FALSE(agv_motion_checks_doubts_wheels(&checks, &vehicle));
    speeds(0, 0, 7200);
    TEST_ASSERT_TRUE(agv_motion_checks_doubts_wheels(&checks, &vehicle));
}

/* ---- One engagement ---- */

/* Shows: SUP-10, SUP-11 */
void test_an_engagement_begins_all_budgets_anew(void) {
    static const unsigned judged[] = {STEERING, THROTTLE, GEAR, AGV_FAULT_AUTOPILOT_OFF_IGNORED};
    steer(18000);
    command_throttle(0);
    agv_commands_take(&commands, AGV_MSG_GEAR_COMMAND, (const uint8_t[8]){AGV_GEAR_D});
    agv_commands_take(&commands, AGV_MSG_TURN_SIGNAL_COMMAND, (const uint8_t[8]){0, 0, 0, 0, 0x40});
    vehicle.gear = AGV_GEAR_R;
    throttle(250);
    begin();
    run(1000);
    measured(9249);
    throttle(226);
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_TRUE(is_active(judged[i]));
    }
    agv_motion_checks_engage(&checks);
    for (unsigned i = 0; i < 4; i++) {
        TEST_ASSERT_FALSE(is_active(judged[i]));
    }
    begin();
    run(400);
    measured(9250); /* a tenth, and one count: earlier motion does not count */
    throttle(225);
    run(100);
    TEST_ASSERT_TRUE(is_active(STEERING));
    TEST_ASSERT_TRUE(is_active(THROTTLE));
}

/* Gain and drop are cleared, too: 24.9 degrees and 24 counts are not enough. */
/* Shows: SUP-10, SUP-11 */
void test_an_engagement_begins_a_way_at_0(void) {
    agv_motion_checks_engage(&checks);
    steer(10000);
    run(400);
    measured(9249);
    expect_after(100, STEERING);
    setUp();
    agv_motion_checks_engage(&checks);
    command_throttle(0);
    vehicle.throttle = 100;
    run(400);
    throttle(76);
    expect_after(100, THROTTLE);
}

/* The same when the first tick is late, so that the budget is never empty: 2 ms, and 498. */
/* Shows: SUP-10, SUP-11, TIM-4 */
void test_an_engagement_begins_a_way_at_0_before_a_late_tick(void) {
    agv_motion_checks_engage(&checks);
    steer(10000);
    command_throttle(0);
    vehicle.throttle = 100;
    agv_motion_checks_tick(&checks, &facts, 2);
    measured(9249);
    throttle(76);
    run(497);
    TEST_ASSERT_FALSE(is_active(STEERING));
    TEST_ASSERT_FALSE(is_active(THROTTLE));
    run(1);
    TEST_ASSERT_TRUE(is_active(STEERING));
    TEST_ASSERT_TRUE(is_active(THROTTLE));
}

/* Cleared, and 25.0 degrees or 25 counts back: in the next engagement one step of 25 clears again. */
/* Shows: SUP-10, SUP-11 */
void test_an_engagement_forgets_the_steps_back(void) {
    steer(10000);
    run(400);
    measured(9250);
    measured(9000);
    command_throttle(0);
    throttle(100);
    run(400);
    throttle(75);
    throttle(100);
    agv_motion_checks_engage(&checks);
    begin();
    run(499);
    measured(9250);
    throttle(75);
    run(499);
    TEST_ASSERT_FALSE(is_active(STEERING));
    TEST_ASSERT_FALSE(is_active(THROTTLE));
}

/* A gain and a step back in the same millisecond: the step back counts from 0. */
/* Shows: SUP-10 */
void test_after_a_gain_a_step_back_counts_at_once(void) {
    steer(10000);
    run(400);
    measured(9250);
    measured(9000);
    begin();
    run(300);
    measured(9250); /* only back where it was */
    run(200);
    TEST_ASSERT_TRUE(is_active(STEERING));
}

/* As after a start with a stored latch that names such a fault. */
/* Shows: FSM-7 */
void test_without_a_budget_the_faults_are_left_as_they_are(void) {
    agv_fault_monitor_set(&faults, STEERING, true);
    run(1);
    TEST_ASSERT_TRUE(is_active(STEERING));
}

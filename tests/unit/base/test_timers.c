/* Timers on the wrapping clock, with several start times, some just before the wrap. */
#include "base/timers.h"

#include <string.h>

#include "settings_expected.h"
#include "unity.h"

/* A duration and a deadline of 100 ms each. */
static const uint32_t DURATION = AGV_TIMER_STANDSTILL;
static const uint32_t DEADLINE = AGV_TIMER_BOTH_MODES;

static agv_timers_t timers;
static agv_config_t config;

static void advance(uint32_t now_ms) {
    agv_timers_advance(&timers, &config, now_ms, 0);
}

static bool reached(uint32_t timer, uint32_t now_ms) {
    advance(now_ms);
    return agv_timer_reached(&timers, timer);
}

static void begin(uint32_t timer, uint32_t now_ms) {
    agv_timers_set_time(&timers, now_ms);
    agv_timer_start(&timers, timer);
}

static bool go_on_while(bool condition, uint32_t now_ms) {
    advance(now_ms);
    return agv_timer_while(&timers, DURATION, condition);
}

static void start(uint16_t limit_ms) {
    agv_config_defaults(&config);
    config.standstill_ms = limit_ms;
    config.mode_invalid_ms = limit_ms;
    agv_timers_set_time(&timers, 0);
    agv_timers_start(&timers);
}

void setUp(void) {
    start(100);
}

/* Shows: TIM-2 */
TEST_CASE(0)
TEST_CASE(1)
TEST_CASE(123456789)
TEST_CASE(0x7FFFFFFF)
TEST_CASE(0xFFFFFF9B)
TEST_CASE(0xFFFFFFFF)
void test_a_duration_is_reached_at_its_limit_and_a_deadline_a_millisecond_later(uint32_t start_ms) {
    begin(DURATION, start_ms);
    begin(DEADLINE, start_ms);
    for (uint32_t ms = 0; ms <= 200; ms++) {
        TEST_ASSERT_EQUAL(ms >= 100, reached(DURATION, start_ms + ms));
        TEST_ASSERT_EQUAL(ms >= 101, reached(DEADLINE, start_ms + ms));
        TEST_ASSERT_EQUAL(ms < 100, agv_timer_is_within(&timers, DURATION));
        TEST_ASSERT_EQUAL(ms < 101, agv_timer_is_within(&timers, DEADLINE));
    }
}

/* A start in the future is a start now. A start in the past counts when the time advances, however old it is. */
/* Shows: TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFFB0)
void test_a_timer_starts_at_a_given_time(uint32_t start_ms) {
    agv_timers_set_time(&timers, start_ms);
    agv_timer_start_at(&timers, DURATION, start_ms + 5);
    TEST_ASSERT_TRUE(agv_timer_is_within(&timers, DURATION));
    TEST_ASSERT_FALSE(reached(DURATION, start_ms + 99));
    TEST_ASSERT_TRUE(reached(DURATION, start_ms + 100));
    for (uint32_t past_ms = 100; past_ms < 0x80000000u; past_ms *= 2) {
        agv_timer_start_at(&timers, DURATION, timers.now_ms - past_ms);
        TEST_ASSERT_FALSE(agv_timer_reached(&timers, DURATION));
        TEST_ASSERT_TRUE(reached(DURATION, timers.now_ms + 1));
    }
}

/* A start of long ago counts in full, also 65,536 ms ago, which 16 bits do not hold. */
/* Shows: TIM-2 */
TEST_CASE(0)
TEST_CASE(0x8000)
void test_a_start_of_long_ago_counts_in_full(uint32_t now_ms) {
    start(60000);
    for (uint32_t age_ms = 60000; age_ms <= 200000; age_ms += 536) {
        agv_timers_set_time(&timers, now_ms);
        agv_timer_start_at(&timers, DURATION, now_ms - age_ms);
        TEST_ASSERT_TRUE(reached(DURATION, now_ms + 1));
    }
    agv_timers_set_time(&timers, now_ms);
    agv_timer_start_at(&timers, DURATION, now_ms - 65536);
    TEST_ASSERT_TRUE(reached(DURATION, now_ms + 1));
}

/* A limit of 60 s is the longest one. A step may be longer than the 65,536 ms that 16 bits hold. */
/* Shows: TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFFFFB0)
void test_the_longest_limit_and_steps_of_any_length(uint32_t start_ms) {
    start(60000);
    begin(DEADLINE, start_ms);
    TEST_ASSERT_FALSE(reached(DEADLINE, start_ms + 60000));
    TEST_ASSERT_TRUE(reached(DEADLINE, start_ms + 60001));
    for (uint32_t step_ms = 60001; step_ms < 0x80000000u - 60001; step_ms += 65531) {
        begin(DEADLINE, start_ms);
        TEST_ASSERT_TRUE(reached(DEADLINE, start_ms + step_ms));
    }
    begin(DEADLINE, start_ms);
    TEST_ASSERT_FALSE(reached(DEADLINE, start_ms + 59999));
    TEST_ASSERT_TRUE(reached(DEADLINE, start_ms + 59999 + 65536));
}

void test_a_duration_of_a_millisecond_is_reached_in_the_next_one(void) {
    start(1);
    begin(DURATION, 5);
    TEST_ASSERT_FALSE(reached(DURATION, 5));
    TEST_ASSERT_TRUE(reached(DURATION, 6));
}

void test_a_stopped_timer_reaches_nothing(void) {
    TEST_ASSERT_FALSE(agv_timer_is_started(&timers, DURATION));
    TEST_ASSERT_FALSE(agv_timer_is_within(&timers, DURATION));
    TEST_ASSERT_FALSE(reached(DURATION, 1000));
    TEST_ASSERT_FALSE(reached(DEADLINE, 1001));
    begin(DURATION, 1001);
    TEST_ASSERT_TRUE(agv_timer_is_started(&timers, DURATION));
    TEST_ASSERT_TRUE(agv_timer_is_within(&timers, DURATION));
    advance(1101);
    TEST_ASSERT_TRUE(agv_timer_is_started(&timers, DURATION));
    TEST_ASSERT_FALSE(agv_timer_is_within(&timers, DURATION));
    agv_timer_stop(&timers, DURATION);
    TEST_ASSERT_FALSE(agv_timer_is_started(&timers, DURATION));
    TEST_ASSERT_FALSE(agv_timer_reached(&timers, DURATION));
    TEST_ASSERT_FALSE(reached(DURATION, 2000));
}

/* When a timer is reached, against its limit: "for 100 ms" at 100, a deadline of 50 ms at 51. A step is due 1 ms after the
 * last one. */
enum { FOR_DURATION = 0, FOR_DEADLINE = 1, FOR_STEP = 2 };

/* By hand from the rows of the requirements. */
static const struct {
    uint32_t timer;
    uint32_t setting;
    uint32_t later_ms;
} ROWS[] = {
    {AGV_TIMER_BUS_OFF, AGV_SETTING_bus_off_recovery_ms, FOR_DURATION},
    {AGV_TIMER_AI_BUS_OFF, AGV_SETTING_bus_off_recovery_ms, FOR_DURATION},
    {AGV_TIMER_WHEELS_SLOW, AGV_SETTING_standstill_ms, FOR_DURATION},
    {AGV_TIMER_STANDSTILL, AGV_SETTING_standstill_ms, FOR_DURATION},
    {AGV_TIMER_WHEELS_STOOD, AGV_SETTING_hold_standstill_ms, FOR_DURATION},
    {AGV_TIMER_ANGLE, AGV_SETTING_hold_age_ms, FOR_DEADLINE},
    {AGV_TIMER_ENGAGED, AGV_SETTING_engaged_grace_ms, FOR_DURATION},
    {AGV_TIMER_DISENGAGED, AGV_SETTING_reengage_ms, FOR_DEADLINE},
    {AGV_TIMER_ENGAGEMENT_1, AGV_SETTING_mode_flapping_ms, FOR_DEADLINE},
    {AGV_TIMER_ENGAGEMENT_2, AGV_SETTING_mode_flapping_ms, FOR_DEADLINE},
    {AGV_TIMER_ENGAGEMENT_3, AGV_SETTING_mode_flapping_ms, FOR_DEADLINE},
    {AGV_TIMER_BOTH_MODES, AGV_SETTING_mode_invalid_ms, FOR_DEADLINE},
    {AGV_TIMER_NO_MODE, AGV_SETTING_mode_none_ms, FOR_DURATION},
    {AGV_TIMER_AI_NEVER_SEEN, AGV_SETTING_ai_never_seen_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_OTHER_TURN_SIGNAL, AGV_SETTING_wrong_id_set_ms, FOR_DEADLINE},
    {AGV_TIMER_OTHER_VEHICLE_STATUS, AGV_SETTING_wrong_id_set_ms, FOR_DEADLINE},
    {AGV_TIMER_INIT_GOOD, AGV_SETTING_init_hold_ms, FOR_DURATION},
    {AGV_TIMER_STARTUP, AGV_SETTING_startup_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_PARK_WAIT, AGV_SETTING_park_timeout_ms, FOR_DURATION},
    {AGV_TIMER_CONFIRMED, AGV_SETTING_confirmed_ms, FOR_DURATION},
    {AGV_TIMER_STOP, AGV_SETTING_stop_timeout_ms, FOR_DURATION},
    {AGV_TIMER_PRESS, AGV_SETTING_reset_hold_ms, FOR_DURATION},
    {AGV_TIMER_PRESS_LONG, AGV_SETTING_reset_hold_max_ms, FOR_DEADLINE},
    {AGV_TIMER_PIN_PRESS, AGV_SETTING_reset_hold_ms, FOR_DURATION},
    {AGV_TIMER_PIN_PRESS_LONG, AGV_SETTING_reset_hold_max_ms, FOR_DEADLINE},
    {AGV_TIMER_WATCHDOG_FED, AGV_SETTING_watchdog_period_ms, FOR_STEP},
    {AGV_TIMER_TX_TURN_SIGNAL, AGV_SETTING_tx_stalled_ms, FOR_DEADLINE},
    {AGV_TIMER_TX_GEAR, AGV_SETTING_tx_stalled_ms, FOR_DEADLINE},
    {AGV_TIMER_TX_THROTTLE, AGV_SETTING_tx_stalled_ms, FOR_DEADLINE},
    {AGV_TIMER_TX_STEERING, AGV_SETTING_tx_stalled_ms, FOR_DEADLINE},
    {AGV_TIMER_TX_STATUS, AGV_SETTING_tx_stalled_ms, FOR_DEADLINE},
    {AGV_TIMER_TX_AI, AGV_SETTING_tx_stalled_ms, FOR_DEADLINE},
    {AGV_TIMER_EVENT_SUPERVISOR_RESET, AGV_SETTING_event_hold_ms, FOR_DURATION},
    {AGV_TIMER_EVENT_TX_GATE_REFUSED, AGV_SETTING_event_hold_ms, FOR_DURATION},
    {AGV_TIMER_EVENT_STEP_OVERRUN, AGV_SETTING_event_hold_ms, FOR_DURATION},
    {AGV_TIMER_EVENT_MODE_FLAPPING, AGV_SETTING_event_hold_ms, FOR_DURATION},
    {AGV_TIMER_EVENT_AI_COMMAND_OUT_OF_RANGE, AGV_SETTING_event_hold_ms, FOR_DURATION},
    {AGV_TIMER_EVENT_FOREIGN_COMMAND_SENDER, AGV_SETTING_event_hold_ms, FOR_DURATION},
    {AGV_TIMER_EVENT_STATUS_ID_IN_USE, AGV_SETTING_event_hold_ms, FOR_DURATION},
    {AGV_TIMER_EVENT_RX_OVERRUN, AGV_SETTING_event_hold_ms, FOR_DURATION},
    {AGV_TIMER_EVENT_STORE_INVALID, AGV_SETTING_event_hold_ms, FOR_DURATION},
    {AGV_TIMER_MESSAGE_TURN_SIGNAL_COMMAND, AGV_SETTING_ai_heartbeat_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_MESSAGE_GEAR_COMMAND, AGV_SETTING_gear_command_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_MESSAGE_THROTTLE_COMMAND, AGV_SETTING_throttle_command_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_MESSAGE_STEERING_COMMAND, AGV_SETTING_steering_command_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_MESSAGE_VEHICLE_STATUS, AGV_SETTING_vcu_heartbeat_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_MESSAGE_GEAR_STATUS, AGV_SETTING_gear_status_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_MESSAGE_THROTTLE_STATUS, AGV_SETTING_throttle_status_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_MESSAGE_STEERING_STATUS, AGV_SETTING_eps_heartbeat_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_MESSAGE_EPS_STATUS, AGV_SETTING_eps_status_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_MESSAGE_STEERING_POSITION, AGV_SETTING_steering_position_timeout_ms, FOR_DEADLINE},
    {AGV_TIMER_MESSAGE_WHEEL_SPEED, AGV_SETTING_wheel_speed_timeout_ms, FOR_DEADLINE},
};
enum { ROW_COUNT = sizeof ROWS / sizeof ROWS[0] };

/* Shows: INT-2 */
void test_every_timer_has_the_limit_of_its_setting(void) {
    bool is_seen[AGV_TIMER_COUNT] = {false};
    TEST_ASSERT_EQUAL_UINT(ROW_COUNT, AGV_TIMER_COUNT);
    for (unsigned i = 0; i < ROW_COUNT; i++) {
        const uint32_t reached_ms = SETTING_EXPECTED[ROWS[i].setting].preset + ROWS[i].later_ms;
        TEST_ASSERT_FALSE(is_seen[ROWS[i].timer]);
        is_seen[ROWS[i].timer] = true;
        agv_config_defaults(&config);
        begin(ROWS[i].timer, 7);
        TEST_ASSERT_FALSE(reached(ROWS[i].timer, 7 + reached_ms - 1));
        TEST_ASSERT_TRUE(reached(ROWS[i].timer, 7 + reached_ms));
        TEST_ASSERT_TRUE(agv_config_set(&config, ROWS[i].setting, 777));
        TEST_ASSERT_EQUAL_UINT32(777, agv_timer_limit_ms(&config, ROWS[i].timer));
    }
}

/* Every timer has its own limit and does not affect the others. */
void test_every_timer_runs_alone(void) {
    for (uint32_t timer = 0; timer < AGV_TIMER_COUNT; timer++) {
        setUp();
        begin(timer, 7);
        advance(8);
        for (uint32_t other = 0; other < AGV_TIMER_COUNT; other++) {
            TEST_ASSERT_EQUAL(other == timer, agv_timer_is_started(&timers, other));
            TEST_ASSERT_FALSE(agv_timer_reached(&timers, other));
        }
        advance(70000);
        for (uint32_t other = 0; other < AGV_TIMER_COUNT; other++) {
            TEST_ASSERT_EQUAL(other == timer, agv_timer_reached(&timers, other));
        }
        agv_timer_stop(&timers, timer);
        TEST_ASSERT_FALSE(agv_timer_is_started(&timers, timer));
    }
}

/* Shows: TIM-2 */
void test_a_reached_timer_stays_reached_over_a_full_wrap_of_the_clock(void) {
    begin(DURATION, 7);
    /* 2^32 ms are 49.7 days: in steps of one day, and once more around */
    for (uint32_t day = 0; day < 100; day++) {
        TEST_ASSERT_TRUE(reached(DURATION, 107 + day * 86400000));
    }
}

/* 7FFFFFFFh ms are 24.8 days without a call. */
/* Shows: TIM-2 */
void test_a_timer_is_reached_after_half_the_range_of_the_clock(void) {
    begin(DURATION, 7);
    TEST_ASSERT_TRUE(reached(DURATION, 7 + 0x7FFFFFFFu));
}

/* An old stamp of a frame does not reset a reached timer. */
void test_a_reached_timer_stays_reached_after_an_old_stamp(void) {
    begin(DURATION, 0);
    TEST_ASSERT_TRUE(reached(DURATION, 100));
    TEST_ASSERT_TRUE(reached(DURATION, 50));
}

void test_a_restarted_timer_begins_at_zero(void) {
    begin(DURATION, 0);
    TEST_ASSERT_TRUE(reached(DURATION, 100));
    agv_timer_start(&timers, DURATION);
    TEST_ASSERT_FALSE(reached(DURATION, 199));
    TEST_ASSERT_TRUE(reached(DURATION, 200));
}

void test_a_condition_that_breaks_starts_the_time_again(void) {
    TEST_ASSERT_FALSE(go_on_while(true, 10));
    TEST_ASSERT_FALSE(go_on_while(true, 109));
    TEST_ASSERT_FALSE(go_on_while(false, 110));
    TEST_ASSERT_FALSE(agv_timer_is_started(&timers, DURATION));
    TEST_ASSERT_FALSE(go_on_while(true, 111));
    TEST_ASSERT_FALSE(go_on_while(true, 210));
    TEST_ASSERT_TRUE(go_on_while(true, 211));
    TEST_ASSERT_TRUE(go_on_while(true, 500));
    TEST_ASSERT_FALSE(go_on_while(false, 501));
}

/* ---- Which timers are checked ---- */

/* The timers are checked only when one of them can have reached its limit. A thousand random changes are compared with
 * a simple model. */
typedef struct {
    uint32_t since_ms;
    bool runs;
    bool reached;
} account_t;

enum { ACCOUNTS = 2 };
static account_t accounts[ACCOUNTS]; /* of DURATION and of DEADLINE */

static uint32_t draw(uint32_t below) {
    static uint32_t seed = 1;
    seed = seed * 1664525 + 1013904223;
    return (seed >> 8) % below;
}

static void change_one(uint32_t now_ms) {
    const unsigned which = draw(ACCOUNTS);
    const uint32_t timer = (which == 0) ? DURATION : DEADLINE;
    switch (draw(4)) {
    case 0:
        agv_timer_start(&timers, timer);
        accounts[which] = (account_t){now_ms, true, false};
        break;
    case 1:
        accounts[which] = (account_t){now_ms - draw(120), true, false};
        agv_timer_start_at(&timers, timer, accounts[which].since_ms);
        break;
    case 2:
        agv_timer_stop(&timers, timer);
        accounts[which] = (account_t){0};
        break;
    default:
        break;
    }
}

/* Shows: TIM-2 */
TEST_CASE(0)
TEST_CASE(0xFFFF0000)
void test_no_timer_is_overlooked(uint32_t start_ms) {
    uint32_t now_ms = start_ms;
    unsigned seen = 0;
    agv_timers_set_time(&timers, now_ms);
    (void)memset(accounts, 0, sizeof accounts);
    for (unsigned step = 0; step < 5000; step++) {
        change_one(now_ms);
        now_ms += 1 + draw(60);
        advance(now_ms);
        for (uint32_t i = 0; i < ACCOUNTS; i++) {
            account_t *const account = &accounts[i];
            account->reached = account->reached || (account->runs && now_ms - account->since_ms >= 100 + i);
            TEST_ASSERT_EQUAL(account->reached, agv_timer_reached(&timers, (i == 0) ? DURATION : DEADLINE));
            seen += account->reached ? 1 : 0;
        }
    }
    TEST_ASSERT_GREATER_THAN_UINT32(1000, seen);
}

static void expect_spent(uint32_t spent_ms, uint32_t now_ms) {
    advance(now_ms);
    TEST_ASSERT_EQUAL_UINT32(spent_ms, agv_timer_spent_ms(&timers, &config, DURATION));
}

void test_the_elapsed_time_of_a_timer(void) {
    begin(DURATION, 0xFFFFFFFFu);
    expect_spent(0, 0xFFFFFFFFu);
    expect_spent(99, 98);
    expect_spent(100, 99);
    expect_spent(100, 99 + 0x80000000u - 1);
    expect_spent(100, 99 + 0xF0000000u);
}

/* The time is kept; running timers are stopped. */
void test_a_start_stops_all_timers(void) {
    begin(DURATION, 1000);
    begin(DEADLINE, 1000);
    agv_timers_start(&timers);
    TEST_ASSERT_EQUAL_UINT32(1000, timers.now_ms);
    for (uint32_t timer = 0; timer < AGV_TIMER_COUNT; timer++) {
        TEST_ASSERT_FALSE(agv_timer_is_started(&timers, timer));
    }
}

/* Shows: TIM-2 */
void test_an_age_counts_across_the_wrap_and_is_0_for_a_later_stamp(void) {
    TEST_ASSERT_EQUAL_UINT32(0, agv_age_ms(5, 5));
    TEST_ASSERT_EQUAL_UINT32(5, agv_age_ms(10, 5));
    TEST_ASSERT_EQUAL_UINT32(6, agv_age_ms(5, 0xFFFFFFFFu));
    TEST_ASSERT_EQUAL_UINT32(0x7FFFFFFFu, agv_age_ms(0x7FFFFFFFu, 0));
    TEST_ASSERT_EQUAL_UINT32(0, agv_age_ms(0x80000000u, 0));
    TEST_ASSERT_EQUAL_UINT32(0, agv_age_ms(5, 6));
    TEST_ASSERT_EQUAL_UINT32(0, agv_age_ms(0xFFFFFFFFu, 3));
}

static void expect_time(uint32_t ms, uint32_t us) {
    TEST_ASSERT_EQUAL_UINT32(ms, timers.now_ms);
    TEST_ASSERT_EQUAL_UINT32(us, timers.now_us);
}

static void stamp(uint32_t ms, uint32_t us) {
    agv_timers_advance(&timers, &config, ms, us);
}

/* Both clocks agree: 1234567 ms are 1234567000 us. */
/* Shows: TIM-2 */
void test_the_time_only_goes_forwards(void) {
    agv_timers_set_time(&timers, 1234567);
    expect_time(1234567, 1234567000);
    stamp(1234567, 900);
    expect_time(1234567, 1234567900);
    stamp(1234567, 200); /* within the same millisecond, too */
    expect_time(1234567, 1234567900);
    stamp(1234566, 999);
    expect_time(1234567, 1234567900);
    stamp(1234568, 0);
    expect_time(1234568, 1234568000);
    stamp(1234568u - 4294967u, 296); /* a full wrap of the microseconds ago */
    expect_time(1234568, 1234568000);
    agv_timers_set_time(&timers, 1000);
    expect_time(1000, 1000000);
}

/* Shows: TIM-2 */
void test_the_time_goes_on_across_the_wrap(void) {
    agv_timers_set_time(&timers, 0xFFFFFFFFu);
    stamp(0, 5);
    expect_time(0, 5);
    stamp(0xFFFFFFFFu, 999);
    expect_time(0, 5);
}

/* The time may be set back; when the timers are looked at next is no matter of the time before. */
/* Shows: TIM-2 */
void test_a_timer_that_starts_after_the_time_was_set_back_is_reached_in_time(void) {
    begin(DURATION, 1000);
    TEST_ASSERT_FALSE(reached(DURATION, 1001)); /* to be looked at again at 1100 */
    begin(DURATION, 500);
    TEST_ASSERT_FALSE(reached(DURATION, 599));
    TEST_ASSERT_TRUE(reached(DURATION, 600));
}

/* Shows: TIM-2 */
void test_the_time_that_is_spent_is_never_more_than_the_limit(void) {
    advance(5000);
    agv_timer_start_at(&timers, DURATION, 5000 - 99);
    TEST_ASSERT_EQUAL_UINT32(99, agv_timer_spent_ms(&timers, &config, DURATION));
    agv_timer_start_at(&timers, DURATION, 5000 - 2000);
    TEST_ASSERT_TRUE(agv_timer_is_within(&timers, DURATION)); /* until the time advances */
    TEST_ASSERT_EQUAL_UINT32(100, agv_timer_spent_ms(&timers, &config, DURATION));
}

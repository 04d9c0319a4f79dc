/* Periodic sending for 20 minutes with a tick every millisecond, and for a day with late ones. Takes some seconds. */
#include "one_fixture.h"
#include "walk.h"

static uint32_t counts[4];

typedef struct {
    uint32_t id;
    uint32_t first_ms;
    uint32_t cycle_ms;
} slot_t;

static const slot_t SLOTS[] = {{0x43F, 100, 100}, {0x168, 66, 100}, {0x075, 33, 100}, {0x065, 25, 25}};

/* All nodes are silent; the supervisor sends only 43Fh, 168h and 075h. */
static uint32_t tripped_alone(void) {
    walk_to_tripped(&f);
    fixture_mute_vcu(&f, true);
    fixture_mute_eps(&f, true);
    fixture_forget_sent(&f);
    for (unsigned i = 0; i < 4; i++) {
        counts[i] = 0;
    }
    return f.now_ms;
}

/* Each frame in the log was sent at most late_ms after its slot. Empties the log. */
static void check_slots(uint32_t trip_ms, uint32_t late_ms) {
    for (uint32_t i = 0; i < f.sent_count; i++) {
        for (unsigned s = 0; s < 4; s++) {
            if (f.sent[i].id == SLOTS[s].id) {
                const uint32_t since_ms = f.sent[i].time_ms - trip_ms;
                const uint32_t slot_ms = SLOTS[s].first_ms + counts[s] * SLOTS[s].cycle_ms;
                TEST_ASSERT_TRUE(since_ms - slot_ms <= late_ms);
                counts[s]++;
            }
        }
    }
    fixture_forget_sent(&f);
}

/* Shows: TIM-1 */
void test_20_minutes_of_slots_without_drift(void) {
    const uint32_t trip_ms = tripped_alone();
    for (unsigned second = 0; second < 1200; second++) {
        fixture_run(&f, 1000);
        check_slots(trip_ms, 0);
    }
    TEST_ASSERT_EQUAL_UINT32(12000, counts[0]); /* 100, 200 ... 1,200,000 */
    TEST_ASSERT_EQUAL_UINT32(12000, counts[1]);
    TEST_ASSERT_EQUAL_UINT32(12000, counts[2]);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->skipped_slots);
}

/* The EPS is alive and the wheels turn, so the steering is held: 065h every 25 ms. */
/* Shows: TIM-1, FSM-10 */
void test_2_minutes_of_steering_hold_without_drift(void) {
    walk_to_tripped(&f);
    fixture_wheels(&f, 800, 800);
    const uint32_t trip_ms = f.now_ms;
    fixture_forget_sent(&f);
    for (unsigned i = 0; i < 4; i++) {
        counts[i] = 0;
    }
    for (unsigned second = 0; second < 120; second++) {
        fixture_run(&f, 1000);
        check_slots(trip_ms, 0);
    }
    TEST_ASSERT_EQUAL_UINT32(4800, counts[3]);
}

/* Steps come after changing times of 1 to 89 ms: slots neither drift nor get lost. */
/* Shows: TIM-1 */
void test_a_day_of_late_steps_without_drift(void) {
    static const uint32_t DAY_MS = 86400000;
    const uint32_t trip_ms = tripped_alone();
    uint32_t random = 12345;
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    while (f.now_ms - trip_ms < DAY_MS) {
        random = random * 1664525u + 1013904223u;
        fixture_jump(&f, 1 + (random >> 16) % 89);
        check_slots(trip_ms, 88);
    }
    TEST_ASSERT_UINT32_WITHIN(1, 864000, counts[0]);
    TEST_ASSERT_UINT32_WITHIN(1, 864000, counts[1]);
    TEST_ASSERT_UINT32_WITHIN(1, 864000, counts[2]);
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->skipped_slots);
}

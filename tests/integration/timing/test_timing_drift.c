/* Periodic sending for a day with late steps. With a step every millisecond: tests/unit/transmit/test_scheduler.c */
#include "one_fixture.h"
#include "walk.h"

static const struct {
    uint32_t id;
    uint32_t first_ms;
    uint32_t cycle_ms;
} SLOTS[] = {{0x43F, 100, 100}, {0x168, 66, 100}, {0x075, 33, 100}};
enum { SLOT_COUNT = sizeof SLOTS / sizeof SLOTS[0] };

static uint32_t counts[SLOT_COUNT];

/* Each frame in the log was sent at most late_ms after its slot. Empties the log. */
static void check_slots(uint32_t trip_ms, uint32_t late_ms) {
    for (uint32_t i = 0; i < f.sent_count; i++) {
        for (unsigned s = 0; s < SLOT_COUNT; s++) {
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

/* All nodes are silent; the supervisor sends only 43Fh, 168h and 075h. Steps come after changing times of 1 to 89 ms:
 * slots neither drift nor get lost. */
/* Shows: TIM-1 */
void test_a_day_of_late_steps_without_drift(void) {
    static const uint32_t DAY_MS = 86400000;
    uint32_t random = 12345;
    walk_to_tripped(&f);
    const uint32_t trip_ms = f.now_ms;
    fixture_mute_vcu(&f, true);
    fixture_mute_eps(&f, true);
    fixture_forget_sent(&f);
    f.hal.config.watchdog_ms = SIM_HAL_WATCHDOG_OFF;
    while (f.now_ms - trip_ms < DAY_MS) {
        random = random * 1664525 + 1013904223;
        fixture_jump(&f, 1 + (random >> 16) % 89);
        check_slots(trip_ms, 88);
    }
    for (unsigned s = 0; s < SLOT_COUNT; s++) {
        TEST_ASSERT_UINT32_WITHIN(1, 864000, counts[s]);
    }
    TEST_ASSERT_EQUAL_UINT32(0, agv_supervisor_counters(&f.supervisor)->skipped_slots);
}

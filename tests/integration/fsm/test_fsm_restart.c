/* The latch outlives a reset of the MCU: every reset cause, tripped or not, with every state of the store. */
#include "one_fixture.h"
#include "walk.h"

typedef enum { STORE_OK, STORE_CORRUPT, STORE_EMPTY } store_t;

typedef struct {
    const char *what;
    hal_reset_cause_t cause;
    bool tripped;
    store_t store;
    agv_state_t state;
    agv_fault_t reason;
    bool store_invalid;
} restart_t;

static void spoil_store(store_t store) {
    if (store == STORE_CORRUPT) {
        TEST_ASSERT_TRUE(sim_store_corrupt_latch(&f.store, 1, 0x10));
    }
    if (store == STORE_EMPTY) {
        f.store.latch_size = 0;
    }
}

static void expect_restart(const restart_t *row) {
    fixture_init(&f);
    f.what = row->what;
    if (row->tripped) {
        walk_to_safe(&f);
    } else {
        fixture_active(&f);
    }
    fixture_forget_sent(&f);
    f.store.keep_latch = true; /* kept through a power-on, too: its content must not matter then */
    spoil_store(row->store);
    fixture_restart(&f, row->cause);
    expect_state(&f, row->state);
    expect_reason(&f, row->reason);
    expect_fault(&f, AGV_FAULT_STORE_INVALID, row->store_invalid);
    expect_output(&f, false);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(3, f.sent_count, row->what); /* 43Fh, 168h, 075h at once */
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, fixture_count_sent(&f, 0x43F), row->what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, fixture_count_sent(&f, 0x168), row->what);
    TEST_ASSERT_EQUAL_UINT32_MESSAGE(1, fixture_count_sent(&f, 0x075), row->what);
}

#define POWER_ON(what, tripped, store, invalid)                                                                        \
    {what, HAL_RESET_POWER_ON, tripped, store, AGV_STATE_INIT, AGV_FAULT_NONE, invalid}
#define OTHER(what, cause, tripped, store, reason, invalid)                                                            \
    {what, cause, tripped, store, AGV_STATE_TRIPPED, AGV_FAULT_##reason, invalid}
#define OTHERS(name, cause)                                                                                            \
    OTHER(name ", tripped", cause, true, STORE_OK, S_DRIVER_ALARM, false),                                             \
        OTHER(name ", tripped, corrupt", cause, true, STORE_CORRUPT, SUPERVISOR_RESET, true),                          \
        OTHER(name ", tripped, empty", cause, true, STORE_EMPTY, SUPERVISOR_RESET, false),                             \
        OTHER(name ", not tripped", cause, false, STORE_OK, SUPERVISOR_RESET, false),                                  \
        OTHER(name ", not tripped, corrupt", cause, false, STORE_CORRUPT, SUPERVISOR_RESET, true),                     \
        OTHER(name ", not tripped, empty", cause, false, STORE_EMPTY, SUPERVISOR_RESET, false)

/* Shows: FSM-7, SUPERVISOR_RESET, STORE_INVALID */
void test_each_reset_cause_tripped_or_not_with_each_state_of_the_store(void) {
    static const restart_t ROWS[] = {
        POWER_ON("power-on, tripped", true, STORE_OK, false),
        POWER_ON("power-on, tripped, corrupt", true, STORE_CORRUPT, true),
        POWER_ON("power-on, tripped, empty", true, STORE_EMPTY, false),
        POWER_ON("power-on, not tripped", false, STORE_OK, false),
        POWER_ON("power-on, not tripped, corrupt", false, STORE_CORRUPT, true),
        POWER_ON("power-on, not tripped, empty", false, STORE_EMPTY, false),
        OTHERS("watchdog", HAL_RESET_WATCHDOG),
        OTHERS("brown-out", HAL_RESET_BROWN_OUT),
        OTHERS("lock-up", HAL_RESET_LOCK_UP),
        OTHERS("software", HAL_RESET_SOFTWARE),
        OTHERS("unknown", HAL_RESET_UNKNOWN),
    };
    for (unsigned i = 0; i < sizeof ROWS / sizeof ROWS[0]; i++) {
        expect_restart(&ROWS[i]);
    }
}

static void expect_tripped_after_restart(agv_state_t before, agv_fault_t reason) {
    expect_state(&f, before);
    fixture_restart(&f, HAL_RESET_BROWN_OUT);
    expect_tripped(&f, reason);
}

/* Shows: FSM-7 */
void test_a_restart_in_each_state(void) {
    fixture_start(&f);
    expect_tripped_after_restart(AGV_STATE_INIT, AGV_FAULT_SUPERVISOR_RESET);
    fixture_init(&f);
    fixture_standby(&f);
    expect_tripped_after_restart(AGV_STATE_STANDBY, AGV_FAULT_SUPERVISOR_RESET);
    fixture_init(&f);
    fixture_active(&f);
    expect_tripped_after_restart(AGV_STATE_ACTIVE, AGV_FAULT_SUPERVISOR_RESET);
    fixture_init(&f);
    walk_to_tripped(&f);
    expect_tripped_after_restart(AGV_STATE_TRIPPED, AGV_FAULT_S_DRIVER_ALARM);
    fixture_init(&f);
    walk_to_safe(&f);
    expect_tripped_after_restart(AGV_STATE_SAFE, AGV_FAULT_S_DRIVER_ALARM);
}

/* Shows: FSM-7, FSM-5 */
void test_the_first_reason_outlives_one_restart_after_the_other(void) {
    walk_to_safe(&f);
    for (unsigned i = 0; i < 5; i++) {
        fixture_restart(&f, HAL_RESET_WATCHDOG);
        expect_reason(&f, AGV_FAULT_S_DRIVER_ALARM);
        expect_state_after(&f, 300, AGV_STATE_SAFE);
    }
}

/* Shows: FSM-7, FSM-3 */
void test_after_a_restart_a_reset_is_possible_and_forgets_the_latch(void) {
    walk_to_safe(&f);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    expect_state_after(&f, 1500, AGV_STATE_SAFE);
    walk_reset(&f, 1050);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    expect_reason(&f, AGV_FAULT_SUPERVISOR_RESET); /* not the earlier alarm */
}

/* With this setting a power-on needs the operator, too. The stored reason is not used. */
/* Shows: FSM-7, FSM-3, SUPERVISOR_RESET */
void test_a_power_on_that_starts_tripped(void) {
    f.config.after_power_on = AGV_AFTER_POWER_ON_TRIPPED;
    fixture_start(&f);
    expect_tripped(&f, AGV_FAULT_SUPERVISOR_RESET);
    expect_output(&f, false);
    TEST_ASSERT_EQUAL_UINT32(1, fixture_count_sent(&f, 0x168));
    expect_state_after(&f, 1500, AGV_STATE_SAFE);
    expect_state_after(&f, 10000, AGV_STATE_SAFE);
    expect_output(&f, false);
    walk_reset(&f, 1000);
    expect_output(&f, true);
    walk_trip(&f);
    f.store.keep_latch = true;
    fixture_restart(&f, HAL_RESET_POWER_ON);
    expect_tripped(&f, AGV_FAULT_SUPERVISOR_RESET);
}

/* A tripped stored latch, an unreadable one, and none: only the warning differs. */
/* Shows: FSM-7, STORE_INVALID, SUPERVISOR_RESET */
void test_a_power_on_that_starts_tripped_with_each_state_of_the_store(void) {
    static const store_t STORES[] = {STORE_OK, STORE_CORRUPT, STORE_EMPTY};
    for (unsigned i = 0; i < 3; i++) {
        fixture_init(&f);
        f.config.after_power_on = AGV_AFTER_POWER_ON_TRIPPED;
        f.reset_cause = HAL_RESET_POWER_ON;
        fixture_start(&f);
        f.store.keep_latch = true;
        spoil_store(STORES[i]);
        fixture_restart(&f, HAL_RESET_POWER_ON);
        expect_tripped(&f, AGV_FAULT_SUPERVISOR_RESET);
        expect_fault(&f, AGV_FAULT_STORE_INVALID, STORES[i] == STORE_CORRUPT);
    }
}

/* All other resets are unchanged: the stored reason is used. */
/* Shows: FSM-7 */
void test_after_power_on_changes_no_other_reset(void) {
    f.config.after_power_on = AGV_AFTER_POWER_ON_TRIPPED;
    fixture_start(&f);
    fixture_run(&f, 2500);
    walk_reset(&f, 1000);
    walk_trip(&f);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    expect_reason(&f, AGV_FAULT_S_DRIVER_ALARM);
}

/* Shows: FSM-7, STORE_INVALID */
void test_a_torn_write_of_the_latch_counts_as_tripped(void) {
    for (unsigned bytes = 0; bytes < 8; bytes++) {
        fixture_init(&f);
        fixture_active(&f);
        sim_store_tear_write(&f.store, bytes);
        walk_trip(&f);
        fixture_restart(&f, HAL_RESET_BROWN_OUT);
        expect_state(&f, AGV_STATE_TRIPPED);
    }
}

/* Shows: FSM-7 */
void test_a_store_that_accepts_nothing_changes_only_the_reason(void) {
    sim_store_fail_writes(&f.store, UINT32_MAX);
    walk_to_safe(&f);
    expect_reason(&f, AGV_FAULT_S_DRIVER_ALARM);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    expect_tripped(&f, AGV_FAULT_SUPERVISOR_RESET);
}

/* ---- What cannot be read ---- */

/* Shows: FSM-7 */
void test_a_reset_cause_that_cannot_be_read_is_no_power_on(void) {
    fixture_start(&f);
    sim_hal_fail_at(&f.hal, 1, UINT32_MAX, 1u << SIM_HAL_OP_RESET_CAUSE);
    f.hal.config.reset_cause = HAL_RESET_POWER_ON;
    agv_supervisor_start(&f.supervisor, &f.ports, &f.config, f.now_ms);
    expect_tripped(&f, AGV_FAULT_SUPERVISOR_RESET);
}

/* Shows: FSM-7 */
void test_a_latch_that_cannot_be_read_is_tripped_after_a_restart(void) {
    walk_to_safe(&f);
    sim_hal_fail_at(&f.hal, 1, UINT32_MAX, 1u << SIM_HAL_OP_STORE_READ_LATCH);
    fixture_restart(&f, HAL_RESET_WATCHDOG);
    expect_tripped(&f, AGV_FAULT_SUPERVISOR_RESET);
}

/* Without a stored latch nothing else in memory counts as one: the same wherever the supervisor lies, over 64 kB. */
/* Shows: FSM-7, SUPERVISOR_RESET */
void test_a_restart_without_a_latch_has_no_other_reason_at_any_place(void) {
    enum { PLACES = 65536 / sizeof(agv_supervisor_t) + 1 };
    static agv_supervisor_t supervisors[PLACES];
    fixture_start(&f);
    sim_hal_reset(&f.hal, HAL_RESET_WATCHDOG);
    for (unsigned i = 0; i < PLACES; i++) {
        f.store.latch_size = 0;
        agv_supervisor_start(&supervisors[i], &f.ports, &f.config, f.now_ms);
        TEST_ASSERT_EQUAL(AGV_FAULT_SUPERVISOR_RESET, agv_supervisor_first_reason(&supervisors[i]));
    }
}

/* Reset causes, latch, watchdog, pins, and the settings of the build. */
#include <string.h>

#include <zephyr/drivers/hwinfo.h>

#include "agv/config.h"
#include "fixture.h"
#include "kconfig.h"
#include "zephyr_hal_internal.h"

ZTEST_SUITE(port_reset, NULL, NULL, fixture_before, fixture_after, NULL);

static hal_reset_cause_t cause_after(uint32_t flags) {
    fake_reset_flags = flags;
    (void)fixture_begin();
    return hal_reset_cause(&hal);
}

/* Shows: FSM-7 */
ZTEST(port_reset, test_only_a_certain_power_on_is_reported) {
    static const struct {
        uint32_t flags;
        hal_reset_cause_t cause;
    } cases[] = {
        {RESET_POR, HAL_RESET_POWER_ON},
        {RESET_POR | RESET_BROWNOUT | RESET_PIN, HAL_RESET_POWER_ON},
        {RESET_POR | RESET_WATCHDOG, HAL_RESET_WATCHDOG},
        {RESET_POR | RESET_SOFTWARE, HAL_RESET_SOFTWARE},
        {RESET_POR | RESET_LOW_POWER_WAKE, HAL_RESET_UNKNOWN},
        {RESET_BROWNOUT | RESET_PIN, HAL_RESET_BROWN_OUT},
        {RESET_WATCHDOG | RESET_PIN, HAL_RESET_WATCHDOG},
        {RESET_CPU_LOCKUP, HAL_RESET_LOCK_UP},
        {RESET_SOFTWARE | RESET_PIN, HAL_RESET_SOFTWARE},
        {RESET_PIN, HAL_RESET_UNKNOWN},
        {0u, HAL_RESET_UNKNOWN},
    };
    for (size_t i = 0u; i < ARRAY_SIZE(cases); i++) {
        zassert_equal(cause_after(cases[i].flags), cases[i].cause, "case %u", (unsigned)i);
    }
}

/* Shows: FSM-7 */
ZTEST(port_reset, test_the_flags_are_read_once_and_cleared) {
    fake_reset_reads = 0u;
    fake_reset_clears = 0u;
    zassert_equal(cause_after(RESET_WATCHDOG), HAL_RESET_WATCHDOG);
    zassert_equal(hal_reset_cause(&hal), HAL_RESET_WATCHDOG);
    zassert_equal(fake_reset_reads, 1u);
    zassert_equal(fake_reset_clears, 1u);
}

/* Shows: FSM-7 */
ZTEST(port_reset, test_a_power_on_is_certain_only_where_a_brown_out_has_a_flag) {
    fake_reset_supported = RESET_POR | RESET_PIN;
    zassert_equal(cause_after(RESET_POR), HAL_RESET_UNKNOWN);
    fake_reset_supported = RESET_POR | RESET_BROWNOUT;
    zassert_equal(cause_after(RESET_POR), HAL_RESET_POWER_ON);
    fake_reset_supported = 0u; /* the driver does not tell */
    zassert_equal(cause_after(RESET_POR), HAL_RESET_UNKNOWN);
}

/* Shows: FSM-7 */
ZTEST(port_reset, test_without_flags_the_cause_is_unknown) {
    fake_reset_error = -ENOSYS;
    zassert_equal(cause_after(RESET_POR), HAL_RESET_UNKNOWN);
}

/* Shows: FSM-7 */
ZTEST(port_reset, test_a_reset_by_the_port_itself_reports_its_cause_once) {
    zephyr_reset_note(&(zephyr_hal_end_t){.reason = HAL_END_TASK_WATCHDOG});
    zassert_equal(cause_after(RESET_SOFTWARE), HAL_RESET_WATCHDOG);
    zassert_equal(hal.end_before.reason, HAL_END_TASK_WATCHDOG);
    zassert_equal(cause_after(RESET_SOFTWARE), HAL_RESET_SOFTWARE);
    zassert_equal(hal.end_before.reason, HAL_END_UNKNOWN);
    for (uint32_t reason = HAL_END_PROCESSOR; reason < HAL_ENDS; reason++) {
        zephyr_reset_note(&(zephyr_hal_end_t){.reason = reason, .pc = 0x08001234u, .lr = 0x08005679u});
        zassert_equal(cause_after(RESET_SOFTWARE), HAL_RESET_LOCK_UP);
        zassert_equal(hal.end_before.reason, reason);
        zassert_equal(hal.end_before.pc, 0x08001234u);
        zassert_equal(hal.end_before.lr, 0x08005679u);
    }
    zephyr_reset_note(&(zephyr_hal_end_t){.reason = HAL_ENDS});
    zassert_equal(cause_after(RESET_SOFTWARE), HAL_RESET_SOFTWARE, "a reason that does not exist is none");
}

/* Shows: FSM-7 */
ZTEST(port_reset, test_the_latch_outlives_a_reset) {
    static const uint8_t record[] = {1u, 2u, 3u, 4u, 5u};
    uint8_t read[HAL_STORE_LATCH_SIZE_MAX] = {0};
    zassert_true(hal_store_write_latch(&hal, record, sizeof record));
    (void)cause_after(RESET_WATCHDOG);
    zassert_equal(hal_store_read_latch(&hal, read, sizeof read), sizeof record);
    zassert_mem_equal(read, record, sizeof record);
    zassert_equal(hal_store_read_latch(&hal, read, 2u), sizeof record);
    zassert_false(hal_store_write_latch(&hal, record, 0u));
    zassert_false(hal_store_write_latch(&hal, read, HAL_STORE_LATCH_SIZE_MAX + 1u));
}

/* Shows: FSM-7 */
ZTEST(port_reset, test_each_flipped_bit_of_the_latch_is_detected) {
    static const uint8_t record[8] = {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u};
    uint8_t read[HAL_STORE_LATCH_SIZE_MAX];
    for (size_t bit = 0u; bit < (offsetof(zephyr_hal_retained_t, end) * 8u); bit++) {
        zassert_true(hal_store_write_latch(&hal, record, sizeof record));
        ((uint8_t *)&retained)[bit / 8u] ^= (uint8_t)(1u << (bit % 8u));
        hal.reset_cause = HAL_RESET_POWER_ON;
        zassert_equal(hal_store_read_latch(&hal, read, sizeof read), 0u, "power-on: nothing is stored");
        hal.reset_cause = HAL_RESET_WATCHDOG;
        zassert_equal(hal_store_read_latch(&hal, read, sizeof read), HAL_STORE_LATCH_SIZE_MAX,
                      "a reset: of no size that anybody wrote");
    }
}

/* Shows: TIM-3 */
ZTEST(port_reset, test_nothing_but_the_core_feeds_the_watchdog) {
    zassert_true(fake_watchdog_started);
    zassert_equal(fake_watchdog_ms, 120u);
    zassert_true(zephyr_watchdog_start(&hal, 100u));
    const uint32_t before = fake_watchdog_feeds;
    k_msleep(90);
    zassert_equal(fake_watchdog_feeds, before);
    hal_watchdog_feed(&hal);
    zassert_equal(fake_watchdog_feeds, before + 1u);
    k_msleep(90);
    zassert_equal(fake_watchdog_feeds, before + 1u);
}

/* Shows: TIM-3 */
ZTEST(port_reset, test_the_window_watchdog_is_fed_at_every_20th_feed) {
    const fake_window_watchdog_t *const window = &fake_window_watchdog;
    zassert_equal(window->opens_ms, 10u);
    zassert_equal(window->expires_ms, 140u);
    const uint32_t before = window->feeds;
    for (uint32_t i = 0u; (i < 20u) && (window->feeds == before); i++) {
        hal_watchdog_feed(&hal); /* in step with the port's count */
    }
    for (uint32_t i = 1u; i <= 20u; i++) {
        zassert_equal(window->feeds, before + 1u);
        hal_watchdog_feed(&hal);
    }
    zassert_equal(window->feeds, before + 2u);
}

/* Shows: TIM-3 */
ZTEST(port_reset, test_the_window_watchdog_is_fed_in_time_when_steps_come_late) {
    const fake_window_watchdog_t *const window = &fake_window_watchdog;
    const uint32_t before = window->feeds;
    for (uint32_t i = 0u; (i < 20u) && (window->feeds == before); i++) {
        hal_watchdog_feed(&hal);
    }
    const uint32_t first = window->feeds;
    const uint32_t outside = window->outside;
    for (uint32_t i = 0u; i < 60u; i++) {
        k_msleep(8);
        hal_watchdog_feed(&hal);
    }
    zassert_equal(window->outside, outside);
    zassert_equal(window->feeds, first + 20u, "at every third step: 24 ms apart");
}

/* Shows: FSM-4 */
ZTEST(port_reset, test_the_pins) {
    zassert_true(zephyr_hal_output_is_open());
    hal_safety_output_set(&hal, true);
    zassert_true(fake_output_is_closed());
    zassert_false(zephyr_hal_output_is_open());
    zephyr_output_open_now();
    zassert_false(fake_output_is_closed());
    hal_led_set(&hal, true);
    zassert_true(fake_led_is_on());
    hal_led_set(&hal, false);
    zassert_false(fake_led_is_on());
}

/* Shows: FSM-9 */
ZTEST(port_reset, test_an_output_that_reads_closed_at_the_start_fails_the_self_test) {
    hal_safety_output_set(&hal, true);
    zassert_false(fixture_begin());
    zephyr_output_open_now();
    fake_parts_reset();
    zassert_true(fixture_begin());
}

/* Shows: INT-2 */
ZTEST(port_reset, test_the_settings_of_the_build_are_valid) {
    agv_config_t config;
    kconfig_read(&config);
    zassert_equal(agv_config_check(&config).problem, AGV_CONFIG_OK);
    zassert_equal(config.topology, AGV_TOPOLOGY_GATEWAY);
    agv_config_t defaults;
    agv_config_defaults(&defaults);
    defaults.topology = AGV_TOPOLOGY_GATEWAY;
    zassert_equal(agv_config_checksum(&config), agv_config_checksum(&defaults));
}

/* Shows: INT-2 */
ZTEST(port_reset, test_the_build_knows_the_identifiers_of_the_protocol) {
    agv_config_t config;
    kconfig_read(&config);
    for (uint32_t id = 0u; id <= 0x7FFu; id++) {
        config.status_frame_id = (uint16_t)id;
        zassert_equal(agv_config_check(&config).problem == AGV_CONFIG_ID_TWICE, KCONFIG_ID_IS_TAKEN(id), "%03x", id);
    }
}

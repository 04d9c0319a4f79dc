/* hal/watchdog.h: the kernel's task watchdog, backed by the hardware watchdog, which also resets a chip whose kernel
 * hangs. */
#include <zephyr/task_wdt/task_wdt.h>

#include "zephyr_hal_internal.h"

/*
 * The task watchdog feeds the hardware watchdog whenever it checks its channels. With a minimum timeout longer than the
 * period, its own check never comes before the channel has expired. So only hal_watchdog_feed() feeds the two
 * watchdogs.
 */
BUILD_ASSERT(CONFIG_TASK_WDT_MIN_TIMEOUT > CONFIG_AGV_WATCHDOG_PERIOD_MS,
             "CONFIG_TASK_WDT_MIN_TIMEOUT has to be longer than CONFIG_AGV_WATCHDOG_PERIOD_MS");
BUILD_ASSERT((CONFIG_TASK_WDT_MIN_TIMEOUT + CONFIG_TASK_WDT_HW_FALLBACK_DELAY) <=
                 (2 * CONFIG_AGV_WATCHDOG_PERIOD_MS) + 20,
             "the hardware watchdog would expire more than a period too late");

/* Runs in the timer's interrupt. */
static void on_expired(int channel, void *user_data) {
    ARG_UNUSED(channel);
    ARG_UNUSED(user_data);
    zephyr_hal_die(ZEPHYR_HAL_TASK_WATCHDOG, 0u, 0u);
}

bool zephyr_watchdog_start(hal_t *hal, uint32_t period_ms) {
    const struct device *const hardware = DEVICE_DT_GET_OR_NULL(DT_ALIAS(watchdog0));
    const bool is_there = (hardware != NULL) && device_is_ready(hardware);
    static bool started; /* the kernel has one task watchdog, which cannot be stopped */
    started = started || (task_wdt_init(is_there ? hardware : NULL) == 0);
    hal->watchdog_channel = task_wdt_add(period_ms, on_expired, NULL);
    return started && (hal->watchdog_channel >= 0) && (is_there || IS_ENABLED(CONFIG_AGV_WITHOUT_HARDWARE_WATCHDOG));
}

void hal_watchdog_feed(hal_t *hal) {
    (void)task_wdt_feed(hal->watchdog_channel);
}

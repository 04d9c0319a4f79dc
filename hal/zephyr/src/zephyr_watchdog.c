/* hal/watchdog.h: the kernel's task watchdog, backed by the hardware watchdog, which also resets a chip whose kernel
 * hangs; and a window watchdog, which also resets a chip that feeds too often. */
#include <zephyr/drivers/watchdog.h>
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
    zephyr_hal_die(HAL_END_TASK_WATCHDOG, 0u, 0u);
}

#define WINDOW_NODE DT_ALIAS(window_watchdog)
#define HARDWARE_NODE DT_ALIAS(watchdog0)

#if DT_NODE_HAS_STATUS(WINDOW_NODE, okay)

/* It is fed at every 20th feed, and when 20 ms have passed: more than 10 ms later, and before the time by which the hardware
 * watchdog would have expired, in an interval that began up to 20 ms earlier. A program that feeds too often reaches the 20th
 * feed too early. Steps that come late do not delay it. */
enum {
    WINDOW_FEEDS = 20,
    WINDOW_FED_MS = 20,
    WINDOW_OPENS_MS = WINDOW_FED_MS / 2,
    WINDOW_EXPIRES_MS = CONFIG_TASK_WDT_MIN_TIMEOUT + CONFIG_TASK_WDT_HW_FALLBACK_DELAY + WINDOW_FED_MS
};

static const struct device *const window = DEVICE_DT_GET(WINDOW_NODE);
static int window_channel;
static uint32_t window_feeds;
static uint32_t window_fed_ms;

static void on_window_expires(const struct device *device, int channel) {
    ARG_UNUSED(device);
    ARG_UNUSED(channel);
    zephyr_hal_die(HAL_END_WINDOW_WATCHDOG, 0u, 0u);
}

static bool start_window(void) {
    const struct wdt_timeout_cfg timeout = {.window = {.min = WINDOW_OPENS_MS, .max = WINDOW_EXPIRES_MS},
                                            .callback = on_window_expires,
                                            .flags = WDT_FLAG_RESET_SOC};
    if (!device_is_ready(window)) {
        return false;
    }
    window_channel = wdt_install_timeout(window, &timeout);
#if DT_NODE_HAS_COMPAT(WINDOW_NODE, st_stm32_window_watchdog) /* whose driver takes no lower limit */
    zephyr_chip_open_window(DT_REG_ADDR(WINDOW_NODE), WINDOW_OPENS_MS, WINDOW_EXPIRES_MS);
#endif
    /* In a release a processor that a debugger halts is reset, as one that hangs. */
    const uint8_t options = IS_ENABLED(CONFIG_AGV_RELEASE) ? 0u : WDT_OPT_PAUSE_HALTED_BY_DBG;
    window_fed_ms = k_uptime_get_32();
    return (window_channel >= 0) && (wdt_setup(window, options) == 0);
}

static void feed_window(void) {
    const uint32_t now_ms = k_uptime_get_32();
    window_feeds++;
    if ((window_feeds == (uint32_t)WINDOW_FEEDS) || (now_ms - window_fed_ms >= (uint32_t)WINDOW_FED_MS)) {
        window_feeds = 0u;
        window_fed_ms = now_ms;
        (void)wdt_feed(window, window_channel);
    }
}

#else

static bool start_window(void) {
    return true;
}

static void feed_window(void) {
}

#endif

/* A board may have one watchdog for both. Then the kernel's one has no other behind it: it would feed it too early. */
#if DT_NODE_HAS_STATUS(WINDOW_NODE, okay) && DT_NODE_HAS_STATUS(HARDWARE_NODE, okay)
#define HARDWARE_IS_WINDOW DT_SAME_NODE(HARDWARE_NODE, WINDOW_NODE)
#else
#define HARDWARE_IS_WINDOW false
#endif

/* The hardware watchdog behind the task watchdog; NULL: there is none. */
static const struct device *find_hardware(void) {
    const struct device *const hardware = DEVICE_DT_GET_OR_NULL(HARDWARE_NODE);
    const bool is_there = !HARDWARE_IS_WINDOW && (hardware != NULL) && device_is_ready(hardware);
    return is_there ? hardware : NULL;
}

static bool start_once(const struct device *hardware) {
    const bool is_enough =
        (hardware != NULL) || DT_NODE_HAS_STATUS(WINDOW_NODE, okay) || IS_ENABLED(CONFIG_AGV_WITHOUT_HARDWARE_WATCHDOG);
    const bool window_works = start_window();
    if (task_wdt_init(hardware) == 0) {
        return window_works && is_enough;
    }
    (void)task_wdt_init(NULL); /* without it the task watchdog would have no timer */
    return false;
}

/* The task watchdog starts it with its first channel, and does not look at the result. */
static bool hardware_runs(const struct device *hardware) {
    const int status = (hardware != NULL) ? wdt_setup(hardware, WDT_OPT_PAUSE_HALTED_BY_DBG) : 0;
    return (status == 0) || (status == -EBUSY);
}

bool zephyr_watchdog_start(hal_t *hal, uint32_t period_ms) {
    static bool started; /* neither watchdog can be stopped */
    static bool works;
    const struct device *const hardware = find_hardware();
    if (!started) {
        works = start_once(hardware);
    }
    hal->watchdog_channel = task_wdt_add(period_ms, on_expired, NULL);
    if (!started) {
        works = hardware_runs(hardware) && works;
        started = true;
    }
    return works && (hal->watchdog_channel >= 0);
}

void hal_watchdog_feed(hal_t *hal) {
    (void)task_wdt_feed(hal->watchdog_channel);
    feed_window();
}

/* Start, clock and waiting. */
#include "zephyr_hal_internal.h"

enum { MS_PER_TICK = 1 };

uint32_t hal_clock_now_ms(hal_t *hal) {
    ARG_UNUSED(hal);
    return (uint32_t)k_ticks_to_ms_floor64((uint64_t)k_uptime_ticks());
}

/* Runs in the timer's interrupt. The semaphore counts to one: a late thread gets one tick, not all that it missed. */
static void on_tick(struct k_timer *timer) {
    k_sem_give(k_timer_user_data_get(timer));
}

static const struct device *const controllers[HAL_CAN_SIDES] = {
    DEVICE_DT_GET(DT_PHANDLE(ZEPHYR_HAL_NODE, vehicle_can)),
#if defined(CONFIG_AGV_TOPOLOGY_GATEWAY)
    DEVICE_DT_GET(DT_PHANDLE(ZEPHYR_HAL_NODE, ai_can)),
#endif
};

static bool start_sides(hal_t *hal, const zephyr_hal_config_t *config) {
    bool works = true;
    for (uint32_t i = 0u; i < (uint32_t)HAL_CAN_SIDES; i++) {
        zephyr_hal_side_t *const side = &hal->sides[i];
        side->device = controllers[i];
        side->wake = &hal->wake;
        k_msgq_init(&side->received, side->received_buffer, sizeof(hal_can_frame_t), CONFIG_AGV_CAN_RX_QUEUE);
        if (side->device != NULL) {
            side->running = zephyr_can_start(side, config);
            works = works && side->running;
        }
    }
    return works;
}

bool zephyr_hal_init(hal_t *hal, const zephyr_hal_config_t *config) {
    (void)memset(hal, 0, sizeof *hal);
    (void)k_sem_init(&hal->wake, 0u, 1u);
    const bool output_works = zephyr_hal_output_is_open();
    const bool watchdog_works = zephyr_watchdog_start(hal, config->watchdog_ms);
    hal->retained = config->retained;
    hal->reset_cause = zephyr_reset_read(hal->retained, &hal->end_before);
    const bool led_works = zephyr_led_start();
    const bool log_works = zephyr_log_start(hal);
    const bool sides_work = start_sides(hal, config);
    k_timer_init(&hal->timer, on_tick, NULL);
    k_timer_user_data_set(&hal->timer, &hal->wake);
    k_timer_start(&hal->timer, K_MSEC(MS_PER_TICK), K_MSEC(MS_PER_TICK));
    const bool devices_work = output_works && led_works && log_works && sides_work;
    hal->failed = (watchdog_works ? 0u : HAL_SELF_TEST_WATCHDOG) | (devices_work ? 0u : HAL_SELF_TEST_DEVICES);
    return hal->failed == 0u;
}

uint32_t hal_self_test(hal_t *hal) {
    return hal->failed;
}

bool hal_clock_second_ms(hal_t *hal, uint32_t *time_ms) {
    ARG_UNUSED(hal);
    ARG_UNUSED(time_ms);
    return false;
}

void zephyr_hal_wait(hal_t *hal) {
    (void)k_sem_take(&hal->wake, K_FOREVER);
}

zephyr_hal_side_t *zephyr_hal_side(hal_t *hal, hal_can_side_t side) {
    return (((unsigned)side < HAL_CAN_SIDES) && (hal->sides[side].device != NULL)) ? &hal->sides[side] : NULL;
}

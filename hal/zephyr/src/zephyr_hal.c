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

static uint32_t start_devices(hal_t *hal, const zephyr_hal_config_t *config) {
    const bool led_works = zephyr_led_start();
    const bool inputs_work = zephyr_inputs_start();
    const bool clock_works = zephyr_second_clock_start(hal);
    const bool log_works = zephyr_log_start(hal);
    const bool sides_work = start_sides(hal, config);
    return (led_works && inputs_work && clock_works && log_works && sides_work) ? 0u : HAL_SELF_TEST_DEVICES;
}

bool zephyr_hal_init(hal_t *hal, const zephyr_hal_config_t *config) {
    uint32_t failed = zephyr_self_test_start(config); /* before the memory is used */
    (void)memset(hal, 0, sizeof *hal);
    (void)k_sem_init(&hal->wake, 0u, 1u);
    failed |= zephyr_hal_output_is_open() ? 0u : HAL_SELF_TEST_DEVICES;
    failed |=
        zephyr_flash_test_start(hal); /* can take longer than the watchdog's period: see IWDG_STM32_INITIAL_TIMEOUT */
    failed |= zephyr_watchdog_start(hal, config->watchdog_ms) ? 0u : HAL_SELF_TEST_WATCHDOG;
    hal->retained = config->retained;
    hal->reset_cause = zephyr_reset_read(hal->retained, &hal->end_before);
    failed |= start_devices(hal, config);
    k_timer_init(&hal->timer, on_tick, NULL);
    k_timer_user_data_set(&hal->timer, &hal->wake);
    k_timer_start(&hal->timer, K_MSEC(MS_PER_TICK), K_MSEC(MS_PER_TICK));
    hal->failed = failed;
    return failed == 0u;
}

void zephyr_hal_wait(hal_t *hal) {
    (void)k_sem_take(&hal->wake, K_FOREVER);
}

zephyr_hal_side_t *zephyr_hal_side(hal_t *hal, hal_can_side_t side) {
    return (((unsigned)side < HAL_CAN_SIDES) && (hal->sides[side].device != NULL)) ? &hal->sides[side] : NULL;
}

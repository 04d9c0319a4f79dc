#include "fixture.h"

#include <zephyr/task_wdt/task_wdt.h>

hal_t hal;
zephyr_hal_retained_t retained;

static bool begin(bool listen_only) {
    fixture_after(NULL);
    const zephyr_hal_config_t config = {.bitrate = 500000u,
                                        .sample_point_permille = 875u,
                                        .watchdog_ms = 100u,
                                        .listen_only = listen_only,
                                        .retained = &retained};
    for (size_t i = 0u; i < (size_t)HAL_CAN_SIDES; i++) {
        fake_buses[i].started = false; /* the reset has stopped it */
    }
    const bool works = zephyr_hal_init(&hal, &config);
    (void)task_wdt_delete(hal.watchdog_channel); /* most tests do not feed it */
    return works;
}

bool fixture_begin(void) {
    return begin(false);
}

bool fixture_begin_listening(void) {
    return begin(true);
}

void fixture_before(void *unused) {
    ARG_UNUSED(unused);
    fake_parts_reset();
    (void)fixture_begin();
}

void fixture_after(void *unused) {
    ARG_UNUSED(unused);
    (void)task_wdt_delete(hal.watchdog_channel);
    k_timer_stop(&hal.timer);
}

void (*fixture_arrives)(void);
uint32_t fixture_looks;

/* In zephyr_can.c, in place of the kernel's function. */
int fixture_peek(struct k_msgq *queue, void *data);

int fixture_peek(struct k_msgq *queue, void *data) {
    const int result = z_impl_k_msgq_peek(queue, data);
    if ((fixture_looks > 0u) && (--fixture_looks == 0u)) {
        fixture_arrives();
    }
    return result;
}

hal_can_status_t fixture_status(void) {
    hal_can_status_t status;
    hal_can_status(&hal, HAL_CAN_VEHICLE, &status);
    return status;
}

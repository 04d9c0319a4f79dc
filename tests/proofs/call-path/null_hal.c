#include "null_hal.h"

#include "hal/clock.h"
#include "hal/inputs.h"
#include "hal/led.h"
#include "hal/reset.h"
#include "hal/safety_output.h"
#include "hal/self_test.h"
#include "hal/store.h"
#include "hal/watchdog.h"

bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    (void)hal;
    (void)side;
    (void)frame;
    return true;
}

void hal_can_purge(hal_t *hal, hal_can_side_t side) {
    (void)hal;
    (void)side;
}

void hal_can_recover(hal_t *hal, hal_can_side_t side) {
    (void)hal;
    (void)side;
}

void hal_can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    (void)hal;
    (void)side;
    *status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
}

hal_reset_cause_t hal_reset_cause(hal_t *hal) {
    (void)hal;
    return HAL_RESET_POWER_ON;
}

void hal_led_set(hal_t *hal, bool on) {
    (void)hal;
    (void)on;
}

void hal_safety_output_set(hal_t *hal, bool closed) {
    (void)hal;
    (void)closed;
}

size_t hal_store_read_latch(hal_t *hal, void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    return 0;
}

bool hal_store_write_latch(hal_t *hal, const void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    return true;
}

bool hal_store_append(hal_t *hal, const void *record, size_t size) {
    return hal_store_write_latch(hal, record, size);
}

size_t hal_store_read_record(hal_t *hal, uint32_t index, void *record, size_t size) {
    (void)index;
    return hal_store_read_latch(hal, record, size);
}

void hal_watchdog_feed(hal_t *hal) {
    (void)hal;
}

void hal_inputs_read(hal_t *hal, hal_inputs_t *inputs) {
    (void)hal;
    *inputs = (hal_inputs_t){.output_feedback = HAL_CONTACT_NONE};
}

bool hal_clock_second_ms(hal_t *hal, uint32_t *time_ms) {
    (void)hal;
    (void)time_ms;
    return false;
}

uint32_t hal_self_test(hal_t *hal) {
    (void)hal;
    return 0;
}

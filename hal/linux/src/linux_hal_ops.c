/* The functions of hal/include, behind hal_ops.h. */
#include <string.h>

#include "linux_hal_internal.h"

enum { US_PER_MS = 1000 };

static bool can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    linux_hal_side_t *sender = linux_hal_side(hal, side);
    return sender != NULL && linux_hal_controller_state(sender) != HAL_CAN_BUS_OFF &&
           linux_hal_queue_take(sender, frame, linux_hal_now_us(hal));
}

static void can_purge(hal_t *hal, hal_can_side_t side) {
    linux_hal_side_t *purged = linux_hal_side(hal, side);
    if (purged != NULL) {
        linux_hal_queue_purge(purged, hal->looked_us);
    }
}

static void can_recover(hal_t *hal, hal_can_side_t side) {
    const linux_hal_side_t *off = linux_hal_side(hal, side);
    if (off != NULL && off->is_up && off->state == HAL_CAN_BUS_OFF) {
        (void)linux_can_restart(&off->can); /* after a failure the supervisor requests it again */
    }
}

static void can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    const linux_hal_side_t *asked = linux_hal_side(hal, side);
    *status = (hal_can_status_t){.state = HAL_CAN_ERROR_ACTIVE};
    if (asked != NULL) {
        status->state = linux_hal_controller_state(asked);
        status->tx_pending_ms = linux_hal_queue_pending_ms(asked, hal->looked_us);
        status->bus_off_count = asked->bus_offs;
        status->overrun_count = asked->overruns;
    }
}

static uint32_t clock_now_ms(hal_t *hal) {
    return (uint32_t)(linux_hal_now_us(hal) / US_PER_MS);
}

static void led_set(hal_t *hal, bool on) {
    hal->led_on = on;
}

static void safety_output_set(hal_t *hal, bool closed) {
    hal->output_closed = closed;
}

/* Always a power-on: a program keeps nothing from its previous run. */
static hal_reset_cause_t reset_cause(hal_t *hal) {
    (void)hal;
    return HAL_RESET_POWER_ON;
}

static void watchdog_feed(hal_t *hal) {
    hal->feeds++;
}

static size_t store_read_latch(hal_t *hal, void *record, size_t size) {
    memcpy(record, hal->latch, (hal->latch_size < size) ? hal->latch_size : size);
    return hal->latch_size;
}

static bool store_write_latch(hal_t *hal, const void *record, size_t size) {
    if (size == 0 || size > sizeof hal->latch) {
        return false;
    }
    memcpy(hal->latch, record, size);
    hal->latch_size = size;
    return true;
}

static bool store_append(hal_t *hal, const void *record, size_t size) {
    (void)hal;
    (void)record;
    (void)size;
    return false;
}

static size_t store_read_record(hal_t *hal, uint32_t index, void *record, size_t size) {
    (void)hal;
    (void)index;
    (void)record;
    (void)size;
    return 0;
}

/* A computer has no such inputs, no second oscillator that a program could read, and no program in flash. */
static void inputs_read(hal_t *hal, hal_inputs_t *inputs) {
    (void)hal;
    *inputs = (hal_inputs_t){.output_feedback = HAL_CONTACT_NONE};
}

static bool clock_second_ms(hal_t *hal, uint32_t *time_ms) {
    (void)hal;
    *time_ms = 0;
    return false;
}

static uint32_t self_test(hal_t *hal) {
    (void)hal;
    return 0;
}

const hal_ops_t linux_hal_ops = {
    .can_send = can_send,
    .can_purge = can_purge,
    .can_recover = can_recover,
    .can_status = can_status,
    .clock_now_ms = clock_now_ms,
    .led_set = led_set,
    .safety_output_set = safety_output_set,
    .reset_cause = reset_cause,
    .watchdog_feed = watchdog_feed,
    .store_read_latch = store_read_latch,
    .store_write_latch = store_write_latch,
    .store_append = store_append,
    .store_read_record = store_read_record,
    .inputs_read = inputs_read,
    .clock_second_ms = clock_second_ms,
    .self_test = self_test,
};

/* The functions of hal/include: each calls the port that opened this hal_t. */
#include "hal_forward/hal_ops.h"

#include <string.h>

#include "hal/clock.h"
#include "hal/led.h"
#include "hal/safety_output.h"
#include "hal/self_test.h"
#include "hal/store.h"
#include "hal/watchdog.h"

/* The first member of every port's `struct hal` (hal_ops.h). */
typedef struct {
    const hal_ops_t *ops;
} head_t;

static const hal_ops_t *ops_of(const hal_t *hal) {
    head_t head;
    memcpy(&head, hal, sizeof head);
    return head.ops;
}

bool hal_can_send(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame) {
    return ops_of(hal)->can_send(hal, side, frame);
}

void hal_can_purge(hal_t *hal, hal_can_side_t side) {
    ops_of(hal)->can_purge(hal, side);
}

void hal_can_recover(hal_t *hal, hal_can_side_t side) {
    ops_of(hal)->can_recover(hal, side);
}

void hal_can_status(hal_t *hal, hal_can_side_t side, hal_can_status_t *status) {
    ops_of(hal)->can_status(hal, side, status);
}

uint32_t hal_clock_now_ms(hal_t *hal) {
    return ops_of(hal)->clock_now_ms(hal);
}

void hal_led_set(hal_t *hal, bool on) {
    ops_of(hal)->led_set(hal, on);
}

void hal_safety_output_set(hal_t *hal, bool closed) {
    ops_of(hal)->safety_output_set(hal, closed);
}

hal_reset_cause_t hal_reset_cause(hal_t *hal) {
    return ops_of(hal)->reset_cause(hal);
}

void hal_watchdog_feed(hal_t *hal) {
    ops_of(hal)->watchdog_feed(hal);
}

size_t hal_store_read_latch(hal_t *hal, void *record, size_t size) {
    return ops_of(hal)->store_read_latch(hal, record, size);
}

bool hal_store_write_latch(hal_t *hal, const void *record, size_t size) {
    return ops_of(hal)->store_write_latch(hal, record, size);
}

bool hal_store_append(hal_t *hal, const void *record, size_t size) {
    return ops_of(hal)->store_append(hal, record, size);
}

size_t hal_store_read_record(hal_t *hal, uint32_t index, void *record, size_t size) {
    return ops_of(hal)->store_read_record(hal, index, record, size);
}

void hal_inputs_read(hal_t *hal, hal_inputs_t *inputs) {
    ops_of(hal)->inputs_read(hal, inputs);
}

bool hal_clock_second_ms(hal_t *hal, uint32_t *time_ms) {
    return ops_of(hal)->clock_second_ms(hal, time_ms);
}

uint32_t hal_self_test(hal_t *hal) {
    return ops_of(hal)->self_test(hal);
}

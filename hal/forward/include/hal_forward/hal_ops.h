/**
 * @file hal_ops.h
 * The functions of the contract as a table, so that one program can hold several ports. For ports on a computer only: on a
 * microcontroller the port defines the functions of hal/include itself.
 *
 * The first member of such a port's `struct hal` is a pointer to its table, set when the port is opened.
 */
#ifndef HAL_FORWARD_HAL_OPS_H
#define HAL_FORWARD_HAL_OPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/can.h"
#include "hal/hal.h"
#include "hal/inputs.h"
#include "hal/reset.h"

/** Each pointer implements the function of hal/include with the same name. */
typedef struct {
    bool (*can_send)(hal_t *hal, hal_can_side_t side, const hal_can_frame_t *frame);
    void (*can_purge)(hal_t *hal, hal_can_side_t side);
    void (*can_recover)(hal_t *hal, hal_can_side_t side);
    void (*can_status)(hal_t *hal, hal_can_side_t side, hal_can_status_t *status);
    uint32_t (*clock_now_ms)(hal_t *hal);
    void (*led_set)(hal_t *hal, bool on);
    void (*safety_output_set)(hal_t *hal, bool closed);
    hal_reset_cause_t (*reset_cause)(hal_t *hal);
    void (*watchdog_feed)(hal_t *hal);
    size_t (*store_read_latch)(hal_t *hal, void *record, size_t size);
    bool (*store_write_latch)(hal_t *hal, const void *record, size_t size);
    bool (*store_append)(hal_t *hal, const void *record, size_t size);
    size_t (*store_read_record)(hal_t *hal, uint32_t index, void *record, size_t size);
    void (*inputs_read)(hal_t *hal, hal_inputs_t *inputs);
    bool (*clock_second_ms)(hal_t *hal, uint32_t *time_ms);
    uint32_t (*self_test)(hal_t *hal);
} hal_ops_t;

#endif

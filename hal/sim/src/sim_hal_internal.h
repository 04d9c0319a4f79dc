/**
 * @file sim_hal_internal.h
 * Declarations that the source files of the simulated port share.
 */
#ifndef SIM_HAL_INTERNAL_H
#define SIM_HAL_INTERNAL_H

#include "hal_forward/hal_ops.h"
#include "hal_sim/sim_hal.h"

extern const hal_ops_t sim_hal_ops;

/** The controller of a side; NULL = it does not exist. */
static inline sim_hal_can_t *sim_hal_controller(hal_t *hal, hal_can_side_t side) {
    return (unsigned)side < HAL_CAN_SIDES && hal->can[side].exists ? &hal->can[side] : NULL;
}

static inline void sim_hal_set_pin(sim_hal_pin_t *pin, bool on, uint32_t time_ms) {
    if (pin->on != on) {
        pin->on = on;
        pin->changes++;
        pin->changed_ms = time_ms;
    }
}

/** The inputs at a time of the clock. */
hal_inputs_t sim_board_inputs(hal_t *hal, uint32_t now_ms);

/** The second clock at a time of the first one. */
uint32_t sim_board_second_ms(hal_t *hal, uint32_t now_ms);

/** Check the watchdog's period. @return true: the watchdog holds the MCU in reset. */
bool sim_hal_watch(hal_t *hal, uint32_t now_ms);

#endif

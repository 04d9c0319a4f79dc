/**
 * @file hal_template.h
 * A port to start from: it compiles, links and does nothing. See README.md beside it.
 *
 * A port's own header holds what the program that uses it needs and nobody else: the definition of `struct hal`, and how
 * to begin.
 */
#ifndef HAL_TEMPLATE_HAL_TEMPLATE_H
#define HAL_TEMPLATE_HAL_TEMPLATE_H

#include "hal/can.h"
#include "hal/hal.h"
#include "hal/reset.h"

/**
 * One supervisor's hardware. The program owns it (static memory); the core only passes its address around.
 * Replace the members by what your hardware needs: device handles, queues, counters.
 */
struct hal {
    hal_reset_cause_t reset_cause;              /**< read once, in hal_template_init() */
    hal_can_status_t can_status[HAL_CAN_SIDES]; /**< what the controllers report */
};

/**
 * Begin: safety output open, LED dark, watchdog started, reset cause read, CAN controllers on the bus. In this order: from
 * the first instruction on nothing may close the output, and a hang in here must be bitten.
 */
void hal_template_init(hal_t *hal);

/**
 * Take the next received frame of a side, oldest first; the program hands it to the supervisor. Not part of the contract:
 * how frames come in (interrupt, thread, poll) is the port's business.
 * @return false: nothing there.
 */
bool hal_template_receive(hal_t *hal, hal_can_side_t side, hal_can_frame_t *frame);

#endif

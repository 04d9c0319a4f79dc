/**
 * @file hal_template.h
 * A port to start from: it compiles and links, but does nothing. README.md describes how to use it.
 *
 * The header of a port is for the program that uses the port: it defines `struct hal` and declares how to start the
 * port.
 */
#ifndef HAL_TEMPLATE_HAL_TEMPLATE_H
#define HAL_TEMPLATE_HAL_TEMPLATE_H

#include "hal/can.h"
#include "hal/hal.h"
#include "hal/reset.h"

/**
 * Hardware of one supervisor. The program owns it (static memory); the core only passes its address on.
 * Replace the members by what your hardware needs: device handles, queues, counters.
 */
struct hal {
    hal_reset_cause_t reset_cause;              /**< read once, in hal_template_init() */
    hal_can_status_t can_status[HAL_CAN_SIDES]; /**< last state of the controllers */
};

/**
 * Start the port, in this order: safety output open, watchdog started, reset cause read, LED dark, CAN controllers on
 * the bus. Nothing may close the output during the start, and the watchdog must end a start that hangs.
 */
void hal_template_init(hal_t *hal);

/**
 * Take the next received frame of a side, oldest first; the program passes it to the supervisor. This function is not
 * part of the contract: each port receives frames in its own way (interrupt, thread, polling).
 * @return false: no frame
 */
bool hal_template_receive(hal_t *hal, hal_can_side_t side, hal_can_frame_t *frame);

#endif

/**
 * @file safety_output.h
 * The hardware safety output: a contact that the integrator wires into the vehicle's drive enable. Open = safe. It must
 * not cut the supply of VCU, EPS or remote receiver.
 *
 * There is no feedback of the contact yet (HW-1), and no emergency stop input (HW-2): an optional function for each has its
 * place here, with a stub for ports of boards that have none.
 */
#ifndef HAL_SAFETY_OUTPUT_H
#define HAL_SAFETY_OUTPUT_H

#include <stdbool.h>

#include "hal/hal.h"

/**
 * Close (true) or open (false) the output. The port keeps it open from reset until the first call with true, and opens
 * it in its fault handlers (FSM-4). The core hears of no failure: the contact is wired so that it falls open.
 */
void hal_safety_output_set(hal_t *hal, bool closed);

#endif

/**
 * @file safety_output.h
 * The hardware safety output: a contact that the integrator wires into the vehicle's drive enable. Open is safe. It
 * must not cut the supply of VCU, EPS or remote receiver. The feedback of the contact is one of the inputs (inputs.h).
 */
#ifndef HAL_SAFETY_OUTPUT_H
#define HAL_SAFETY_OUTPUT_H

#include <stdbool.h>

#include "hal/hal.h"

/**
 * Close (true) or open (false) the output. The port keeps it open from reset until the first call with true, and opens
 * it in its fault handlers (FSM-4). Called when the output changes, and at every tick (HW-1). Failure of the output is not
 * reported here: wire the contact so that it opens when it fails, and read it back (inputs.h).
 */
void hal_safety_output_set(hal_t *hal, bool closed);

#endif

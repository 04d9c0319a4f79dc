/**
 * @file safety_output.h
 * The hardware safety output: a contact that the integrator wires into the vehicle's drive enable. Open is safe. It must
 * not cut the supply of VCU, EPS or remote receiver.
 *
 * There are no functions yet for a feedback of the contact (HW-1) and an emergency stop input (HW-2). They belong in this
 * header, as optional functions with a stub for boards without such an input.
 */
#ifndef HAL_SAFETY_OUTPUT_H
#define HAL_SAFETY_OUTPUT_H

#include <stdbool.h>

#include "hal/hal.h"

/**
 * Close (true) or open (false) the output. The port keeps it open from reset until the first call with true, and opens
 * it in its fault handlers (FSM-4). Failure of the output is not reported to the core: wire the contact so that it opens
 * when it fails.
 */
void hal_safety_output_set(hal_t *hal, bool closed);

#endif

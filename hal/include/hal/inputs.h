/**
 * @file inputs.h
 * The hard-wired inputs of the supervisor (HW-1, HW-2, HW-3). All are optional: for an input that the board does not
 * have, a port reports HAL_CONTACT_NONE in every call.
 */
#ifndef HAL_INPUTS_H
#define HAL_INPUTS_H

#include <stdint.h>

#include "hal/hal.h"

/** The position of a contact at this moment: not debounced, and not inverted by the core. */
typedef enum { HAL_CONTACT_NONE = 0, HAL_CONTACT_OPEN = 1, HAL_CONTACT_CLOSED = 2 } hal_contact_t;

/**
 * The inputs, hal_contact_t each. Any other value is a broken input, and so is HAL_CONTACT_NONE after another value. A broken
 * feedback contradicts the output in both positions. A broken emergency stop counts as open, and a press of a broken
 * button ends without a reset.
 */
typedef struct {
    uint8_t output_feedback; /**< position of the output (not of its mirror contact): OPEN is the safe one (HW-1) */
    uint8_t emergency_stop;  /**< normally closed circuit: OPEN stops, a broken wire too (HW-2) */
    uint8_t reset_button;    /**< push button, CLOSED = pressed (HW-3) */
} hal_inputs_t;

/** Read the inputs. Called at every tick. */
void hal_inputs_read(hal_t *hal, hal_inputs_t *inputs);

#endif

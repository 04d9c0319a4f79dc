/* hal/inputs.h: the hard-wired inputs. */
#include "hal/inputs.h"

void hal_inputs_read(hal_t *hal, hal_inputs_t *inputs) {
    (void)hal;
    /*
     * TODO: read the pins that the board has, without debouncing. Leave HAL_CONTACT_NONE for the others. For a pin that
     * cannot be read now report another value, such as UINT8_MAX.
     */
    *inputs = (hal_inputs_t){.output_feedback = HAL_CONTACT_NONE};
}

/* hal/safety_output.h: the hardware safety output. */
#include "hal/safety_output.h"

void hal_safety_output_set(hal_t *hal, bool closed) {
    (void)hal;
    (void)closed;
    /* TODO: set the pin directly, without a queue or a driver that may be suspended. It must be open without supply and
     * in reset. */
}

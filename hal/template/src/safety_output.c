/* hal/safety_output.h: the hardware safety output. */
#include "hal/safety_output.h"

void hal_safety_output_set(hal_t *hal, bool closed) {
    (void)hal;
    (void)closed;
    /* TODO: the pin, directly: no queue, no driver that may be asleep. Without supply, and in reset, it has to be open. */
}

/* hal/led.h: the alarm LED. */
#include "hal/led.h"

void hal_led_set(hal_t *hal, bool on) {
    (void)hal;
    (void)on;
    /* TODO: set the pin. The LED may be lit by a high or by a low level. */
}

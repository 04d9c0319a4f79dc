/* hal/led.h: the alarm LED. */
#include "hal/led.h"

void hal_led_set(hal_t *hal, bool on) {
    (void)hal;
    (void)on;
    /* TODO: the pin; mind whether the LED is lit by a high or by a low level. */
}

/* hal/clock.h: the clock. */
#include "hal/clock.h"

uint32_t hal_clock_now_ms(hal_t *hal) {
    (void)hal;
    /*
     * TODO: a 32-bit count of milliseconds that wraps only from UINT32_MAX to 0. Extend a timer that has fewer bits or
     * other units. The same clock stamps the received frames.
     */
    return 0;
}

bool hal_clock_second_ms(hal_t *hal, uint32_t *time_ms) {
    (void)hal;
    *time_ms = 0u;
    /* TODO: read a counter that another oscillator drives, in milliseconds, and return true. */
    return false;
}

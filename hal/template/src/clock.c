/* hal/clock.h: the clock. */
#include "hal/clock.h"

uint32_t hal_clock_now_ms(hal_t *hal) {
    (void)hal;
    /*
     * TODO: a 32-bit count of milliseconds that wraps from UINT32_MAX to 0 and at no other number: a timer with fewer
     * bits, or one in other units, has to be extended. The same clock stamps the received frames.
     */
    return 0;
}

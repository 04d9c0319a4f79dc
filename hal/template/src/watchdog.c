/* hal/watchdog.h: the hardware watchdog. */
#include "hal/watchdog.h"

void hal_watchdog_feed(hal_t *hal) {
    (void)hal;
    /* TODO: reload the counter. Do not reload it anywhere else, such as in an interrupt or an idle task (TIM-3). */
}

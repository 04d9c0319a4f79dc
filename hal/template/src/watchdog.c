/* hal/watchdog.h: the hardware watchdog. */
#include "hal/watchdog.h"

void hal_watchdog_feed(hal_t *hal) {
    (void)hal;
    /* TODO: reload the counter. The only place that does: no interrupt, no idle task (TIM-3). */
}

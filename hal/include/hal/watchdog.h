/**
 * @file watchdog.h
 * The hardware watchdog (TIM-3). The port starts it before the first frame, with the configured period (default 100 ms). Nothing
 * can stop it afterwards.
 */
#ifndef HAL_WATCHDOG_H
#define HAL_WATCHDOG_H

#include "hal/hal.h"

/**
 * Feed the watchdog. Only the core calls it, under the conditions of TIM-3. A port does not report a failure to feed: the
 * watchdog then resets the microcontroller, which is safe.
 */
void hal_watchdog_feed(hal_t *hal);

#endif

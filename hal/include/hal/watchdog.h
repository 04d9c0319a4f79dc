/**
 * @file watchdog.h
 * The hardware watchdog. The port starts it at boot with the configured period (default 100 ms) and cannot stop it.
 */
#ifndef HAL_WATCHDOG_H
#define HAL_WATCHDOG_H

#include "hal/hal.h"

/**
 * Feed the watchdog. Called by the core only, under the conditions of TIM-3. Where that fails the watchdog resets the MCU,
 * which is the safe end of it.
 */
void hal_watchdog_feed(hal_t *hal);

#endif

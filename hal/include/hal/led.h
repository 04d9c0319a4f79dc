/**
 * @file led.h
 * The alarm LED.
 */
#ifndef HAL_LED_H
#define HAL_LED_H

#include <stdbool.h>

#include "hal/hal.h"

/** Switch the LED. Called when it changes, at most once a tick. Whether it lights up, nobody asks: no fault hangs on it. */
void hal_led_set(hal_t *hal, bool on);

#endif

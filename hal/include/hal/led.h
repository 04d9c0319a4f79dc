/**
 * @file led.h
 * The alarm LED.
 */
#ifndef HAL_LED_H
#define HAL_LED_H

#include <stdbool.h>

#include "hal/hal.h"

/** Switch the LED. Called when its state changes, at most once per tick. LED failure is not monitored. */
void hal_led_set(hal_t *hal, bool on);

#endif

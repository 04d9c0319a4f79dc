/**
 * @file clock.h
 * The clocks. Only programs call hal_clock_now_ms(): they pass the time to the core as an argument. The core reads the
 * second clock.
 */
#ifndef HAL_CLOCK_H
#define HAL_CLOCK_H

#include <stdbool.h>
#include <stdint.h>

#include "hal/hal.h"

/** Milliseconds since an arbitrary time. Wraps from UINT32_MAX to 0 every 49.7 days and never goes backwards. */
uint32_t hal_clock_now_ms(hal_t *hal);

/**
 * Read a second clock, from another oscillator than the first one (HW-4). Called at every tick. The core compares both each
 * time that one of them has advanced by a second, so that a slow first clock is detected, too. When a call returns false after
 * an earlier one returned true, the second clock counts as standing still.
 * @param time_ms out: milliseconds since an arbitrary time; wraps as the first clock does. It must be accurate to 1 %.
 * @return false in every call if the board has no second clock
 */
bool hal_clock_second_ms(hal_t *hal, uint32_t *time_ms);

#endif

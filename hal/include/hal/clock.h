/**
 * @file clock.h
 * The clock. Only programs read it: the core gets the time as an argument. There is no function yet for a second,
 * independent clock to compare it with (HW-4, CLOCK_DEVIATION).
 */
#ifndef HAL_CLOCK_H
#define HAL_CLOCK_H

#include <stdint.h>

#include "hal/hal.h"

/** Milliseconds since an arbitrary time. Wraps from UINT32_MAX to 0 every 49.7 days and never goes backwards. */
uint32_t hal_clock_now_ms(hal_t *hal);

#endif

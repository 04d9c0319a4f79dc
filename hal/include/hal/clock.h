/**
 * @file clock.h
 * The clock. Read by programs only: the core takes its time as an argument. A second, independent clock to compare it with
 * has no function yet (HW-4, CLOCK_DEVIATION).
 */
#ifndef HAL_CLOCK_H
#define HAL_CLOCK_H

#include <stdint.h>

#include "hal/hal.h"

/** Milliseconds since an arbitrary moment; wraps from UINT32_MAX to 0 every 49.7 days and never goes backwards. */
uint32_t hal_clock_now_ms(hal_t *hal);

#endif

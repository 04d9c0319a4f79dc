/**
 * @file clock.h
 * The clock. Read by programs only: the core takes its time as an argument.
 */
#ifndef HAL_CLOCK_H
#define HAL_CLOCK_H

#include <stdint.h>

#include "hal/hal.h"

/** Milliseconds since an arbitrary moment; wraps from UINT32_MAX to 0 every 49.7 days and never goes backwards. */
uint32_t hal_clock_now_ms(hal_t *hal);

#endif

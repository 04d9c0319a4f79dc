/**
 * @file reset.h
 * Why the MCU started.
 *
 * A push button on a pin that resets as remote button 1 does (HW-3) has no function yet.
 */
#ifndef HAL_RESET_H
#define HAL_RESET_H

#include "hal/hal.h"

/** Cause of the last reset. Whatever a port cannot tell apart is HAL_RESET_UNKNOWN, never HAL_RESET_POWER_ON. */
typedef enum {
    HAL_RESET_POWER_ON,
    HAL_RESET_WATCHDOG,
    HAL_RESET_BROWN_OUT,
    HAL_RESET_LOCK_UP,
    HAL_RESET_SOFTWARE,
    HAL_RESET_UNKNOWN
} hal_reset_cause_t;

/** The cause, read once from the hardware at boot and the same for the whole run. */
hal_reset_cause_t hal_reset_cause(hal_t *hal);

#endif

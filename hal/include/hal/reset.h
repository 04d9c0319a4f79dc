/**
 * @file reset.h
 * The cause of the last MCU reset. (The button that resets the supervisor is in inputs.h.)
 */
#ifndef HAL_RESET_H
#define HAL_RESET_H

#include "hal/hal.h"

/** A reset cause. A port reports HAL_RESET_POWER_ON only if it is certain, HAL_RESET_UNKNOWN if it cannot tell. */
typedef enum {
    HAL_RESET_POWER_ON,
    HAL_RESET_WATCHDOG,
    HAL_RESET_BROWN_OUT,
    HAL_RESET_LOCK_UP,
    HAL_RESET_SOFTWARE,
    HAL_RESET_UNKNOWN
} hal_reset_cause_t;

/** The cause of the last reset. The port reads it once from the hardware at boot; it never changes in a run. */
hal_reset_cause_t hal_reset_cause(hal_t *hal);

#endif

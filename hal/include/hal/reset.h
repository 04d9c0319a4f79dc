/**
 * @file reset.h
 * The cause of the last reset of the microcontroller. (The button that resets the supervisor is in inputs.h.)
 */
#ifndef HAL_RESET_H
#define HAL_RESET_H

#include "hal/hal.h"

/** A reset cause. A port reports HAL_RESET_POWER_ON only if it is certain, HAL_RESET_UNKNOWN if it does not know. */
typedef enum {
    HAL_RESET_POWER_ON, /**< the only cause after which the supervisor may start in INIT (FSM-7) */
    HAL_RESET_WATCHDOG,
    HAL_RESET_BROWN_OUT, /**< the supply was too low for a moment */
    HAL_RESET_LOCK_UP, /**< the processor could not go on: a fault in a fault handler, or the port ended the run (hal_end_t) */
    HAL_RESET_SOFTWARE, /**< the application asked for it; an end by the port itself is HAL_RESET_LOCK_UP */
    HAL_RESET_UNKNOWN
} hal_reset_cause_t;

/** How a port itself ended a run. The numbers are stored in the flight recorder (AGV_EVENT_CRASH). */
typedef enum {
    HAL_END_UNKNOWN = 0, /**< the port did not end it: a reset from outside, or by hardware */
    HAL_END_TASK_WATCHDOG = 1,
    HAL_END_PROCESSOR = 2, /**< a fault exception */
    HAL_END_INTERRUPT = 3, /**< an interrupt without a handler */
    HAL_END_STACK = 4,
    HAL_END_ASSERTION = 5, /**< the program counter is the place of the assertion */
    HAL_END_KERNEL = 6,    /**< oops or panic */
    HAL_END_NMI = 7,
    HAL_END_CLOCK = 8,            /**< the oscillator failed */
    HAL_END_FLASH_ECC = 9,        /**< two wrong bits in a word of the flash */
    HAL_END_RAM_PARITY = 10,      /**< a wrong bit in the RAM */
    HAL_END_WINDOW_WATCHDOG = 11, /**< not fed in time; when fed too early, it resets without this note */
    HAL_ENDS
} hal_end_t;

/** The cause of the last reset. The port reads it once from the hardware at boot; it never changes in a run. */
hal_reset_cause_t hal_reset_cause(hal_t *hal);

#endif

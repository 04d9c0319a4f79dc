/**
 * @file self_test.h
 * The self-test of the target (HW-4). The port tests at boot, and continues in the background.
 */
#ifndef HAL_SELF_TEST_H
#define HAL_SELF_TEST_H

#include <stdint.h>

#include "hal/hal.h"

/** Parts that are tested: bits. The supervisor adds HAL_SELF_TEST_CORE itself. */
#define HAL_SELF_TEST_FLASH 0x01u     /**< the program: CRC-32 against the one made at build time */
#define HAL_SELF_TEST_RAM 0x02u       /**< march test of the supervisor's RAM */
#define HAL_SELF_TEST_PROCESSOR 0x04u /**< registers */
#define HAL_SELF_TEST_WATCHDOG 0x08u  /**< the watchdog could not be started */
#define HAL_SELF_TEST_DEVICES 0x10u   /**< a CAN controller or a pin could not be set up */
#define HAL_SELF_TEST_CORE 0x20u      /**< the supervisor's own test of codec and gate failed */
#define HAL_SELF_TEST_SUPPLY 0x40u    /**< the brown-out level is below the one that the build asks for */

/**
 * Run the next slice of the background test, in a small part of a tick. Called once at the start, before the first frame is
 * sent, and then at every tick. The whole flash is tested within 60 s.
 * @return the parts that have failed since boot, HAL_SELF_TEST_* bits; a part that a port cannot test is never among them
 */
uint32_t hal_self_test(hal_t *hal);

#endif

/**
 * @file zephyr_chip.h
 * What a chip can do for its own safety and Zephyr has no driver for: brown-out level, parity and error correction of RAM and
 * flash, the window of a watchdog. Implemented for STM32; on other chips the functions say that there is nothing.
 */
#ifndef HAL_ZEPHYR_ZEPHYR_CHIP_H
#define HAL_ZEPHYR_ZEPHYR_CHIP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "hal/reset.h"

/** What the option bytes of the chip say. */
typedef struct {
    int8_t brown_out_level; /**< 0 = the lowest (STM32H7: off) to 4; -1: not known */
    int8_t ram_parity;      /**< 1: checked, 0: not checked; -1: the RAM has none, or it is not known */
} zephyr_chip_options_t;

/** A region of RAM. */
typedef struct {
    uintptr_t start; /**< aligned to 8 bytes */
    size_t size;     /**< in bytes, a multiple of 8 */
} zephyr_chip_ram_t;

/** Read the option bytes. On a chip without them both members are -1. */
zephyr_chip_options_t zephyr_chip_options(void);

/**
 * Begin to watch the RAM's error correction. After a power-on the check bits are random, so all of the RAM is written once,
 * with what it holds. Call it while nothing else runs.
 */
void zephyr_chip_watch_ram(const zephyr_chip_ram_t *regions, size_t count);

/** Whether the RAM has had an error that could not be corrected, since it is watched. */
bool zephyr_chip_ram_has_failed(void);

/** What ended the run, in an NMI. */
hal_end_t zephyr_chip_reason_of_nmi(void);

/**
 * Clear an NMI's error that is expected: an ECC error of the flash while @p is_flash_read, because a power cut can tear a
 * record, and the self-test reports a program that is damaged; a parity error while @p is_ram_new, because after a power-on the RAM that outlives a reset is random.
 * @return false: there is none
 */
bool zephyr_chip_expects_nmi(bool is_flash_read, bool is_ram_new);

/**
 * Set the lower limit of a window watchdog that has been set up to expire after @p expires_ms, where its driver sets none.
 * @param base address of its registers; @p opens_ms below @p expires_ms
 */
void zephyr_chip_open_window(uintptr_t base, uint32_t opens_ms, uint32_t expires_ms);

#endif

/* hal/reset.h, the end of the run before, and the latch of hal/store.h: memory that a reset does not clear. */
#include <string.h>

#include <zephyr/drivers/hwinfo.h>
#include <zephyr/sys/crc.h>

#include "zephyr_hal_internal.h"

/* Retained memory for zephyr_hal_die(), which may run in any context. Set once, at the start. */
static zephyr_hal_retained_t *notes;

static uint32_t latch_checksum(const zephyr_hal_retained_t *retained) {
    return crc32_ieee((const uint8_t *)retained, offsetof(zephyr_hal_retained_t, latch_checksum));
}

static uint32_t end_checksum(const zephyr_hal_end_t *end) {
    return ~crc32_ieee((const uint8_t *)end, sizeof *end);
}

void zephyr_reset_note(const zephyr_hal_end_t *end) {
    if (notes != NULL) {
        notes->end = *end;
        notes->end_checksum = end_checksum(end);
    }
}

/* Read and clear how the port itself ended the last run. */
static zephyr_hal_end_t take_end(zephyr_hal_retained_t *retained) {
    const zephyr_hal_end_t end = retained->end;
    const bool valid = (retained->end_checksum == end_checksum(&end)) && (end.reason < (uint32_t)HAL_ENDS);
    retained->end_checksum = ~end_checksum(&end);
    return valid ? end : (zephyr_hal_end_t){.reason = HAL_END_UNKNOWN};
}

/* The cause of a software reset: the port itself requested it, or another part of the program. */
static hal_reset_cause_t cause_of_end(const zephyr_hal_end_t *end) {
    if (end->reason == (uint32_t)HAL_END_UNKNOWN) {
        return HAL_RESET_SOFTWARE;
    }
    return (end->reason == (uint32_t)HAL_END_TASK_WATCHDOG) ? HAL_RESET_WATCHDOG : HAL_RESET_LOCK_UP;
}

/* Where a brown-out has no flag of its own, it may look like a power-on. */
static bool power_on_is_certain(void) {
    uint32_t supported = 0u;
    const bool known = hwinfo_get_supported_reset_cause(&supported) == 0;
    return !IS_ENABLED(CONFIG_AGV_BROWN_OUT_IS_POWER_ON) && known && ((supported & RESET_BROWNOUT) != 0u);
}

/*
 * The flags accumulate until they are cleared. A power-on is reported only if no later reset set another flag. A
 * power-on itself may also set the flags of brown-out and reset pin.
 */
static hal_reset_cause_t cause_of(uint32_t flags, hal_reset_cause_t noted) {
    const uint32_t with_power_on = RESET_POR | RESET_BROWNOUT | RESET_PIN;
    if ((flags & RESET_WATCHDOG) != 0u) {
        return HAL_RESET_WATCHDOG;
    }
    if ((flags & RESET_CPU_LOCKUP) != 0u) {
        return HAL_RESET_LOCK_UP;
    }
    if ((flags & RESET_SOFTWARE) != 0u) {
        return noted;
    }
    if ((flags & RESET_POR) != 0u) {
        const bool is_alone = (flags & ~with_power_on) == 0u;
        return (is_alone && power_on_is_certain()) ? HAL_RESET_POWER_ON : HAL_RESET_UNKNOWN;
    }
    return ((flags & RESET_BROWNOUT) != 0u) ? HAL_RESET_BROWN_OUT : HAL_RESET_UNKNOWN;
}

hal_reset_cause_t zephyr_reset_read(zephyr_hal_retained_t *retained, zephyr_hal_end_t *end) {
    uint32_t flags = 0u;
    notes = retained;
    *end = take_end(retained);
    const bool known = hwinfo_get_reset_cause(&flags) == 0;
    if (known) {
        (void)hwinfo_clear_reset_cause();
    }
    if (IS_ENABLED(CONFIG_AGV_EVERY_START_IS_POWER_ON)) {
        return HAL_RESET_POWER_ON;
    }
    return known ? cause_of(flags, cause_of_end(end)) : HAL_RESET_UNKNOWN;
}

hal_reset_cause_t hal_reset_cause(hal_t *hal) {
    return hal->reset_cause;
}

/* With a wrong checksum: after a power-on the content is random, so nothing is stored. After any other reset the
 * content is returned as it is, and the supervisor detects that it is corrupt. */
size_t hal_store_read_latch(hal_t *hal, void *record, size_t size) {
    const zephyr_hal_retained_t *const retained = hal->retained;
    const bool fits =
        (retained->latch_size <= sizeof retained->latch) && (retained->latch_checksum == latch_checksum(retained));
    if (!fits && (hal->reset_cause == HAL_RESET_POWER_ON)) {
        return 0u;
    }
    const size_t stored = fits ? retained->latch_size : sizeof retained->latch;
    (void)memcpy(record, retained->latch, MIN(size, stored));
    return stored;
}

bool hal_store_write_latch(hal_t *hal, const void *record, size_t size) {
    zephyr_hal_retained_t *const retained = hal->retained;
    if ((size == 0u) || (size > sizeof retained->latch)) {
        return false;
    }
    retained->latch_size = size;
    (void)memcpy(retained->latch, record, size);
    retained->latch_checksum = latch_checksum(retained);
    return true;
}

/* hal_zephyr/zephyr_chip.h for a chip that has nothing of it, or whose registers the port does not know. */
#include "hal_zephyr/zephyr_chip.h"

zephyr_chip_options_t zephyr_chip_options(void) {
    return (zephyr_chip_options_t){.brown_out_level = -1, .ram_parity = -1};
}

void zephyr_chip_watch_ram(const zephyr_chip_ram_t *regions, size_t count) {
    (void)regions;
    (void)count;
}

bool zephyr_chip_ram_has_failed(void) {
    return false;
}

hal_end_t zephyr_chip_reason_of_nmi(void) {
    return HAL_END_NMI;
}

bool zephyr_chip_expects_nmi(bool is_flash_read, bool is_ram_new) {
    (void)is_flash_read;
    (void)is_ram_new;
    return false;
}

void zephyr_chip_open_window(uintptr_t base, uint32_t opens_ms, uint32_t expires_ms) {
    (void)base;
    (void)opens_ms;
    (void)expires_ms;
}

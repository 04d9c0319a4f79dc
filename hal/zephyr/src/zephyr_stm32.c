/* hal_zephyr/zephyr_chip.h for STM32: registers that Zephyr has no driver for. */
#include <soc.h>
#include <stm32_ll_rcc.h>
#include <stm32_ll_wwdg.h>

#include "hal_zephyr/zephyr_chip.h"

#if defined(FLASH_OPTR_BOR_EN) /* G0: a switch, and levels above the lowest */
static int8_t brown_out_level(void) {
    const uint32_t level = (FLASH->OPTR & FLASH_OPTR_BORF_LEV_Msk) >> FLASH_OPTR_BORF_LEV_Pos;
    return ((FLASH->OPTR & FLASH_OPTR_BOR_EN) != 0u) ? (int8_t)(level + 1u) : 0;
}
#elif defined(FLASH_OPTR_BOR_LEV_Msk)  /* G4 */
static int8_t brown_out_level(void) {
    return (int8_t)((FLASH->OPTR & FLASH_OPTR_BOR_LEV_Msk) >> FLASH_OPTR_BOR_LEV_Pos);
}
#elif defined(FLASH_OPTSR_BOR_LEV_Msk) /* H7 */
static int8_t brown_out_level(void) {
    return (int8_t)((FLASH->OPTSR_CUR & FLASH_OPTSR_BOR_LEV_Msk) >> FLASH_OPTSR_BOR_LEV_Pos);
}
#else
static int8_t brown_out_level(void) {
    return -1;
}
#endif

/* The option is stored inverted. */
#if defined(FLASH_OPTR_SRAM_PE)
static int8_t ram_parity(void) {
    return ((FLASH->OPTR & FLASH_OPTR_SRAM_PE) == 0u) ? 1 : 0;
}
#elif defined(FLASH_OPTR_RAM_PARITY_CHECK)
static int8_t ram_parity(void) {
    return ((FLASH->OPTR & FLASH_OPTR_RAM_PARITY_CHECK) == 0u) ? 1 : 0;
}
#else
static int8_t ram_parity(void) {
    return -1;
}
#endif

zephyr_chip_options_t zephyr_chip_options(void) {
    return (zephyr_chip_options_t){.brown_out_level = brown_out_level(), .ram_parity = ram_parity()};
}

#if defined(CONFIG_AGV_RAM_ECC)
/* Of the RAM that the program uses: AXI SRAM, and both halves of the DTCM. */
static RAMECC_MonitorTypeDef *const monitors[] = {RAMECC1_Monitor1, RAMECC1_Monitor3, RAMECC1_Monitor4};
enum { MONITORS = sizeof monitors / sizeof monitors[0] };

static void write_once(const zephyr_chip_ram_t *region) {
    /* NOLINTNEXTLINE(performance-no-int-to-ptr): an address of the chip */
    volatile uint64_t *const words = (volatile uint64_t *)region->start;
    for (size_t i = 0u; i < (region->size / sizeof *words); i++) {
        const uint64_t word = words[i];
        words[i] = word;
    }
}

void zephyr_chip_watch_ram(const zephyr_chip_ram_t *regions, size_t count) {
    for (size_t i = 0u; i < count; i++) {
        write_once(&regions[i]);
    }
    for (size_t i = 0u; i < (size_t)MONITORS; i++) {
        monitors[i]->CR |= RAMECC_CR_ECCELEN;
        monitors[i]->SR = 0u; /* written 0: cleared */
    }
}

bool zephyr_chip_ram_has_failed(void) {
    uint32_t status = 0u;
    for (size_t i = 0u; i < (size_t)MONITORS; i++) {
        status |= monitors[i]->SR;
    }
    return (status & (RAMECC_SR_DEDF | RAMECC_SR_DEBWDF)) != 0u;
}
#else
void zephyr_chip_watch_ram(const zephyr_chip_ram_t *regions, size_t count) {
    (void)regions;
    (void)count;
}

bool zephyr_chip_ram_has_failed(void) {
    return false;
}
#endif

/* Each flag is cleared by writing 1. */
#if defined(FLASH_ECCR_ECCD)
static bool flash_has_failed(bool clear) {
    const bool failed = (FLASH->ECCR & FLASH_ECCR_ECCD) != 0u;
    if (failed && clear) {
        FLASH->ECCR |= FLASH_ECCR_ECCD;
    }
    return failed;
}
#else
static bool flash_has_failed(bool clear) {
    (void)clear;
    return false;
}
#endif

#if defined(SYSCFG_CFGR2_SPF)
static bool parity_has_failed(bool clear) {
    const bool failed = (SYSCFG->CFGR2 & SYSCFG_CFGR2_SPF) != 0u;
    if (failed && clear) {
        SYSCFG->CFGR2 |= SYSCFG_CFGR2_SPF;
    }
    return failed;
}
#else
static bool parity_has_failed(bool clear) {
    (void)clear;
    return false;
}
#endif

hal_end_t zephyr_chip_reason_of_nmi(void) {
#if defined(CONFIG_AGV_CLOCK_SECURITY)
    if (LL_RCC_IsActiveFlag_HSECSS() != 0u) {
        LL_RCC_ClearFlag_HSECSS();
        return HAL_END_CLOCK;
    }
#endif
    if (flash_has_failed(false)) {
        return HAL_END_FLASH_ECC;
    }
    return parity_has_failed(true) ? HAL_END_RAM_PARITY : HAL_END_NMI;
}

bool zephyr_chip_expects_nmi(bool is_flash_read, bool is_ram_new) {
    const bool record = is_flash_read && flash_has_failed(true);
    const bool ram = is_ram_new && parity_has_failed(true);
    return record || ram;
}

/* The counter goes down from its start, and resets the chip below 0x40; above the window it must not be reloaded. */
void zephyr_chip_open_window(uintptr_t base, uint32_t opens_ms, uint32_t expires_ms) {
    enum { LAST = 0x3F };
    /* NOLINTNEXTLINE(performance-no-int-to-ptr): an address of the chip */
    WWDG_TypeDef *const watchdog = (WWDG_TypeDef *)base;
    const uint32_t start = LL_WWDG_GetCounter(watchdog);
    LL_WWDG_SetWindow(watchdog, start - (((start - (uint32_t)LAST) * opens_ms) / expires_ms));
#if defined(RCC_GCR_WW1RSC)
    LL_RCC_WWDG1_EnableSystemReset();
#endif
    /* Zephyr 3.7's driver enables its interrupt before the watchdog has a clock, which has no effect. */
    LL_WWDG_ClearFlag_EWKUP(watchdog);
    LL_WWDG_EnableIT_EWKUP(watchdog);
}

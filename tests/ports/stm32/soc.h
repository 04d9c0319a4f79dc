/**
 * @file soc.h
 * In place of ST's header: the registers that hal/zephyr/src/zephyr_stm32.c uses, in memory. Positions of the bits are those of
 * the reference manuals RM0440 (STM32G4, TEST_G4) and RM0433 (STM32H743, TEST_H7).
 */
#ifndef TEST_STM32_SOC_H
#define TEST_STM32_SOC_H

#include <stdint.h>

typedef struct {
    uint32_t OPTR;
    uint32_t ECCR;
    uint32_t OPTSR_CUR;
    unsigned uses;
} FLASH_TypeDef;

typedef struct {
    uint32_t CFGR2;
    unsigned uses;
} SYSCFG_TypeDef;

typedef struct {
    uint32_t CR;
    uint32_t CFR;
    uint32_t SR;
} WWDG_TypeDef;

typedef struct {
    uint32_t CR;
    uint32_t SR;
} RAMECC_MonitorTypeDef;

extern FLASH_TypeDef test_flash;
extern SYSCFG_TypeDef test_syscfg;
extern RAMECC_MonitorTypeDef test_monitors[5];

/* Each use is counted: a flag that is cleared by writing 1 does not change in memory. */
#define FLASH (test_flash.uses++, &test_flash)
#define SYSCFG (test_syscfg.uses++, &test_syscfg)

#if defined(TEST_G4)
#define FLASH_OPTR_BOR_LEV_Pos 8u
#define FLASH_OPTR_BOR_LEV_Msk (7u << 8)
#define FLASH_OPTR_SRAM_PE (1u << 24)
#define FLASH_ECCR_ECCD (1u << 31)
#define SYSCFG_CFGR2_SPF (1u << 8)
#else
#define FLASH_OPTSR_BOR_LEV_Pos 2u
#define FLASH_OPTSR_BOR_LEV_Msk (3u << 2)
#define RAMECC1_Monitor1 (&test_monitors[0])
#define RAMECC1_Monitor3 (&test_monitors[2])
#define RAMECC1_Monitor4 (&test_monitors[3])
#define RAMECC_CR_ECCELEN (1u << 5)
#define RAMECC_SR_DEDF (1u << 1)
#define RAMECC_SR_DEBWDF (1u << 2)
#define RCC_GCR_WW1RSC 1u
#endif

#endif

/**
 * @file stm32_ll_rcc.h
 * In place of ST's header.
 */
#ifndef TEST_STM32_LL_RCC_H
#define TEST_STM32_LL_RCC_H

#include <stdint.h>

uint32_t LL_RCC_IsActiveFlag_HSECSS(void);
void LL_RCC_ClearFlag_HSECSS(void);
void LL_RCC_WWDG1_EnableSystemReset(void);

#endif

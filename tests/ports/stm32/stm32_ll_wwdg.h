/**
 * @file stm32_ll_wwdg.h
 * In place of ST's header.
 */
#ifndef TEST_STM32_LL_WWDG_H
#define TEST_STM32_LL_WWDG_H

#include "soc.h"

static inline uint32_t LL_WWDG_GetCounter(const WWDG_TypeDef *watchdog) {
    return watchdog->CR & 0x7Fu;
}

static inline void LL_WWDG_SetWindow(WWDG_TypeDef *watchdog, uint32_t window) {
    watchdog->CFR = (watchdog->CFR & ~0x7Fu) | window;
}

static inline void LL_WWDG_ClearFlag_EWKUP(WWDG_TypeDef *watchdog) {
    watchdog->SR &= ~0x1u;
}

static inline void LL_WWDG_EnableIT_EWKUP(WWDG_TypeDef *watchdog) {
    watchdog->CFR |= 0x200u;
}

#endif

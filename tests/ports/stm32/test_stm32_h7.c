/* What the Zephyr port reads and writes on an STM32H743 itself. */
#include <string.h>

#include "hal_zephyr/zephyr_chip.h"
#include "soc.h"
#include "stm32_ll_rcc.h"
#include "unity.h"

enum { SINGLE = 1, DOUBLE = 2, DOUBLE_IN_A_PARTIAL_WRITE = 4, LATCH = 0x20 };

FLASH_TypeDef test_flash;
SYSCFG_TypeDef test_syscfg;
RAMECC_MonitorTypeDef test_monitors[5];
static uint32_t resets_enabled;

void LL_RCC_WWDG1_EnableSystemReset(void) {
    resets_enabled++;
}

void setUp(void) {
    memset(test_monitors, 0, sizeof test_monitors);
    resets_enabled = 0;
}

void tearDown(void) {
}

void test_the_option_bytes(void) {
    test_flash.OPTSR_CUR = 0x1BC6AAF0u;
    TEST_ASSERT_EQUAL_INT8(0, zephyr_chip_options().brown_out_level);
    test_flash.OPTSR_CUR = 0x1BC6AAFCu;
    TEST_ASSERT_EQUAL_INT8(3, zephyr_chip_options().brown_out_level);
    TEST_ASSERT_EQUAL_INT8(-1, zephyr_chip_options().ram_parity);
}

void test_an_nmi_has_no_reason_and_none_is_expected(void) {
    TEST_ASSERT_EQUAL_INT(HAL_END_NMI, zephyr_chip_reason_of_nmi());
    TEST_ASSERT_FALSE(zephyr_chip_expects_nmi(true, true));
}

/* Shows: HW-4 */
void test_the_watch_begins_without_the_errors_of_unwritten_memory(void) {
    uint64_t memory[2][4] = {{1, 2, 3, 4}, {UINT64_MAX, 6, 7, 8}};
    const uint64_t before[2][4] = {{1, 2, 3, 4}, {UINT64_MAX, 6, 7, 8}};
    const zephyr_chip_ram_t regions[] = {{.start = (uintptr_t)memory[0], .size = sizeof memory[0]},
                                         {.start = (uintptr_t)memory[1], .size = sizeof memory[1]}};
    test_monitors[0].SR = DOUBLE;
    test_monitors[2].SR = DOUBLE_IN_A_PARTIAL_WRITE;
    zephyr_chip_watch_ram(regions, 2);
    TEST_ASSERT_EQUAL_MEMORY(before, memory, sizeof memory);
    TEST_ASSERT_FALSE(zephyr_chip_ram_has_failed());
    TEST_ASSERT_EQUAL_HEX32(LATCH, test_monitors[0].CR);
    TEST_ASSERT_EQUAL_HEX32(LATCH, test_monitors[2].CR);
    TEST_ASSERT_EQUAL_HEX32(LATCH, test_monitors[3].CR);
}

/* AXI SRAM, and both halves of the DTCM. The program uses no other RAM. */
/* Shows: HW-4 */
void test_an_error_that_cannot_be_corrected_is_a_failure(void) {
    static const uint32_t used[] = {0, 2, 3};
    for (uint32_t i = 0; i < 3; i++) {
        test_monitors[used[i]].SR = SINGLE;
        TEST_ASSERT_FALSE(zephyr_chip_ram_has_failed());
        test_monitors[used[i]].SR = SINGLE | DOUBLE;
        TEST_ASSERT_TRUE(zephyr_chip_ram_has_failed());
        test_monitors[used[i]].SR = DOUBLE_IN_A_PARTIAL_WRITE;
        TEST_ASSERT_TRUE(zephyr_chip_ram_has_failed());
        test_monitors[used[i]].SR = 0;
    }
    test_monitors[1].SR = DOUBLE;
    test_monitors[4].SR = DOUBLE;
    TEST_ASSERT_FALSE(zephyr_chip_ram_has_failed());
}

/* Without its system reset the watchdog of this chip would only set a flag. */
void test_the_window_of_the_watchdog(void) {
    WWDG_TypeDef watchdog = {.CR = 0x7Fu, .CFR = 0x7Fu};
    zephyr_chip_open_window((uintptr_t)&watchdog, 10, 140);
    TEST_ASSERT_EQUAL_HEX32(0x27Bu, watchdog.CFR);
    TEST_ASSERT_EQUAL_UINT32(1, resets_enabled);
}

/* What the Zephyr port reads and writes on an STM32G4 itself. */
#include "hal_zephyr/zephyr_chip.h"
#include "soc.h"
#include "stm32_ll_rcc.h"
#include "unity.h"

FLASH_TypeDef test_flash;
SYSCFG_TypeDef test_syscfg;
static uint32_t clock_flag;

uint32_t LL_RCC_IsActiveFlag_HSECSS(void) {
    return clock_flag;
}

void LL_RCC_ClearFlag_HSECSS(void) {
    clock_flag = 0;
}

void setUp(void) {
    test_flash = (FLASH_TypeDef){0};
    test_syscfg = (SYSCFG_TypeDef){0};
    clock_flag = 0;
}

void tearDown(void) {
}

/* Option bytes as they leave the factory: level 0, parity not checked. */
void test_the_option_bytes(void) {
    test_flash.OPTR = 0xFFEFF8AAu;
    TEST_ASSERT_EQUAL_INT8(0, zephyr_chip_options().brown_out_level);
    TEST_ASSERT_EQUAL_INT8(0, zephyr_chip_options().ram_parity);
    test_flash.OPTR = 0xFEEFFCAAu;
    TEST_ASSERT_EQUAL_INT8(4, zephyr_chip_options().brown_out_level);
    TEST_ASSERT_EQUAL_INT8(1, zephyr_chip_options().ram_parity);
}

void test_an_nmi_without_a_flag(void) {
    TEST_ASSERT_EQUAL_INT(HAL_END_NMI, zephyr_chip_reason_of_nmi());
    TEST_ASSERT_FALSE(zephyr_chip_expects_nmi(true, true));
}

void test_an_nmi_of_the_oscillator(void) {
    clock_flag = 1;
    TEST_ASSERT_FALSE(zephyr_chip_expects_nmi(true, true));
    TEST_ASSERT_EQUAL_INT(HAL_END_CLOCK, zephyr_chip_reason_of_nmi());
    TEST_ASSERT_EQUAL_UINT32(0, clock_flag);
}

/* What was done with a flag, by the number of uses of its register: looked at it, and written 1, which clears it. */
enum { NOTHING = 0, LEFT = 1, CLEARED = 2 };

static void expect_flash(unsigned done) {
    TEST_ASSERT_EQUAL_UINT(done, test_flash.uses);
    TEST_ASSERT_EQUAL_HEX32(0x80000000u, test_flash.ECCR); /* 0 would leave the flag */
    test_flash.uses = 0;
}

static void expect_parity(unsigned done) {
    TEST_ASSERT_EQUAL_UINT(done, test_syscfg.uses);
    TEST_ASSERT_EQUAL_HEX32(0x100u, test_syscfg.CFGR2);
    test_syscfg.uses = 0;
}

/* Expected while the log is read, and only then. */
void test_an_nmi_of_the_flash(void) {
    test_flash.ECCR = 0x80000000u;
    TEST_ASSERT_FALSE(zephyr_chip_expects_nmi(false, true));
    expect_flash(NOTHING);
    TEST_ASSERT_EQUAL_INT(HAL_END_FLASH_ECC, zephyr_chip_reason_of_nmi());
    expect_flash(LEFT);
    TEST_ASSERT_TRUE(zephyr_chip_expects_nmi(true, false));
    expect_flash(CLEARED);
}

/* Expected while memory is tested that was never written, and only then. */
void test_an_nmi_of_the_ram(void) {
    test_syscfg.CFGR2 = 0x100u;
    TEST_ASSERT_FALSE(zephyr_chip_expects_nmi(true, false));
    expect_parity(NOTHING);
    TEST_ASSERT_EQUAL_INT(HAL_END_RAM_PARITY, zephyr_chip_reason_of_nmi());
    expect_parity(CLEARED);
    TEST_ASSERT_TRUE(zephyr_chip_expects_nmi(false, true));
    expect_parity(CLEARED);
}

void test_there_is_no_error_correction_of_ram(void) {
    zephyr_chip_watch_ram(NULL, 0);
    TEST_ASSERT_FALSE(zephyr_chip_ram_has_failed());
}

/* 45 steps of 3.08 ms from 0x6C to 0x3F are 139 ms. The first 10 ms are 3 steps. */
void test_the_window_of_the_watchdog(void) {
    WWDG_TypeDef watchdog = {.CR = 0x6Cu, .CFR = 0x387Fu, .SR = 0x1u};
    zephyr_chip_open_window((uintptr_t)&watchdog, 10, 140);
    TEST_ASSERT_EQUAL_HEX32(0x3A69u, watchdog.CFR); /* with the interrupt */
    TEST_ASSERT_EQUAL_HEX32(0, watchdog.SR);
    TEST_ASSERT_EQUAL_HEX32(0x6Cu, watchdog.CR);
}

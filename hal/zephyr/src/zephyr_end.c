/* The end of a run: faults, failed assertions and NMIs. All of them open the safety output first. */
#include <zephyr/fatal.h>
#include <zephyr/init.h>
#include <zephyr/sys/reboot.h>

#include "zephyr_hal_internal.h"

#if defined(CONFIG_CPU_CORTEX_M)
#include <cmsis_core.h>
#include <zephyr/arch/arm/nmi.h>
#endif
#if defined(CONFIG_SOC_FAMILY_STM32)
#include <soc.h>
#include <stm32_ll_bus.h>
#include <stm32_ll_rcc.h>
#endif

FUNC_NORETURN void zephyr_hal_die(hal_end_t reason, uint32_t pc, uint32_t lr) {
    (void)irq_lock(); /* otherwise the supervisor's thread could run once more, and close the output again */
    zephyr_output_open_now();
    zephyr_reset_note(&(zephyr_hal_end_t){.reason = (uint32_t)reason, .pc = pc, .lr = lr});
    sys_reboot(SYS_REBOOT_COLD);
    CODE_UNREACHABLE;
}

static hal_end_t reason_of(unsigned int fault) {
    switch (fault) {
    case K_ERR_CPU_EXCEPTION:
        return HAL_END_PROCESSOR;
    case K_ERR_SPURIOUS_IRQ:
        return HAL_END_INTERRUPT;
    case K_ERR_STACK_CHK_FAIL:
        return HAL_END_STACK;
    case K_ERR_KERNEL_OOPS:
    case K_ERR_KERNEL_PANIC:
        return HAL_END_KERNEL;
    default:
        return HAL_END_PROCESSOR; /* a fault that the architecture describes in more detail */
    }
}

/* Zephyr calls this after a processor fault, a kernel panic or a stack overflow. */
void k_sys_fatal_error_handler(unsigned int reason, const struct arch_esf *esf) {
    uint32_t pc = 0u;
    uint32_t lr = 0u;
#if defined(CONFIG_CPU_CORTEX_M)
    if (esf != NULL) {
        pc = esf->basic.pc;
        lr = esf->basic.lr;
    }
#else
    ARG_UNUSED(esf);
#endif
    zephyr_hal_die(reason_of(reason), pc, lr);
}

#if defined(CONFIG_ASSERT)
/* In place of Zephyr's own one: the program counter is that of the assertion, not of a panic. */
#if defined(CONFIG_ASSERT_NO_FILE_INFO)
void assert_post_action(void) {
#else
void assert_post_action(const char *file, unsigned int line) {
    ARG_UNUSED(file);
    ARG_UNUSED(line);
#endif
    zephyr_hal_die(HAL_END_ASSERTION, (uint32_t)(uintptr_t)__builtin_return_address(0), 0u);
}
#endif

#if defined(CONFIG_CPU_CORTEX_M)

/* Program counter and link register in the frame that the processor stored. */
enum { FRAME_LR = 5, FRAME_PC = 6 };

/* A thread was interrupted: its frame is known. Of an interrupted handler it is not. */
static const uint32_t *interrupted_frame(void) {
#if defined(SCB_ICSR_RETTOBASE_Msk)
    return ((SCB->ICSR & SCB_ICSR_RETTOBASE_Msk) != 0u) ? (const uint32_t *)__get_PSP() : NULL;
#else
    return NULL;
#endif
}

static void on_nmi(void) {
    const uint32_t *const frame = interrupted_frame();
    if (!zephyr_chip_expects_nmi(zephyr_log_is_read || zephyr_flash_is_tested, zephyr_ram_is_new)) {
        zephyr_hal_die(zephyr_chip_reason_of_nmi(), (frame != NULL) ? frame[FRAME_PC] : 0u,
                       (frame != NULL) ? frame[FRAME_LR] : 0u);
    }
}

static int handle_nmi(void) {
    z_arm_nmi_set_handler(on_nmi);
    return 0;
}

/* Twice: drivers of clocks and watchdogs set a handler of their own in between. */
SYS_INIT_NAMED(handle_nmi_at_boot, handle_nmi, PRE_KERNEL_1, 0);
SYS_INIT_NAMED(handle_nmi_again, handle_nmi, POST_KERNEL, CONFIG_AGV_OUTPUT_INIT_PRIORITY);

#if defined(CONFIG_AGV_RAM_ECC)
/* Before there are interrupts, and before a stack has a guard that cannot be written; but after Zephyr has switched on what
 * makes reading the AXI SRAM reliable (ST's errata sheet ES0392, 2.2.9). */
static int watch_ram(void) {
    static const zephyr_chip_ram_t regions[] = {
        {.start = DT_REG_ADDR(DT_CHOSEN(zephyr_sram)), .size = DT_REG_SIZE(DT_CHOSEN(zephyr_sram))},
        {.start = DT_REG_ADDR(DT_CHOSEN(zephyr_dtcm)), .size = DT_REG_SIZE(DT_CHOSEN(zephyr_dtcm))},
    };
    zephyr_chip_watch_ram(regions, ARRAY_SIZE(regions));
    return 0;
}

SYS_INIT(watch_ram, PRE_KERNEL_1, 1);
#endif

#if defined(CONFIG_AGV_RAM_PARITY)
/* The flag of a parity error is behind this clock. */
static int clock_parity_flag(void) {
    LL_APB2_GRP1_EnableClock(LL_APB2_GRP1_PERIPH_SYSCFG);
    return 0;
}

SYS_INIT(clock_parity_flag, PRE_KERNEL_1, 0);
#endif

#if defined(CONFIG_AGV_CLOCK_SECURITY)
/* An oscillator that fails raises an NMI, and the chip goes on with its internal one. */
static int watch_oscillator(void) {
    LL_RCC_HSE_EnableCSS();
    return 0;
}

SYS_INIT(watch_oscillator, POST_KERNEL, CONFIG_AGV_OUTPUT_INIT_PRIORITY);
#endif

#endif

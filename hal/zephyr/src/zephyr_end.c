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
#include <stm32_ll_rcc.h>
#endif

FUNC_NORETURN void zephyr_hal_die(zephyr_hal_reason_t reason, uint32_t pc, uint32_t lr) {
    zephyr_output_open_now();
    zephyr_reset_note(&(zephyr_hal_end_t){.reason = (uint32_t)reason, .pc = pc, .lr = lr});
    sys_reboot(SYS_REBOOT_COLD);
    CODE_UNREACHABLE;
}

const char *zephyr_hal_reason_name(uint32_t reason) {
    static const char *const names[ZEPHYR_HAL_REASONS] = {
        [ZEPHYR_HAL_NO_REASON] = "-",
        [ZEPHYR_HAL_TASK_WATCHDOG] = "task watchdog",
        [ZEPHYR_HAL_PROCESSOR] = "processor fault",
        [ZEPHYR_HAL_INTERRUPT] = "spurious interrupt",
        [ZEPHYR_HAL_STACK] = "stack overflow",
        [ZEPHYR_HAL_ASSERTION] = "failed assertion",
        [ZEPHYR_HAL_KERNEL] = "kernel panic",
        [ZEPHYR_HAL_NMI] = "NMI",
        [ZEPHYR_HAL_CLOCK] = "clock failure",
        [ZEPHYR_HAL_FLASH_ECC] = "flash ECC error",
    };
    return (reason < (uint32_t)ZEPHYR_HAL_REASONS) ? names[reason] : names[ZEPHYR_HAL_NO_REASON];
}

static zephyr_hal_reason_t reason_of(unsigned int fault) {
    switch (fault) {
    case K_ERR_CPU_EXCEPTION:
        return ZEPHYR_HAL_PROCESSOR;
    case K_ERR_SPURIOUS_IRQ:
        return ZEPHYR_HAL_INTERRUPT;
    case K_ERR_STACK_CHK_FAIL:
        return ZEPHYR_HAL_STACK;
    case K_ERR_KERNEL_OOPS:
    case K_ERR_KERNEL_PANIC:
        return ZEPHYR_HAL_KERNEL;
    default:
        return ZEPHYR_HAL_PROCESSOR; /* a fault that the architecture describes in more detail */
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
    zephyr_hal_die(ZEPHYR_HAL_ASSERTION, (uint32_t)(uintptr_t)__builtin_return_address(0), 0u);
}
#endif

#if defined(CONFIG_CPU_CORTEX_M)

#if defined(CONFIG_SOC_FAMILY_STM32) && defined(FLASH_ECCR_ECCD)
/* A record that a power cut tore can have such an error. While the log is read it is no end: its checksum finds it. */
static bool is_flash_error(void) {
    return (FLASH->ECCR & FLASH_ECCR_ECCD) != 0u;
}

static bool belongs_to_log(void) {
    const bool belongs = is_flash_error() && zephyr_log_is_read;
    if (belongs) {
        FLASH->ECCR |= FLASH_ECCR_ECCD; /* written 1: cleared */
    }
    return belongs;
}
#else
static bool is_flash_error(void) {
    return false;
}

static bool belongs_to_log(void) {
    return false;
}
#endif

static zephyr_hal_reason_t reason_of_nmi(void) {
#if defined(CONFIG_AGV_CLOCK_SECURITY)
    if (LL_RCC_IsActiveFlag_HSECSS() != 0u) {
        LL_RCC_ClearFlag_HSECSS();
        return ZEPHYR_HAL_CLOCK;
    }
#endif
    return is_flash_error() ? ZEPHYR_HAL_FLASH_ECC : ZEPHYR_HAL_NMI;
}

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
    if (!belongs_to_log()) {
        zephyr_hal_die(reason_of_nmi(), (frame != NULL) ? frame[FRAME_PC] : 0u, (frame != NULL) ? frame[FRAME_LR] : 0u);
    }
}

static int handle_nmi(void) {
    z_arm_nmi_set_handler(on_nmi);
    return 0;
}

/* Twice: drivers of clocks and watchdogs set a handler of their own in between. */
SYS_INIT_NAMED(handle_nmi_at_boot, handle_nmi, PRE_KERNEL_1, 0);
SYS_INIT_NAMED(handle_nmi_again, handle_nmi, POST_KERNEL, CONFIG_AGV_OUTPUT_INIT_PRIORITY);

#if defined(CONFIG_AGV_CLOCK_SECURITY)
/* An oscillator that fails raises an NMI, and the chip goes on with its internal one. */
static int watch_oscillator(void) {
    LL_RCC_HSE_EnableCSS();
    return 0;
}

SYS_INIT(watch_oscillator, POST_KERNEL, CONFIG_AGV_OUTPUT_INIT_PRIORITY);
#endif

#endif

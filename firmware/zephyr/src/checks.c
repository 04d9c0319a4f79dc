/* What may not be switched off, found at build time. */
#include <zephyr/devicetree.h>
#include <zephyr/sys/__assert.h>
#include <zephyr/sys/util.h>
#include <zephyr/toolchain.h>

BUILD_ASSERT(CONFIG_SYS_CLOCK_TICKS_PER_SEC >= 1000, "the kernel's clock has to tell milliseconds");

/* An application with a main() of its own decides about its heap, and in which thread the supervisor runs. */
#if !defined(CONFIG_AGV_SUPERVISOR)
BUILD_ASSERT(CONFIG_HEAP_MEM_POOL_SIZE == 0, "there is no heap");
#if !defined(CONFIG_ZTEST)
BUILD_ASSERT(CONFIG_MAIN_THREAD_PRIORITY < 0, "the supervisor is a cooperative thread");
#endif
#endif

#if !defined(CONFIG_ZTEST)
BUILD_ASSERT(CONFIG_SYSTEM_WORKQUEUE_PRIORITY >= 0, "the work queue does not keep the processor from the supervisor");
BUILD_ASSERT(IS_ENABLED(CONFIG_ARCH_POSIX) ||
                 !(IS_ENABLED(CONFIG_LOG_MODE_IMMEDIATE) || IS_ENABLED(CONFIG_LOG_MODE_MINIMAL) ||
                   IS_ENABLED(CONFIG_LOG_BLOCK_IN_THREAD) || IS_ENABLED(CONFIG_DEBUG_COREDUMP)),
             "printing would delay the supervisor, and the opening of the output after a crash");
#endif

#if defined(CONFIG_AGV_RELEASE)
BUILD_ASSERT(__ASSERT_ON != 0, "release: assertions stay on");
BUILD_ASSERT(!IS_ENABLED(CONFIG_ARCH_HAS_STACK_PROTECTION) || IS_ENABLED(CONFIG_HW_STACK_PROTECTION),
             "release: stacks are guarded");
BUILD_ASSERT(!IS_ENABLED(CONFIG_SHELL), "release: no shell");
BUILD_ASSERT(IS_ENABLED(CONFIG_WATCHDOG) && IS_ENABLED(CONFIG_TASK_WDT_HW_FALLBACK) &&
                 DT_NODE_HAS_STATUS(DT_ALIAS(watchdog0), okay),
             "release: a hardware watchdog");
BUILD_ASSERT(!IS_ENABLED(CONFIG_AGV_WITHOUT_HARDWARE_WATCHDOG) && !IS_ENABLED(CONFIG_AGV_EVERY_START_IS_POWER_ON),
             "release: not for a simulator");
#endif

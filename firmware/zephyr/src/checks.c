/* What may not be switched off, found at build time. */
#include <zephyr/devicetree.h>
#include <zephyr/sys/__assert.h>
#include <zephyr/sys/util.h>
#include <zephyr/toolchain.h>

BUILD_ASSERT(CONFIG_SYS_CLOCK_TICKS_PER_SEC >= 1000,
             "CONFIG_SYS_CLOCK_TICKS_PER_SEC must be 1000 or more: the supervisor runs every millisecond");

/* An application with a main() of its own decides about its heap, and in which thread the supervisor runs. */
#if !defined(CONFIG_AGV_SUPERVISOR)
BUILD_ASSERT(CONFIG_HEAP_MEM_POOL_SIZE == 0, "CONFIG_HEAP_MEM_POOL_SIZE must be 0: the firmware has no heap");
#if !defined(CONFIG_ZTEST)
BUILD_ASSERT(CONFIG_MAIN_THREAD_PRIORITY < 0,
             "CONFIG_MAIN_THREAD_PRIORITY must be below 0: the supervisor is a cooperative thread");
#endif
#endif

#if !defined(CONFIG_ZTEST)
BUILD_ASSERT(CONFIG_SYSTEM_WORKQUEUE_PRIORITY >= 0,
             "CONFIG_SYSTEM_WORKQUEUE_PRIORITY must be 0 or more: the work queue must not delay the supervisor");
BUILD_ASSERT(!IS_ENABLED(CONFIG_PM),
             "CONFIG_PM must be off: the supervisor runs every millisecond, on a bus that wakes nobody");
#if defined(CONFIG_LOG_PROCESS_THREAD_CUSTOM_PRIORITY)
BUILD_ASSERT(CONFIG_LOG_PROCESS_THREAD_PRIORITY >= 0,
             "CONFIG_LOG_PROCESS_THREAD_PRIORITY must be 0 or more: printing must not delay the supervisor");
#endif
#if defined(CONFIG_MCUMGR_TRANSPORT_WORKQUEUE_THREAD_PRIO)
BUILD_ASSERT(
    CONFIG_MCUMGR_TRANSPORT_WORKQUEUE_THREAD_PRIO >= 0,
    "CONFIG_MCUMGR_TRANSPORT_WORKQUEUE_THREAD_PRIO must be 0 or more: an update must not delay the supervisor");
#endif
BUILD_ASSERT(IS_ENABLED(CONFIG_ARCH_POSIX) ||
                 !(IS_ENABLED(CONFIG_LOG_MODE_IMMEDIATE) || IS_ENABLED(CONFIG_LOG_MODE_MINIMAL) ||
                   IS_ENABLED(CONFIG_LOG_BLOCK_IN_THREAD) || IS_ENABLED(CONFIG_DEBUG_COREDUMP)),
             "CONFIG_LOG_MODE_IMMEDIATE, CONFIG_LOG_MODE_MINIMAL, CONFIG_LOG_BLOCK_IN_THREAD and CONFIG_DEBUG_COREDUMP "
             "must be off: printing would delay the supervisor");
#endif

#if defined(CONFIG_AGV_RELEASE)
BUILD_ASSERT(__ASSERT_ON != 0, "release: assertions must stay on (CONFIG_ASSERT=y)");
BUILD_ASSERT(!IS_ENABLED(CONFIG_ARCH_HAS_STACK_PROTECTION) || IS_ENABLED(CONFIG_HW_STACK_PROTECTION),
             "release: CONFIG_HW_STACK_PROTECTION must be y");
BUILD_ASSERT(!IS_ENABLED(CONFIG_SHELL), "release: no shell");
BUILD_ASSERT(IS_ENABLED(CONFIG_WATCHDOG) && IS_ENABLED(CONFIG_TASK_WDT_HW_FALLBACK) &&
                 DT_NODE_HAS_STATUS(DT_ALIAS(watchdog0), okay),
             "release: CONFIG_WATCHDOG, CONFIG_TASK_WDT_HW_FALLBACK and the devicetree alias watchdog0 are needed");
BUILD_ASSERT(!IS_ENABLED(CONFIG_AGV_WITHOUT_HARDWARE_WATCHDOG) && !IS_ENABLED(CONFIG_AGV_EVERY_START_IS_POWER_ON),
             "release: a simulator cannot be a product");
#endif

/* What may not be switched off, found at build time. */
#include <zephyr/devicetree.h>
#include <zephyr/sys/util.h>
#include <zephyr/toolchain.h>

BUILD_ASSERT(CONFIG_HEAP_MEM_POOL_SIZE == 0, "there is no heap");
BUILD_ASSERT(CONFIG_SYS_CLOCK_TICKS_PER_SEC >= 1000, "the kernel's clock has to tell milliseconds");

#if defined(CONFIG_AGV_RELEASE)
BUILD_ASSERT(IS_ENABLED(CONFIG_ASSERT), "release: assertions stay on");
BUILD_ASSERT(!IS_ENABLED(CONFIG_ARCH_HAS_STACK_PROTECTION) || IS_ENABLED(CONFIG_HW_STACK_PROTECTION),
             "release: stacks are guarded");
BUILD_ASSERT(!IS_ENABLED(CONFIG_SHELL), "release: no shell");
BUILD_ASSERT(IS_ENABLED(CONFIG_WATCHDOG) && IS_ENABLED(CONFIG_TASK_WDT_HW_FALLBACK) &&
                 DT_NODE_HAS_STATUS(DT_ALIAS(watchdog0), okay),
             "release: a hardware watchdog");
BUILD_ASSERT(!IS_ENABLED(CONFIG_AGV_WITHOUT_HARDWARE_WATCHDOG) && !IS_ENABLED(CONFIG_AGV_EVERY_START_IS_POWER_ON),
             "release: not for a simulator");
#endif

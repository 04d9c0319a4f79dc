/* hal/self_test.h: the program in flash, the supervisor's RAM, and the processor's registers (HW-4). */
#include <string.h>

#include <zephyr/sys/crc.h>

#include "zephyr_hal_internal.h"

volatile bool zephyr_flash_is_tested;

#if defined(CONFIG_AGV_FLASH_TEST)

BUILD_ASSERT((CONFIG_FLASH_BASE_ADDRESS != 0) || !(IS_ENABLED(CONFIG_NULL_POINTER_EXCEPTION_DETECTION_DWT) ||
                                                   IS_ENABLED(CONFIG_NULL_POINTER_EXCEPTION_DETECTION_MPU)),
             "the program at address 0 is read: CONFIG_NULL_POINTER_EXCEPTION_DETECTION_NONE=y");

/* Bytes of a slice: few, and so many that a round at one slice a millisecond takes 50 s at most. */
enum { SLICE_MIN = 16, ROUND_MS = 50000 };

/* Written by scripts/tools/zephyr-checksum.py after the program was linked. */
const zephyr_image_sum_t zephyr_image_sum __used __attribute__((section(".rodata.zephyr_image_sum"))) = {.magic = 0u};

/* Volatile: the compiler must not use the values that it sees above. */
static const volatile zephyr_image_sum_t *const image = &zephyr_image_sum;

static uint32_t image_size(void) {
    uint32_t size = 0u;
    for (uint32_t i = 0u; i < image->count; i++) {
        size += image->ranges[i].size;
    }
    return size;
}

static bool table_is_valid(void) {
    return (image->magic == (uint32_t)ZEPHYR_IMAGE_SUM_MAGIC) && (image->count > 0u) &&
           (image->count <= (uint32_t)ZEPHYR_IMAGE_RANGES);
}

static void restart(zephyr_flash_test_t *test) {
    test->range = 0u;
    test->done = 0u;
    test->crc = 0u;
}

/* @return false: the round ended here with a wrong checksum */
static bool test_slice(zephyr_flash_test_t *test, uint32_t bytes) {
    const uint32_t left = image->ranges[test->range].size - test->done;
    const uint32_t size = MIN(bytes, left);
    const uintptr_t start = (uintptr_t)image->ranges[test->range].start + test->done;
    zephyr_flash_is_tested = true;
    test->crc = crc32_ieee_update(test->crc, (const uint8_t *)start, size);
    zephyr_flash_is_tested = false;
    test->done += size;
    if (size < left) {
        return true;
    }
    test->range++;
    test->done = 0u;
    if (test->range < image->count) {
        return true;
    }
    const bool right = test->crc == image->crc;
    restart(test);
    test->rounds++;
    return right;
}

static bool test_whole_flash(zephyr_flash_test_t *test) {
    if (!table_is_valid()) {
        return false;
    }
    restart(test);
    test->rounds = 0u;
    test->slice = MAX((uint32_t)SLICE_MIN, (image_size() / (uint32_t)ROUND_MS) + 1u);
    bool right = true;
    while (test->rounds == 0u) {
        right = test_slice(test, UINT32_MAX);
    }
    return right;
}

static bool test_flash_on(zephyr_flash_test_t *test) {
    return table_is_valid() && test_slice(test, test->slice);
}

#else

static bool test_whole_flash(zephyr_flash_test_t *test) {
    ARG_UNUSED(test);
    return true;
}

static bool test_flash_on(zephyr_flash_test_t *test) {
    ARG_UNUSED(test);
    return true;
}

#endif

/* Read each word, which must be `from`, and write `to`: upwards or downwards. */
static bool march_once(volatile uint32_t *words, size_t count, bool up, uint32_t from, uint32_t to) {
    bool right = true;
    for (size_t i = 0u; i < count; i++) {
        volatile uint32_t *const word = &words[up ? i : (count - 1u - i)];
        right = (*word == from) && right;
        *word = to;
    }
    return right;
}

/* March C- with this pattern and its complement. */
static bool march_pattern(volatile uint32_t *words, size_t count, uint32_t pattern) {
    for (size_t i = 0u; i < count; i++) {
        words[i] = pattern;
    }
    bool right = march_once(words, count, true, pattern, ~pattern);
    right = march_once(words, count, true, ~pattern, pattern) && right;
    right = march_once(words, count, false, pattern, ~pattern) && right;
    right = march_once(words, count, false, ~pattern, pattern) && right;
    return march_once(words, count, true, pattern, 0u) && right;
}

/* The patterns tell neighbouring bits of a word apart. */
bool zephyr_march(volatile uint32_t *words, size_t count) {
    const bool all = march_pattern(words, count, 0u);
    const bool pairs = march_pattern(words, count, 0x33333333u);
    return march_pattern(words, count, 0x55555555u) && all && pairs;
}

/* Memory whose content is needed: block by block, while nothing else runs. */
bool zephyr_march_kept(volatile uint32_t *words, size_t count) {
    enum { BLOCK = 16 };
    uint32_t kept[BLOCK];
    bool right = true;
    for (size_t done = 0u; done < count; done += BLOCK) {
        const size_t size = MIN((size_t)BLOCK, count - done);
        const unsigned int key = irq_lock();
        for (size_t i = 0u; i < size; i++) {
            kept[i] = words[done + i];
        }
        right = zephyr_march(&words[done], size) && right;
        for (size_t i = 0u; i < size; i++) {
            words[done + i] = kept[i];
        }
        irq_unlock(key);
    }
    return right;
}

volatile bool zephyr_ram_is_new;

static bool test_memory(const zephyr_hal_memory_t *memory) {
    volatile uint32_t *const words = memory->start;
    const size_t count = memory->size / sizeof *words;
    zephyr_ram_is_new = memory->is_kept;
    const bool right = memory->is_kept ? zephyr_march_kept(words, count) : zephyr_march(words, count);
    zephyr_ram_is_new = false;
    return right;
}

#if defined(CONFIG_AGV_BROWN_OUT_LEVEL)
static bool test_supply(void) {
    return (CONFIG_AGV_BROWN_OUT_LEVEL == 0) || (zephyr_chip_options().brown_out_level >= CONFIG_AGV_BROWN_OUT_LEVEL);
}
#else
static bool test_supply(void) {
    return true;
}
#endif

#if defined(CONFIG_CPU_CORTEX_M)
/* Whether r0 to r12 hold a value. `inverse` is its complement: both come from the caller in registers of their own. */
__attribute__((naked)) static uint32_t registers_hold(uint32_t value, uint32_t inverse) {
    __asm__ volatile(".syntax unified\n" /* gcc assembles for a Cortex-M0+ in the older syntax */
                     "push {r4-r7, lr}\n"
                     "mov r4, r8\n"
                     "mov r5, r9\n"
                     "mov r6, r10\n"
                     "mov r7, r11\n"
                     "push {r4-r7}\n"
                     "mvns r1, r1\n"
                     "cmp r0, r1\n"
                     "bne 1f\n"
                     "mov r2, r0\n"
                     "mov r3, r2\n"
                     "mov r4, r3\n"
                     "mov r5, r4\n"
                     "mov r6, r5\n"
                     "mov r7, r6\n"
                     "mov r8, r7\n"
                     "mov r9, r8\n"
                     "mov r10, r9\n"
                     "mov r11, r10\n"
                     "mov r12, r11\n"
                     "cmp r0, r12\n"
                     "bne 1f\n"
                     "cmp r1, r11\n"
                     "bne 1f\n"
                     "cmp r2, r10\n"
                     "bne 1f\n"
                     "cmp r3, r9\n"
                     "bne 1f\n"
                     "cmp r4, r8\n"
                     "bne 1f\n"
                     "cmp r5, r7\n"
                     "bne 1f\n"
                     "cmp r6, r12\n"
                     "bne 1f\n"
                     "movs r0, #1\n"
                     "b 2f\n"
                     "1: movs r0, #0\n"
                     "2: pop {r4-r7}\n"
                     "mov r8, r4\n"
                     "mov r9, r5\n"
                     "mov r10, r6\n"
                     "mov r11, r7\n"
                     "pop {r4-r7, pc}\n");
}

static bool test_registers(void) {
    static const uint32_t values[] = {0x55555555u, 0xAAAAAAAAu, 0x33333333u, 0u, UINT32_MAX};
    bool right = true;
    for (size_t i = 0u; i < ARRAY_SIZE(values); i++) {
        right = (registers_hold(values[i], ~values[i]) == 1u) && right;
    }
    return right;
}
#else
static bool test_registers(void) {
    return true;
}
#endif

uint32_t zephyr_self_test_start(const zephyr_hal_config_t *config) {
    uint32_t failed = test_registers() ? 0u : HAL_SELF_TEST_PROCESSOR;
    failed |= test_supply() ? 0u : HAL_SELF_TEST_SUPPLY;
    for (size_t i = 0u; i < config->memory_count; i++) {
        failed |= test_memory(&config->memory[i]) ? 0u : HAL_SELF_TEST_RAM;
    }
    return failed;
}

uint32_t zephyr_flash_test_start(hal_t *hal) {
    return test_whole_flash(&hal->flash_test) ? 0u : HAL_SELF_TEST_FLASH;
}

uint32_t hal_self_test(hal_t *hal) {
    hal->failed |= test_flash_on(&hal->flash_test) ? 0u : HAL_SELF_TEST_FLASH;
    hal->failed |= zephyr_chip_ram_has_failed() ? HAL_SELF_TEST_RAM : 0u;
    return hal->failed;
}

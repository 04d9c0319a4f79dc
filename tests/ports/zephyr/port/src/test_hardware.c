/* Inputs, second clock, self-test (HW-1 to HW-4). */
#include <string.h>

#include "fixture.h"
#include "zephyr_hal_internal.h"

ZTEST_SUITE(port_hardware, NULL, NULL, fixture_before, fixture_after, NULL);

static hal_inputs_t inputs(void) {
    hal_inputs_t read;
    hal_inputs_read(&hal, &read);
    return read;
}

/* Shows: HW-1, HW-2, HW-3 */
ZTEST(port_hardware, test_each_input_reads_its_own_pin) {
    for (unsigned levels = 0u; levels < 8u; levels++) {
        fake_input_set(FAKE_FEEDBACK, (levels & 1u) != 0u);
        fake_input_set(FAKE_STOP, (levels & 2u) != 0u);
        fake_input_set(FAKE_BUTTON, (levels & 4u) != 0u);
        const hal_inputs_t read = inputs();
        zassert_equal(read.output_feedback, ((levels & 1u) != 0u) ? HAL_CONTACT_CLOSED : HAL_CONTACT_OPEN);
        zassert_equal(read.emergency_stop, ((levels & 2u) != 0u) ? HAL_CONTACT_CLOSED : HAL_CONTACT_OPEN);
        zassert_equal(read.reset_button, ((levels & 4u) != 0u) ? HAL_CONTACT_OPEN : HAL_CONTACT_CLOSED, "active low");
    }
}

static uint32_t second_ms(void) {
    uint32_t time_ms = 0u;
    zassert_true(hal_clock_second_ms(&hal, &time_ms));
    return time_ms;
}

static void counter_restarts(uint32_t hz, uint32_t top, uint32_t value, bool up) {
    fake_counter_hz = hz;
    fake_counter_top = top;
    fake_counter_value = value;
    fake_counter_direction(up);
    fake_counter_error = 0;
}

static void counter_is_as_before(void) {
    counter_restarts(32768u, UINT32_MAX, 0u, true);
    (void)fixture_begin();
}

/* Shows: HW-4 */
ZTEST(port_hardware, test_the_second_clock_counts_milliseconds_over_the_counters_wrap) {
    counter_restarts(32768u, 0xFFFFu * 2u, 100u, true);
    zassert_true(fixture_begin());
    zassert_equal(second_ms(), 0u);
    fake_counter_value = 100u + 32768u;
    zassert_equal(second_ms(), 1000u);
    fake_counter_value = 100u + 65536u;
    zassert_equal(second_ms(), 2000u);
    fake_counter_value = 100u + 98304u;
    zassert_equal(second_ms(), 3000u);
    fake_counter_value = 101u; /* 131072 counts later: it wraps after 131071 */
    zassert_equal(second_ms(), 4000u);
    fake_counter_error = -EIO;
    zassert_equal(second_ms(), 4000u, "a counter that cannot be read stands still");
    counter_is_as_before();
}

/* Shows: HW-4 */
ZTEST(port_hardware, test_the_second_clock_may_count_down) {
    counter_restarts(1000u, 9999u, 500u, false);
    zassert_true(fixture_begin());
    fake_counter_value = 400u;
    zassert_equal(second_ms(), 100u);
    fake_counter_value = 9900u;
    zassert_equal(second_ms(), 600u);
    counter_is_as_before();
}

/* Shows: HW-4 */
ZTEST(port_hardware, test_a_counter_that_is_too_coarse_or_wraps_too_soon_is_refused) {
    counter_restarts(1u, UINT32_MAX, 0u, true);
    zassert_false(fixture_begin());
    zassert_equal(hal_self_test(&hal), HAL_SELF_TEST_DEVICES);
    counter_restarts(32768u, 0xFFFFu, 0u, true); /* wraps just before 2 s */
    zassert_false(fixture_begin());
    counter_is_as_before();
}

static uint32_t memory[300];

/* Shows: HW-4 */
ZTEST(port_hardware, test_the_march_clears_or_keeps_good_memory) {
    (void)memset(memory, 0x5A, sizeof memory);
    zassert_true(zephyr_march(memory, ARRAY_SIZE(memory)));
    for (size_t i = 0u; i < ARRAY_SIZE(memory); i++) {
        zassert_equal(memory[i], 0u);
        memory[i] = (uint32_t)i * 2654435761u;
    }
    zassert_true(zephyr_march_kept(memory, ARRAY_SIZE(memory)));
    for (size_t i = 0u; i < ARRAY_SIZE(memory); i++) {
        zassert_equal(memory[i], (uint32_t)i * 2654435761u);
    }
}

#if defined(CONFIG_BOARD_MPS2)
/* A register of a timer is a word of memory; the divisor of a serial port has 20 bits: the others are stuck at 0. */
#define TIMER_RELOAD ((volatile uint32_t *)0x40001008u)
#define SERIAL_DIVISOR ((volatile uint32_t *)0x40006010u)

/* Shows: HW-4 */
ZTEST(port_hardware, test_the_march_finds_bits_that_are_stuck) {
    zassert_true(zephyr_march(TIMER_RELOAD, 1u));
    zassert_false(zephyr_march(SERIAL_DIVISOR, 1u));
    zassert_false(zephyr_march_kept(SERIAL_DIVISOR, 1u));
}
#endif

#if defined(CONFIG_AGV_FLASH_TEST)
extern const volatile zephyr_image_sum_t zephyr_image_sum;

static uint32_t calls_of_a_round(void) {
    const uint32_t round = hal.flash_test.rounds;
    uint32_t calls = 0u;
    while ((hal.flash_test.rounds == round) && (calls < 60001u)) {
        zassert_equal(hal_self_test(&hal), 0u);
        calls++;
    }
    return calls;
}

/* Shows: HW-4 */
ZTEST(port_hardware, test_the_flash_is_tested_once_round_in_60_s) {
    const uint32_t calls = calls_of_a_round();
    zassert_true(calls <= 60000u);
    zassert_equal(calls_of_a_round(), calls);
    TC_PRINT("figure: background test of the flash: once round in %u ms, %u bytes a tick\n", calls,
             hal.flash_test.slice);
}

/* A place in the program where a bit can flip: this machine's flash is memory. It is not executed, and not read but here. */
static const uint32_t place[4] __used
    __attribute__((section(".rodata.place"))) = {0x11223344u, 0x55667788u, 0x99AABBCCu, 0xDDEEFF00u};

static void flip(uint32_t bit) {
    volatile uint32_t *const word = (volatile uint32_t *)&place[bit / 32u];
    *word ^= BIT(bit % 32u);
}

/* Shows: HW-4 */
ZTEST(port_hardware, test_each_flipped_bit_of_the_flash_is_found_at_the_start) {
    for (uint32_t bit = 0u; bit < 128u; bit += 9u) {
        flip(bit);
        fake_parts_reset();
        zassert_false(fixture_begin());
        zassert_equal(hal_self_test(&hal), HAL_SELF_TEST_FLASH, "bit %u", bit);
        flip(bit);
    }
    fake_parts_reset();
    zassert_true(fixture_begin());
}

/* Shows: HW-4 */
ZTEST(port_hardware, test_a_flipped_bit_of_the_flash_is_found_in_the_background_and_stays_known) {
    flip(77u);
    uint32_t calls = 0u;
    while ((hal_self_test(&hal) == 0u) && (calls < 60001u)) {
        calls++;
    }
    zassert_true(calls <= 60000u, "not found");
    flip(77u);
    for (uint32_t i = 0u; i < (2u * calls); i++) {
        zassert_equal(hal_self_test(&hal), HAL_SELF_TEST_FLASH);
    }
}

/* For docs/firmware.md: it prints instructions, and compares them with no limit. */
ZTEST(port_hardware, test_times_of_the_self_test) {
    const zephyr_hal_config_t config = {.memory_count = 0u};
    uint32_t at[6] = {k_cycle_get_32()};
    zassert_equal(zephyr_self_test_start(&config), 0u);
    at[1] = k_cycle_get_32();
    (void)zephyr_march(memory, 256u);
    at[2] = k_cycle_get_32();
    (void)zephyr_march_kept(memory, 256u);
    at[3] = k_cycle_get_32();
    zassert_equal(zephyr_flash_test_start(&hal), 0u);
    at[4] = k_cycle_get_32();
    for (uint32_t i = 0u; i < 100u; i++) {
        (void)hal_self_test(&hal);
    }
    at[5] = k_cycle_get_32();
    for (size_t i = 5u; i > 0u; i--) {
        at[i] = (at[i] - at[i - 1u]) * 5u; /* 8 ns an instruction, 40 ns a cycle of the timer */
    }
    uint32_t size = 0u;
    for (uint32_t i = 0u; i < zephyr_image_sum.count; i++) {
        size += zephyr_image_sum.ranges[i].size;
    }
    TC_PRINT("figure: instructions: registers %u, march of 1 KB %u, of 1 KB that is kept %u, flash %u for %u bytes, "
             "slice %u\n",
             at[1], at[2], at[3], at[4], size, at[5] / 100u);
}
#endif

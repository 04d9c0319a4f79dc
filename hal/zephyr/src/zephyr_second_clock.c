/* hal/clock.h: the second clock, a counter of the devicetree (second-clock). */
#include "zephyr_hal_internal.h"

#if DT_NODE_HAS_PROP(ZEPHYR_HAL_NODE, second_clock)

#include <zephyr/drivers/counter.h>

/* The core compares the clocks once a second, to 5 %: this accuracy needs some counts, and no wrap in between. */
enum { MS_PER_S = 1000, FREQUENCY_MIN = 200, WRAP_MIN_S = 2 };

static const struct device *const counter = DEVICE_DT_GET(DT_PHANDLE(ZEPHYR_HAL_NODE, second_clock));

bool zephyr_second_clock_start(hal_t *hal) {
    hal->second_counts = 0u;
    hal->second_last = 0u;
    if (!device_is_ready(counter)) {
        return false;
    }
    const uint32_t frequency = counter_get_frequency(counter);
    const int status = counter_start(counter);
    const bool runs = (status == 0) || (status == -EALREADY);
    return runs && (frequency >= (uint32_t)FREQUENCY_MIN) &&
           ((counter_get_top_value(counter) / frequency) >= (uint32_t)WRAP_MIN_S) &&
           (counter_get_value(counter, &hal->second_last) == 0);
}

/* Counts since the last call. */
static uint32_t passed(uint32_t last, uint32_t now) {
    const uint32_t from = counter_is_counting_up(counter) ? last : now;
    const uint32_t to = counter_is_counting_up(counter) ? now : last;
    return (to >= from) ? (to - from) : (counter_get_top_value(counter) - from + to + 1u);
}

/* A counter that cannot be read stands still: the core finds the deviation. */
bool hal_clock_second_ms(hal_t *hal, uint32_t *time_ms) {
    uint32_t now = 0u;
    const uint32_t frequency = counter_get_frequency(counter);
    if (counter_get_value(counter, &now) == 0) {
        hal->second_counts += passed(hal->second_last, now);
        hal->second_last = now;
    }
    *time_ms = (frequency != 0u) ? (uint32_t)((hal->second_counts * MS_PER_S) / frequency) : 0u;
    return true;
}

#else

bool zephyr_second_clock_start(hal_t *hal) {
    ARG_UNUSED(hal);
    return true;
}

bool hal_clock_second_ms(hal_t *hal, uint32_t *time_ms) {
    ARG_UNUSED(hal);
    ARG_UNUSED(time_ms);
    return false;
}

#endif

/**
 * @file units.h
 * Units of time, the clock that measures how long something takes, and that of the day.
 */
#ifndef HOST_SIM_UNITS_H
#define HOST_SIM_UNITS_H

#include <stdint.h>

enum { NS_PER_US = 1000, NS_PER_MS = 1000000, US_PER_MS = 1000, US_PER_S = 1000000, MS_PER_S = 1000 };

/** Microseconds in ms. */
static inline double ms_of_us(uint64_t us) {
    return (double)us / (double)US_PER_MS;
}

/** Microseconds in s. */
static inline double s_of_us(uint64_t us) {
    return (double)us / (double)US_PER_S;
}

/** The difference of two times as they are shown, in ms: each without its microseconds. */
static inline uint64_t shown_ms(uint64_t from_us, uint64_t to_us) {
    return (to_us / US_PER_MS) - (from_us / US_PER_MS);
}

/** Milliseconds of a clock that never goes back. */
uint64_t monotonic_ms(void);

/** The time of day: microseconds since 1970. */
uint64_t time_of_day_us(void);

#endif

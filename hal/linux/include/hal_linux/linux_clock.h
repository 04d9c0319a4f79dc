/**
 * @file linux_clock.h
 * Monotonic time since a start, and conversion of the kernel's time stamps to it.
 */
#ifndef HAL_LINUX_LINUX_CLOCK_H
#define HAL_LINUX_LINUX_CLOCK_H

#include <stdint.h>

/** The start from which time is counted. */
typedef struct {
    uint64_t start_ns; /**< CLOCK_MONOTONIC */
} linux_clock_t;

/** Start the clock now. */
void linux_clock_start(linux_clock_t *clock);

/** Microseconds since the start. */
uint64_t linux_clock_now_us(const linux_clock_t *clock);

/**
 * The receive time of a frame: now minus the age of its time stamp by CLOCK_REALTIME. A stamp that is 0, in the future,
 * before the start, or more than 60 s old (the system time was changed) counts as now. The result is never after now.
 * @param stamp_us as in linux_can_record_t
 * @return microseconds since the start
 */
uint64_t linux_clock_of_stamp(const linux_clock_t *clock, uint64_t stamp_us);

#endif

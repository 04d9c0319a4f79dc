/**
 * @file linux_clock.h
 * Time since a start, monotonic; and the kernel's time stamps in it.
 */
#ifndef HAL_LINUX_LINUX_CLOCK_H
#define HAL_LINUX_LINUX_CLOCK_H

#include <stdint.h>

/** A moment that time is counted from. */
typedef struct {
    uint64_t start_ns; /**< CLOCK_MONOTONIC */
} linux_clock_t;

/** Count from now on. */
void linux_clock_start(linux_clock_t *clock);

/** Microseconds since the start. */
uint64_t linux_clock_now_us(const linux_clock_t *clock);

/**
 * When a frame arrived: its stamp's age by CLOCK_REALTIME, taken off now. A stamp that is 0, lies in the future, before
 * the start, or more than 60 s back (the system's time was set) counts as now; the result never lies after now.
 * @param stamp_us as in linux_can_record_t
 * @return microseconds since the start
 */
uint64_t linux_clock_of_stamp(const linux_clock_t *clock, uint64_t stamp_us);

#endif

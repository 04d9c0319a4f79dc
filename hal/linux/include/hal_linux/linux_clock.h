/**
 * @file linux_clock.h
 * Monotonic time since a start, the time in which the computer slept included, and conversion of the kernel's time stamps to
 * it.
 */
#ifndef HAL_LINUX_LINUX_CLOCK_H
#define HAL_LINUX_LINUX_CLOCK_H

#include <stdint.h>

/** The start from which time is counted. */
typedef struct {
    uint64_t start_ns; /**< CLOCK_BOOTTIME */
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

/**
 * The same for a supervisor: a stamp before the start, or more than 60 s old, counts as @p last_us, so that a frame that
 * waited for so long does not look fresh.
 * @param last_us time of the frame before this one
 */
uint64_t linux_clock_of_stamp_after(const linux_clock_t *clock, uint64_t stamp_us, uint64_t last_us);

#endif

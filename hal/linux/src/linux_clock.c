#include "hal_linux/linux_clock.h"

#include <time.h>

#define NS_PER_S UINT64_C(1000000000)
#define NS_PER_US 1000u
#define AGE_MAX_US UINT64_C(60000000)
#define READINGS_MAX 3u
#define APART_MAX_NS 20000u

static uint64_t read_ns(clockid_t id) {
    struct timespec now = {0};
    return (clock_gettime(id, &now) == 0) ? (uint64_t)now.tv_sec * NS_PER_S + (uint64_t)now.tv_nsec : 0;
}

/* This clock goes on while the computer sleeps: then nothing was supervised, which must show. */
static uint64_t read_own_ns(void) {
    return read_ns(CLOCK_BOOTTIME);
}

void linux_clock_start(linux_clock_t *clock) {
    clock->start_ns = read_own_ns();
}

uint64_t linux_clock_now_us(const linux_clock_t *clock) {
    return (read_own_ns() - clock->start_ns) / NS_PER_US;
}

/* Both clocks at the same time: an interruption between the two readings would be added to the age of a frame. */
static uint64_t read_both(uint64_t *real_ns) {
    uint64_t before_ns = 0;
    for (unsigned i = 0; i < READINGS_MAX; i++) {
        before_ns = read_own_ns();
        *real_ns = read_ns(CLOCK_REALTIME);
        if (read_own_ns() - before_ns < APART_MAX_NS) {
            break;
        }
    }
    return before_ns;
}

uint64_t linux_clock_of_stamp_after(const linux_clock_t *clock, uint64_t stamp_us, uint64_t last_us) {
    uint64_t real_ns = 0;
    const uint64_t now_us = (read_both(&real_ns) - clock->start_ns) / NS_PER_US;
    const uint64_t real_us = real_ns / NS_PER_US;
    if (stamp_us == 0 || stamp_us > real_us) {
        return now_us;
    }
    const uint64_t age_us = real_us - stamp_us;
    if (age_us > AGE_MAX_US || age_us > now_us) {
        return (last_us < now_us) ? last_us : now_us;
    }
    return now_us - age_us;
}

uint64_t linux_clock_of_stamp(const linux_clock_t *clock, uint64_t stamp_us) {
    return linux_clock_of_stamp_after(clock, stamp_us, UINT64_MAX);
}

#include "text/units.h"

#include <time.h>

uint64_t monotonic_ms(void) {
    struct timespec now;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return ((uint64_t)now.tv_sec * MS_PER_S) + ((uint64_t)now.tv_nsec / NS_PER_MS);
}

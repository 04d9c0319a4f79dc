#include "common/prng.h"

uint64_t prng_next(uint64_t *state) {
    *state += 0x9E3779B97F4A7C15u;
    uint64_t z = *state;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9u;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBu;
    return z ^ (z >> 31);
}

uint32_t prng_draw(uint64_t *state, uint32_t lowest, uint32_t highest) {
    const uint64_t span = (highest > lowest) ? ((uint64_t)highest - lowest) + 1 : 1;
    return lowest + (uint32_t)(prng_next(state) % span);
}

bool prng_toss(uint64_t *state, uint32_t in) {
    return prng_draw(state, 1, in) == 1;
}

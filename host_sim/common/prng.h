/**
 * @file prng.h
 * Random numbers that follow from a state alone: the same state, the same numbers, on every computer.
 */
#ifndef HOST_SIM_PRNG_H
#define HOST_SIM_PRNG_H

#include <stdbool.h>
#include <stdint.h>

/** The next 64 bits (splitmix64); @p state may begin with any value. */
uint64_t prng_next(uint64_t *state);

/** A number from @p lowest up to and with @p highest; @p lowest when that is the larger one. */
uint32_t prng_draw(uint64_t *state, uint32_t lowest, uint32_t highest);

/** True one time in @p in. */
bool prng_toss(uint64_t *state, uint32_t in);

#endif

/**
 * @file gaps.h
 * Gaps between frames, counted as they come in a histogram of fixed size.
 *
 * Number, shortest and longest gap are exact. Every power of two of microseconds has 64 equal cells, each with its own
 * shortest and longest gap, so a gap found by its rank (median, 99.9 %) is within 1.6 % (1/64) of the true one. It is
 * exact up to 128 us, and where the gaps of its cell are equal.
 */
#ifndef HOST_SIM_GAPS_H
#define HOST_SIM_GAPS_H

#include <stddef.h>
#include <stdint.h>

#define GAPS_CELLS_PER_OCTAVE ((size_t)64)
/** Up to 2^37 us (38 hours); longer gaps are in the last cell. */
#define GAPS_CELLS (GAPS_CELLS_PER_OCTAVE * (size_t)32)

/** Gaps of nearly the same length, as differences from the least one that the cell can have. */
typedef struct {
    uint32_t count;
    uint32_t shortest;
    uint32_t longest;
} gaps_cell_t;

/** All zero: no gap yet. Some 24 KiB. Up to 4 thousand million gaps in each cell. */
typedef struct {
    uint64_t count;
    uint64_t shortest_us;
    uint64_t longest_us;
    uint64_t longest_at_us; /**< when the longest one began */
    gaps_cell_t cells[GAPS_CELLS];
} gaps_t;

/** Add a gap. @param begin_us when it began */
void gaps_add(gaps_t *gaps, uint64_t begin_us, uint64_t gap_us);

/** The gap of which @p permille of 1000 gaps are no longer, by proportion between those of its cell; 0: no gaps. */
uint64_t gaps_quantile_us(const gaps_t *gaps, uint32_t permille);

/** The shortest gap that at most @p longer gaps exceed, or up to 1.6 % more; 0: there are not more gaps than that. */
uint64_t gaps_without_longest_us(const gaps_t *gaps, uint64_t longer);

/** Number of gaps that are longer than @p limit_us, within 1.6 %. */
uint64_t gaps_longer_than(const gaps_t *gaps, uint64_t limit_us);

#endif

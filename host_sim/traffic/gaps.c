#include "traffic/gaps.h"

#include <stddef.h>

enum { PERMILLE = 1000, LINEAR_OCTAVE = 6, HIGHEST_BIT = 63 };

/** The cell of a gap: linear below 128 us, then 64 cells for each power of two. */
static size_t cell_of(uint64_t gap_us) {
    if (gap_us < 2u * GAPS_CELLS_PER_OCTAVE) {
        return (size_t)gap_us;
    }
    const uint32_t octave = (uint32_t)(HIGHEST_BIT - __builtin_clzll(gap_us)) - (uint32_t)LINEAR_OCTAVE;
    const size_t cell = ((size_t)octave * GAPS_CELLS_PER_OCTAVE) + (size_t)(gap_us >> octave);
    return (cell < GAPS_CELLS) ? cell : GAPS_CELLS - 1u;
}

/** The longest gap of a cell. */
static uint64_t top_of(size_t cell) {
    if (cell < 2u * GAPS_CELLS_PER_OCTAVE) {
        return cell;
    }
    const uint32_t octave = (uint32_t)(cell / GAPS_CELLS_PER_OCTAVE) - 1u;
    const uint64_t mantissa = (cell % GAPS_CELLS_PER_OCTAVE) + GAPS_CELLS_PER_OCTAVE;
    return ((mantissa + 1u) << octave) - 1u;
}

void gaps_add(gaps_t *gaps, uint64_t begin_us, uint64_t gap_us) {
    if ((gaps->count == 0u) || (gap_us < gaps->shortest_us)) {
        gaps->shortest_us = gap_us;
    }
    if ((gaps->count == 0u) || (gap_us > gaps->longest_us)) {
        gaps->longest_us = gap_us;
        gaps->longest_at_us = begin_us;
    }
    gaps->count++;
    gaps->cells[cell_of(gap_us)]++;
}

/** The gap with this rank, the shortest one having rank 1. */
static uint64_t ranked_us(const gaps_t *gaps, uint64_t rank) {
    uint64_t seen = 0u;
    for (size_t cell = 0u; cell < GAPS_CELLS - 1u; cell++) {
        seen += gaps->cells[cell];
        if (seen >= rank) {
            const uint64_t top_us = top_of(cell);
            return (top_us < gaps->longest_us) ? top_us : gaps->longest_us;
        }
    }
    return gaps->longest_us;
}

uint64_t gaps_quantile_us(const gaps_t *gaps, uint32_t permille) {
    if (gaps->count == 0u) {
        return 0u;
    }
    const uint64_t rank = ((gaps->count * permille) + (uint64_t)PERMILLE - 1u) / (uint64_t)PERMILLE;
    return ranked_us(gaps, (rank > 0u) ? rank : 1u);
}

uint64_t gaps_without_longest_us(const gaps_t *gaps, uint64_t longer) {
    return (gaps->count > longer) ? ranked_us(gaps, gaps->count - longer) : 0u;
}

uint64_t gaps_longer_than(const gaps_t *gaps, uint64_t limit_us) {
    uint64_t longer = 0u;
    for (size_t cell = cell_of(limit_us) + 1u; cell < GAPS_CELLS; cell++) {
        longer += gaps->cells[cell];
    }
    return longer;
}

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
static uint64_t longest_gap_of(size_t cell) {
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

/** The cell of the gap with this rank, the shortest one having rank 1. @param before the gaps in the cells before */
static size_t cell_of_rank(const gaps_t *gaps, uint64_t rank, uint64_t *before) {
    size_t cell = 0u;
    *before = 0u;
    while ((cell < GAPS_CELLS - 1u) && (*before + gaps->cells[cell] < rank)) {
        *before += gaps->cells[cell];
        cell++;
    }
    return cell;
}

static uint64_t clamp(const gaps_t *gaps, uint64_t gap_us) {
    const uint64_t most_us = (gap_us < gaps->longest_us) ? gap_us : gaps->longest_us;
    return (most_us > gaps->shortest_us) ? most_us : gaps->shortest_us;
}

uint64_t gaps_quantile_us(const gaps_t *gaps, uint32_t permille) {
    if (gaps->count == 0u) {
        return 0u;
    }
    const uint64_t least = ((gaps->count * permille) + (uint64_t)PERMILLE - 1u) / (uint64_t)PERMILLE;
    const uint64_t rank = (least > 0u) ? least : 1u;
    uint64_t before = 0u;
    const size_t cell = cell_of_rank(gaps, rank, &before);
    if (cell == GAPS_CELLS - 1u) {
        return gaps->longest_us;
    }
    const uint64_t width_us = longest_gap_of(cell) - ((cell > 0u) ? longest_gap_of(cell - 1u) : 0u);
    const uint64_t above = gaps->cells[cell] - (rank - before); /* gaps of the cell that are longer */
    return clamp(gaps, longest_gap_of(cell) - ((width_us * above) / gaps->cells[cell]));
}

uint64_t gaps_without_longest_us(const gaps_t *gaps, uint64_t longer) {
    if (gaps->count <= longer) {
        return 0u;
    }
    uint64_t before = 0u;
    const size_t cell = cell_of_rank(gaps, gaps->count - longer, &before);
    return clamp(gaps, (cell == GAPS_CELLS - 1u) ? gaps->longest_us : longest_gap_of(cell));
}

uint64_t gaps_longer_than(const gaps_t *gaps, uint64_t limit_us) {
    uint64_t longer = 0u;
    for (size_t cell = cell_of(limit_us) + 1u; cell < GAPS_CELLS; cell++) {
        longer += gaps->cells[cell];
    }
    return longer;
}

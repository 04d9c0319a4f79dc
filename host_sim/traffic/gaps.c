#include "traffic/gaps.h"

#include <stddef.h>

enum { PERMILLE = 1000, LINEAR_OCTAVE = 6, HIGHEST_BIT = 63 };

/** The cell of a gap: linear below 128 us, then 64 cells for each power of two. */
static size_t cell_of(uint64_t gap_us) {
    if (gap_us < 2 * GAPS_CELLS_PER_OCTAVE) {
        return (size_t)gap_us;
    }
    const uint32_t octave = (uint32_t)(HIGHEST_BIT - __builtin_clzll(gap_us)) - (uint32_t)LINEAR_OCTAVE;
    const size_t cell = ((size_t)octave * GAPS_CELLS_PER_OCTAVE) + (size_t)(gap_us >> octave);
    return (cell < GAPS_CELLS) ? cell : GAPS_CELLS - 1;
}

/** The shortest gap that a cell can have. */
static uint64_t begin_of(size_t cell) {
    const size_t octave = cell / GAPS_CELLS_PER_OCTAVE;
    if (octave < 2) {
        return cell;
    }
    return (uint64_t)((cell % GAPS_CELLS_PER_OCTAVE) + GAPS_CELLS_PER_OCTAVE) << (octave - 1);
}

void gaps_add(gaps_t *gaps, uint64_t begin_us, uint64_t gap_us) {
    if ((gaps->count == 0) || (gap_us < gaps->shortest_us)) {
        gaps->shortest_us = gap_us;
    }
    if ((gaps->count == 0) || (gap_us > gaps->longest_us)) {
        gaps->longest_us = gap_us;
        gaps->longest_at_us = begin_us;
    }
    gaps->count++;
    const size_t index = cell_of(gap_us);
    gaps_cell_t *cell = &gaps->cells[index];
    const uint32_t more = (uint32_t)(gap_us - begin_of(index));
    cell->shortest = ((cell->count == 0) || (more < cell->shortest)) ? more : cell->shortest;
    cell->longest = (more > cell->longest) ? more : cell->longest;
    cell->count++;
}

/** The cell of the gap with this rank, the shortest one having rank 1. @param before the gaps in the cells before */
static size_t cell_of_rank(const gaps_t *gaps, uint64_t rank, uint64_t *before) {
    size_t cell = 0;
    *before = 0;
    while ((cell < GAPS_CELLS - 1) && (*before + gaps->cells[cell].count < rank)) {
        *before += gaps->cells[cell].count;
        cell++;
    }
    return cell;
}

/** The gap of a cell at a place of its gaps, 0 being that of the shortest one. */
static uint64_t gap_of(const gaps_t *gaps, size_t index, uint64_t place) {
    if (index == GAPS_CELLS - 1) {
        return gaps->longest_us;
    }
    const gaps_cell_t *cell = &gaps->cells[index];
    const uint64_t range = cell->longest - cell->shortest;
    return begin_of(index) + cell->shortest + ((range == 0) ? 0 : (range * place) / (cell->count - 1));
}

uint64_t gaps_quantile_us(const gaps_t *gaps, uint32_t permille) {
    if (gaps->count == 0) {
        return 0;
    }
    const uint64_t least = ((gaps->count * permille) + (uint64_t)PERMILLE - 1) / PERMILLE;
    const uint64_t rank = (least > 0) ? least : 1;
    uint64_t before = 0;
    const size_t cell = cell_of_rank(gaps, rank, &before);
    return gap_of(gaps, cell, rank - before - 1);
}

uint64_t gaps_without_longest_us(const gaps_t *gaps, uint64_t longer) {
    if (gaps->count <= longer) {
        return 0;
    }
    uint64_t before = 0;
    const size_t cell = cell_of_rank(gaps, gaps->count - longer, &before);
    return gap_of(gaps, cell, (uint64_t)gaps->cells[cell].count - 1);
}

uint64_t gaps_longer_than(const gaps_t *gaps, uint64_t limit_us) {
    uint64_t longer = 0;
    for (size_t cell = cell_of(limit_us) + 1; cell < GAPS_CELLS; cell++) {
        longer += gaps->cells[cell].count;
    }
    return longer;
}

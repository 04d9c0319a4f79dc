/**
 * @file checkpoint.h
 * The state of a long run as it lies in memory, for the same program to go on from.
 */
#ifndef HOST_SIM_CHECKPOINT_H
#define HOST_SIM_CHECKPOINT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/output.h"

#define CHECKPOINT_NUMBERS 8u

/** What a checkpoint belongs to. */
typedef struct {
    const char *path; /**< NULL: nothing is saved or loaded */
    const char *kind; /**< "soak" */
    /**
     * Seed, shard and the like: a run in which one of them is different does not go on from it. Those left out are 0.
     */
    uint64_t numbers[CHECKPOINT_NUMBERS];
} checkpoint_t;

/** A piece of memory without pointers. */
typedef struct {
    void *bytes;
    size_t size;
} checkpoint_part_t;

/** Check the path of --checkpoint: standard output cannot be read. NULL is good. @return false: was reported */
bool checkpoint_check_path(const char *path);

/** Whether it could be written; one that is there stays as it is. @param path NULL is good @return false: was reported */
bool checkpoint_may_save(const char *path, output_t *file);

/** Write it. @return false: was reported */
bool checkpoint_save(const checkpoint_t *checkpoint, output_t *file, const checkpoint_part_t parts[], size_t count);

/**
 * Read it, if its file exists.
 * @param parts  as many and as large as those that were saved; undefined after a failure
 * @param loaded whether it was read
 * @return false: it is damaged or belongs to another run; was reported
 */
bool checkpoint_load(const checkpoint_t *checkpoint, const checkpoint_part_t parts[], size_t count, bool *loaded);

#endif

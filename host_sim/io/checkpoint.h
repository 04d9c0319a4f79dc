/**
 * @file checkpoint.h
 * The state of a long run as it lies in memory, for the same program to go on from. While a run has it open, no other
 * one can: the kernel locks the file, and forgets the lock when the program ends, however it ends.
 */
#ifndef HOST_SIM_CHECKPOINT_H
#define HOST_SIM_CHECKPOINT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "io/output.h"

#define CHECKPOINT_NUMBERS 4u

/** A checkpoint, and what it belongs to. */
typedef struct {
    const char *path; /**< NULL: nothing is saved or loaded */
    const char *kind; /**< "soak" */
    /**
     * Seed, shard and the like: a run in which one of them is different does not go on from it. Those left out are 0.
     */
    uint64_t numbers[CHECKPOINT_NUMBERS];
    /** @name Of checkpoint.c @{ */
    uint32_t program; /**< checksum of the program's file */
    int lock;         /**< the file that is locked */
    bool is_open;
    bool is_made; /**< the file was not there, and nothing is saved in it yet */
    /** @} */
} checkpoint_t;

/** A piece of memory without pointers. */
typedef struct {
    void *bytes;
    size_t size;
} checkpoint_part_t;

/** Check the path of --checkpoint: standard output cannot be read. NULL is good. @return false: was reported */
bool checkpoint_check_path(const char *path);

/**
 * Keep it for this run, and see that it can be written. A file that is there stays as it is; otherwise an empty one is
 * made. On a file system without locks a line says that nothing is locked. Signals are held back from here on
 * (interrupt.h).
 * @return false: another run has it, or it cannot be written; was reported
 */
bool checkpoint_open(checkpoint_t *checkpoint, output_t *file);

/**
 * Read it, if something was saved in it.
 * @param parts  as many and as large as those that were saved; undefined after a failure
 * @param loaded whether it was read
 * @return false: it is damaged, or belongs to another run or program; was reported
 */
bool checkpoint_load(const checkpoint_t *checkpoint, const checkpoint_part_t parts[], size_t count, bool *loaded);

/** Write it. @return false: was reported */
bool checkpoint_save(checkpoint_t *checkpoint, output_t *file, const checkpoint_part_t parts[], size_t count);

/** Let others have it. The empty file that checkpoint_open() made is removed. Nothing when it is not open. */
void checkpoint_close(checkpoint_t *checkpoint);

#endif

/**
 * @file hunt.h
 * A hunt: searches for hazards with random attacks and with mutations of those that came close. docs/hunt.md is its
 * manual.
 *
 * Runs come in pieces of HUNT_PIECE_RUNS. A piece depends on the seed and its number only: each begins with an empty
 * corpus. So shards and checkpoints are whole pieces.
 */
#ifndef HOST_SIM_HUNT_H
#define HOST_SIM_HUNT_H

#include <stdint.h>

#include "common/report.h"

#define HUNT_PIECE_RUNS 500u

/** The options. */
typedef struct {
    uint64_t runs;    /**< of all shards together; UINT64_MAX: until the time is over */
    uint64_t minutes; /**< UINT64_MAX: until all runs are done */
    uint64_t seed;
    uint32_t shard; /**< 1 .. shards */
    uint32_t shards;
    const char *checkpoint; /**< file; NULL: none. The run resumes from it if it exists */
    const char *folder;     /**< for scenarios of hazards */
} hunt_request_t;

/** Run. @return STATUS_UNMET: a hazard was found */
status_t hunt_run(const hunt_request_t *request);

/** Print what counts as a hazard. */
void hunt_list_hazards(void);

#endif

/**
 * @file soak.h
 * A soak: the supervisor and its vehicle for days and months of virtual time, with random disturbances that it has to
 * survive. Nothing may trip, drift or be miscounted.
 */
#ifndef HOST_SIM_SOAK_H
#define HOST_SIM_SOAK_H

#include <stdint.h>

#include "common/report.h"

/** The options. */
typedef struct {
    uint32_t hours; /**< of all shards together */
    uint64_t seed;
    uint32_t shard; /**< 1 .. shards; each is a stretch of the time, one after the other */
    uint32_t shards;
    const char *checkpoint; /**< file; NULL: none. The run resumes from it if it exists */
    const char *results;    /**< file; NULL: none */
} soak_request_t;

/** Run. @return STATUS_UNMET: something tripped, drifted or was miscounted */
status_t soak_run(const soak_request_t *request);

#endif

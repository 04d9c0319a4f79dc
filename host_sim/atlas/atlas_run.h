/**
 * @file atlas_run.h
 * The atlas of double faults: plays the cases of a shard, judges them, and writes them as JSON Lines.
 */
#ifndef HOST_SIM_ATLAS_RUN_H
#define HOST_SIM_ATLAS_RUN_H

#include <stdbool.h>
#include <stdint.h>

#include "campaign/campaign_rows.h"
#include "common/report.h"

/** The options. */
typedef struct {
    uint32_t shard; /**< 1 .. shards */
    uint32_t shards;
    const campaign_row_t *first;  /**< only cases with this first fault; NULL: all */
    const campaign_row_t *second; /**< the same of the second one */
    const char *results;          /**< file; NULL: none */
    bool shows_one;               /**< print case `one` as a scenario, nothing else */
    uint32_t one;
} atlas_request_t;

/** Run. @return STATUS_UNMET: a pair is weaker than its worse baseline in some case */
status_t atlas_run(const atlas_request_t *request);

#endif

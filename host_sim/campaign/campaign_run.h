/**
 * @file campaign_run.h
 * A campaign: its runs, one after the other, each on a bus and with a vehicle of its own, evaluated.
 */
#ifndef HOST_SIM_CAMPAIGN_RUN_H
#define HOST_SIM_CAMPAIGN_RUN_H

#include "campaign/campaign_result.h"
#include "common/report.h"

/** The options. */
typedef struct {
    campaign_part_t part;
    const char *results; /**< file; NULL: none */
    const char *why;     /**< file; NULL: none */
    const char *folder;  /**< for the scenarios of broken runs */
    bool shows_one;      /**< print run `one` as a scenario, nothing else */
    uint64_t one;
} campaign_request_t;

/** Run. @return STATUS_UNMET: an invariant did not hold */
status_t campaign_run(const campaign_request_t *request);

#endif

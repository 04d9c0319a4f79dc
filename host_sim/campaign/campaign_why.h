/**
 * @file campaign_why.h
 * What `--why` would say of each run of a campaign: the injected fault is known, so it can be checked.
 */
#ifndef HOST_SIM_CAMPAIGN_WHY_H
#define HOST_SIM_CAMPAIGN_WHY_H

#include <stdbool.h>

#include "campaign/campaign_plan.h"
#include "io/output.h"
#include "scenario/scenario_testbed.h"
#include "why/why.h"

/** The analysis of a run. All zero: none. */
typedef struct {
    why_t *why;
} campaign_why_t;

/** Begin a run. @return false: no memory; was reported */
bool campaign_why_init(campaign_why_t *why, const agv_config_t *config);

/** The callbacks for events and frames. */
scenario_watch_t campaign_why_watch(campaign_why_t *why);

/** The run is over: write it as a line of JSON. */
void campaign_why_write(campaign_why_t *why, output_t *output, const campaign_plan_t *plan);

/** Release it. */
void campaign_why_free(campaign_why_t *why);

#endif

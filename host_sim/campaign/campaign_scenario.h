/**
 * @file campaign_scenario.h
 * A run of a campaign as a scenario file: what was done, and what has to come of it.
 */
#ifndef HOST_SIM_CAMPAIGN_SCENARIO_H
#define HOST_SIM_CAMPAIGN_SCENARIO_H

#include "campaign/campaign_check.h"

/**
 * Write a run that was evaluated. What is expected are the invariants, so that a run that breaks one fails as a
 * scenario; what they leave open (when the safe state is confirmed) is expected as it was seen.
 */
void campaign_scenario_write(text_t *text, const campaign_check_t *check);

#endif

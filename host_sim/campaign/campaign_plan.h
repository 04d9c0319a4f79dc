/**
 * @file campaign_plan.h
 * One run of a campaign, drawn from random numbers and written as the text of a scenario.
 *
 * A run depends on the seed and its number only, so it is the same in every shard.
 */
#ifndef HOST_SIM_CAMPAIGN_PLAN_H
#define HOST_SIM_CAMPAIGN_PLAN_H

#include <stdbool.h>
#include <stdint.h>

#include "campaign/campaign_rows.h"
#include "text/text.h"

/** A run. */
typedef struct {
    uint64_t seed;
    uint64_t run;
    const campaign_row_t *row;
    const campaign_engagement_t *engagement; /**< NULL: the cause comes under way */
    bool gateway;
    bool table_ids;
    bool renumbered; /**< each identifier is one more than that of the set */
    uint32_t bitrate;
    bool park_guard;
    bool at_standstill; /**< park: at_standstill */
    bool engaged;
    bool bunched; /**< all messages are due in the same milliseconds */
    uint16_t tick_phase_us;
    uint32_t clock_start_ms;
    uint32_t number;    /**< $n */
    uint32_t engage_ms; /**< with an engagement: when the operator switches */
    uint32_t steps_ms;  /**< when the steps of the row come */
    uint32_t cause_ms;  /**< times are counted from here: the steps, $n ms after them, or the engagement */
    uint32_t bound_us;  /**< after the cause: the reaction has come */
    uint32_t duration_ms;
    text_t head; /**< the scenario with its steps, without its expectations */
} campaign_plan_t;

/** Which causes a campaign has. */
typedef struct {
    const campaign_row_t *only; /**< NULL: any fault; with `newly_engaged` one that an engagement delays */
    bool newly_engaged;         /**< the cause comes with an engagement, and not under way */
} campaign_causes_t;

/** Make a run. */
void campaign_plan_make(campaign_plan_t *plan, uint64_t seed, uint64_t run, const campaign_causes_t *causes);

#endif

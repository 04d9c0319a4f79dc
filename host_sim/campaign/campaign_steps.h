/**
 * @file campaign_steps.h
 * The steps of a row of campaign_rows.h, and the settings it needs, as words of a scenario file.
 */
#ifndef HOST_SIM_CAMPAIGN_STEPS_H
#define HOST_SIM_CAMPAIGN_STEPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "campaign/campaign_rows.h"
#include "text/text.h"

#define CAMPAIGN_STEPS_MAX 8u
#define CAMPAIGN_WORDS_SIZE 160u

/** A step: "eps: freeze_counter" */
typedef struct {
    uint32_t at_ms;
    char words[CAMPAIGN_WORDS_SIZE];
} campaign_step_t;

/** What the placeholders of a row stand for. */
typedef struct {
    uint32_t number; /**< $n */
    bool gateway;    /**< $s: the side of the AI computer */
    bool table_ids;  /**< $o: 43Fh as the other set has it */
} campaign_values_t;

/** Add the settings that a row needs, as lines of a scenario's `config`. */
void campaign_settings(text_t *text, const campaign_row_t *row);

/** How many ways a row has to cause its fault: at least 1. */
uint32_t campaign_alternatives(const campaign_row_t *row);

/**
 * The steps of one of these ways.
 * @param alternative below campaign_alternatives()
 * @param from_ms     time of the first step
 * @param steps       filled in, in the order of time; room for CAMPAIGN_STEPS_MAX
 * @return how many
 */
size_t campaign_steps(const campaign_row_t *row, uint32_t alternative, uint32_t from_ms,
                      const campaign_values_t *values, campaign_step_t *steps);

#endif

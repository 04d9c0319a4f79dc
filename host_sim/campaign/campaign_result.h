/**
 * @file campaign_result.h
 * The results of a campaign: one JSON object for each run, and one table of all runs.
 */
#ifndef HOST_SIM_CAMPAIGN_RESULT_H
#define HOST_SIM_CAMPAIGN_RESULT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "campaign/campaign_check.h"
#include "io/output.h"

/** Which runs: those whose number leaves the rest `shard` - 1 when divided by `shards`. */
typedef struct {
    uint64_t runs; /**< of all shards */
    uint64_t seed;
    uint32_t shard; /**< 1 .. shards */
    uint32_t shards;
    campaign_causes_t causes;
} campaign_part_t;

/** A time that there is not. */
#define CAMPAIGN_NO_TIME INT32_MIN

/** A run, as the table needs it. Times are microseconds after the cause. */
typedef struct {
    uint8_t row;
    bool broken;
    int32_t safe_us;
    int32_t confirmed_us;
    int32_t opened_us;
} campaign_sample_t;

/** All runs so far. */
typedef struct {
    campaign_sample_t *samples;
    size_t count;
    size_t room;
} campaign_samples_t;

/** @return false: no memory; was reported */
bool campaign_samples_add(campaign_samples_t *samples, const campaign_sample_t *sample);
void campaign_samples_free(campaign_samples_t *samples);

/** A run as a row of the table. */
campaign_sample_t campaign_sample_of(const campaign_check_t *check);

/** The first line of a file of results, and that of a run. Failures are remembered by the output. */
void campaign_write_part(output_t *output, const campaign_part_t *part);
void campaign_write_run(output_t *output, const campaign_check_t *check);

/** Print the table on standard output. @return false: no memory; was reported */
bool campaign_print_table(const campaign_samples_t *samples);

/**
 * Read the files of all shards of one campaign, and write them as that of the whole.
 * @param count at most SHARDS_MAX
 * @param merged not open: nothing is written
 * @return false: they are no whole campaign; was reported
 */
bool campaign_merge(char *const files[], size_t count, campaign_samples_t *samples, output_t *merged);

#endif

/**
 * @file random_options.h
 * The options of commands that make random runs, which can be divided into shards.
 */
#ifndef HOST_SIM_RANDOM_OPTIONS_H
#define HOST_SIM_RANDOM_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "cli/options.h"

#define SHARDS_MAX 1000u
#define RANDOM_OPTIONS 2u

/** What was given. Start from random_options_init(). */
typedef struct {
    uint64_t seed;     /**< --seed; OPTION_NOT_GIVEN */
    const char *shard; /**< --shard; NULL: not given */
} random_options_t;

/**
 * Nothing given.
 * @param rows are filled in with the options
 * @param parts help of --shard: "only part I of N of the runs (1/1)"
 */
void random_options_init(random_options_t *options, option_t rows[RANDOM_OPTIONS], const char *parts);

/** Read a shard: "2/8". @return false: it is not I/N; was reported */
bool random_options_shard(const char *text, uint32_t *shard, uint32_t *shards);

/**
 * Check the options.
 * @param command "soak": whose `--help` is named
 * @param shard   part of @p shards; 1 of 1 if it is not given
 * @return false: the seed is missing, or the shard is not I/N; was reported
 */
bool random_options_check(const random_options_t *options, const char *command, uint32_t *shard, uint32_t *shards);

#endif

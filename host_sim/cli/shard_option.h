/**
 * @file shard_option.h
 * The option --shard I/N.
 */
#ifndef HOST_SIM_SHARD_OPTION_H
#define HOST_SIM_SHARD_OPTION_H

#include <stdbool.h>
#include <stdint.h>

#define SHARDS_MAX 1000u

/** Read "2/8". @return false: it is no such thing; reported */
bool shard_option_take(const char *text, uint32_t *shard, uint32_t *shards);

#endif

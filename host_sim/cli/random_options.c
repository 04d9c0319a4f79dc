#include "cli/random_options.h"

#include <string.h>

#include "common/report.h"
#include "text/words.h"

void random_options_init(random_options_t *options, option_t rows[RANDOM_OPTIONS], const char *parts) {
    *options = (random_options_t){.seed = OPTION_NOT_GIVEN};
    rows[0] = (option_t)OPTION_NUMBER("--seed", "S", "random seed; the same seed gives the same runs", &options->seed,
                                      0, INT64_MAX);
    rows[1] = (option_t)OPTION_TEXT("--shard", "I/N", parts, &options->shard);
}

bool random_options_shard(const char *text, uint32_t *shard, uint32_t *shards) {
    char first[8];
    uint64_t part = 0;
    uint64_t parts = 0;
    const size_t length = strcspn(text, "/");

    if ((length >= sizeof first) || (text[length] != '/')) {
        return report("--shard: '%s' is not I/N, such as 2/8", text);
    }
    memcpy(first, text, length);
    first[length] = '\0';
    if (!words_decimal(&text[length + 1], 1, SHARDS_MAX, &parts) || !words_decimal(first, 1, parts, &part)) {
        return report("--shard: '%s' is not I/N with I from 1 to N and N at most %u", text, SHARDS_MAX);
    }
    *shard = (uint32_t)part;
    *shards = (uint32_t)parts;
    return true;
}

bool random_options_check(const random_options_t *options, const char *command, uint32_t *shard, uint32_t *shards) {
    if (options->seed == OPTION_NOT_GIVEN) {
        return report("--seed is missing; see host_sim %s --help", command);
    }
    *shard = 1;
    *shards = 1;
    return (options->shard == NULL) || random_options_shard(options->shard, shard, shards);
}

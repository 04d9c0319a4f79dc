#include "cli/shard_option.h"

#include <string.h>

#include "common/report.h"
#include "common/words.h"

bool shard_option_take(const char *text, uint32_t *shard, uint32_t *shards) {
    char first[8];
    uint64_t part = 0u;
    uint64_t parts = 0u;
    const size_t length = strcspn(text, "/");

    if ((length >= sizeof first) || (text[length] != '/')) {
        return report("--shard: '%s' is not I/N, such as 2/8", text);
    }
    memcpy(first, text, length);
    first[length] = '\0';
    if (!words_decimal(&text[length + 1u], 1u, SHARDS_MAX, &parts) || !words_decimal(first, 1u, parts, &part)) {
        return report("--shard: '%s' is not I/N with I from 1 to N and N at most %u", text, SHARDS_MAX);
    }
    *shard = (uint32_t)part;
    *shards = (uint32_t)parts;
    return true;
}

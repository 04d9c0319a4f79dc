#include "part.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

part_t part_read(const char *program, int argc, char **argv) {
    part_t part = {.shard = 0, .shards = 1, .every = 1};
    for (int i = 1; i + 1 < argc; i += 2) {
        if (strcmp(argv[i], "--shard") == 0) {
            char *end = NULL;
            part.shard = (unsigned)strtoul(argv[i + 1], &end, 10);
            part.shards = (*end == '/') ? (unsigned)strtoul(end + 1, NULL, 10) : 0;
        } else if (strcmp(argv[i], "--every") == 0) {
            part.every = (unsigned)strtoul(argv[i + 1], NULL, 10);
        } else {
            part.shards = 0;
        }
    }
    if (((argc % 2) == 0) || (part.shards == 0) || (part.shard >= part.shards) || (part.every == 0)) {
        (void)fprintf(stderr, "usage: %s [--shard I/N] [--every N]     I from 0\n", program);
        exit(2);
    }
    return part;
}

/* Checkpoints of a soak: its state and the whole testbed. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "agv/checksum.h"
#include "campaign/soak/soak_internal.h"
#include "io/checkpoint.h"

enum { CHUNK_SIZE = 65536 };

/** The checksum of the program's file: another build may have another layout of the testbed. */
static bool identify_program(soak_t *soak) {
    static const char path[] = "/proc/self/exe";
    uint8_t chunk[CHUNK_SIZE];
    FILE *stream = fopen(path, "rb");

    if (stream == NULL) {
        return report("--checkpoint: %s: %s", path, strerror(errno));
    }
    soak->program = AGV_CRC32_START;
    while ((feof(stream) == 0) && (ferror(stream) == 0)) {
        const size_t length = fread(chunk, 1, sizeof chunk, stream);
        soak->program = agv_crc32(soak->program, chunk, length);
    }
    const bool good = ferror(stream) == 0;
    (void)fclose(stream);
    return good || report("--checkpoint: %s cannot be read", path);
}

static checkpoint_t checkpoint_of(const soak_t *soak) {
    const soak_request_t *request = soak->request;
    return (checkpoint_t){
        .path = request->checkpoint,
        .kind = "soak",
        .numbers = {request->seed, request->hours, request->shard, request->shards, soak->program},
    };
}

bool soak_save(soak_t *soak) {
    const checkpoint_t checkpoint = checkpoint_of(soak);
    const checkpoint_part_t parts[] = {{&soak->state, sizeof soak->state}, {&soak->testbed, sizeof soak->testbed}};

    return checkpoint_save(&checkpoint, &soak->file, parts, sizeof parts / sizeof parts[0]);
}

bool soak_load(soak_t *soak) {
    if ((soak->request->checkpoint != NULL) && !identify_program(soak)) {
        return false;
    }
    const checkpoint_t checkpoint = checkpoint_of(soak);
    const checkpoint_part_t parts[] = {{&soak->state, sizeof soak->state}, {&soak->saved, sizeof soak->saved}};
    bool loaded = false;

    const bool good = checkpoint_load(&checkpoint, parts, sizeof parts / sizeof parts[0], &loaded);
    if (loaded) {
        scenario_testbed_restore(&soak->testbed, &soak->saved);
    }
    return good;
}

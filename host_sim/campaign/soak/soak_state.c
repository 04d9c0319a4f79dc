/* Checkpoints of a soak: the whole world as it lies in memory, for the same program to go on from. */
#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "agv/checksum.h"
#include "campaign/soak/soak_internal.h"

/** What stands before it. */
typedef struct {
    char magic[16];
    char version[16];
    uint64_t world_size;
    uint64_t state_size;
    uint64_t seed;
    uint64_t hours;
    uint32_t shard;
    uint32_t shards;
    uint32_t checksum; /**< of state and world */
    uint32_t program;  /**< checksum of the program's file */
} head_t;

enum { CHUNK_SIZE = 65536 };

/** What a checkpoint says of the program: another build may have another layout of the world. */
static bool identify_program(soak_t *soak) {
    static const char path[] = "/proc/self/exe";
    uint8_t chunk[CHUNK_SIZE];
    FILE *stream = fopen(path, "rb");

    if (stream == NULL) {
        return report("--checkpoint: %s: %s", path, strerror(errno));
    }
    soak->program = AGV_CRC32_START;
    while ((feof(stream) == 0) && (ferror(stream) == 0)) {
        const size_t length = fread(chunk, 1u, sizeof chunk, stream);
        soak->program = agv_crc32(soak->program, chunk, length);
    }
    const bool good = ferror(stream) == 0;
    (void)fclose(stream);
    return good || report("--checkpoint: %s cannot be read", path);
}

static head_t head_of(const soak_t *soak) {
    head_t head;
    memset(&head, 0, sizeof head);
    (void)snprintf(head.magic, sizeof head.magic, "agv soak 1");
    (void)snprintf(head.version, sizeof head.version, "%s", HOST_SIM_VERSION);
    head.world_size = sizeof soak->world;
    head.state_size = sizeof soak->state;
    head.seed = soak->request->seed;
    head.hours = soak->request->hours;
    head.shard = soak->request->shard;
    head.shards = soak->request->shards;
    head.program = soak->program;
    return head;
}

static uint32_t checksum_of(const soak_state_t *state, const scenario_world_t *world) {
    const uint32_t crc = agv_crc32(AGV_CRC32_START, state, sizeof *state);
    return agv_crc32(crc, world, sizeof *world);
}

bool soak_save(soak_t *soak) {
    head_t head = head_of(soak);

    if (soak->request->checkpoint == NULL) {
        return true;
    }
    head.checksum = checksum_of(&soak->state, &soak->world);
    if (!output_open(&soak->file, soak->request->checkpoint)) {
        return false;
    }
    (void)output_write(&soak->file, &head, sizeof head);
    (void)output_write(&soak->file, &soak->state, sizeof soak->state);
    (void)output_write(&soak->file, &soak->world, sizeof soak->world);
    return output_commit(&soak->file);
}

bool soak_may_save(soak_t *soak) {
    const char *path = soak->request->checkpoint;
    const bool may = (path == NULL) || output_open(&soak->file, path);
    output_discard(&soak->file);
    return may;
}

static bool read_all(soak_t *soak, FILE *stream) {
    const char *path = soak->request->checkpoint;
    const head_t expected = head_of(soak);
    soak_state_t state;
    head_t head;

    if (fread(&head, sizeof head, 1u, stream) != 1u) {
        return report("%s: not a soak checkpoint", path);
    }
    const uint32_t checksum = head.checksum;
    head.checksum = 0u;
    if (memcmp(&head, &expected, sizeof head) != 0) {
        return report("%s: the checkpoint of another soak or another build; remove it to start over", path);
    }
    if ((fread(&state, sizeof state, 1u, stream) != 1u) ||
        (fread(&soak->saved, sizeof soak->saved, 1u, stream) != 1u) || (fgetc(stream) != EOF) ||
        (checksum_of(&state, &soak->saved) != checksum)) {
        return report("%s: a damaged checkpoint; remove it to start over", path);
    }
    scenario_world_restore(&soak->world, &soak->saved);
    soak->state = state;
    return true;
}

bool soak_load(soak_t *soak) {
    const char *path = soak->request->checkpoint;

    if (path == NULL) {
        return true;
    }
    if (!identify_program(soak)) {
        return false;
    }
    FILE *stream = fopen(path, "rb");
    if (stream == NULL) {
        return (errno == ENOENT) || report("%s: %s", path, strerror(errno));
    }
    const bool good = read_all(soak, stream);
    (void)fclose(stream);
    return good;
}

#include "hunt/hunt_state.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>

#include "agv/checksum.h"

/** What stands before it: another hunt, or another version of the program, does not go on from it. */
typedef struct {
    char magic[16];
    char version[16];
    uint64_t seed;
    uint64_t state_size;
    uint32_t shard;
    uint32_t shards;
    uint32_t attacks;
    uint32_t settings;
    uint32_t faults;
    uint32_t checksum;
} head_t;

static head_t head_of(const hunt_request_t *request, const hunt_state_t *state) {
    head_t head;

    memset(&head, 0, sizeof head);
    (void)snprintf(head.magic, sizeof head.magic, "agv hunt 1");
    (void)snprintf(head.version, sizeof head.version, "%s", HOST_SIM_VERSION);
    head.seed = request->seed;
    head.state_size = sizeof *state;
    head.shard = request->shard;
    head.shards = request->shards;
    head.attacks = (uint32_t)HUNT_ATTACK_COUNT;
    head.settings = AGV_SETTING_COUNT;
    head.faults = AGV_FAULT_COUNT;
    head.checksum = agv_crc32(AGV_CRC32_START, state, sizeof *state);
    return head;
}

bool hunt_state_save(const hunt_request_t *request, const hunt_state_t *state, output_t *file) {
    const head_t head = head_of(request, state);

    if (request->checkpoint == NULL) {
        return true;
    }
    if (!output_open(file, request->checkpoint)) {
        return false;
    }
    (void)output_write(file, &head, sizeof head);
    (void)output_write(file, state, sizeof *state);
    return output_commit(file);
}

static bool read_all(const hunt_request_t *request, hunt_state_t *state, FILE *stream) {
    const char *path = request->checkpoint;
    head_t head;

    if (fread(&head, sizeof head, 1u, stream) != 1u) {
        return report("%s: not a hunt checkpoint", path);
    }
    if ((fread(state, sizeof *state, 1u, stream) != 1u) || (fgetc(stream) != EOF)) {
        memset(state, 0, sizeof *state);
    }
    const head_t expected = head_of(request, state);
    return (memcmp(&head, &expected, sizeof head) == 0) ||
           report("%s: the checkpoint of another hunt, or a damaged one; remove it to start over", path);
}

bool hunt_state_load(const hunt_request_t *request, hunt_state_t *state) {
    memset(state, 0, sizeof *state);
    if (request->checkpoint == NULL) {
        return true;
    }
    FILE *stream = fopen(request->checkpoint, "rb");
    if (stream == NULL) {
        return (errno == ENOENT) || report("%s: %s", request->checkpoint, strerror(errno));
    }
    const bool good = read_all(request, state, stream);
    (void)fclose(stream);
    return good;
}
